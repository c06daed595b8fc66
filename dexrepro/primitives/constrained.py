"""Movement primitives that keep a constraint on the distance to a reference path (Sect. 6.3).

The primitive gets an extra acceleration from a barrier Lyapunov function, see :mod:`dexrepro.primitives.barrier`. What
the printed law (6.14), (6.15) does depends on the reading of the acceleration that it subtracts: :data:`LAWS` has all
of them. Positions have shape (..., d): any leading axes are runs that are stepped together.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dexrepro.arrays import Array, Mask
from dexrepro.primitives.barrier import Constraint, Gains, gain
from dexrepro.primitives.transformation import SpringDamper, Step

CRITICAL = SpringDamper(25.0 * 25.0 / 4, 25.0)
"""alpha_z = 25, beta_z = alpha_z / 4, as printed in Sect. 6.4."""


@dataclass(frozen=True)
class Reference:
    """Reference path x^c with its two derivatives at the control instants, each of shape (n, ..., d)."""

    position: Array
    velocity: Array
    acceleration: Array


@dataclass(frozen=True)
class Skill:
    """What the primitive contributes: its equation tau dv/dt = alpha_z (beta_z (g - x) - v) + f, tau dx/dt = v.

    system: K = alpha_z beta_z and D = alpha_z; forcing: f at the control instants, shape (n, ..., d); goal: shape
    (..., d); nominal: dv/dt of the unconstrained primitive at the same instants (needed by the law ``feedforward``).
    """

    forcing: Array
    goal: Array
    time_constant: float | Array
    system: SpringDamper = CRITICAL
    nominal: Array | None = None

    def acceleration(self, forcing: Array, position: Array, velocity: Array) -> Array:
        """dv/dt of the primitive alone, Eq. (6.1)."""
        return self.system.acceleration(position, velocity, self.goal, forcing) / self.time_constant

    def step(self, k: int, coupling: Callable[[Array, Array], Array] | None = None) -> Step:
        """The step from instant k to the next, for an integrator, with a coupling(x, v) added to tau dv/dt."""
        forcing = self.forcing[k], self.forcing[min(k + 1, len(self.forcing) - 1)]
        return Step(self.system, self.goal, self.time_constant, forcing, coupling)


@dataclass(slots=True)
class Moment:
    """What a law may use at one instant; accelerations are dv/dt."""

    own: Array  # the primitive's at the present state
    nominal: Array | float  # the unconstrained primitive's at this instant
    previous: Array | float  # the one applied one step ago
    stabiliser_rate: Array  # d(alpha_2)/dt
    decay: Array  # k_n z2
    error: Array  # e
    error_rate: Array  # de/dt
    reference_acceleration: Array
    margin: float | Array  # h
    inside: bool
    time_constant: float | Array


@dataclass(frozen=True)
class Law:
    """dv/dt = base(moment) + share k_n z2, the second term taken implicitly.

    barrier: whether the law uses the barrier at all, and is undefined where the constraint is violated.
    """

    base: Callable[[Moment], Array]
    share: float
    barrier: bool = True


@dataclass(frozen=True)
class SafetyFilter:
    """Smallest acceleration that keeps b'' + (p1 + p2) b' + p1 p2 b >= 0, b = +-(h^2 - |e|^2). Not in the book."""

    rates: tuple[float, float] = (10.0, 10.0)

    def __call__(self, now: Moment) -> Array:
        sign = 1.0 if now.inside else -1.0
        p1, p2 = self.rates
        free = now.reference_acceleration - now.own / now.time_constant
        e, rate = now.error, now.error_rate
        slack = sign * (now.margin**2 - _dot(e, e))
        slack_rate = -2 * sign * _dot(e, rate)
        need = -2 * sign * (_dot(rate, rate) + _dot(e, free)) + (p1 + p2) * slack_rate + p1 * p2 * slack
        direction = 2 * sign * e / now.time_constant
        return now.own + np.maximum(-need, 0) * direction / (_dot(direction, direction) + 1e-300)


def safety_filter(rates: tuple[float, float] = (10.0, 10.0)) -> Law:
    """The law of :class:`SafetyFilter` with the rates p1, p2 [1/s]."""
    return Law(SafetyFilter(rates), 0.0, barrier=False)


LAWS: dict[str, Law] = {
    # (6.13) with the acceleration read as the primitive's at the present state; the primitive cancels.
    "consistent": Law(lambda now: now.stabiliser_rate, 1.0),
    # (6.14), (6.15) taken literally: the acceleration stands on both sides; solved for it.
    "printed": Law(lambda now: 0.5 * (now.own + now.stabiliser_rate), 0.5),
    # (6.15) with the acceleration of the step before; explicit, and unstable for every step length.
    "lagged": Law(lambda now: now.own + now.stabiliser_rate + now.decay - now.previous, 0.0),
    # (6.13) with the acceleration of the learned path (6.12) as a function of time.
    "feedforward": Law(lambda now: now.own + now.stabiliser_rate - now.nominal, 1.0),
    "filter": safety_filter(),
    # The primitive alone, (6.1).
    "none": Law(lambda now: now.own, 0.0, barrier=False),
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
    projected: Mask
    altered: Mask

    @property
    def defined(self) -> Mask:
        """Where the state is within the barrier's domain, (n, ...)."""
        return np.isfinite(self.distance)


def rollout(
    skill: Skill,
    reference: Reference,
    constraint: Constraint,
    gains: Gains,
    law: Law,
    dt: float | Array,
    position: Array,
    velocity: Array,
    projection: float | None = None,
    explicit: bool = False,
) -> Path:
    """Step a constrained primitive along all instants of its reference; v is tau dx/dt.

    The gain k_n is treated implicitly unless ``explicit``, everything else explicitly. ``projection`` is the rate
    lambda of the discrete barrier |e+| <= h - (1 - lambda) (h - |e|) (our addition): a step beyond it is put back on
    that sphere, whatever the law, the step length or the reference; the steps where this happened are marked.
    """
    count, tau = len(reference.position), skill.time_constant
    x, v = np.array(position, float, subok=True), np.array(velocity, float, subok=True)
    margin = np.asarray(constraint.upper) / gains.position
    positions, velocities = np.empty((count, *x.shape)), np.empty((count, *x.shape))
    projected, altered = np.zeros((count, *x.shape[:-1]), bool), np.zeros((count, *x.shape[:-1]), bool)
    previous: Array | float = 0.0
    unguarded = not np.any(constraint.weight)
    for k in range(count):
        positions[k], velocities[k] = x, v
        if k == count - 1:
            break
        now, stabiliser, kn = _moment(k, x, v, skill, reference, constraint, gains, margin, previous)
        if law.barrier:
            held = constraint.satisfied(gains.position * now.error) | unguarded
            if not held.all():
                x, v = np.where(held[..., None], x, np.nan), np.where(held[..., None], v, np.nan)
        base = law.base(now)
        if explicit:
            after = v + dt * (base + law.share * now.decay)
        elif law.share:
            implicit = dt * law.share * gains.velocity * kn
            after = (v + dt * base + implicit * (stabiliser + dt * now.stabiliser_rate)) / (1 + implicit)
        else:
            after = v + dt * base
        if not law.barrier:
            altered[k] = (base != now.own).any(axis=-1)
        moved = x + dt * after / tau
        if projection is not None:
            moved, projected[k + 1] = _project(moved, now.error, reference.position[k + 1], margin, projection)
            after = np.where(projected[k + 1][..., None], tau * (moved - x) / dt, after)
        previous = (after - v) / dt
        x, v = moved, after
    return Path(
        positions, velocities, *_levels(positions, velocities, reference, constraint, gains, tau), projected, altered
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
) -> tuple[Moment, Array, Array]:
    """What the law sees at instant k, alpha_2 and k_n."""
    tau = skill.time_constant
    error = reference.position[k] - x
    rate = reference.velocity[k] - v / tau
    z1 = gains.position * error
    pull_rate = constraint.pull_rate(z1, gains.position * rate)
    stabiliser = tau * (reference.velocity[k] - constraint.pull(z1) / gains.velocity)
    kn = gain(z1, constraint, gains, 1 / tau)
    now = Moment(
        own=skill.acceleration(skill.forcing[k], x, v),
        nominal=0.0 if skill.nominal is None else skill.nominal[k],
        previous=previous,
        stabiliser_rate=tau * (reference.acceleration[k] - pull_rate / gains.velocity),
        decay=kn * gains.velocity * (stabiliser - v),
        error=error,
        error_rate=rate,
        reference_acceleration=reference.acceleration[k],
        margin=margin,
        inside=constraint.inside,
        time_constant=tau,
    )
    return now, stabiliser, kn


def _project(moved: Array, error: Array, target: Array, margin: Array, rate: float) -> tuple[Array, Mask]:
    """Put positions beyond the discrete barrier back on its sphere about the target."""
    offset = moved - target
    distance = np.sqrt(_dot(offset, offset))
    margin = margin * (1 - 1e-9)  # rounding must not put a position on the barrier itself
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
