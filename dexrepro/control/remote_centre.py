"""Keeping an arm near a point that it has to pass: the remote centre of motion (Sects. 3.2.5 and 3.3.2)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from dexrepro.arrays import Array
from dexrepro.robots.rotations import rotation_matrix, tilt


def closest_point(centre: Array, corners: Sequence[Array]) -> tuple[int, Array]:
    """Segment, counted from 0, and its point (3,) [m] that is nearest to the centre, over a line through corners."""
    best, found = math.inf, (0, corners[0])
    cx, cy, cz = centre.tolist()
    for index, (start, end) in enumerate(pairwise([corner.tolist() for corner in corners])):
        (sx, sy, sz), (ex, ey, ez) = start, end
        ax, ay, az = ex - sx, ey - sy, ez - sz
        share = ((cx - sx) * ax + (cy - sy) * ay + (cz - sz) * az) / (ax * ax + ay * ay + az * az)
        share = min(max(share, 0.0), 1.0)
        point = sx + share * ax, sy + share * ay, sz + share * az
        gap = math.dist((cx, cy, cz), point)
        if gap < best:
            best, found = gap, (index, np.array(point))
    return found


def centre_force(centre: Array, point: Array, stiffness: float) -> Array:
    """F_R = K_R (P_R - point), (3,) [N]: pulls the arm's nearest point to the remote centre, Eq. (3.31)."""
    return stiffness * (centre - point)


def printed_centre_force(centre: Array, tip: Array, wrist: Array, stiffness: float) -> Array:
    """F_R = K_R R with R exactly as printed in Eq. (3.31), (3,) [N]: the scale multiplies the whole difference.

    tip: end joint P_E, wrist: joint before it P_EA [m]. With arrows from the first letter to the second the
    difference is that from P_R to P_EA, so the force is not across the link and points away from the centre; with the
    opposite arrows, under which the corrected form pulls, this one pulls as well.
    """
    to_tip, link = tip - centre, tip - wrist
    reach, length = float(np.linalg.norm(to_tip)), float(np.linalg.norm(link))
    if reach < 1e-9:
        return np.zeros(3)
    cosine = float(to_tip @ link) / (reach * length)
    result: Array = stiffness * (to_tip - link) * cosine * reach / length
    return result


def aligned(rotation: Array, desired: Array, printed: bool = False) -> Array:
    """The actual orientation (3, 3) turned by the least rotation that brings its z axis to the desired one, Eq. (3.21).

    printed: turn about q_U = q_D x q as printed, the axis that leads from the desired axis to the actual one.
    """
    turn = tilt(desired, rotation[:, 2])
    result: Array = rotation_matrix(turn if printed else -turn) @ rotation
    return result


def tool_axis(reference: Array, centre: Array, target: Array, lever: float) -> Array:
    """Unit tool axis (3,) that passes through the centre: from it to the reference, or to the target near the centre.

    The direction to the reference is undefined where the reference is at the centre; it is used once the reference is
    more than ``lever`` [m] beyond the centre towards the target.
    """
    final = target - centre
    final = final / math.sqrt(final.dot(final))
    offset = reference - centre
    if offset.dot(final) <= lever:
        return final
    result: Array = offset / math.sqrt(offset.dot(offset))
    return result
