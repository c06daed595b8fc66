"""Adaptive neural tracking whose joint errors stay inside prescribed bounds."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.control.contract import (
    Command,
    Kind,
    Measured,
    Network,
    NominalModel,
    coriolis,
    printed_forms,
)
from dexrepro.control.motion import Motion
from dexrepro.control.prescribed_performance import PerformanceBound

CLIP = 0.9998  # share of the bound beyond which the barrier's push no longer grows, 1 - CLIP^2 = 0.02^2


class BoundedNeuralTracking:
    """tau = M alpha' + C alpha + G + K_tau delta + rho F - tau_e + W^T S(z), Eq. (5.32) corrected.

    The arm is that of Eq. (5.31). M, C, G are taken at (q_d, q_d'). e = q_d - q, alpha = q_d' - L e, delta = alpha -
    q', L = -(k_c + |v'/v|); F = e / (b^2 - e^2) with b the bound that the sign of e selects; dW/dt = Gamma_s (S delta^T
    - K_s W), which the network does. Printed are -W^T S (which turns learning into positive feedback), no rho F, L =
    -sqrt(1/k_2^2 + 1/k_1^2 + k_c^2) |v'/v|, and u tanh(u delta / w) delta in the weight law, Eq. (5.44).

    model: nominal. network: None leaves the term out; it sees z = [q / position_scale, q' / velocity_scale].
    bound: upper factor k_2, lower factor k_1 [rad]. convergence: k_c [1/s]. velocity_gain: K_tau [N m s/rad].
    barrier_gain: rho [N m rad]. printed: "network", its sign; "virtual_gain", L. robust_rate: u, with robust_width w
    [rad/s]. torque_limit [N m]. dt: control period [s].
    """

    kind: ClassVar[Kind] = "joint"
    needs = ("model", "network")

    def __init__(
        self,
        model: NominalModel,
        network: Network | None,
        *,
        bound: PerformanceBound,
        convergence: float,
        velocity_gain: float,
        barrier_gain: float,
        dt: float,
        position_scale: float = 0.35,
        velocity_scale: float = 1.2,
        printed: Collection[str] = (),
        robust_rate: float = 0.0,
        robust_width: float = 0.1,
        torque_limit: float = math.inf,
    ) -> None:
        self.model, self.network, self.bound, self.dt = model, network, bound, dt
        self.convergence, self.velocity_gain, self.barrier_gain = convergence, velocity_gain, barrier_gain
        self.position_scale, self.velocity_scale = position_scale, velocity_scale
        forms = printed_forms(printed, ("network", "virtual_gain"))
        self._network_sign, self._printed_gain = -1 if "network" in forms else 1, "virtual_gain" in forms
        self.robust_rate, self.robust_width, self.torque_limit = robust_rate, robust_width, torque_limit
        self._periods, self.velocity_error = 0, np.zeros(0)

    def reset(self, measured: Measured[Array]) -> None:
        """Start the bound anew; the network keeps what it has learned."""
        self._periods = 0

    def diagnostics(self) -> Mapping[str, Array]:
        """delta (n,) [rad/s] of the last call."""
        return {"velocity_error": self.velocity_error}

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Torque (n,) [N m]; tau_e is the measured external torque."""
        (_, q, dq, contact, *_), (q_d, dq_d, ddq_d) = measured, desired
        nu, gain, gain_rate = self._virtual_gain()
        e = q_d - q
        alpha = dq_d - gain * e
        alpha_rate = ddq_d - gain * (dq_d - dq) - gain_rate * e
        self.velocity_error = delta = alpha - dq
        torque = self.model.mass_matrix(q_d) @ alpha_rate + coriolis(self.model, q_d, dq_d, alpha)
        torque += self.model.gravity(q_d)
        torque += self.velocity_gain * delta - contact
        if self.barrier_gain:
            torque += self.barrier_gain * self.bound.barrier_gradient(e, nu, CLIP)
        if self.network is not None:
            z = np.concatenate([q / self.position_scale, dq / self.velocity_scale])
            torque += self._network_sign * self.network.output(z)
            self.network.adapt(delta)
            if self.robust_rate:
                u = self.robust_rate
                self.network.weights[...] += self.dt * u * np.tanh(u * delta / self.robust_width) * delta
        return Command(np.minimum(np.maximum(torque, -self.torque_limit), self.torque_limit))

    def _virtual_gain(self) -> tuple[float, float, float]:
        """The bound nu, L [1/s] and its derivative [1/s^2]."""
        nu, ratio, ratio_rate = self.bound.rate(self._periods * self.dt)
        self._periods += 1
        sign = math.copysign(1.0, ratio)
        if not self._printed_gain:
            return nu, -(self.convergence + abs(ratio)), -sign * ratio_rate
        factor = math.sqrt(1 / self.bound.upper**2 + 1 / self.bound.lower**2 + self.convergence**2)
        return nu, -factor * abs(ratio), -factor * sign * ratio_rate


def barrier(error: Array, bound: PerformanceBound, time: ArrayLike) -> Array:
    """V_1 = sum over joints of 1/2 ln(b^2 / (b^2 - e^2)), Eq. (5.35) corrected; infinite outside the bound.

    error: (N, n) [rad] at the instants ``time`` (N,) [s].
    """
    usage = bound.usage(error, bound.nu(time)[:, None])
    inside = np.abs(usage) < 1
    terms = np.where(inside, -0.5 * np.log1p(-(np.where(inside, usage, 0.0) ** 2)), np.inf)
    return terms.sum(axis=1)
