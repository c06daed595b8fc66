"""Demonstrated paths with the derivatives that fitting a movement primitive needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import make_interp_spline

Array = NDArray[Any]


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
        rest = [(1, np.zeros(position.shape[1])), (2, np.zeros(position.shape[1]))]
        ends: Any = (rest, rest) if at_rest else None
        spline = make_interp_spline(time, position, k=5, bc_type=ends)
        return cls(time, position, spline(time, 1), spline(time, 2))

    @property
    def duration(self) -> float:
        """Time from the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def start(self) -> Array:
        return self.position[0]

    @property
    def goal(self) -> Array:
        return self.position[-1]

    @property
    def extent(self) -> Array:
        """Range of the positions an axis, (d,)."""
        return np.ptp(self.position, axis=0)

    def with_rest(self, fraction: float) -> Demonstration:
        """The same, held at its goal for ``fraction`` of its duration afterwards."""
        count = round(fraction * (len(self.time) - 1))
        later = self.time[-1] + (self.time[1] - self.time[0]) * np.arange(1, count + 1)
        still = np.zeros((count, self.position.shape[1]))
        return Demonstration(
            np.concatenate([self.time, later]),
            np.concatenate([self.position, still + self.goal]),
            np.concatenate([self.velocity, still]),
            np.concatenate([self.acceleration, still]),
        )
