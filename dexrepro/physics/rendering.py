"""Cameras, and what they see."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dexrepro.arrays import Array


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
