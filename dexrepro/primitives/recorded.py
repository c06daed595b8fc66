"""Recorded paths from text files of many makes: read, checked, and resampled at equal steps."""

from __future__ import annotations

import contextlib
import csv
import glob
import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from dexrepro.arrays import Array
from dexrepro.primitives.columns import LENGTHS, TIMES, Header
from dexrepro.primitives.tables import Table, lines_of
from dexrepro.text import decoded

FEWEST = 8
LONG = 60.0  # s; a file that lasts longer with steps of a second or more has other stamps than seconds
SHORT = 0.01  # s; no movement of a hand
WIDE = 2.0  # m; neither
NARROW = 0.004  # m; as small becomes what a hand has drawn, or an outline, if its lengths are in m and taken for cm
FAR = 1e7  # m; as far as from the equator to a pole
MANY = 20  # samples, of which none is far from the one before
PAUSE = 10.0  # times the usual step; where such pauses take a third of the time, clocks have jumped
csv.field_size_limit(2**31 - 1)  # by default 128 kB, which a note or a picture in base64 beside the path exceeds


@dataclass(frozen=True)
class Format:
    """How a file of recorded positions is written.

    unit: of its lengths, m, cm, mm or inch; time_unit: s, ms, us, ns or min; None: as its header says. duplicates:
    "drop" keeps the first of several samples of one instant, "refuse" refuses them. encoding: of a file that is neither
    UTF-8 nor UTF-16, such as cp1252; 1252 is the same.
    """

    unit: str | None = None
    time_unit: str | None = None
    duplicates: str = "refuse"
    encoding: str | int | None = None

    def __post_init__(self) -> None:
        allowed = {"unit": [*LENGTHS], "time_unit": [*TIMES], "duplicates": ["refuse", "drop"]}
        for key, values in allowed.items():
            value = getattr(self, key)
            if value not in values and (value is not None or key == "duplicates"):
                raise ValueError(f"{key} = {value} is not allowed: it must be one of {', '.join(values)}")
        if not isinstance(self.encoding, str | int | None):
            raise ValueError(f"encoding = {self.encoding} is not allowed: it must be a name such as utf-8 or cp1252")


def read_path(path: str, style: Format = Format(), axes: int = 3, otherwise: str = "m") -> tuple[Array, Array]:
    """Time (N,) [s] from 0 and position (N, axes) [m] of a file with the columns time, x, y and, for three axes, z.

    Columns are parted by commas, semicolons, tabs or blanks; the decimal mark may be a comma where that is clear. Times
    are numbers, or dates with a clock's time as ISO 8601 writes them, or this or minutes and seconds alone. A line
    before the numbers may name the columns, in any order and among others, with their units in brackets. Lines that
    begin with #, % or // are comments, one of which may name the columns, as is what stands behind # or // in a row.
    otherwise: the unit of length where neither header nor ``style`` tells it. Raises ValueError with one sentence where
    the file cannot be used; warns where it may hold several movements.
    """
    with _named(path, "cannot read "):
        table = _table(path, style, ("time", "x", "y", "z")[: axes + 1])
    with _named(path):
        header = Header(table)
        length = header.unit("unit", style.unit, otherwise) or otherwise
        if table.dated and style.time_unit not in (None, "s"):
            raise ValueError(f"its times are a clock's; leave out time_unit={style.time_unit}")
        tick = "s" if table.dated else header.unit("time_unit", style.time_unit, "s")
        if len(table.body) < FEWEST:
            raise ValueError(f"it has {len(table.body)} samples; there must be at least {FEWEST}")
        data, lines = table.numbers()
        time, position = TIMES[tick or "s"] * (data[:, 0] - data[0, 0]), LENGTHS[length] * data[:, 1:]
        if style.duplicates == "drop":
            new = np.concatenate([[True], np.diff(time) != 0])
            time, position, lines = time[new], position[new], lines[new]
        _check(time, position, lines, tick)
    for doubt in _doubts(table, position, lines):
        warnings.warn(f"'{path}' {doubt}", stacklevel=2)
    return time, position


def read_corners(path: str, style: Format = Format(), otherwise: str = "m") -> Array:
    """Corners (n, 2) [m] of a polygon, in order, from a file with the columns x, y; see :func:`read_path`."""
    with _named(path):
        table = _table(path, style, ("x", "y"))
        header = Header(table)
        corners, lines = table.numbers_by_row()
        unit = header.unit("unit", style.unit, otherwise)
        corners = LENGTHS[unit or otherwise] * corners
        _check_near(corners, lines)
    corners = corners[:-1] if len(corners) > 1 and (corners[0] == corners[-1]).all() else corners
    (x, y), (later_x, later_y) = corners.T, np.roll(corners, -1, axis=0).T
    if len(corners) < 3 or abs((x * later_y - y * later_x).sum()) < 1e-12:
        must = "it must hold the corners x, y of a polygon, three or more, in order"
        raise ValueError(f"'{path}': it has no area; {must}")
    _warn_of_size(path, corners, unit)
    return corners


def _warn_of_size(path: str, places: Array, unit: str | None) -> None:
    """Say how large a drawing is that no hand is likely to have made; ``unit``: of its lengths, if told."""
    span = float(np.ptp(places, axis=0).max())
    if span > WIDE or (span < NARROW and unit is None):
        large = "large" if span > WIDE else "small"
        warnings.warn(f"'{path}' spans {span:.3g} m; set unit= if that is too {large}", stacklevel=3)


def _table(path: str, style: Format, wanted: tuple[str, ...]) -> Table:
    encoding = f"cp{style.encoding}" if isinstance(style.encoding, int) else style.encoding  # of Windows, such as 1252
    return Table(lines_of(decoded(Path(os.path.expanduser(path)).read_bytes(), encoding)), wanted)


@contextlib.contextmanager
def _named(path: str, failed: str = "") -> Iterator[None]:
    """Let what is refused name the file, after what ``failed``."""
    try:
        yield
    except OSError as error:
        raise ValueError(f"cannot read '{path}': {error.strerror}") from None
    except ValueError as error:
        raise ValueError(f"{failed}'{path}': {error}") from None


def _check(time: Array, position: Array, lines: Array, tick: str | None) -> None:
    """Refuse what is no movement over time; ``lines``: lines of the samples; ``tick``: the unit of time, if told."""
    if len(time) < FEWEST:
        raise ValueError(f"it has samples of {len(time)} instants; there must be at least {FEWEST}")
    steps = np.diff(time)
    if (late := np.flatnonzero(steps <= 0)).size:
        remedy = " (duplicates=drop keeps the first of several samples of one instant)" if steps[late[0]] == 0 else ""
        remedy = "; give each of its recordings a file of its own" if time[late[0] + 1] <= 0 < late[0] else remedy
        raise ValueError(f"its time does not increase at line {lines[late[0] + 1]}{remedy}")
    total, usual = time[-1], np.median(steps)
    long = steps > PAUSE * np.maximum(usual, (total - steps) / max(len(steps) - 1, 1))
    if steps[long].sum() > total / 3:
        worst = int(np.argmax(steps))
        raise ValueError(
            f"line {lines[worst + 1]} comes {steps[worst]:.6g} s after the line before, where the usual step is "
            f"{usual:.3g} s; delete what does not belong to the movement (or set time_unit= if its stamps are not in s)"
        )
    if tick is None and usual >= 1 and total > LONG:
        likely = "ms" if usual < 1e3 else "us" if usual < 1e6 else "ns"
        raise ValueError(
            f"line {lines[1]} comes {steps[0]:.6g} s after the line before, and all take {total:.6g} s; set "
            f"time_unit={likely} if that is the unit of its stamps, time_unit=s if it is as slow as that"
        )
    if total < SHORT:
        span = f"it lasts {total:.3g} s from line {lines[0]} to {lines[-1]}"
        raise ValueError(f"{span}; its unit of time must be another")
    _check_near(position, lines)
    if not np.ptp(position, axis=0).any():
        raise ValueError("it never moves: all its samples are at one place")


def _doubts(table: Table, position: Array, lines: Array) -> Iterator[str]:
    """What suggests that a file holds more than one movement."""
    own = "give each recording a file of its own"
    if table.again is not None:
        yield f"names its columns again in line {table.again + 1}; {own} if that begins another one"
    steps = np.abs(np.diff(position, axis=0)).max(axis=1)
    worst, span = int(np.argmax(steps)), float(np.ptp(position, axis=0).max())
    if len(steps) >= MANY and steps[worst] > span / 2:
        far = f"jumps by {steps[worst]:.3g} m from line {lines[worst]} to {lines[worst + 1]}, and spans {span:.3g} m"
        yield f"{far}; delete what does not belong to the movement, or {own}"


def _check_near(position: Array, lines: Array) -> None:
    """Refuse a place that no hand can reach; ``lines``: lines of the places."""
    away = np.abs(position).max(axis=1)
    if (far := np.flatnonzero(away > FAR)).size:
        raise ValueError(f"line {lines[far[0]]} is {away[far[0]]:.3g} m away; mend it, or set unit=")


def resampled(time: ArrayLike, position: ArrayLike, samples: int) -> Array:
    """The path (samples, d) at equal steps from its first instant to its last, by monotone cubic interpolation."""
    time = np.asarray(time, dtype=float)
    path: Array = PchipInterpolator(time, np.asarray(position, dtype=float))(np.linspace(time[0], time[-1], samples))
    return path


def matching(files: str | Sequence[str]) -> list[str]:
    """Files by a name or, where there is none of it, a pattern such as ``letters/*.csv``, or by a list of such words; a
    word for no file stays as it is."""
    if not isinstance(files, str):
        return [name for word in files for name in matching(word)]
    name = os.path.expanduser(files)  # "~t.csv" is the home of nobody
    return [name] if os.path.exists(name) else sorted(glob.glob(name)) or [files]


def demonstrations(
    files: str | Sequence[str], count: int, samples: int, style: Format, axes: int, otherwise: str = "m"
) -> list[Array]:
    """``count`` recorded paths (samples, axes) [m], the ``matching`` files one after another and over again.

    Raises ValueError as :func:`read_path` does, and where there are more files than ``count``.
    """
    for name in [files] if isinstance(files, str) else files:
        if os.path.isdir(os.path.expanduser(name)):
            raise ValueError(f"'{name}' is a folder; give its files, such as {os.path.join(name, '*.csv')}")
    found = matching(files)
    if len(found) > count:
        raise ValueError(f"{len(found)} files are more than the {count} demonstrations of the experiment")
    paths = [resampled(*read_path(name, style, axes, otherwise), samples) for name in found]
    for name, path in zip(found, paths, strict=True):
        _warn_of_size(name, path, style.unit)
    return [paths[k % len(paths)] for k in range(count)]
