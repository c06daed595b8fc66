"""The planar arm of two links in closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate

import numpy as np

from dexrepro.arrays import Array


class TwoLink:
    """Kinematics of two links in a plane: x right, y up, base at the origin.

    lengths: [m]. Joint angles [rad], shape (2,), are measured from the x axis and from the first link.
    """

    def __init__(self, lengths: Sequence[float]) -> None:
        self._first, self._second = lengths

    def position(self, q: Array) -> Array:
        """Tip (x, y) [m]."""
        a, b = accumulate(q.tolist())
        return np.array(
            [
                self._first * math.cos(a) + self._second * math.cos(b),
                self._first * math.sin(a) + self._second * math.sin(b),
            ]
        )

    def jacobian(self, q: Array) -> Array:
        """Tip velocity per joint rate, shape (2, 2) [m/rad]."""
        a, b = accumulate(q.tolist())
        x, y = self._second * math.cos(b), self._second * math.sin(b)
        return np.array([[-self._first * math.sin(a) - y, -y], [self._first * math.cos(a) + x, x]])

    def inverse(self, tip: Sequence[float] | Array, elbow: float = 1.0) -> Array:
        """Joint angles (2,) [rad] that put the tip at (x, y) [m]; ``elbow``: sign of the second angle.

        Raises ValueError where the tip cannot get there.
        """
        x, y = map(float, tip)
        first, second = self._first, self._second
        cosine = (x * x + y * y - first**2 - second**2) / (2.0 * first * second)
        if abs(cosine) > 1:
            raise ValueError(f"({x:g}, {y:g}) m is out of reach of links of {first:g} and {second:g} m")
        bend = elbow * math.acos(cosine)
        shoulder = math.atan2(y, x) - math.atan2(second * math.sin(bend), first + second * math.cos(bend))
        return np.array([shoulder, bend])
