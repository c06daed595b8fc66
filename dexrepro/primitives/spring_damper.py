"""The spring-damper of a movement primitive, solved exactly.

A primitive's forcing term depends on the phase, hence on time alone, so the primitive is a linear time-invariant system
driven by a known signal. With the forcing linear between samples its solution is exact for any step; it is computed as
two first-order recursions, without a loop over the samples and for any number of movements at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import expm
from scipy.signal import lfilter

from dexrepro.arrays import Array


@dataclass(frozen=True)
class Discretisation:
    """Coefficients of one step for the factored system u' = second u + F, y' = first y + u; see ``SpringDamper``.

    u+ = decay_u u + force_u . (F, F+),  y+ = decay_y y + cross u + force_y . (F, F+), with velocity v = u + first y.
    """

    first: complex
    decay_u: complex
    decay_y: complex
    cross: complex
    force_u: tuple[complex, complex]
    force_y: tuple[complex, complex]


@lru_cache(maxsize=64)
def _discretise(stiffness: float, damping: float, step: float) -> Discretisation:
    discriminant = damping**2 / 4 - stiffness
    if abs(discriminant) < 1e-12 * damping**2:
        discriminant = 0.0  # critically damped up to rounding: keep the arithmetic real
    root = np.sqrt(discriminant) if discriminant >= 0 else 1j * np.sqrt(-discriminant)
    first, second = -damping / 2 + root, -damping / 2 - root
    hold = np.array([[second, 0, 1, 0], [1, first, 0, 0], [0, 0, 0, 1], [0, 0, 0, 0]])
    u, y = expm(step * hold)[:2]
    return Discretisation(first, u[0], y[1], y[0], (u[2] - u[3] / step, u[3] / step), (y[2] - y[3] / step, y[3] / step))


@dataclass(frozen=True)
class SpringDamper:
    """Transformation system tau v' = K (g - x) - D v + F, tau x' = v; Eq. (5.1), with F = A f(s).

    stiffness, damping: K and D, in units of normalised time t / tau (dimensionless); D = 2 sqrt(K) is critical.
    Positions are arrays (..., d) or, over time, (..., N, d); leading axes are a batch. The velocity ``v`` of this class
    is scaled, v = tau dx/dt.
    """

    stiffness: float
    damping: float

    def __post_init__(self) -> None:
        if self.stiffness <= 0 or self.damping <= 0:
            raise ValueError(f"stiffness {self.stiffness} and damping {self.damping} must be positive")

    @classmethod
    def critical(cls, stiffness: float) -> SpringDamper:
        """Critically damped: D = 2 sqrt(K)."""
        return cls(stiffness, 2 * stiffness**0.5)

    def forcing(self, position: Array, velocity: Array, acceleration: Array, goal: ArrayLike) -> Array:
        """F that makes the system follow a path: v' - K (g - x) + D v; Eq. (5.5) with the sign of D v corrected.

        velocity = tau dx/dt and acceleration = tau^2 d2x/dt2, all (..., N, d); goal (..., d).
        """
        error = np.asarray(goal)[..., None, :] - position
        return acceleration - self.stiffness * error + self.damping * velocity

    def acceleration(self, position: Array, velocity: Array, goal: Array, forcing: Array) -> Array:
        """tau v' = tau^2 d2x/dt2 at a state (scaled velocity)."""
        return self.stiffness * (goal - position) - self.damping * velocity + forcing

    def discretise(self, step: float) -> Discretisation:
        """Exact coefficients for a step of normalised time t / tau with F linear in between."""
        return _discretise(float(self.stiffness), float(self.damping), float(step))

    def solve(
        self, forcing: ArrayLike, step: float, start: ArrayLike = 0.0, goal: ArrayLike = 0.0, velocity: ArrayLike = 0.0
    ) -> tuple[Array, Array]:
        """Position and scaled velocity at every sample, both (..., N, d).

        forcing: F at the samples, (..., N, d), linear in between; step: normalised, dt / tau;
        start, goal, velocity: initial position, goal and initial scaled velocity, (..., d).
        """
        c = self.discretise(step)
        force = np.asarray(forcing, dtype=float)
        goal = np.asarray(goal, dtype=float)
        initial = np.asarray(start, dtype=float) - goal
        velocity = np.asarray(velocity, dtype=float)
        batch = np.broadcast_shapes(force.shape[:-2], initial.shape[:-1], velocity.shape[:-1])
        force = np.broadcast_to(force, batch + force.shape[-2:])
        drive = np.empty(force.shape, dtype=type(c.first * 1.0))
        drive[..., 0, :] = velocity - c.first * initial
        drive[..., 1:, :] = c.force_u[0] * force[..., :-1, :] + c.force_u[1] * force[..., 1:, :]
        u = lfilter([1.0], [1.0, -c.decay_u], drive, axis=-2)
        drive[..., 0, :] = initial
        drive[..., 1:, :] = (
            c.force_y[0] * force[..., :-1, :] + c.force_y[1] * force[..., 1:, :] + c.cross * u[..., :-1, :]
        )
        y = lfilter([1.0], [1.0, -c.decay_y], drive, axis=-2)
        return y.real + (goal[..., None, :] if goal.ndim else goal), (u + c.first * y).real

    def step(
        self, position: Array, velocity: Array, goal: Array, forcing: Array, following: Array, step: float
    ) -> tuple[Array, Array]:
        """One step of ``solve``: F goes from ``forcing`` to ``following``. Returns position and scaled velocity."""
        c = self.discretise(step)
        y = position - goal
        u = velocity - c.first * y
        y_next = c.decay_y * y + c.cross * u + c.force_y[0] * forcing + c.force_y[1] * following
        u_next = c.decay_u * u + c.force_u[0] * forcing + c.force_u[1] * following
        return y_next.real + goal, (u_next + c.first * y_next).real
