"""How a force history is judged; None where a run is too short to tell."""

from __future__ import annotations

import math

from dexrepro.arrays import Array
from dexrepro.experiment import Recording


def mean(values: Array) -> float | None:
    """Mean."""
    return float(values.mean()) if values.size else None


def shown(value: float | int | None) -> float:
    """A metric as a figure takes it: not a number where it is absent."""
    return math.nan if value is None else float(value)


def force_error(recording: Recording, desired: float, start: float, end: float = math.inf) -> Array:
    """||F|| - f_d [N] of the object between two instants [s]."""
    return recording["object.force"][recording.between(start, end)] - desired
