"""Orientation of the assistive follower facing the teleoperated one, Section 1.3.3 (Lemma 1.1).

Quaternions are unit, scalar first, of shape (..., 4); rotation matrices of shape (..., 3, 3).
"""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Array


def facing(quaternion: Array) -> Array:
    """Orientation that faces ``quaternion``, Q_D of Eq. (1.13): opposite y and z axes, the same x axis, Eq. (1.14).

    In angles about the fixed axes Eq. (1.15), in components Eq. (1.17).
    """
    q = np.asarray(quaternion, float)
    return np.stack([-q[..., 1], q[..., 0], q[..., 3], -q[..., 2]], axis=-1)


def quaternion_from_rotation_printed(rotation: Array) -> Array:
    """Quaternion by the one formula of Eq. (1.12), which divides by q_0 and so fails at half-turns."""
    r = np.asarray(rotation, float)
    q0 = 0.5 * np.sqrt(np.maximum(1.0 + np.trace(r, axis1=-2, axis2=-1), 1e-300))
    vector = [r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]]
    return np.stack([q0, *(v / (4 * q0) for v in vector)], axis=-1)
