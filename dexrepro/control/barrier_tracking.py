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


class BarrierTracking:
    """Tracking law of Eq. (8.31), its estimates and their factors written out; it knows nothing of the arm's dynamics.

    F = -z1/cos^2(...) + D alpha' + C alpha + G - Kp z2 - Kr sgn(z2) + force_sign tau_e, with z1 = x - x_0,
    alpha = -K1 phi + x_0', z2 = x' - alpha. The networks see x (inertia, gravity) and [x, x'] (coriolis) and adapt with
    z2, Eqs. (8.38) to (8.40).

    networks: of d^2, d^2 and d outputs for D, C and G, whose bases may grow. bound: iota [m];
    position_gain: K1 [1/s]; velocity_gain: Kp [N s/m]; robust_gain: Kr [N]; one entry an axis.
    boundary_layer: 0 for the sign of z2, or delta [m/s] of tanh(z2/delta). force_sign: -1 cancels a force tau_e that
    acts on the arm; +1 is printed.
    """

    def __init__(
        self,
        networks: tuple[AdaptiveNetwork, AdaptiveNetwork, AdaptiveNetwork],
        bound: Sequence[float],
        position_gain: Sequence[float],
        velocity_gain: Sequence[float],
        robust_gain: Sequence[float],
        boundary_layer: float = 0.0,
        force_sign: float = -1.0,
    ) -> None:
        self.networks = networks
        self._gains = [[float(value) for value in part] for part in (bound, position_gain, velocity_gain, robust_gain)]
        self.boundary_layer, self.force_sign = boundary_layer, force_sign
        self.network_force = np.zeros(len(bound))

    @property
    def nodes(self) -> Array:
        """Number of nodes of D, C and G, shape (3,)."""
        return np.array([getattr(network.basis, "nodes", network.basis.capacity) for network in self.networks])

    @property
    def feature_power(self) -> float:
        """Squared length of the features of G: its adaptation gain per unit of its rate."""
        features = self.networks[2].features
        return float(features @ features)

    def reset(self) -> None:
        for network in self.networks:
            network.reset()
            if hasattr(network.basis, "reset"):
                network.basis.reset()

    def __call__(self, arm: ArmState, reference: Motion, force: Array) -> Array:
        """Force at the end effector [N]; the networks learn from the same call."""
        velocity_error, rate, rate_slope, feedback = self._feedback(arm, reference)
        inertia, coriolis, gravity = self.networks
        axes = len(rate)
        self.network_force = (
            inertia.output(arm.position, grow=True).reshape(axes, axes) @ rate_slope
            + coriolis.output(np.concatenate((arm.position, arm.velocity)), grow=True).reshape(axes, axes) @ rate
            + gravity.output(arm.position, grow=True)
        )
        inertia.adapt((velocity_error[:, None] * -rate_slope).ravel())
        coriolis.adapt((velocity_error[:, None] * -rate).ravel())
        gravity.adapt(-velocity_error)
        return self.network_force + feedback + self.force_sign * force

    def _feedback(self, arm: ArmState, reference: Motion) -> tuple[Array, Array, Array, Array]:
        """z2, alpha, alpha' and the force of barrier, velocity and robust term, each (d,); scalars are fastest."""
        motions = zip(arm.position.tolist(), arm.velocity.tolist(), *(part.tolist() for part in reference))
        columns = []
        for (x, v, x_ref, v_ref, a_ref), bound, k1, kp, kr in zip(motions, *self._gains):
            phi, slope, barrier = barrier_terms(x - x_ref, bound)
            rate = v_ref - k1 * phi
            error = v - rate
            columns.append(
                (error, rate, a_ref - k1 * slope * (v - v_ref), -barrier - kp * error - kr * self._sign(error))
            )
        return tuple(np.array(columns).T)

    def _sign(self, value: float) -> float:
        if self.boundary_layer > 0:
            return math.tanh(value / self.boundary_layer)
        return (value > 0) - (value < 0)
