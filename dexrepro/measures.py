"""Numbers that every experiment reads off its runs."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from dexrepro.arrays import Array


def rms(values: ArrayLike) -> float:
    """Root mean square; not a number, null on disk, where there are none because a run is too short to tell."""
    values = np.asarray(values, dtype=float)
    return float(np.sqrt(np.mean(np.square(values)))) if values.size else np.nan


def rms_distance(path: ArrayLike, wanted: ArrayLike = 0.0) -> Array:
    """Root mean square distance (...) of paths (..., N, d) from another; see ``rms``."""
    squares: Array = ((np.asarray(path, dtype=float) - wanted) ** 2).sum(axis=-1)
    return np.sqrt(squares.mean(axis=-1)) if squares.size else np.full(squares.shape[:-1], np.nan)[()]


def rms_length(vectors: ArrayLike) -> float:
    """Root mean square length of vectors (N, d)."""
    return float(rms_distance(vectors))


def last_outside(time: Array, error: Array, bound: float) -> float:
    """Time [s] after which the magnitude of an error stays within a bound: the end of the run if it never does."""
    outside = np.flatnonzero(np.abs(error) > bound)
    return float(time[outside[-1]]) if outside.size else 0.0


def angle_between(first: Array, second: Array) -> Array:
    """Angle (...) [rad] between vectors (..., d) of any length."""
    lengths = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    return np.arccos(np.clip(np.sum(first * second, axis=-1) / lengths, -1.0, 1.0))


def binomial_interval(
    successes: int, trials: int, method: Literal["wilson", "exact"] = "wilson"
) -> tuple[float, float]:
    """95 % interval of a share: Wilson's score interval, or the exact one of Clopper and Pearson."""
    low, high = stats.binomtest(successes, trials).proportion_ci(method=method)
    return float(low), float(high)
