"""H-infinity tracking: computed torque on a nominal model with a robust state feedback around it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from scipy.linalg import solve_continuous_are

from dexrepro.arrays import Array
from dexrepro.control.contract import Command, Kind, Measured, NominalModel
from dexrepro.control.motion import Motion


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


class HInfinityTracking:
    """Computed torque F = M_x (x_d'' - K e) + C_x x' + G_x on a nominal model, with K from :func:`hinfinity_gain`.

    The nominal M_x, C_x, G_x are those of Eqs. (8.2) to (8.4); the arm has as many joints as the task axes. gain: on
    [e, e'] or [integral of e, e, e'] with e = x - x_d, the same for each axis; dt: control period [s].
    """

    kind: ClassVar[Kind] = "end_point"
    needs = ("model",)

    def __init__(self, model: NominalModel, gain: Sequence[float], dt: float) -> None:
        self.model, self.gain, self.dt = model, [float(value) for value in gain], dt
        self.integral: Array | float = 0.0

    def reset(self, measured: Measured[Array]) -> None:
        """Empty the integral."""
        self.integral = 0.0

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Force at the end point (d,) [N]; the measured contact force is not used."""
        _, position, velocity, _, q, dq = measured
        error = position - desired.position
        command = -self.gain[-1] * (velocity - desired.velocity) - self.gain[-2] * error
        if len(self.gain) == 3:
            self.integral = self.integral + self.dt * error
            command = command - self.gain[0] * self.integral
        jacobian, drift = self._kinematics(q, dq, len(error))
        acceleration = np.linalg.solve(jacobian, desired.acceleration + command - drift)
        torque = self.model.mass_matrix(q) @ acceleration + self.model.bias(q, dq)
        force: Array = np.linalg.solve(jacobian.T, torque).astype(float, copy=False)
        return Command(force=force)

    def _kinematics(self, position: Array, velocity: Array, axes: int) -> tuple[Array, Array]:
        """J and J' dq of the task's axes, the latter by a central difference along the motion."""
        step = 1e-5
        here, ahead, behind = (
            self.model.jacobian(position + shift * step * velocity)[:axes] for shift in (0.0, 1.0, -1.0)
        )
        return here, (ahead - behind) @ velocity / (2.0 * step)
