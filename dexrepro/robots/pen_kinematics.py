"""Closed-form kinematics of the pen arm, for whole paths at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dexrepro.robots.pen_arm import LENGTH

Array = NDArray[np.float64]


def pen_arm_tip(angles: Array) -> Array:
    """Tip positions (..., 3) [m] in the frame of the arm's base for yaw, shoulder and elbow (..., 3) [rad]."""
    yaw, shoulder, elbow = np.moveaxis(angles, -1, 0)
    reach = LENGTH * (np.cos(shoulder) + np.cos(shoulder + elbow))
    height = LENGTH * (np.sin(shoulder) + np.sin(shoulder + elbow))
    return np.stack([reach * np.cos(yaw), reach * np.sin(yaw), height], axis=-1)


def pen_arm_angles(tip: Array) -> Array:
    """Yaw, shoulder and elbow (..., 3) [rad], elbow up, for tip positions (..., 3) [m] in the frame of the arm's base.

    Raises ValueError where a position is out of reach.
    """
    x, y, z = np.moveaxis(tip, -1, 0)
    reach = np.hypot(x, y)
    cosine = (reach**2 + z**2 - 2 * LENGTH**2) / (2 * LENGTH**2)
    if np.any(np.abs(cosine) > 1):
        raise ValueError(f"a tip position is out of the arm's reach of {2 * LENGTH:g} m")
    elbow = -np.arccos(cosine)
    shoulder = np.arctan2(z, reach) - np.arctan2(np.sin(elbow), 1 + np.cos(elbow))
    return np.stack([np.arctan2(y, x), shoulder, elbow], axis=-1)
