"""Barrier Lyapunov functions for a constraint on the distance to a reference path (Sect. 6.3.2).

With the error e = x^c - x of a system xdot = f1 + g1 v, the scaled errors are z1 = k_z e and z2 = d_z (alpha_2 - v).
Every constraint case has one form::

    alpha_2 = (xdot^c - f1) / g1 - W(z1) / (d_z g1)                 stabilising function
    k_n     = k_2 / d_z + k_z g1^2 B(z1) / (4 d_z^2)                gain of z2

with a pull W and a barrier share B that belong to the case. When vdot = d(alpha_2)/dt + k_n z2, then
dz1/dt = (k_z / d_z) (W + g1 z2), dz2/dt = -d_z k_n z2, and the Lyapunov function V^c never rises (6.21).
Errors have shape (..., d); leading axes are independent runs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array, Mask


@dataclass(frozen=True)
class Gains:
    """Gains of (6.9)-(6.11): k_z [1/length], d_z [time/length], k_2 [1/s]."""

    position: float = 150.0
    velocity: float = 25.0
    decay: float | Array = 10.0


@dataclass(frozen=True)
class Constraint:
    """A constraint on the scaled error z1, Eq. (6.7), with the Lyapunov functions (6.9), (6.16), (6.18).

    inside: |z1| has to stay below the bound (a tube about the reference), else above it (a keep-out zone).
    upper, lower: bounds H in the units of z1, so k_z times the margin h. With ``lower`` each coordinate has its own
        side of the asymmetric constraint, lower < 0 < upper; without it the bound is on the norm over the last axis.
    weight: factor of the barrier; the book has 1, which is negligible beside z2^2 unless lengths are scaled; H^2
        makes V close to (z1^2 + z2^2) / 2 for small errors.
    """

    inside: bool
    upper: float | Array
    lower: float | None = None
    weight: float | Array = 1.0

    def __post_init__(self) -> None:
        if np.any(np.asarray(self.upper) <= 0) or (self.lower is not None and self.lower >= 0):
            raise ValueError("the bounds have to satisfy lower < 0 < upper: reference and path may not be on one side")

    def _squares(self, z1: Array) -> tuple[Array, Array]:
        """Squared error and squared bound of the side the error is on."""
        if self.lower is None:
            return np.add.reduce(z1 * z1, axis=-1, keepdims=True), np.square(self.upper)
        return z1 * z1, np.where(z1 > 0, np.square(self.upper), np.square(self.lower))

    def satisfied(self, z1: Array) -> Mask:
        """Whether the constraint holds strictly, shape (...)."""
        square, bound = self._squares(z1)
        held = square < bound if self.inside else square > bound
        return np.logical_and.reduce(held, axis=-1)

    def value(self, z1: Array) -> Array:
        """The barrier's part of V^c, shape (...)."""
        square, bound = self._squares(z1)
        # log1p keeps the small values: 1 - (e/h)^2 loses them.
        barrier = -np.log1p(-square / bound) if self.inside else -np.log1p(-bound / square)
        return 0.5 * (self.weight * barrier).sum(axis=-1)

    def pull(self, z1: Array) -> Array:
        """W, by which alpha_2 leaves the reference's velocity, shape (..., d)."""
        return -z1 if self.inside else z1 / self._squares(z1)[0]

    def pull_rate(self, z1: Array, rate: Array) -> Array:
        """Time derivative of W for dz1/dt = rate, shape (..., d)."""
        if self.inside:
            return -rate
        square = self._squares(z1)[0]
        inner = z1 * rate if self.lower is not None else np.add.reduce(z1 * rate, axis=-1, keepdims=True)
        return (rate - 2 * z1 * inner / square) / square

    def share(self, z1: Array) -> Array:
        """B, the barrier's share of the gain k_n, shape (..., 1), or (..., d) for an asymmetric constraint."""
        square, bound = self._squares(z1)
        gap = np.maximum(bound - square if self.inside else square - bound, 1e-15 * bound)  # not below rounding
        return np.asarray(self.weight / gap if self.inside else self.weight * bound / gap)


def printed_case_two_pull(z1: Array, lower: float, upper: float) -> Array:
    """W of the second asymmetric case as (6.17) prints it; its denominator lacks a factor z1."""
    inner, outer = case_two_shares(z1, lower, upper)
    return (outer + inner * z1**4) / (outer - inner * z1**3)


def case_two_shares(z1: Array, lower: float, upper: float) -> tuple[Array, Array]:
    """K_1 and K_2 of (6.17) with the printed flags q(.) of the bounds' signs."""
    right, low, high = z1 > 0, float(lower > 0), float(upper > 0)
    inner = np.where(right, low / (lower**2 - z1**2), (1 - high) / (upper**2 - z1**2))
    outer = np.where(right, high * upper**2 / (z1**2 - upper**2), (1 - low) * lower**2 / (z1**2 - lower**2))
    return inner, outer


def case_two_value(z1: Array, lower: float, upper: float) -> Array:
    """Barrier of (6.16) with the printed flags; NaN where a logarithm's argument is negative."""
    right, low, high = z1 > 0, float(lower > 0), float(upper > 0)
    with np.errstate(invalid="ignore", divide="ignore"):
        inner = [np.log(bound**2 / (bound**2 - z1**2)) for bound in (lower, upper)]
        outer = [np.log(z1**2 / (z1**2 - bound**2)) for bound in (lower, upper)]
    terms = [
        (~right * (1 - low), outer[0]),
        (~right * (1 - high), inner[1]),
        (right * low, inner[0]),
        (right * high, outer[1]),
    ]
    return 0.5 * np.sum([np.where(flag > 0, value, 0.0) for flag, value in terms], axis=0)


def closed_loop_rates(
    z1: Array, z2: Array, constraint: Constraint, gains: Gains, coupling: float, pull: Array | None = None
) -> tuple[Array, Array]:
    """dz1/dt and dz2/dt, (..., d), under the consistent law; ``coupling`` is g1, ``pull`` replaces the case's W."""
    w = constraint.pull(z1) if pull is None else pull
    rate1 = gains.position / gains.velocity * (w + coupling * z2)
    return rate1, -gains.velocity * gain(z1, constraint, gains, coupling) * z2


def gain(z1: Array, constraint: Constraint, gains: Gains, coupling: float | Array) -> Array:
    """k_n of (6.11), (6.17) and Table 6.2."""
    barrier = gains.position * coupling**2 / (4 * gains.velocity**2) * constraint.share(z1)
    return gains.decay / gains.velocity + barrier


def lyapunov_rate(
    z1: Array, z2: Array, rate1: Array, rate2: Array, constraint: Constraint, step: float = 1e-7
) -> Array:
    """dV^c/dt along given rates by a central difference (independent of the book's algebra), shape (...)."""
    ahead = constraint.value(z1 + step * rate1)
    behind = constraint.value(z1 - step * rate1)
    return (ahead - behind) / (2 * step) + (z2 * rate2).sum(axis=-1)


def decay_in_error_coordinates(
    z1: ArrayLike, z2: ArrayLike, constraint: Constraint, gains: Gains, coupling: float, dt: float, steps: int
) -> tuple[Array, Array, Array]:
    """Follow the consistent law in (z1, z2), where neither reference nor primitive appears.

    A step is halved until it keeps the constraint and lowers V^c; at the 24th halving the outward part of z2 is
    removed. Returns z1, z2 of shape (steps + 1, d) and V^c of shape (steps + 1,).
    """
    state = np.asarray(z1, float), np.asarray(z2, float)
    history = [state]
    for _ in range(steps):
        state = _decay(*state, constraint, gains, coupling, dt, 24)
        history.append(state)
    first, second = (np.array(part) for part in zip(*history))
    return first, second, constraint.value(first) + 0.5 * (second**2).sum(axis=-1)


def _decay(
    z1: Array, z2: Array, constraint: Constraint, gains: Gains, coupling: float, dt: float, halvings: int
) -> tuple[Array, Array]:
    ratio = gains.position / gains.velocity
    second = z2 / (1 + dt * gains.velocity * gain(z1, constraint, gains, coupling))
    if constraint.inside:
        first = (z1 + dt * ratio * coupling * second) / (1 + dt * ratio)
    else:
        first = z1 + dt * ratio * (constraint.pull(z1) + coupling * second)
    if constraint.satisfied(first):
        before = constraint.value(z1) + 0.5 * z2 @ z2
        if constraint.value(first) + 0.5 * second @ second <= before:
            return first, second
    if halvings:
        half = _decay(z1, z2, constraint, gains, coupling, dt / 2, halvings - 1)
        return _decay(*half, constraint, gains, coupling, dt / 2, halvings - 1)
    outward = z1 / np.linalg.norm(z1) * (1.0 if constraint.inside else -1.0)
    return z1, z2 - max(0.0, float(z2 @ outward)) * outward
