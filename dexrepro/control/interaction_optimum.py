"""The optimal interaction with a known spring-damper object, from the Riccati equation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_continuous_are

from dexrepro.arrays import Array


class NoStabilisingSolution(ValueError):
    """The Riccati equation has no solution that stabilises the closed loop."""


@dataclass(frozen=True)
class InteractionModel:
    """Object C x' + G x = -tau_e and reference generator s' = M s, Eqs. (8.6) to (8.8).

    stiffness: G [N/m]; damping: C [N s/m]; exosystem: M [1/s]. x [m] is measured from the object's surface, tau_e [N]
    is the force of the object on the robot.
    """

    stiffness: float
    damping: float
    exosystem: float

    @property
    def system_matrix(self) -> Array:
        """A of Eq. (8.7) for the state [x, s], shape (2, 2)."""
        return np.diag([-self.stiffness / self.damping, self.exosystem])

    @property
    def input_matrix(self) -> Array:
        """B of Eq. (8.7), shape (2, 1)."""
        return np.array([[-1.0 / self.damping], [0.0]])


@dataclass(frozen=True)
class InteractionCost:
    """Integral of Q (x - N s)^2 + R tau_e^2, Eq. (8.9).

    tracking: Q [1/m^2]; effort: R [1/N^2]; output: N, the desired position per unit of s [m].
    """

    tracking: float
    effort: float
    output: float

    @property
    def state_weight(self) -> Array:
        """Q' of Eq. (8.9) for the state [x, s], shape (2, 2)."""
        direction = np.array([1.0, -self.output])
        return self.tracking * np.outer(direction, direction)

    @property
    def effort_weight(self) -> Array:
        """R, shape (1, 1)."""
        return np.array([[self.effort]])


def optimal_gain(model: InteractionModel, cost: InteractionCost) -> Array:
    """Gain K of tau_e = -K [x, s] that minimises the cost, shape (2,): [N/m, N].

    Raises NoStabilisingSolution where the object or the reference generator cannot be stabilised (M > 0).
    """
    system, control = model.system_matrix, model.input_matrix
    try:
        value = solve_continuous_are(system, control, cost.state_weight, cost.effort_weight)
    except np.linalg.LinAlgError as error:
        raise NoStabilisingSolution(
            f"no stabilising solution for {model}: the reference generator must decay (exosystem < 0)"
        ) from error
    return (control.T @ value / cost.effort).ravel()


def closed_form_gain(model: InteractionModel, cost: InteractionCost) -> Array:
    """The same gain written out, shape (2,). Holds also for a growing generator as long as M < sqrt(a^2 + b^2 Q/R).

    With a = -G/C, b = -1/C and the closed-loop pole p = -sqrt(a^2 + b^2 Q/R):
    P11 = (R/b^2)(a - p), P12 = Q N/(p + M), K = [b P11, b P12]/R.
    """
    pole_open, control = -model.stiffness / model.damping, -1.0 / model.damping
    pole = -np.hypot(pole_open, control * np.sqrt(cost.tracking / cost.effort))
    if pole + model.exosystem >= 0:
        raise NoStabilisingSolution(f"the reference of {model} grows faster than the object can settle")
    value_11 = cost.effort / control**2 * (pole_open - pole)
    value_12 = cost.tracking * cost.output / (pole + model.exosystem)
    return np.array([control * value_11, control * value_12]) / cost.effort


def model_gain(model: Sequence[float], cost: InteractionCost, force_on: str = "robot") -> list[float]:
    """Gain [N/m, N] of a linear-quadratic regulator for a model [G, C, M] of the object, right or wrong.

    force_on: whose force tau_e is in Eq. (8.6) when the model is written down; with "environment" the gain of the force
    on the robot is the opposite.
    """
    gain = closed_form_gain(InteractionModel(*model), cost)
    return [float(value) for value in (gain if force_on == "robot" else -gain)]


def steady_fraction(gain: Array, stiffness: float, output: float) -> float:
    """Indentation x over desired indentation N s at rest, under tau_e = -K [x, s] against a spring [N/m]."""
    return float(gain[1] / (output * (stiffness - gain[0])))


def steady_cost(fraction: float, stiffness: float, cost: InteractionCost) -> float:
    """Cost rate of Eq. (8.9) at rest per squared desired indentation [1/m^2]."""
    return cost.tracking * (fraction - 1.0) ** 2 + cost.effort * (stiffness * fraction) ** 2
