"""Handwriting: letters as pen paths with a human speed profile, variation between repetitions and tremor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.signal import butter, filtfilt

from dexrepro.arrays import Array

_START, _END = (0.0, 0.35), (1.0, 0.25)  # shared by the lower-case letters

LETTERS: dict[str, tuple[tuple[float, float], ...]] = {
    "A": (
        (0.0, 0.0), (0.25, 0.52), (0.5, 1.0), (0.74, 0.5), (1.0, 0.0), (0.62, 0.28), (0.16, 0.36), (0.5, 0.37),
        (0.9, 0.36),
    ),
    "a": (
        _START, (0.35, 0.72), (0.66, 0.82), (0.40, 0.98), (0.12, 0.62), (0.14, 0.2), (0.42, 0.02), (0.66, 0.36),
        (0.70, 0.84), (0.68, 0.36), (0.78, 0.06), _END,
    ),
    "z": (
        _START, (0.10, 0.86), (0.45, 0.98), (0.84, 0.92), (0.50, 0.50), (0.12, 0.06), (0.45, 0.10), (0.80, 0.02), _END,
    ),
    "l": (
        _START, (0.34, 0.62), (0.60, 1.20), (0.50, 1.55), (0.34, 1.20), (0.34, 0.62), (0.42, 0.12), (0.72, 0.02), _END,
    ),
    "k": (
        _START, (0.22, 0.85), (0.36, 1.38), (0.22, 1.50), (0.16, 0.90), (0.16, 0.04), (0.26, 0.52), (0.56, 0.86),
        (0.66, 0.66), (0.34, 0.50), (0.56, 0.22), (0.78, 0.02), _END,
    ),
    "w": (
        _START, (0.06, 0.80), (0.12, 0.50), (0.24, 0.06), (0.42, 0.30), (0.50, 0.78), (0.56, 0.32), (0.68, 0.04),
        (0.86, 0.34), (0.90, 0.84), _END,
    ),
}  # fmt: skip
"""Via points in a unit box, x to the right and y up."""


def via_path(points: Sequence[Sequence[float]] | Array, time: Array) -> Array:
    """Smooth path (N, d) through ``points`` (p, d), at rest at both ends: the minimum-jerk path for its passage times.

    The passage times grow with the square root of the chord length, as people slow down less in long strokes.
    time: sampling instants (N,) from 0 to the duration [s].
    """
    points = np.asarray(points, dtype=float)
    passage = np.append(0.0, np.cumsum(np.sqrt(np.linalg.norm(np.diff(points, axis=0), axis=1))))
    rest: Any = [(1, np.zeros(points.shape[1])), (2, np.zeros(points.shape[1]))]
    return make_interp_spline(passage / passage[-1] * time[-1], points, k=5, bc_type=(rest, rest))(time)


def tremor(time: Array, axes: int, rms: float, rng: np.random.Generator) -> Array:
    """Physiological tremor (N, axes): three sines of 8-12 Hz an axis that together have ``rms``, none at the ends."""
    frequency, phase = rng.uniform(8.0, 12.0, size=(3, axes)), rng.uniform(0.0, 2 * np.pi, size=(3, axes))
    waves = np.sin(2 * np.pi * time[:, None, None] * frequency + phase).sum(axis=1)
    window = np.sin(np.pi * np.clip(time / time[-1], 0.0, 1.0)).clip(0.0) ** 0.25
    return rms * np.sqrt(2 / 3) * waves * window[:, None]


def smoothed(time: Array, path: Array, cutoff: float) -> Array:
    """The path (N, d) after a zero-phase low-pass of ``cutoff`` [Hz] that leaves its end points where they are."""
    nyquist = 0.5 * (len(time) - 1) / (time[-1] - time[0])
    filtered = filtfilt(*butter(2, cutoff / nyquist), path, axis=0)
    u = ((time - time[0]) / (time[-1] - time[0]))[:, None]
    blend = u**3 * (10 - 15 * u + 6 * u**2)
    return filtered + (1 - blend) * (path[0] - filtered[0]) + blend * (path[-1] - filtered[-1])


def hand_path(
    points: Sequence[Sequence[float]] | Array,
    time: Array,
    jitter: Array | float,
    tremor_rms: float,
    cutoff: float,
    rng: np.random.Generator,
) -> Array:
    """One person's repetition of a path, as recorded and smoothed, (N, d) in the unit of ``points``.

    jitter: standard deviation of the inner via points (a number or one an axis); cutoff: of the smoothing [Hz].
    """
    points = np.array(points, dtype=float)
    points[1:-1] += np.asarray(jitter) * rng.standard_normal(points[1:-1].shape)
    path = via_path(points, time)
    path += tremor(time, points.shape[1], tremor_rms, rng)
    return smoothed(time, path, cutoff)


def write(
    letter: str, time: Array, size: float, jitter: float, tremor_rms: float, cutoff: float, rng: np.random.Generator
) -> Array:
    """A handwritten letter (N, 2): x and y in the unit of ``size``, the height of a small letter."""
    return hand_path(size * np.array(LETTERS[letter]), time, jitter, tremor_rms, cutoff, rng)
