"""Rotations as matrices, vectors and quaternions; needs numpy and scipy alone, so that control laws may use it too."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Array


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


def tilt(axis: Array, actual: Array) -> Array:
    """Rotation vector (3,) [rad] that turns the unit vector ``axis`` (3,) into ``actual`` by the least angle.

    Aligned vectors give zero, exactly opposed ones half a turn about any axis across.
    """
    (a, b, c), (u, v, w) = axis.tolist(), actual.tolist()
    x, y, z = b * w - c * v, c * u - a * w, a * v - b * u
    sine, cosine = math.sqrt(x * x + y * y + z * z), a * u + b * v + c * w
    if sine < 1e-12:
        return np.zeros(3) if cosine > 0 else math.pi * perpendicular(actual)
    scale = math.atan2(sine, cosine) / sine
    return np.array((scale * x, scale * y, scale * z))


def rotation_matrix(vector: Array) -> Array:
    """Rotation (3, 3) of a rotation vector (3,) [rad], Eqs. (3.21), (3.22) corrected."""
    x, y, z = vector.tolist()
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < 1e-15:
        return np.eye(3)
    x, y, z = x / angle, y / angle, z / angle
    skew = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
    result: Array = math.sin(angle) * skew + 2.0 * math.sin(angle / 2) ** 2 * skew.dot(skew)
    result.reshape(-1)[::4] += 1.0
    return result


def cross(a: Sequence[float] | Array, b: Sequence[float] | Array) -> Array:
    """Cross product of two vectors (3,), faster than numpy's for one pair."""
    (x, y, z), (u, v, w) = a, b
    return np.array((y * w - z * v, z * u - x * w, x * v - y * u))


def perpendicular(vector: Array) -> Array:
    """A unit vector (3,) at right angles to a unit vector (3,)."""
    other = np.zeros(3)
    other[int(np.abs(vector).argmin())] = 1.0
    result = cross(vector, other)
    return result / math.sqrt(float(result @ result))


def rotated(quaternion: Sequence[float], vector: Sequence[float]) -> tuple[float, float, float]:
    """A vector turned by a unit quaternion (x, y, z, w), the engine's order: v + 2 u x (u x v + w v)."""
    i, j, k, w = quaternion
    a, b, c = vector
    x, y, z = j * c - k * b + w * a, k * a - i * c + w * b, i * b - j * a + w * c
    return a + 2 * (j * z - k * y), b + 2 * (k * x - i * z), c + 2 * (i * y - j * x)


def quaternion_from_euler(angles: Array) -> Array:
    """Quaternion (..., 4), scalar first, of rotations (..., 3) [rad] about the fixed x, y and z axes, Eq. (1.16)."""
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
    """Rotation matrix (..., 3, 3) of a unit quaternion (..., 4), scalar first."""
    w, x, y, z = np.moveaxis(np.asarray(quaternion, float), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def quaternion_from_rotation(rotation: Array) -> Array:
    """Quaternion (..., 4), scalar first, of a rotation matrix (..., 3, 3); exact also at half-turns.

    Of the four formulas it takes the one that divides by the largest component.
    """
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
