"""Task-space adaptive neural control with prescribed performance, global through a switch to a robust term (4.27)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg.lapack import dgesv

from dexrepro.arrays import Array
from dexrepro.control.contract import Command, Kind, Measured, Network
from dexrepro.control.motion import Motion
from dexrepro.control.prescribed_performance import PerformanceBound


class Kinematics(Protocol):
    """The part of a robot model that the law needs: the Jacobian at joint angles, whose first m rows are the task's."""

    def jacobian(self, q: Array) -> Array:
        """(m or more, n) [m/rad], at joint angles (n,) [rad]."""


@dataclass(frozen=True)
class Switch:
    """E(Xi), Eq. (4.26): 1 where every |Xi_k| < inner, 0 where one is > outer, continuous between.

    shape: omega; E <= 1 needs shape >= 0.6382, or >= 2 with ``square_outside``. square_outside: take the square of the
    exponential instead of the square of its argument, the other way to read the print. node_scaled: inner and outer
    are the book's epsilon_a and epsilon_b, multiples of the radius of the node farthest from the origin.
    """

    inner: float
    outer: float
    shape: float = 1.0
    square_outside: bool = False
    node_scaled: bool = False

    def __call__(self, z: ArrayLike, radius: float = 1.0) -> float:
        """E at the input ``z``; ``radius`` of the farthest node [unit of z], used with ``node_scaled``."""
        scale = radius if self.node_scaled else 1.0
        inner, outer = self.inner * scale, self.outer * scale
        size = np.abs(z)
        largest = max(size.tolist())
        if largest < inner:
            return 1.0
        if largest > outer:
            return 0.0
        return float(np.prod(self.component(size[size > inner], inner, outer)))

    def component(self, size: ArrayLike, inner: float, outer: float) -> Array:
        """e of one component's magnitude between ``inner`` and ``outer``."""
        share = (np.asarray(size, dtype=float) ** 2 - inner**2) / (outer**2 - inner**2)
        power = 2 * share / self.shape if self.square_outside else (share / self.shape) ** 2
        return (1.0 - share) * np.exp(power)


class RobustTerm:
    """Upsilon_b = y tanh(y z_2 / width), Eq. (4.29): bounded by y [N m] a joint; width: omega-bar [N m rad/s]."""

    def __init__(self, bound: ArrayLike, width: ArrayLike) -> None:
        self.bound, self.width = np.asarray(bound, dtype=float), np.asarray(width, dtype=float)

    def __call__(self, velocity_error: Array) -> Array:
        term: Array = self.bound * np.tanh(self.bound * velocity_error / self.width)
        return term


class GlobalAdaptiveControl:
    """Backstepping with a barrier on the task error z_1, a network for the unknown dynamics and a robust term.

    tau = -K_2 z_2 - J^T P - E Y(Xi) - (1 - E) Upsilon_b, Eq. (4.27) with tau in joint space and J^T P for P^T J, and
    the virtual velocity alpha = J^+ (x_d' - (K_1 + L) z_1), Eq. (4.20); z_2 = q' - alpha. The network, Upsilon_a of Eq.
    (4.28), estimates F = -(M alpha' + C alpha + G) and learns from E z_2.

    model: kinematics only. network: None leaves the term out. bound: the prescribed performance. switch: None for
    E = 1. robust: None leaves Upsilon_b out. position_gain: K_1 [1/s], a number or one a task axis. velocity_gain:
    K_2 [N m s/rad], one a joint. floor: c in L(t) [1/s^2]. barrier: False leaves J^T P out. reduced_input: Xi = [q,
    alpha'] instead of [q, q', alpha, alpha']. step: control period [s].

    After a call ``error`` is z_1 [m], ``velocity_error`` z_2 [rad/s]; ``learning`` False freezes weights and nodes.
    """

    kind: ClassVar[Kind] = "end_point"
    needs = ("model", "network")

    def __init__(
        self,
        model: Kinematics,
        network: Network | None,
        *,
        bound: PerformanceBound,
        position_gain: ArrayLike,
        velocity_gain: ArrayLike,
        step: float,
        switch: Switch | None = None,
        robust: RobustTerm | None = None,
        floor: float = 0.01,
        barrier: bool = True,
        reduced_input: bool = False,
    ) -> None:
        self.model, self.network, self.bound, self.switch, self.robust = model, network, bound, switch, robust
        self.position_gain = np.asarray(position_gain, dtype=float)
        self.velocity_gain = np.asarray(velocity_gain, dtype=float)
        self.step, self.floor, self.barrier, self.reduced_input = step, floor, barrier, reduced_input
        self.learning = True
        self._periods, self.share = 0, 1.0
        self.error = self.usage = self.velocity_error = self.input = np.empty(0)

    def reset(self, measured: Measured[Array]) -> None:
        """Start the bound anew; the network keeps what it has learned."""
        self._periods = 0

    def diagnostics(self) -> Mapping[str, Array | float]:
        """Share of the bound chi (m,), E, and input Xi of the last call; those of the network."""
        network = {} if self.network is None else self.network.diagnostics()
        return {"usage": self.usage, "share": self.share, "input": self.input, **network}

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Joint torque (n,) [N m] without -K_2 q', and that damping K_2 [N m s/rad]."""
        (_, place, _, _, q, dq), (position, velocity, acceleration) = measured, desired
        nu, ratio, ratio_rate = self.bound.rate(self._periods * self.step)
        self._periods += 1
        self.error = place - position
        jacobian = self.model.jacobian(q)[: len(self.error)]
        alpha, alpha_rate = self._virtual_velocity(q, dq, jacobian, (velocity, acceleration), (ratio, ratio_rate))
        self.velocity_error = dq - alpha
        parts = (q, alpha_rate) if self.reduced_input else (q, dq, alpha, alpha_rate)
        self.input = np.concatenate(parts)
        self.share = share = 1.0 if self.switch is None else self.switch(self.input, self._radius())
        torque = self.velocity_gain * alpha
        self.usage = self.bound.usage(self.error, nu)
        if self.barrier:
            torque -= self.bound.barrier_gradient(self.error, nu).dot(jacobian)
        if self.network is not None:
            torque -= share * self.network.output(self.input, grow=self.learning)
            if self.learning:
                self.network.adapt(share * self.velocity_error)
        if self.robust is not None and share < 1.0:
            torque -= (1.0 - share) * self.robust(self.velocity_error)
        return Command(torque, self.velocity_gain)

    def _virtual_velocity(
        self, q: Array, dq: Array, jacobian: Array, reference: tuple[Array, Array], ratios: tuple[float, float]
    ) -> tuple[Array, Array]:
        """alpha (4.20) and its derivative, which is exact but for a forward difference of the Jacobian."""
        (velocity, acceleration), (ratio, ratio_rate) = reference, ratios
        decay = math.sqrt(2.0 * ratio**2 + self.floor)  # l(t)
        feedback = self.position_gain + decay
        u = velocity - feedback * self.error
        error_rate = jacobian.dot(dq) - velocity
        u_rate = acceleration - feedback * error_rate - (2.0 * ratio * ratio_rate / decay) * self.error
        jacobian_rate = (self.model.jacobian(q + 1e-7 * dq)[: len(jacobian)] - jacobian) * 1e7
        inverse = _right_inverse(jacobian)
        alpha = inverse.dot(u)
        u_rate -= jacobian_rate.dot(alpha)
        if len(jacobian) == len(q):
            return alpha, inverse.dot(u_rate)
        drift = alpha.dot(inverse).dot(jacobian_rate)  # of the row space of J
        return alpha, drift + inverse.dot(u_rate - jacobian.dot(drift))

    def _radius(self) -> float:
        if self.switch is None or not self.switch.node_scaled or self.network is None:
            return 1.0
        centres: Array = self.network.basis.centres  # type: ignore[attr-defined]
        return float(np.sqrt(np.max(np.einsum("ij,ij->i", centres, centres)))) if len(centres) else np.inf


def _right_inverse(jacobian: Array) -> Array:
    """J^+ = J^T (J J^T)^-1, which is the inverse of a square J; by LAPACK directly, as NumPy's checks cost more."""
    rows, columns = jacobian.shape
    if rows == columns:
        return dgesv(jacobian, _identity(rows))[2]
    return jacobian.T.dot(dgesv(jacobian.dot(jacobian.T), _identity(rows))[2])


@cache
def _identity(size: int) -> Array:
    return np.eye(size)
