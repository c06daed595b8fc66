"""Pictures of a scene without a display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pybullet as bullet

from dexrepro.arrays import Array, Image


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


@dataclass(frozen=True)
class Overhead:
    """A depth camera that looks straight down from a place (3,) [m]; image right is +x, image up is +y.

    size: (width, height) in pixels; field_of_view: vertical, degrees; near, far: range [m].
    """

    position: tuple[float, float, float]
    size: tuple[int, int] = (160, 160)
    field_of_view: float = 36.0
    near: float = 0.2
    far: float = 2.0

    @property
    def focal(self) -> float:
        """Focal length in pixels."""
        return self.size[1] / 2 / float(np.tan(np.radians(self.field_of_view) / 2))

    def project(self, points: Array) -> Array:
        """Pixel coordinates (..., 2), column and row, of points (..., 3) [m]; pixel centres are whole numbers."""
        x, y, z = np.moveaxis(np.asarray(points) - self.position, -1, 0)
        scale = self.focal / -z
        return np.stack((self.size[0] / 2 - 0.5 + scale * x, self.size[1] / 2 - 0.5 - scale * y), axis=-1)

    def place(self, column: float, row: float, height: float) -> tuple[float, float]:
        """Where (x, y) [m] the ray through a pixel meets a height z [m]."""
        scale = (self.position[2] - height) / self.focal
        x = self.position[0] + (column - self.size[0] / 2 + 0.5) * scale
        return x, self.position[1] - (row - self.size[1] / 2 + 0.5) * scale


def look_down(client: int, camera: Overhead) -> tuple[Image, Array]:
    """Colours (height, width, 3) and heights z (height, width) [m] that an overhead camera sees, free of noise."""
    (x, y, z), (width, height) = camera.position, camera.size
    view = bullet.computeViewMatrix((x, y, z), (x, y, z - 1.0), (0.0, 1.0, 0.0), physicsClientId=client)
    lens = bullet.computeProjectionMatrixFOV(
        camera.field_of_view, width / height, camera.near, camera.far, physicsClientId=client
    )
    answer = bullet.getCameraImage(
        width, height, view, lens, shadow=0, lightDirection=(0.3, -0.3, 1.0), renderer=bullet.ER_TINY_RENDERER,
        physicsClientId=client,
    )  # fmt: skip
    colours = np.asarray(answer[2], dtype=np.uint8).reshape(height, width, -1)[:, :, :3].copy()
    buffer = np.asarray(answer[3], dtype=float).reshape(height, width)
    depth = camera.far * camera.near / (camera.far - (camera.far - camera.near) * buffer)
    return colours, z - depth


def photograph(client: int, camera: Camera, size: tuple[int, int]) -> Image:
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


@dataclass(frozen=True)
class Solid:
    """What is seen of a link: kind ("box", "sphere", "cylinder", "capsule"), size [m], colour (red to alpha).

    size: three sides of a box, the radius of a sphere, else radius and length. place, turn: in the frame of the link.
    """

    body: int
    link: int
    kind: str
    size: tuple[float, ...]
    colour: tuple[float, ...]
    place: tuple[float, ...]
    turn: tuple[float, ...]


_KINDS = {bullet.GEOM_BOX: "box", bullet.GEOM_SPHERE: "sphere", bullet.GEOM_CYLINDER: "cylinder",
          bullet.GEOM_CAPSULE: "capsule"}  # fmt: skip


def solids(client: int) -> list[Solid]:
    """Everything in a scene that is seen, meshes apart."""
    bodies = [bullet.getBodyUniqueId(i, physicsClientId=client) for i in range(bullet.getNumBodies(client))]
    found = []
    for body in bodies:
        for _, link, kind, size, _, place, turn, colour, *_ in bullet.getVisualShapeData(body, physicsClientId=client):
            if kind in _KINDS and colour[3] > 0:
                sides = {"box": size, "sphere": size[:1]}.get(_KINDS[kind], (size[1], size[0]))
                found.append(Solid(body, link, _KINDS[kind], tuple(sides), tuple(colour), place, turn))
    return found


def whereabouts(client: int, seen: Sequence[Solid]) -> Array:
    """Poses (n, 7) of solids in the world: position [m] and quaternion x, y, z, w."""
    poses = []
    for solid in seen:
        if solid.link < 0:
            inertial = bullet.getDynamicsInfo(solid.body, -1, physicsClientId=client)[3:5]
            centre = bullet.getBasePositionAndOrientation(solid.body, physicsClientId=client)
            frame = bullet.multiplyTransforms(*centre, *bullet.invertTransform(*inertial))
        else:
            frame = bullet.getLinkState(solid.body, solid.link, 0, 1, physicsClientId=client)[4:6]
        place, turn = bullet.multiplyTransforms(*frame, solid.place, solid.turn)
        poses.append((*place, *turn))
    return np.array(poses)
