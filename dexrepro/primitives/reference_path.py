"""Reference paths x^c for constrained primitives: a detour joined to what is kept of a learned path (Sect. 6.3.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from dexrepro.arrays import Array
from dexrepro.primitives.constrained import Reference


def arc(centre: ArrayLike, radius: float, start: float, end: float, count: int = 25) -> Array:
    """Points on a circular arc between two angles [rad], shape (count, 2)."""
    angle = np.linspace(start, end, count)
    return np.asarray(centre, float) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def chord_length(points: ArrayLike) -> Array:
    """Cumulated distance along points of shape (n, d), shape (n,), starting at 0."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def differentiable(time: Array, points: Array, at: Array) -> Reference:
    """Twice differentiable reference through samples: a cubic spline over time that starts and ends at rest.

    The stabilising function needs the acceleration of x^c (Assumption 6.2).
    """
    spline = CubicSpline(time, points, bc_type="clamped")
    return Reference(spline(at), spline(at, 1), spline(at, 2))


def detour(time: Array, path: Array, around: Array, leave: int, resume: int, samples: int = 100) -> tuple[Array, Array]:
    """Replace path[leave + 1 : resume] by a cubic spline through the points ``around`` (the interpolation method).

    Timing: up to the point where it leaves, the old; from there the old profile of speed, stretched to the new length.
    Returns instants (samples,) and points (samples, d) over the same duration.
    """
    keep = slice(0, leave + 1, max(1, leave // 40)), slice(resume, None, max(1, (len(path) - resume) // 40))
    nodes = np.vstack([path[: leave + 1][:: -keep[0].step][::-1], around, path[keep[1]][:-1], path[-1:]])
    curve = CubicSpline(chord_length(nodes), nodes)
    fine = np.linspace(0, chord_length(nodes)[-1], 4000)
    length = chord_length(curve(fine))
    old = chord_length(path)
    left = float(np.interp(_arrival(nodes, path[leave]), fine, length))
    progress = np.where(
        np.arange(len(old)) <= leave,
        old * left / old[leave],
        left + (old - old[leave]) * (length[-1] - left) / (old[-1] - old[leave]),
    )
    coarse = np.linspace(0, len(path) - 1, 30).round().astype(int)
    profile = CubicSpline(time[coarse], progress[coarse], bc_type="clamped")
    at = np.linspace(time[0], time[-1], samples)
    return at, curve(np.interp(np.clip(profile(at), 0, length[-1]), length, fine))


def _arrival(nodes: Array, point: Array) -> float:
    """Chord length at which the nodes pass a point that is one of them."""
    return float(chord_length(nodes)[np.linalg.norm(nodes - point, axis=1).argmin()])


def lagrange(parameter: Array, nodes: Array, at: Array) -> Array:
    """Global interpolating polynomial through nodes (n, d), the book's example; it oscillates with many nodes."""
    gaps = parameter[:, None] - parameter[None, :] + np.eye(len(parameter))
    basis = np.array(
        [
            np.prod(np.delete(at[:, None] - parameter, i, axis=1) / np.delete(gaps[i], i), axis=1)
            for i in range(len(nodes))
        ]
    )
    return basis.T @ nodes
