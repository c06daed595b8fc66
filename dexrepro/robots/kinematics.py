"""Forward kinematics and Jacobians of any arm, batched over leading dimensions, in the world frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate
from math import cos, sin
from operator import add

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from dexrepro.robots.arm import Arm

Array = NDArray[np.float64]


def joint_frames(arm: Arm, position: ArrayLike) -> Array:
    """World transforms of all moving links, shape (..., n, 4, 4), for joint angles (..., n) [rad]."""
    q = np.asarray(position, dtype=float)[..., None, None]
    origins, cross, square = arm.turns
    # Rodrigues' formula for all joints at once.
    local = origins + np.sin(q) * cross + (1.0 - np.cos(q)) * square
    frames = np.empty_like(local)
    frames[..., 0, :, :] = local[..., 0, :, :]
    for i in range(1, arm.dof):
        np.matmul(frames[..., i - 1, :, :], local[..., i, :, :], out=frames[..., i, :, :])
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


def rotation_error(desired: ArrayLike, actual: ArrayLike) -> Array:
    """Rotation vector (..., 3) [rad], world frame, that turns the actual orientation (..., 3, 3) into the desired."""
    difference = np.asarray(desired, dtype=float) @ np.asarray(actual, dtype=float).swapaxes(-1, -2)
    if difference.ndim == 2:
        (a, b, c), (d, e, f), (g, h, i) = difference.tolist()
        x, y, z = (h - f) / 2, (c - g) / 2, (d - b) / 2
        sine, cosine = math.sqrt(x * x + y * y + z * z), (a + e + i - 1) / 2
        if sine > 1e-6 or cosine > 0:
            scale = math.atan2(sine, cosine) / sine if sine > 1e-9 else 1.0
            return np.array((scale * x, scale * y, scale * z))
    return Rotation.from_matrix(difference.reshape(-1, 3, 3)).as_rotvec().reshape(difference.shape[:-1])


class PlanarTip:
    """Closed forms for one state of any planar arm in plain floats, for loops at 1 kHz.

    ``PlanarChain`` has those of three bare rods, batches and dynamics included, at less than half the time.
    """

    def __init__(self, arm: Arm) -> None:
        if not arm.is_planar:
            raise ValueError(f"arm '{arm.name}' does not stay in the plane z = const")
        first, *rest = arm.origins
        self.base = float(first[0, 3]), float(first[1, 3])
        self.height = float(forward(arm, np.zeros(arm.dof))[0][2])
        self._turns = [math.atan2(origin[1, 0], origin[0, 0]) for origin in arm.origins]
        self._sides = [(float(after[0, 3]), float(after[1, 3])) for after in (arm.tip, *reversed(rest))]

    def levers(self, q: Sequence[float]) -> list[tuple[float, float]]:
        """Vectors (x, y) [m] from each joint to the end point; the first one starts at ``base``."""
        angles = list(accumulate(map(add, self._turns, q)))
        x = y = 0.0
        result = []
        for a, b in self._sides:  # from the tip to the base
            angle = angles.pop()
            c, s = cos(angle), sin(angle)
            x += c * a - s * b
            y += s * a + c * b
            result.append((x, y))
        result.reverse()
        return result

    def tip(self, q: Sequence[float]) -> tuple[float, float]:
        """End point (x, y) [m]."""
        x, y = self.levers(q)[0]
        return self.base[0] + x, self.base[1] + y

    def jacobian(self, q: Sequence[float]) -> Array:
        """Jacobian of (x, y), shape (2, n) [m/rad]."""
        levers = self.levers(q)
        return np.array(([-y for _, y in levers], [x for x, _ in levers]))
