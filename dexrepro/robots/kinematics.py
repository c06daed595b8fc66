"""Forward kinematics and Jacobians of any arm, batched over leading dimensions, in the world frame."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.robots.arm import Arm


def joint_frames(arm: Arm, position: ArrayLike) -> Array:
    """World transforms of all moving links, shape (..., n, 4, 4), for joint angles (..., n) [rad]."""
    q = np.asarray(position, dtype=float)[..., None, None]
    origins, cross, square = arm.turns
    # Rodrigues' formula for all joints at once; then each frame is put behind the one before it.
    frames: Array = origins + np.sin(q) * cross + (1.0 - np.cos(q)) * square
    if frames.ndim == 3:
        for before, frame in pairwise(frames):
            frame[...] = before.dot(frame)
    else:
        for i in range(1, arm.dof):
            frames[..., i, :, :] = frames[..., i - 1, :, :] @ frames[..., i, :, :]
    return frames


def forward(arm: Arm, position: ArrayLike) -> tuple[Array, Array]:
    """Position (..., 3) [m] and rotation (..., 3, 3) of the end point for joint angles (..., n) [rad]."""
    tip = joint_frames(arm, position)[..., -1, :, :] @ arm.tip
    return tip[..., :3, 3], tip[..., :3, :3]


def jacobian(arm: Arm, position: ArrayLike) -> Array:
    """Geometric Jacobian of the end point, shape (..., 6, n): linear rows [m/rad] over angular rows, world frame."""
    return point_jacobian(arm, position, arm.dof - 1, arm.tip[:3, 3])


def point_jacobian(arm: Arm, position: ArrayLike, link: int, point: ArrayLike) -> Array:
    """Geometric Jacobian (..., 6, n) of a point (3,) [m] of a moving link's frame; link counts from 0."""
    frames = joint_frames(arm, position)
    carrier = frames[..., link, :, :]
    place = carrier[..., :3, :3] @ np.asarray(point, dtype=float) + carrier[..., :3, 3]
    axes = (frames[..., :3, :3] @ arm.axes[:, :, None])[..., 0]
    levers = place[..., None, :] - frames[..., :3, 3]
    x, y, z = axes[..., 0], axes[..., 1], axes[..., 2]
    u, v, w = levers[..., 0], levers[..., 1], levers[..., 2]
    result = np.empty((*x.shape[:-1], 6, arm.dof))
    for row, values in enumerate((y * w - z * v, z * u - x * w, x * v - y * u, x, y, z)):
        result[..., row, :] = values
    result[..., link + 1 :] = 0.0
    return result
