"""Orientation of the assistive follower facing the teleoperated one, Section 1.3.3 (Lemma 1.1).

Quaternions are unit, scalar first, of shape (..., 4); rotation matrices of shape (..., 3, 3).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def facing(quaternion: Array) -> Array:
    """Orientation that faces ``quaternion``: opposite y and z axes, the same x axis, Eq. (1.14)."""
    q = np.asarray(quaternion, float)
    return np.stack([-q[..., 1], q[..., 0], q[..., 3], -q[..., 2]], axis=-1)


def quaternion_from_euler(angles: Array) -> Array:
    """Quaternion of rotations about the fixed x, y and z axes [rad], shape (..., 3), Eq. (1.16)."""
    half = 0.5 * np.asarray(angles, float)
    (cx, cy, cz), (sx, sy, sz) = np.moveaxis(np.cos(half), -1, 0), np.moveaxis(np.sin(half), -1, 0)
    return np.stack(
        [
            cx * cy * cz + sx * sy * sz,
            sx * cy * cz - cx * sy * sz,
            cx * sy * cz + sx * cy * sz,
            cx * cy * sz - sx * sy * cz,
        ],
        axis=-1,
    )


def rotation_from_quaternion(quaternion: Array) -> Array:
    """Rotation matrix of a unit quaternion."""
    w, x, y, z = np.moveaxis(np.asarray(quaternion, float), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def quaternion_from_rotation(rotation: Array) -> Array:
    """Quaternion of a rotation matrix by the branch with the largest component; exact also at half-turns."""
    r = np.asarray(rotation, float)
    d = np.einsum("...ii->...i", r)
    trace = d.sum(-1)
    # Row k is 4 q_k times the quaternion; the row with the largest diagonal loses no digits.
    k = np.empty((*r.shape[:-2], 4, 4))
    k[..., 0, 0] = 1 + trace
    for i in range(3):
        k[..., i + 1, i + 1] = 1 + 2 * d[..., i] - trace
    for i, (a, b) in enumerate(((2, 1), (0, 2), (1, 0))):
        k[..., 0, i + 1] = k[..., i + 1, 0] = r[..., a, b] - r[..., b, a]
    for a, b in ((0, 1), (0, 2), (1, 2)):
        k[..., a + 1, b + 1] = k[..., b + 1, a + 1] = r[..., a, b] + r[..., b, a]
    best = np.argmax(np.einsum("...ii->...i", k), axis=-1)
    q = np.take_along_axis(k, best[..., None, None], axis=-2)[..., 0, :]
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def quaternion_from_rotation_printed(rotation: Array) -> Array:
    """Quaternion by the one formula of Eq. (1.12), which divides by q_0 and so fails at half-turns."""
    r = np.asarray(rotation, float)
    q0 = 0.5 * np.sqrt(np.maximum(1.0 + np.trace(r, axis1=-2, axis2=-1), 1e-300))
    vector = [r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]]
    return np.stack([q0, *(v / (4 * q0) for v in vector)], axis=-1)
