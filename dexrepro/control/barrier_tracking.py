"""Backstepping inside a hard error bound, with networks in the place of the arm's dynamics, Eqs. (8.25) to (8.40)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np

from dexrepro.arrays import Array, Real
from dexrepro.control.contract import Command, Kind, Measured
from dexrepro.control.motion import Motion
from dexrepro.networks import AdaptiveNetwork


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

    F = -z1/cos^2(...) + D alpha' + C alpha + G - Kp z2 - Kr sgn(z2) - s tau_e, with z1 = x - x_0,
    alpha = -K1 phi + x_0', z2 = x' - alpha. The networks see x (inertia, gravity) and [x, x'] (coriolis) and adapt with
    z2, Eqs. (8.38) to (8.40).

    networks: of d^2, d^2 and d outputs for D, C and G, whose bases may grow. bound: iota [m];
    position_gain: K1 [1/s]; velocity_gain: Kp [N s/m]; robust_gain: Kr [N]; one entry an axis.
    boundary_layer: 0 for the sign of z2, or delta [m/s] of tanh(z2/delta). force_feedback: s, 1 cancels a force tau_e
    that acts on the arm; printed: + tau_e.
    """

    kind: ClassVar[Kind] = "end_point"
    needs = ("networks",)

    def __init__(
        self,
        networks: tuple[AdaptiveNetwork, AdaptiveNetwork, AdaptiveNetwork],
        bound: Sequence[float],
        position_gain: Sequence[float],
        velocity_gain: Sequence[float],
        robust_gain: Sequence[float],
        boundary_layer: float = 0.0,
        force_feedback: float = 1.0,
        printed: bool = False,
    ) -> None:
        self.networks = networks
        self._gains = [[float(value) for value in part] for part in (bound, position_gain, velocity_gain, robust_gain)]
        self.boundary_layer, self._force_sign = boundary_layer, force_feedback if printed else -force_feedback
        self.network_force = np.zeros(len(bound))

    def reset(self, measured: Measured[Array]) -> None:
        """Forget everything learned."""
        for network in self.networks:
            network.forget()

    def diagnostics(self) -> Mapping[str, Real]:
        """Nodes of D, C and G (3,), the force of the networks (d,) [N], and the squared length of the features of G."""
        nodes = np.array([network.nodes for network in self.networks])
        features = self.networks[2].features
        return {"nodes": nodes, "network_force": self.network_force, "feature_power": float(features @ features)}

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Force at the end point (d,) [N]; the networks learn from the same call."""
        _, position, velocity, force, *_ = measured
        velocity_error, rate, rate_slope, feedback = self._feedback(position, velocity, desired)
        inertia, coriolis, gravity = self.networks
        axes = len(rate)
        features = inertia.basis(position, grow=True)
        mass = inertia.value(features).reshape(axes, axes)
        drag = coriolis.output(np.concatenate((position, velocity)), grow=True).reshape(axes, axes)
        if gravity.basis is not inertia.basis:
            features = gravity.basis(position, grow=True)
        self.network_force = mass.dot(rate_slope) + drag.dot(rate) + gravity.value(features)
        descent = -velocity_error
        inertia.adapt(np.multiply.outer(descent, rate_slope).reshape(-1))
        coriolis.adapt(np.multiply.outer(descent, rate).reshape(-1))
        gravity.adapt(descent)
        return Command(force=self.network_force + feedback + self._force_sign * force)

    def _feedback(self, position: Array, velocity: Array, desired: Motion[Array]) -> tuple[Array, Array, Array, Array]:
        """z2, alpha, alpha' and the force of barrier, velocity and robust term, each (d,); scalars are fastest."""
        motions = zip(position.tolist(), velocity.tolist(), *(part.tolist() for part in desired))
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
