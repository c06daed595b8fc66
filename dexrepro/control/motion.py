"""Where an arm should be: a motion at one instant, and the paths that give it over time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array

Value = TypeVar("Value", covariant=True)


class Motion(NamedTuple, Generic[Value]):
    """Desired position, velocity and acceleration of joints (n,) [rad, …], an end point (d,) [m, …] or along a line."""

    position: Value
    velocity: Value
    acceleration: Value


Path = Callable[[float], Motion[Array]]
"""The motion at a time [s]."""


class Curve(Protocol):
    """A function of time that gives its own derivatives, such as scipy's CubicSpline."""

    def __call__(self, time: float, nu: int = 0) -> Array:
        """Its derivative of order ``nu`` at a time [s]."""


class Sampled:
    """A path known at the instants 0, dt, 2 dt, …; the nearest sample counts, the last one for ever after.

    position, velocity, acceleration: (N, …) each. dt: sampling period [s].
    """

    def __init__(self, dt: float, position: Array, velocity: Array, acceleration: Array) -> None:
        self.dt, self.position, self.velocity, self.acceleration = dt, position, velocity, acceleration
        self._last = len(position) - 1

    def __len__(self) -> int:
        return self._last + 1

    @property
    def duration(self) -> float:
        """Time [s] from the first sample to the end of the last one's period."""
        return len(self) * self.dt

    def index(self, time: float) -> int:
        """The sample that counts at a time [s]."""
        return min(round(time / self.dt), self._last)

    def __call__(self, time: float) -> Motion[Array]:
        k = self.index(time)
        return Motion(self.position[k], self.velocity[k], self.acceleration[k])


def rest(position: ArrayLike) -> Path:
    """Stays at a position, of joints (n,) [rad] or an end point (d,) [m]."""
    place = np.array(position, dtype=float)
    here = Motion(place, np.zeros_like(place), np.zeros_like(place))
    return lambda time: here


def line(start: ArrayLike, end: ArrayLike, period: float) -> Path:
    """Straight between two places (d,) [m], there and back in a period [s], a sine about the middle."""
    first, last = np.array(start, dtype=float), np.array(end, dtype=float)
    middle, half, rate = (first + last) / 2, (last - first) / 2, 2 * math.pi / period

    def motion(time: float) -> Motion[Array]:
        c, s = math.cos(rate * time), math.sin(rate * time)
        return Motion(middle - c * half, rate * s * half, rate**2 * c * half)

    return motion


def circle(centre: ArrayLike, radius: float, period: float) -> Path:
    """Around a centre (3,) [m] in the plane of x and y, once a period [s], smoothly from rest."""
    middle, rate, pace = np.array(centre, dtype=float), 2 * math.pi / period, period / 10

    def motion(time: float) -> Motion[Array]:
        fade = math.exp(-time / pace)
        angle, speed, gain = rate * (time - pace * (1 - fade)), rate * (1 - fade), rate * fade / pace
        out = radius * np.array((math.cos(angle), math.sin(angle), 0.0))
        along = np.array((-out[1], out[0], 0.0))
        return Motion(middle + out, speed * along, gain * along - speed**2 * out)

    return motion


def held(curve: Curve, start: float, end: float) -> Path:
    """A curve between two times [s], and its ends at rest before and after them."""
    still = np.zeros_like(curve(start))

    def motion(time: float) -> Motion[Array]:
        if start <= time <= end:
            return Motion(curve(time), curve(time, 1), curve(time, 2))
        return Motion(curve(min(max(time, start), end)), still, still)

    return motion


def minimum_jerk(u: ArrayLike) -> Array:
    """Share 10 u^3 - 15 u^4 + 6 u^5 of a minimum-jerk movement done at normalised times u; still outside [0, 1]."""
    share: Array = np.clip(np.asarray(u, dtype=float), 0.0, 1.0)
    return share**3 * (10 + share * (6 * share - 15))


def minimum_jerk_rates(u: Array, duration: float) -> tuple[Array, Array, Array]:
    """``minimum_jerk`` at times u in [0, 1] of a duration [s], with its first and second derivative [1/s, 1/s^2]."""
    rate = (30 * u**2 - 60 * u**3 + 30 * u**4) / duration
    return 10 * u**3 - 15 * u**4 + 6 * u**5, rate, (60 * u - 180 * u**2 + 120 * u**3) / duration**2


def quintic(time: float, duration: float) -> tuple[float, float]:
    """``minimum_jerk`` in plain floats, for control loops: the share and its rate [1/s] at a time [s]."""
    u = min(max(time / duration, 0.0), 1.0)
    return u**3 * (10 - 15 * u + 6 * u * u), 30 * u * u * (1 - u) ** 2 / duration


def via_points(points: Sequence[ArrayLike], times: Sequence[float], dt: float) -> Sampled:
    """Minimum-jerk segments from point to point (d,) [m], each of a duration [s], at rest at every point."""
    parts: list[tuple[Array, Array, Array]] = []
    for start, end, duration in zip(points[:-1], points[1:], times, strict=True):
        s = (np.arange(round(duration / dt)) * dt / duration)[:, None]
        span = np.asarray(end, dtype=float) - np.asarray(start, dtype=float)
        share, rate, bend = minimum_jerk_rates(s, duration)  # type: ignore[arg-type]
        parts.append((start + share * span, rate * span, bend * span))
    return Sampled(dt, *(np.concatenate(columns) for columns in zip(*parts)))
