"""H-infinity tracking: computed torque on a nominal model with a robust state feedback around it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvals, solve_continuous_are

Array = NDArray[np.float64]


class NominalModel(Protocol):
    """What the law knows of the arm: M(q), C(q, dq) dq + G(q), J(q) and J'(q, dq) dq."""

    def mass_matrix(self, position: Array) -> Array: ...

    def bias(self, position: Array, velocity: Array) -> Array: ...

    def jacobian(self, position: Array) -> Array: ...

    def drift(self, position: Array, velocity: Array) -> Array: ...


def integrator_chain(order: int) -> tuple[Array, Array]:
    """System and input matrix of a chain of integrators, shapes (n, n) and (n, 1), lowest derivative first."""
    return np.eye(order, k=1), np.eye(order)[:, -1:]


def hinfinity_gain(weights: Sequence[float], effort: float, attenuation: float) -> Array:
    """Gain K (n,) of u = -K e for a chain of integrators whose disturbance enters with the input.

    Solves A'P + PA + Q - P B (1/r - 1/gamma^2) B'P = 0, K = B'P/r, with Q = diag(weights) on e (lowest derivative
    first), r = effort and gamma = attenuation. Raises ValueError for gamma <= sqrt(r), where no solution exists.
    """
    if attenuation**2 <= effort:
        raise ValueError(f"an attenuation of {attenuation} cannot be reached; it must exceed {effort**0.5:g}")
    system, control = integrator_chain(len(weights))
    game_effort = np.array([[1.0 / (1.0 / effort - attenuation**-2)]])
    value = solve_continuous_are(system, control, np.diag(np.asarray(weights, float)), game_effort)
    return (control.T @ value / effort).ravel()


def achieved_norm(gain: Array, weights: Sequence[float], effort: float) -> float:
    """H-infinity norm from the disturbance to [sqrt(Q) e, sqrt(r) u] under u = -K e, by bisection."""
    system, control = integrator_chain(len(weights))
    closed = system - control @ gain[None, :]
    output = np.diag(np.asarray(weights, float)) + effort * np.outer(gain, gain)
    low, high = 0.0, 1.0

    def exceeded(level: float) -> bool:
        hamiltonian = np.block([[closed, control @ control.T / level**2], [-output, -closed.T]])
        roots = eigvals(hamiltonian)
        return bool(np.any(np.abs(roots.real) < 1e-8 * np.abs(roots)))

    while exceeded(high):
        low, high = high, 2.0 * high
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if exceeded(middle) else (low, middle)
    return high
