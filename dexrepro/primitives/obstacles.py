"""Plane obstacles: signed distances and closest points for whole paths at once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array, Mask


@dataclass(frozen=True)
class Polygon:
    """A simple polygon, or one for each run: vertices of shape (..., n, 2) in order."""

    vertices: Array

    @classmethod
    def rectangle(cls, x: ArrayLike, y: ArrayLike) -> Polygon:
        """Axis-aligned rectangle over the intervals x and y, (low, high) each, in the unit of the path."""
        (left, right), (bottom, top) = np.asarray(x, float), np.asarray(y, float)
        return cls(np.array([[left, bottom], [right, bottom], [right, top], [left, top]]))

    @property
    def centroid(self) -> Array:
        """Centre of area, shape (..., 2)."""
        a, b = self.vertices, np.roll(self.vertices, -1, axis=-2)
        cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
        return (cross[..., None] * (a + b)).sum(-2) / (3 * cross.sum(-1)[..., None])

    def closest(self, points: ArrayLike) -> Array:
        """Closest boundary points to points of shape (..., 2), same shape."""
        feet = self._feet(points)
        offset = feet - np.asanyarray(points, float)[..., None, :]
        nearest = (offset * offset).sum(-1).argmin(-1)
        return np.take_along_axis(feet, nearest[..., None, None], axis=-2)[..., 0, :]

    def distance(self, points: ArrayLike) -> Array:
        """Signed distances of points of shape (..., 2), negative inside."""
        points = np.asanyarray(points, float)
        gap = np.linalg.norm(self.closest(points) - points, axis=-1)
        return np.where(self.contains(points), -gap, gap)

    def contains(self, points: ArrayLike) -> Mask:
        """Whether points of shape (..., 2) lie inside (ray casting)."""
        p = np.asanyarray(points, float)[..., None, :]
        a, b = self.vertices, np.roll(self.vertices, -1, axis=-2)
        straddles = (a[..., 1] > p[..., 1]) != (b[..., 1] > p[..., 1])
        height = np.where(a[..., 1] == b[..., 1], 1.0, b[..., 1] - a[..., 1])
        crossing = a[..., 0] + (p[..., 1] - a[..., 1]) * (b[..., 0] - a[..., 0]) / height
        return (straddles & (p[..., 0] < crossing)).sum(-1) % 2 == 1

    def boundary(self, count: int) -> Array:
        """Points at equal spacing along the boundary of a single polygon, shape (count, 2)."""
        closed = np.vstack([self.vertices, self.vertices[:1]])
        length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
        at = np.arange(count) * length[-1] / count
        return np.stack([np.interp(at, length, closed[:, axis]) for axis in (0, 1)], axis=1)

    def _feet(self, points: ArrayLike) -> Array:
        """Closest point on every edge, shape (..., n, 2)."""
        p = np.asanyarray(points, float)[..., None, :]
        a, edge = self.vertices, np.roll(self.vertices, -1, axis=-2) - self.vertices
        along = ((p - a) * edge).sum(-1) / (edge * edge).sum(-1)
        return a + np.clip(along, 0, 1)[..., None] * edge


@dataclass(frozen=True)
class Disk:
    """A disk; its centre may move: shape (2,), or (n, 2) with one centre for each of n points."""

    centre: Array
    radius: float

    def distance(self, points: ArrayLike) -> Array:
        """Signed distances of points of shape (..., 2), negative inside."""
        return np.linalg.norm(np.asanyarray(points, float) - self.centre, axis=-1) - self.radius


def clearance(path: ArrayLike, obstacles: Iterable[Polygon | Disk]) -> float:
    """Smallest signed distance of a path (n, 2) to any of the obstacles."""
    return float(min(obstacle.distance(path).min() for obstacle in obstacles))
