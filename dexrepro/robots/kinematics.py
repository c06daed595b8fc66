"""Forward kinematics and Jacobians of any arm, batched over leading dimensions, in the world frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from dexrepro.robots.arm import Arm

Array = NDArray[np.float64]


def joint_frames(arm: Arm, position: ArrayLike) -> Array:
    """World transforms of all moving links, shape (..., n, 4, 4), for joint angles (..., n) [rad]."""
    q = np.asarray(position, dtype=float)
    frames = np.empty((*q.shape, 4, 4))
    current: Array = np.eye(4)
    for i, (origin, joint) in enumerate(zip(arm.origins, arm.joints, strict=True)):
        current = current @ origin @ _turn(joint.axis, q[..., i])
        frames[..., i, :, :] = current
    return frames


def forward(arm: Arm, position: ArrayLike) -> tuple[Array, Array]:
    """Position (..., 3) [m] and rotation (..., 3, 3) of the end point for joint angles (..., n) [rad]."""
    tip = joint_frames(arm, position)[..., -1, :, :] @ arm.tip
    return tip[..., :3, 3], tip[..., :3, :3]


def jacobian(arm: Arm, position: ArrayLike) -> Array:
    """Geometric Jacobian of the end point, shape (..., 6, n): linear rows [m/rad] over angular rows, world frame."""
    frames = joint_frames(arm, position)
    tip = frames[..., -1, :, :] @ arm.tip
    axes = np.stack([frames[..., i, :3, :3] @ np.array(j.axis) for i, j in enumerate(arm.joints)], axis=-2)
    lever = tip[..., None, :3, 3] - frames[..., :3, 3]
    return np.concatenate([np.cross(axes, lever), axes], axis=-1).swapaxes(-1, -2)


def rotation_error(desired: ArrayLike, actual: ArrayLike) -> Array:
    """Rotation vector (..., 3) [rad], world frame, that turns the actual orientation (..., 3, 3) into the desired."""
    difference = np.asarray(desired, dtype=float) @ np.swapaxes(np.asarray(actual, dtype=float), -1, -2)
    return Rotation.from_matrix(difference.reshape(-1, 3, 3)).as_rotvec().reshape(difference.shape[:-1])


def _turn(axis: tuple[float, float, float], angle: Array) -> Array:
    """Homogeneous rotation about a unit axis, shape (..., 4, 4), by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    result = np.zeros((*angle.shape, 4, 4))
    result[..., :3, :3] = (
        np.eye(3) + np.sin(angle)[..., None, None] * cross + (1 - np.cos(angle))[..., None, None] * (cross @ cross)
    )
    result[..., 3, 3] = 1.0
    return result
