"""Cutting a demonstration into sub-skills."""

from __future__ import annotations

import numpy as np
import ruptures
from scipy.signal import savgol_filter

from dexrepro.arrays import Array


def change_point(time: Array, position: Array, rate: float = 10.0) -> float:
    """Instant [s] at which two piecewise linear models of the path (n, d) fit best.

    Dynamic programming of the library ``ruptures`` with the cost "clinear" on positions at ``rate`` [Hz].
    """
    step = max(1, round(1 / (rate * (time[1] - time[0]))))
    coarse = position[::step]
    cut = ruptures.Dynp(model="clinear", min_size=5, jump=1).fit(coarse).predict(n_bkps=1)[0]
    return float(time[::step][min(cut, len(coarse) - 1)])


def slowest_point(time: Array, position: Array, window: int = 31) -> float:
    """Instant [s] of the smallest smoothed speed in the middle 60 % of the path (n, d)."""
    velocity = savgol_filter(position, window, 3, deriv=1, delta=time[1] - time[0], axis=0)
    speed = np.linalg.norm(velocity, axis=1)
    low, high = int(0.2 * len(time)), int(0.8 * len(time))
    return float(time[low + int(speed[low:high].argmin())])
