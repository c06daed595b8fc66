"""Demonstrations through way-points: strokes with a minimum-jerk pace, a pause between them, spread and tremor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from dexrepro.arrays import Array
from dexrepro.control.motion import minimum_jerk


def stroke(waypoints: ArrayLike, u: ArrayLike) -> Array:
    """Points at normalised times u of a minimum-jerk movement along a spline through way-points (n, d)."""
    points = np.asarray(waypoints, float)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return CubicSpline(length, points)(length[-1] * minimum_jerk(u))


@dataclass(frozen=True)
class Drawing:
    """One demonstration: time (n,) [s], position (n, d), and the instants (strokes - 1,) amid its pauses [s]."""

    time: Array
    position: Array
    pauses: Array


def draw(
    strokes: Sequence[ArrayLike],
    durations: Sequence[float],
    rng: np.random.Generator,
    spread: float,
    tremor: float,
    pause: float = 0.2,
    rate: float = 100.0,
) -> Drawing:
    """A person follows strokes that join end to start.

    strokes: way-points (n_i, d); every one but the very first and last is missed by N(0, spread^2) an axis. durations:
    of each stroke [s]. tremor: standard deviation of white noise on the samples; rate: [Hz].
    """
    through = [np.array(points, float) for points in strokes]
    for index, points in enumerate(through):
        missed = rng.normal(0, spread, points.shape)
        points[1:-1] += missed[1:-1]
        if index + 1 < len(through):
            points[-1] += missed[-1]
            through[index + 1][0] = points[-1]
    starts = np.concatenate([[0.0], np.cumsum(np.add(durations[:-1], pause))])
    time = np.arange(round((starts[-1] + durations[-1]) * rate) + 1) / rate
    position = np.empty((len(time), through[0].shape[1]))
    for points, start, duration in zip(through, starts, durations):
        later = time >= start
        position[later] = stroke(points, (time[later] - start) / duration)
    position += rng.normal(0, tremor, position.shape)
    return Drawing(time, position, starts[1:] - pause / 2)


def average(pieces: Sequence[tuple[Array, Array]], samples: int = 100) -> tuple[Array, Array]:
    """Mean of several (time, position) after their times are normalised; its duration is the mean duration.

    Returns time (samples,) from 0 [s] and position (samples, d).
    """
    u = np.linspace(0, 1, samples)
    durations = [time[-1] - time[0] for time, _ in pieces]
    paths = [
        np.stack([np.interp(u, (time - time[0]) / span, column) for column in path.T], axis=1)
        for (time, path), span in zip(pieces, durations)
    ]
    return u * float(np.mean(durations)), np.mean(paths, axis=0)
