"""Numbers that every chapter reads off its runs."""

from __future__ import annotations

from typing import Any

import numpy as np


def rms(values: Any) -> float:
    """Root mean square; not a number, null on disk, where there are none because a run is too short to tell."""
    values = np.asarray(values, dtype=float)
    return float(np.sqrt(np.mean(np.square(values)))) if values.size else np.nan
