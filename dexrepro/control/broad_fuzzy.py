"""Backstepping inside a hard error bound, with networks in the place of the arm's dynamics, Eqs. (8.25) to (8.40)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dexrepro.control.task_space import ArmState, Motion
from dexrepro.networks import AdaptiveNetwork

Array = NDArray[np.float64]


def barrier_terms(error: float, bound: float) -> tuple[float, float, float]:
    """phi [m] of Eq. (8.30), its derivative, and the barrier force z / cos^2(pi z^2 / (2 iota^2)) [m] of Eq. (8.31).

    error: z [m]; bound: iota [m]. phi -> z/2 at z = 0. All three are meant for |error| < bound.
    """
    argument = math.pi * (error / bound) ** 2
    if abs(error) < 1e-7 * bound:
        return 0.5 * error, 0.5, error
    phi = bound**2 / (2.0 * math.pi * error) * math.sin(argument)
    return phi, math.cos(argument) - phi / error, error / math.cos(0.5 * argument) ** 2


def barrier_energy(error: Array, bound: Array | float) -> Array:
    """Barrier function iota^2/pi tan(pi z^2 / (2 iota^2)) [m^2], Eq. (8.28); z^2/2 far inside the bound."""
    return bound**2 / np.pi * np.tan(0.5 * np.pi * (error / bound) ** 2)


class BroadFuzzyControl:
    """Tracking law of Eq. (8.31) with its estimates and their factors written out; the arm's dynamics are unknown to it.

    F = -z1/cos^2(...) + D alpha' + C alpha + G - Kp z2 - Kr sgn(z2) + force_sign tau_e, with z1 = x - x_0,
    alpha = -K1 phi + x_0', z2 = x' - alpha. The networks see x (inertia, gravity) and [x, x'] (coriolis) and adapt with
    z2, Eqs. (8.38) to (8.40).

    inertia, coriolis, gravity: networks of d^2, d^2 and d outputs, whose bases may grow. bound: iota [m];
    position_gain: K1 [1/s]; velocity_gain: Kp [N s/m]; robust_gain: Kr [N]; one entry an axis.
    boundary_layer: 0 for the sign of z2, or delta [m/s] of tanh(z2/delta). force_sign: -1 cancels a force tau_e that
    acts on the arm; +1 is printed.
    """

    def __init__(
        self,
        inertia: AdaptiveNetwork,
        coriolis: AdaptiveNetwork,
        gravity: AdaptiveNetwork,
        bound: Sequence[float],
        position_gain: Sequence[float],
        velocity_gain: Sequence[float],
        robust_gain: Sequence[float],
        boundary_layer: float = 0.0,
        force_sign: float = -1.0,
    ) -> None:
        self.inertia, self.coriolis, self.gravity = inertia, coriolis, gravity
        self.bound = [float(value) for value in bound]
        self.position_gain = [float(value) for value in position_gain]
        self.velocity_gain, self.robust_gain = np.array(velocity_gain, float), np.array(robust_gain, float)
        self.boundary_layer, self.force_sign = boundary_layer, force_sign
        self.network_force = np.zeros(len(self.bound))

    @property
    def networks(self) -> tuple[AdaptiveNetwork, AdaptiveNetwork, AdaptiveNetwork]:
        return self.inertia, self.coriolis, self.gravity

    def reset(self) -> None:
        for network in self.networks:
            network.reset()
            if hasattr(network.basis, "reset"):
                network.basis.reset()

    def __call__(self, arm: ArmState, reference: Motion, force: Array) -> Array:
        """Force at the end effector [N]; the networks learn from the same call."""
        error, velocity_error, rate, rate_slope, barrier = self._errors(arm, reference)
        axes = len(self.bound)
        inertia = self.inertia.output(arm.position, grow=True).reshape(axes, axes)
        coriolis = self.coriolis.output(np.concatenate((arm.position, arm.velocity)), grow=True).reshape(axes, axes)
        self.network_force = inertia @ rate_slope + coriolis @ rate + self.gravity.output(arm.position, grow=True)
        command = (
            self.network_force
            - barrier
            - self.velocity_gain * velocity_error
            - self.robust_gain * self._sign(velocity_error)
            + self.force_sign * force
        )
        self.inertia.adapt(np.multiply.outer(-velocity_error, rate_slope).ravel())
        self.coriolis.adapt(np.multiply.outer(-velocity_error, rate).ravel())
        self.gravity.adapt(-velocity_error)
        return command

    def _errors(self, arm: ArmState, reference: Motion) -> tuple[Array, Array, Array, Array, Array]:
        """z1, z2, alpha, alpha' and the barrier force, each (d,)."""
        error = arm.position - reference.position
        terms = [barrier_terms(z, bound) for z, bound in zip(error.tolist(), self.bound)]
        phi = np.array([gain * term[0] for gain, term in zip(self.position_gain, terms)])
        slope = np.array([gain * term[1] for gain, term in zip(self.position_gain, terms)])
        rate = reference.velocity - phi
        rate_slope = reference.acceleration - slope * (arm.velocity - reference.velocity)
        return error, arm.velocity - rate, rate, rate_slope, np.array([term[2] for term in terms])

    def _sign(self, value: Array) -> Array:
        return np.tanh(value / self.boundary_layer) if self.boundary_layer > 0 else np.sign(value)
