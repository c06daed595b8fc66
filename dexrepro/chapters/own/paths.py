"""Where the leader goes: through points, along a line, around a circle, or as recorded in a file."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from dexrepro.config import InputError
from dexrepro.control.task_space import Motion
from dexrepro.experiment import Config
from dexrepro.primitives.recorded import Format, read_path

Path = Callable[[float], Motion]


def leader_path(config: Config) -> Path:
    """The motion (3,) over time [s] that the block ``leader`` describes. Raises InputError with one sentence."""
    given = {name: value for name, value in config.leader.items() if value is not None}
    if len(given) != 1 or not given.keys() <= KINDS.keys():
        raise InputError(f"scene.leader names {', '.join(given) or 'nothing'}: give exactly one of {', '.join(KINDS)}")
    ((name, value),) = given.items()
    try:
        return KINDS[name](value)
    except (AttributeError, TypeError, ValueError) as error:
        raise InputError(f"scene.leader.{name}: {error}") from error


def _points(rows: Any) -> Path:
    """Rows of time [s], x, y, z [m], joined by a cubic spline that rests at both ends."""
    data = np.array(rows, dtype=float)
    if data.ndim != 2 or data.shape[1] != 4 or len(data) < 2 or np.any(np.diff(data[:, 0]) <= 0):
        raise ValueError("give two rows or more of time, x, y, z, the time increasing")
    return _held(CubicSpline(data[:, 0], data[:, 1:], bc_type="clamped"), data[0, 0], data[-1, 0])


def _line(settings: Config) -> Path:
    """Straight between two places (3,) [m], there and back in a ``period`` [s], a sine about the middle."""
    start, end = np.array(settings.start, dtype=float), np.array(settings.end, dtype=float)
    middle, half, rate = (start + end) / 2, (end - start) / 2, 2 * math.pi / settings.period

    def motion(time: float) -> Motion:
        c, s = math.cos(rate * time), math.sin(rate * time)
        return Motion(middle - c * half, rate * s * half, rate**2 * c * half)

    return motion


def _circle(settings: Config) -> Path:
    """Around ``centre`` (3,) [m] with a ``radius`` [m] in the plane of x and y, once a ``period`` [s], from rest."""
    centre, radius, rate = np.array(settings.centre, dtype=float), settings.radius, 2 * math.pi / settings.period
    pace = settings.period / 10

    def motion(time: float) -> Motion:
        fade = math.exp(-time / pace)
        angle, speed, gain = rate * (time - pace * (1 - fade)), rate * (1 - fade), rate * fade / pace
        out = radius * np.array((math.cos(angle), math.sin(angle), 0.0))
        along = np.array((-out[1], out[0], 0.0))
        return Motion(centre + out, speed * along, gain * along - speed**2 * out)

    return motion


def _csv(settings: Any) -> Path:
    """A file with the columns time, x, y, z, in metres and seconds unless its header or ``{file: ..., unit: cm}``
    says otherwise; what else can be said of it is in :class:`dexrepro.primitives.recorded.Format`."""
    given = {"file": settings} if isinstance(settings, str) else dict(settings)
    if unknown := given.keys() - {"file", *(field.name for field in fields(Format))}:
        raise ValueError(f"unknown key '{min(unknown)}'; there are: file, unit, time_unit, duplicates, encoding")
    time, position = read_path(given.pop("file"), Format(**given))
    return _held(PchipInterpolator(time, position), time[0], time[-1])


def _held(curve: Any, start: float, end: float) -> Path:
    """A curve over time, and its ends before and after it."""
    still = np.zeros(3)

    def motion(time: float) -> Motion:
        if start <= time <= end:
            return Motion(curve(time), curve(time, 1), curve(time, 2))
        return Motion(curve(min(max(time, start), end)), still, still)

    return motion


KINDS: dict[str, Callable[[Any], Path]] = {"points": _points, "line": _line, "circle": _circle, "csv": _csv}
