"""How a force history is judged; None where a run is too short to tell."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from dexrepro.experiment import Recording

Array = NDArray[np.float64]


def mean(values: Array) -> float | None:
    """Mean."""
    return float(values.mean()) if values.size else None


def shown(value: float | int | None) -> float:
    """A metric as a figure takes it: not a number where it is absent."""
    return math.nan if value is None else float(value)


def last_outside(time: Array, error: Array, bound: float) -> float:
    """Time [s] after which the magnitude of an error stays within a bound: the end of the run if it never does."""
    outside = np.flatnonzero(np.abs(error) > bound)
    return float(time[outside[-1]]) if outside.size else 0.0


def force_error(recording: Recording, desired: float, start: float, end: float = math.inf) -> Array:
    """||F|| - f_d [N] of the object between two instants [s]."""
    return recording["object.force"][recording.between(start, end)] - desired
