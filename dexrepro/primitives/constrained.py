"""Movement primitives that keep a constraint on the distance to a reference path (Sect. 6.3).

The primitive xdot = f1 + g1 v gets an extra acceleration from a barrier Lyapunov function. With the error
e = x^c - x, the scaled errors are z1 = k_z e and z2 = d_z (alpha_2 - v). Every constraint case has one form::

    alpha_2 = (xdot^c - f1) / g1 - W(z1) / (d_z g1)                 stabilising function
    k_n     = k_2 / d_z + k_z g1^2 B(z1) / (4 d_z^2)                gain of z2

with a pull W and a barrier share B that belong to the case. When vdot = d(alpha_2)/dt + k_n z2, the Lyapunov function
never rises. What the printed law (6.14), (6.15) does instead depends on the reading of the acceleration it subtracts:
see :data:`LAWS`. Positions have shape (..., d): any leading axes are runs that are stepped together.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


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

    def satisfied(self, z1: Array) -> NDArray[np.bool_]:
        """Whether the constraint holds strictly, shape (...)."""
        square, bound = self._squares(z1)
        return (square < bound if self.inside else square > bound).all(axis=-1)

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
        return self.weight / (bound - square) if self.inside else self.weight * bound / (square - bound)


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
    return 0.5 * sum(np.where(flag > 0, value, 0.0) for flag, value in terms)


def closed_loop_rates(
    z1: Array, z2: Array, constraint: Constraint, gains: Gains, coupling: float, pull: Array | None = None
) -> tuple[Array, Array]:
    """dz1/dt and dz2/dt under the consistent law; ``coupling`` is g1, ``pull`` replaces the case's W."""
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
    return z1, z2 - max(0.0, z2 @ outward) * outward


@dataclass(frozen=True)
class Reference:
    """Reference path x^c with its two derivatives at the control instants, each of shape (n, ..., d)."""

    position: Array
    velocity: Array
    acceleration: Array


@dataclass(frozen=True)
class Skill:
    """What the primitive contributes: its equation tau dv/dt = alpha_z (beta_z (g - x) - v) + f, tau dx/dt = v.

    forcing: f at the control instants, shape (n, ..., d); goal: shape (..., d); nominal: dv/dt of the unconstrained
    primitive at the same instants (needed by the law ``feedforward``), shape (n, ..., d).
    """

    forcing: Array
    goal: Array
    time_constant: float | Array
    stiffness: float = 25.0 * 25.0 / 4
    damping: float = 25.0
    nominal: Array | None = None

    def acceleration(self, k: int, position: Array, velocity: Array) -> Array:
        """dv/dt of the primitive alone at instant k, Eq. (6.1)."""
        spring = self.stiffness * (self.goal - position) - self.damping * velocity
        return (spring + self.forcing[k]) / self.time_constant


@dataclass(slots=True)
class Moment:
    """What a law may use at one instant; accelerations are dv/dt."""

    own: Array  # the primitive's at the present state
    nominal: Array | float  # the unconstrained primitive's at this instant
    previous: Array | float  # the one applied one step ago
    stabiliser_rate: Array  # d(alpha_2)/dt
    error: Array  # e
    error_rate: Array  # de/dt
    reference_acceleration: Array
    margin: float | Array  # h
    inside: bool
    time_constant: float | Array


# A law gives the part of dv/dt that does not contain k_n, and the factor before k_n z2.
Law = Callable[[Moment], tuple[Array, float]]


def consistent(now: Moment) -> tuple[Array, float]:
    """(6.13) with the acceleration read as the primitive's at the present state; the primitive cancels."""
    return now.stabiliser_rate, 1.0


def printed(now: Moment) -> tuple[Array, float]:
    """(6.14), (6.15) taken literally: the acceleration on both sides, solved for it."""
    return 0.5 * (now.own + now.stabiliser_rate), 0.5


def lagged(now: Moment) -> tuple[Array, float]:
    """(6.15) with the acceleration of the previous step; unstable for every step length."""
    return now.own + now.stabiliser_rate - now.previous, 1.0


def feedforward(now: Moment) -> tuple[Array, float]:
    """(6.13) with the acceleration of the learned path (6.12) as a function of time."""
    return now.own + now.stabiliser_rate - now.nominal, 1.0


def unconstrained(now: Moment) -> tuple[Array, float]:
    """The primitive alone, (6.1)."""
    return now.own, 0.0


@dataclass(frozen=True)
class SafetyFilter:
    """Smallest acceleration that keeps b'' + (p1 + p2) b' + p1 p2 b >= 0, b = +-(h^2 - |e|^2). Not in the book."""

    rates: tuple[float, float] = (10.0, 10.0)

    def __call__(self, now: Moment) -> tuple[Array, float]:
        sign = 1.0 if now.inside else -1.0
        p1, p2 = self.rates
        free = now.reference_acceleration - now.own / now.time_constant
        e, rate = now.error, now.error_rate
        slack = sign * (now.margin**2 - _dot(e, e))
        slack_rate = -2 * sign * _dot(e, rate)
        need = -2 * sign * (_dot(rate, rate) + _dot(e, free)) + (p1 + p2) * slack_rate + p1 * p2 * slack
        direction = 2 * sign * e / now.time_constant
        return now.own + np.maximum(-need, 0) * direction / (_dot(direction, direction) + 1e-300), 0.0


LAWS: dict[str, Law] = {
    "consistent": consistent,
    "printed": printed,
    "lagged": lagged,
    "feedforward": feedforward,
    "filter": SafetyFilter(),
    "none": unconstrained,
}


@dataclass(frozen=True)
class Path:
    """A rollout: arrays of shape (n, ..., d), then (n, ...).

    A run whose state leaves an active barrier's domain is undefined from there: NaN.
    """

    position: Array
    velocity: Array
    distance: Array
    lyapunov: Array
    projected: NDArray[np.bool_]
    filtered: NDArray[np.bool_]

    @property
    def defined(self) -> NDArray[np.bool_]:
        return np.isfinite(self.distance)


def rollout(
    skill: Skill,
    reference: Reference,
    constraint: Constraint,
    gains: Gains,
    law: Law,
    dt: float,
    position: Array,
    velocity: Array,
    projection: float | None = None,
) -> Path:
    """Step a constrained primitive along all instants of its reference; v is tau dx/dt.

    The gain k_n is treated implicitly, everything else explicitly. ``projection`` is the rate lambda of the discrete
    barrier |e+| <= h - (1 - lambda) (h - |e|) (our addition): a step beyond it is put back on that sphere, whatever
    the law, the step length or the reference; the steps where this happened are marked.
    """
    count, tau = len(reference.position), skill.time_constant
    x, v = np.array(position, float), np.array(velocity, float)
    margin = np.asarray(constraint.upper) / gains.position
    positions, velocities = np.empty((count, *x.shape)), np.empty((count, *x.shape))
    projected, filtered = np.zeros((count, *x.shape[:-1]), bool), np.zeros((count, *x.shape[:-1]), bool)
    previous: Array | float = 0.0
    for k in range(count):
        positions[k], velocities[k] = x, v
        if k == count - 1:
            break
        now, stabiliser = _moment(k, x, v, skill, reference, constraint, gains, margin, previous)
        base, factor = law(now)
        if factor:
            held = constraint.satisfied(gains.position * now.error)
            if not held.all():
                x, v = np.where(held[..., None], x, np.nan), np.where(held[..., None], v, np.nan)
            implicit = dt * factor * gains.velocity * gain(gains.position * now.error, constraint, gains, 1 / tau)
            after = (v + dt * base + implicit * (stabiliser + dt * now.stabiliser_rate)) / (1 + implicit)
        else:
            filtered[k] = (base != now.own).any(axis=-1)
            after = v + dt * base
        moved = x + dt * after / tau
        if projection is not None:
            moved, projected[k + 1] = _project(moved, now.error, reference.position[k + 1], margin, projection)
            after = np.where(projected[k + 1][..., None], tau * (moved - x) / dt, after)
        previous = (after - v) / dt
        x, v = moved, after
    return Path(
        positions, velocities, *_levels(positions, velocities, reference, constraint, gains, tau), projected, filtered
    )


def _moment(
    k: int,
    x: Array,
    v: Array,
    skill: Skill,
    reference: Reference,
    constraint: Constraint,
    gains: Gains,
    margin: Array,
    previous: Array | float,
) -> tuple[Moment, Array]:
    """What the law sees at instant k, and alpha_2."""
    tau = skill.time_constant
    error = reference.position[k] - x
    rate = reference.velocity[k] - v / tau
    z1 = gains.position * error
    stabiliser = tau * (reference.velocity[k] - constraint.pull(z1) / gains.velocity)
    stabiliser_rate = tau * (
        reference.acceleration[k] - constraint.pull_rate(z1, gains.position * rate) / gains.velocity
    )
    nominal = 0.0 if skill.nominal is None else skill.nominal[k]
    now = Moment(
        skill.acceleration(k, x, v),
        nominal,
        previous,
        stabiliser_rate,
        error,
        rate,
        reference.acceleration[k],
        margin,
        constraint.inside,
        tau,
    )
    return now, stabiliser


def _project(moved: Array, error: Array, target: Array, margin: Array, rate: float) -> tuple[Array, NDArray[np.bool_]]:
    """Put positions beyond the discrete barrier back on its sphere about the target."""
    offset = moved - target
    distance = np.sqrt(_dot(offset, offset))
    allowed = margin - (1 - rate) * (margin - np.sqrt(_dot(error, error)))
    over = distance > allowed
    if over.any():
        moved = np.where(over, target + offset * (allowed / np.maximum(distance, 1e-300)), moved)
    return moved, over[..., 0]


def _levels(
    positions: Array, velocities: Array, reference: Reference, constraint: Constraint, gains: Gains, tau: float | Array
) -> tuple[Array, Array]:
    """Distance to the reference and V^c along the whole path."""
    error = reference.position - positions
    z1 = gains.position * error
    z2 = gains.velocity * (tau * (reference.velocity - constraint.pull(z1) / gains.velocity) - velocities)
    held = constraint.satisfied(z1)
    safe = np.where(held[..., None], z1, np.nan)
    return np.sqrt(_dot(error, error))[..., 0], constraint.value(safe) + 0.5 * (z2**2).sum(axis=-1)


def _dot(a: Array, b: Array) -> Array:
    return np.add.reduce(a * b, axis=-1, keepdims=True)
