"""How a tracking run is judged: errors in mm, prescribed bound, oscillation of the error and of the torque."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Array, Mask
from dexrepro.experiment import Metrics
from dexrepro.measures import rms_length


def between(time: Array, start: float, end: float) -> Mask:
    """Mask of start <= time < end [s]."""
    return (time >= start - 1e-9) & (time < end - 1e-9)


def tracking(time: Array, error: Array, usage: Array, torque: Array) -> Metrics:
    """The numbers of one run; time [s] from its start, error (n, m) [m], usage chi (n, m), torque (n, joints) [N m].

    torque_increment_nm: mean over 0.5 to 5 s of the torque's change in 10 ms, summed over the joints.
    error_ripple_mm: rms over 0.2 to 3 s of the error about its 0.15 s mean; error_extrema: turning points of the
    error's components in 0.1 to 3 s.
    """
    step = time[1] - time[0]
    millimetres = 1e3 * error
    stride = round(0.01 / step)
    increments = np.abs(np.diff(torque[::stride], axis=0)).sum(axis=1)[between(time[::stride][:-1], 0.5, 5.0)]
    rate = np.diff(millimetres[between(time, 0.1, 3.0)], axis=0)
    return {
        "rmse_mm": rms_length(millimetres),
        "transient_rmse_mm": rms_length(millimetres[between(time, 1.0, 5.0)]),
        "steady_rmse_mm": rms_length(millimetres[len(time) // 2 :]),
        "torque_increment_nm": float(increments.mean()) if len(increments) else None,
        "error_ripple_mm": rms_length(_about_mean(millimetres, round(0.15 / step))[between(time, 0.2, 3.0)]),
        "error_extrema": int(np.sum(rate[1:] * rate[:-1] < 0)),
        "max_usage": float(np.abs(usage).max()),
        "violations": int(np.sum(np.abs(usage).max(axis=1) >= 1.0)),
    }


def _about_mean(values: Array, window: int) -> Array:
    """Rows minus their centred moving mean over ``window`` samples (shorter at the ends)."""
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    index = np.arange(len(values))
    low, high = np.maximum(index - window // 2, 0), np.minimum(index + window // 2 + 1, len(values))
    return values - (sums[high] - sums[low]) / (high - low)[:, None]
