"""Where the leader goes: through points, along a line, around a circle, or as recorded in a file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from dexrepro.chapters.own.blocks import ANY, NAME, NUMBER, VECTOR, checked, vector
from dexrepro.control.motion import Path, circle, held, line
from dexrepro.errors import InputError, refused
from dexrepro.experiment import Config
from dexrepro.primitives.recorded import Format, read_path


def leader_path(config: Config) -> Path:
    """The motion (3,) over time [s] that the block ``leader`` describes. Raises InputError with one sentence."""
    if not isinstance(leader := config.leader or {}, dict):
        raise refused("scene.leader", leader, f"hold one of {', '.join(KINDS)}, with its keys and values")
    given = {name: value for name, value in leader.items() if value is not None}
    if len(given) != 1 or not given.keys() <= KINDS.keys():
        raise InputError(f"scene.leader names {', '.join(given) or 'nothing'}: give exactly one of {', '.join(KINDS)}")
    ((name, value),) = given.items()
    if name in KEYS and not (name == "csv" and isinstance(value, str)):
        value = checked(value, f"scene.leader.{name}", KEYS[name], ("file",) if name == "csv" else KEYS[name])
    try:
        return KINDS[name](value)
    except (TypeError, ValueError) as error:
        raise InputError(f"scene.leader.{name}: {error}") from error


def _points(rows: Any) -> Path:
    """Rows of time [s], x, y, z [m], joined by a cubic spline that rests at both ends."""
    if not isinstance(rows, list) or not all(vector(row, 4) for row in rows):
        raise ValueError("give two rows or more of time, x, y, z, all of them numbers")
    data = np.array(rows, dtype=float)
    if data.ndim != 2 or data.shape[1] != 4 or len(data) < 2 or np.any(np.diff(data[:, 0]) <= 0):
        raise ValueError("give two rows or more of time, x, y, z, the time increasing")
    return held(CubicSpline(data[:, 0], data[:, 1:], bc_type="clamped"), data[0, 0], data[-1, 0])


def _csv(settings: Any) -> Path:
    """A file with the columns time, x, y, z, in metres and seconds unless its header or ``{file: ..., unit: cm}``
    says otherwise; what else can be said of it is in :class:`dexrepro.primitives.recorded.Format`."""
    given = {"file": settings} if isinstance(settings, str) else settings
    time, position = read_path(given.pop("file"), Format(**given))
    return held(PchipInterpolator(time, position), time[0], time[-1])


KINDS: dict[str, Callable[[Any], Path]] = {
    "points": _points,
    "line": lambda settings: line(**settings),
    "circle": lambda settings: circle(**settings),
    "csv": _csv,
}
KEYS = {
    "line": {"start": VECTOR, "end": VECTOR, "period": NUMBER},
    "circle": {"centre": VECTOR, "radius": NUMBER, "period": NUMBER},
    "csv": {"file": NAME, **{field.name: ANY for field in fields(Format)}},
}
"""What each of them holds, all of it needed but for what is said of a file."""
