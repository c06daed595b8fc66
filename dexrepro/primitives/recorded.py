"""Recorded paths from CSV files: read, checked, and resampled at equal steps."""

from __future__ import annotations

import csv
import glob
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from dexrepro.arrays import Array

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254}
COLUMNS = ("time", "x", "y", "z")
FEWEST = 8


def read_path(path: str, unit: str = "m", axes: int = 3) -> tuple[Array, Array]:
    """Time (N,) [s] and position (N, axes) [m] of a CSV file with the columns time, x, y and, for three axes, z.

    unit: of the lengths in the file, m, cm, mm or inch. A first line with the names of the columns may be there or not.
    Raises ValueError with one sentence where the file cannot be used.
    """
    if unit not in UNITS:
        raise ValueError(f"unit = {unit} is not allowed: it must be one of {', '.join(UNITS)}")
    columns = COLUMNS[: axes + 1]
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:  # spreadsheets begin it with a mark
            rows = [(reader.line_num, row) for reader in [csv.reader(file)] for row in reader if row]
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"cannot read '{path}': {getattr(error, 'strerror', None) or 'it is no text'}") from None
    header = tuple(name.strip().lower() for name in rows[0][1]) if rows else ()
    if header and not _is_number(header[0]):
        if header != columns:
            raise ValueError(f"the columns of '{path}' are {', '.join(header)}; they must be {', '.join(columns)}")
        rows = rows[1:]
    if len(rows) < FEWEST:
        raise ValueError(f"'{path}' has {len(rows)} samples; there must be at least {FEWEST}")
    for line, row in rows:
        if len(row) != len(columns):
            raise ValueError(f"line {line} of '{path}' has {len(row)} numbers; it must have {', '.join(columns)}")
        if not all(map(_is_number, row)):
            raise ValueError(f"line {line} of '{path}' holds '{','.join(row)}': every entry must be a finite number")
    data = np.array([row for _, row in rows], dtype=float)
    if (late := np.flatnonzero(np.diff(data[:, 0]) <= 0)).size:
        raise ValueError(f"the time of '{path}' does not increase at line {rows[late[0] + 1][0]}")
    return data[:, 0] - data[0, 0], UNITS[unit] * data[:, 1:]


def resampled(time: ArrayLike, position: ArrayLike, samples: int) -> Array:
    """The path (samples, d) at equal steps from its first instant to its last, by monotone cubic interpolation."""
    time = np.asarray(time, dtype=float)
    path: Array = PchipInterpolator(time, np.asarray(position, dtype=float))(np.linspace(time[0], time[-1], samples))
    return path


def demonstrations(files: str | Sequence[str], count: int, samples: int, unit: str, axes: int) -> list[Array]:
    """``count`` recorded paths (samples, axes) [m], the files one after another and over again.

    files: a name, a pattern such as ``letters/*.csv``, or a list of them. Raises ValueError as :func:`read_path` does,
    and where there are more files than ``count``.
    """
    patterns = [files] if isinstance(files, str) else list(files)
    found = [name for pattern in patterns for name in sorted(glob.glob(pattern)) or [pattern]]
    if len(found) > count:
        raise ValueError(f"{len(found)} files are more than the {count} demonstrations of the experiment")
    paths = [resampled(*read_path(name, unit, axes), samples) for name in found]
    return [paths[k % len(paths)] for k in range(count)]


def _is_number(text: str) -> bool:
    try:
        return bool(np.isfinite(float(text)))
    except ValueError:
        return False
