"""Demonstrated paths with the derivatives that fitting a movement primitive needs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse
from scipy.interpolate import BSpline, make_interp_spline
from scipy.sparse.linalg import splu

from dexrepro.arrays import Array


@dataclass(frozen=True)
class Demonstration:
    """A path sampled at equal steps: time (N,) [s]; position, velocity, acceleration (N, d), in units, /s, /s^2."""

    time: Array
    position: Array
    velocity: Array
    acceleration: Array

    @classmethod
    def of(cls, time: ArrayLike, position: ArrayLike, at_rest: bool = True) -> Demonstration:
        """Derivatives of the quintic spline through all samples.

        at_rest: velocity and acceleration are zero at both ends; otherwise the ends are free (not-a-knot).
        """
        time, position = np.asarray(time, dtype=float), np.asarray(position, dtype=float)
        if position.ndim != 2 or len(time) != len(position):
            raise ValueError(f"positions of shape {position.shape} do not go with {len(time)} instants: give (N, d)")
        steps = np.diff(time)
        if np.ptp(steps) > 1e-6 * steps[0]:
            raise ValueError("the samples are not equally spaced in time: resample the path first")
        spline = _spline(len(time), at_rest)
        coefficients = spline.solve(position)
        step = (time[-1] - time[0]) / (len(time) - 1)
        return cls(time, position, spline.slope @ coefficients / step, spline.curvature @ coefficients / step**2)

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def start(self) -> Array:
        """First position (d,)."""
        return self.position[0]

    @property
    def goal(self) -> Array:
        """Last position (d,)."""
        return self.position[-1]

    @property
    def extent(self) -> Array:
        """Range of the positions an axis, (d,)."""
        return np.ptp(self.position, axis=0)

    def with_rest(self, fraction: float) -> Demonstration:
        """The same, held at its goal for ``fraction`` of its duration [s] afterwards."""
        count = round(fraction * (len(self.time) - 1))
        later = self.time[-1] + (self.time[1] - self.time[0]) * np.arange(1, count + 1)
        still = np.zeros((count, self.position.shape[1]))
        return Demonstration(
            np.concatenate([self.time, later]),
            np.concatenate([self.position, still + self.goal]),
            np.concatenate([self.velocity, still]),
            np.concatenate([self.acceleration, still]),
        )


class _Spline(NamedTuple):
    """Quintic interpolation of samples at unit steps: from samples to coefficients to derivatives at the samples."""

    factors: Any
    ends: Any
    slope: Any
    curvature: Any

    def solve(self, position: Array) -> Array:
        """Spline coefficients; at rest, three at each end repeat the end point."""
        if self.ends is None:
            return self.factors.solve(position)
        first, last = np.repeat(position[:1], 3, axis=0), np.repeat(position[-1:], 3, axis=0)
        inner = self.factors.solve(position[1:-1] - self.ends @ np.concatenate([first, last]))
        return np.concatenate([first, inner, last])


@lru_cache(maxsize=16)
def _spline(samples: int, at_rest: bool) -> _Spline:
    """Factorised once for a number of samples; a learner sees many demonstrations of one length."""
    instants = np.arange(float(samples))
    rest: Any = [(1, 0.0), (2, 0.0)]
    knots = make_interp_spline(instants, np.zeros(samples), k=5, bc_type=(rest, rest) if at_rest else None).t
    values = BSpline.design_matrix(instants, knots, 5).tocsc()
    first, second = (_difference(knots, 5), _difference(knots[1:-1], 4))
    slope = BSpline.design_matrix(instants, knots[1:-1], 4) @ first
    curvature = BSpline.design_matrix(instants, knots[2:-2], 3) @ second @ first
    if not at_rest:
        return _Spline(splu(values), None, slope, curvature)
    ends = sparse.hstack([values[1:-1, :3], values[1:-1, -3:]]).tocsr()
    return _Spline(splu(values[1:-1, 3:-3]), ends, slope, curvature)


def _difference(knots: Array, degree: int) -> Any:
    """Matrix from the coefficients of a spline to those of its derivative."""
    count = len(knots) - degree - 1
    scale = degree / (knots[degree + 1 : count + degree] - knots[1:count])
    diagonals: Any = [-scale, scale]
    return sparse.diags_array(diagonals, offsets=[0, 1], shape=(count - 1, count)).tocsr()
