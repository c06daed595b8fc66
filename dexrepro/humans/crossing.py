"""Hand movements over a stack of cubes, and the distance of a path from it."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Array

CUBE = 2.0  # edge [cm]
LIP = (2.0, 8.0, 0.2)  # the plate on top of the cubes [cm]


def obstacle_boxes(blocks: int) -> tuple[tuple[Array, Array], ...]:
    """Lower and upper corners [cm] of the stack and of its lip; the stack stands at the origin of the plane z = 0."""
    top = CUBE * blocks
    return (
        (np.array([-1.0, -1.0, 0.0]), np.array([1.0, 1.0, top])),
        (np.array([-LIP[0] / 2, -LIP[1] / 2, top]), np.array([LIP[0] / 2, LIP[1] / 2, top + LIP[2]])),
    )


def via_points(blocks: int, clearance: float, plateau: float) -> Array:
    """Via points (9, 3) [cm] of a movement from x = -6 to x = 6 that passes ``clearance`` above the lip.

    plateau: half the length of the level part of the movement.
    """
    z = CUBE * blocks + LIP[2] + clearance
    x = [-6.0, -5.2, -plateau - 0.9, -plateau + 0.8, 0.0, plateau - 0.8, plateau + 0.9, 5.2, 6.0]
    height = [0.0, 0.45 * z, 0.88 * z, z, z + 0.25, z, 0.88 * z, 0.45 * z, 0.0]
    return np.stack([x, np.zeros(9), height], axis=1)


def clearance(path: Array, blocks: int) -> Array:
    """Signed distance (..., N) [cm] of points (..., N, 3) from the obstacle; negative inside.

    The stack is taken to go on below the table, so that a path along the table is well inside, not on its face.
    """
    distances = []
    for low, high in obstacle_boxes(blocks):
        if low[2] == 0:
            low = low - [0.0, 0.0, 100.0]
        outside = np.maximum(low - path, path - high)
        distances.append(np.linalg.norm(np.maximum(outside, 0.0), axis=-1) + np.minimum(outside.max(axis=-1), 0.0))
    return np.minimum(*distances)
