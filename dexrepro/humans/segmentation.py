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


def pauses(time: Array, position: Array, share: float = 0.1, window: int = 31) -> list[float]:
    """Instants [s] amid the pauses of a path (n, d), however many there are.

    A pause is a stretch whose smoothed speed is below ``share`` of its 90 % quantile; stretches less than 1 s apart are
    one, and those that reach into the first or last tenth are the start and the end.
    """
    velocity = savgol_filter(position, window, 3, deriv=1, delta=time[1] - time[0], axis=0)
    speed = np.linalg.norm(velocity, axis=1)
    slow = np.flatnonzero(speed < share * np.quantile(speed, 0.9))
    if not len(slow):
        return []
    stretches = np.split(slow, np.flatnonzero(np.diff(time[slow]) > 1.0) + 1)
    low, high = 0.1 * len(time), 0.9 * len(time)
    return [float(time[(s[0] + s[-1]) // 2]) for s in stretches if s[0] > low and s[-1] < high]
