"""Pictures of a scene without a display."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pybullet as bullet
from numpy.typing import NDArray


@dataclass(frozen=True)
class Camera:
    """A camera that looks at a target (3,) [m] from a distance [m]; yaw, pitch and field of view in degrees.

    At yaw 0 it looks along +y; pitch -90 looks straight down.
    """

    target: tuple[float, float, float] = (0.4, 0.0, 0.1)
    distance: float = 1.8
    yaw: float = 50.0
    pitch: float = -30.0
    field_of_view: float = 50.0


def photograph(client: int, camera: Camera, size: tuple[int, int]) -> NDArray[np.uint8]:
    """Picture of shape (height, width, 3) for a size (width, height), by PyBullet's software renderer."""
    width, height = size
    view = bullet.computeViewMatrixFromYawPitchRoll(
        camera.target, camera.distance, camera.yaw, camera.pitch, 0.0, 2, physicsClientId=client
    )
    lens = bullet.computeProjectionMatrixFOV(camera.field_of_view, width / height, 0.02, 20.0, physicsClientId=client)
    pixels = bullet.getCameraImage(
        width, height, view, lens, shadow=1, lightDirection=(1.0, -1.0, 2.0), renderer=bullet.ER_TINY_RENDERER,
        physicsClientId=client,
    )[2]  # fmt: skip
    return np.asarray(pixels, dtype=np.uint8).reshape(height, width, -1)[:, :, :3].copy()
