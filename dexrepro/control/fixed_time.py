"""Fixed-time backstepping: errors vanish within a time that does not depend on how large they were (Sect. 3.3)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import ClassVar

import numpy as np

from dexrepro.arrays import Array, Real
from dexrepro.control.contract import Command, Kind, Measured, Network
from dexrepro.control.motion import Motion

TINY = 1e-9  # error below which the secant slope of the root is no longer increased


def secant(x: Array, gains: Sequence[float], alpha: float, beta: float) -> Array:
    """Slope k with k x = k1 x + k2 SIG^alpha(x) + k3 SIG^beta(x), shape of x; SIG^r(x) = |x|^r sign(x), Eq. (3.12)."""
    size = np.maximum(np.abs(x), TINY)
    result: Array = gains[0] + gains[1] * size ** (alpha - 1.0) + gains[2] * size ** (beta - 1.0)
    return result


class FixedTimeBackstepping:
    """Torque that drives a joint error to zero in fixed time, Eqs. (3.24)-(3.28), with what the dynamics need learnt.

    x_2d = -K11 e1 - K12 SIG^a(e1) - K13 SIG^b(e1) + dq_d and e2 = dq - x_2d give
    tau = -e1 - K21 e2 - K22 SIG^a(e2) - K23 SIG^b(e2) - W^T S(z), z = [q, dq, x_2d, dx_2d/dt].

    first: K11, K12, K13; second: K21, K22, K23; powers: alpha < 1 < beta. network: W^T S, or None for none.
    smoothing: time constant [s] of the filter on the numerical derivative of x_2d (the exact one is unbounded where
    an error changes sign). printed: keep the + e2 inside x_2d, Eq. (3.25) as printed, solved for e2. dt: period [s].
    The terms in e2 are returned as torque and damping, so that they can be applied implicitly. ``part`` says by what
    of e2 (n,) [rad/s] the weights are driven; all of it as printed, (3.28).
    """

    kind: ClassVar[Kind] = "joint"
    part: Callable[[Array], Array] | None = None

    def __init__(
        self,
        *,
        first: Sequence[float],
        second: Sequence[float],
        powers: Sequence[float],
        dt: float,
        smoothing: float = 0.005,
        network: Network | None = None,
        printed: bool = False,
    ) -> None:
        self.first, self.second, self.powers = (tuple(map(float, gains)) for gains in (first, second, powers))
        self.dt, self.network, self._share = dt, network, (0.5 if printed else 1.0)
        self._smoothing = (dt / smoothing) / (1.0 + dt / smoothing)
        self._forget()

    def reset(self, measured: Measured[Array]) -> None:
        """Forget the past: the filtered derivative and the weights."""
        self._forget()

    def _forget(self) -> None:
        self.virtual: Array | None = None
        self.rate: Real = 0.0
        if self.network is not None:
            self.network.forget()

    def diagnostics(self) -> Mapping[str, Real]:
        """Number of nodes of the network."""
        return {} if self.network is None else {"nodes": self.network.nodes}

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Torque [N m] and damping [N m s/rad], (n,) each; the network learns from the same call."""
        _, position, velocity, *_ = measured
        error = position - desired.position
        goal = desired.velocity - secant(error, self.first, *self.powers) * error
        second = self._share * (velocity - goal)
        virtual = velocity - second
        if self.virtual is None:
            self.rate = np.zeros_like(virtual)
        else:
            self.rate += self._smoothing * ((virtual - self.virtual) / self.dt - self.rate)
        self.virtual = virtual
        damping = self._share * secant(second, self.second, *self.powers)
        torque: Array = damping * goal - error
        if self.network is not None:
            torque -= self.network.output(np.concatenate((position, velocity, virtual, self.rate)), grow=True)
            self.network.adapt(second if self.part is None else self.part(second))
        return Command(torque, damping)


def settling_bound(
    first: Sequence[float],
    second: Sequence[float],
    powers: Sequence[float],
    *,
    inertia: float,
    joints: int,
    share: float = 1.0,
    printed: bool = False,
) -> float:
    """T_max [s] of Lemma 3.2, Eq. (3.8), for the error system, which no initial error exceeds.

    inertia: largest eigenvalue of M [kg m^2]; share: gamma in (0, 1], how much of the decay is asked for. The constants
    kappa follow from V' = e1^T e1 / 2 + e2^T M e2 / 2 and Eqs. (3.9), (3.40); ``printed`` takes Eqs. (3.41), (3.42).
    """
    (_, k12, k13), (_, k22, k23), (alpha, beta) = first, second, powers
    low, high = (1.0 + alpha) / 2.0, (1.0 + beta) / 2.0
    spread = float(joints) ** (1.0 - high)
    if printed:
        fractional = 2.0 * min(k12, k22)
        superlinear = 2.0 * spread * min(k12, k23) / inertia
    else:
        fractional = min(k12 * 2.0**low, k22 * (2.0 / inertia) ** low)
        superlinear = 2.0 ** (1.0 - high) * spread * min(k13 * 2.0**high, k23 * (2.0 / inertia) ** high)
    return 2.0 / (fractional * share * (1.0 - alpha)) + 2.0 / (superlinear * share * (beta - 1.0))
