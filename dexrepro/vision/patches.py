"""From a picture with heights to the patches of grasp rectangles: 24 x 24 samples of seven channels (Sect. 3.4.2.1)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter, map_coordinates

from dexrepro.arrays import Array, Image

SAMPLES = 24
DEEPEST, HIGHEST = 0.15, 0.40  # m below and above the grasp; what lies beyond is cut off
CHANNELS = ("red", "green", "blue", "depth", "normal x", "normal y", "normal z")


class Lens(Protocol):
    """Where points of the world appear in a picture."""

    @property
    def position(self) -> tuple[float, float, float]:
        """Place of the camera [m]."""

    def project(self, points: Array) -> Array:
        """Pixel coordinates (..., 2), column and row, of points (..., 3) [m]."""


@dataclass(frozen=True)
class Grasp:
    """A grasp rectangle g = {x, y, Phi, h, w}, Eq. (3.44), with the height of what it closes on.

    x, y: centre [m]; angle: direction in which the fingers close [rad]; z: height of the surface there [m];
    width: opening w [m]; the book's h is w / 4.
    """

    x: float
    y: float
    angle: float
    z: float
    width: float = 0.085

    @property
    def direction(self) -> Array:
        """Unit vector (2,) in which the fingers close."""
        return np.array((np.cos(self.angle), np.sin(self.angle)))

    @property
    def corners(self) -> Array:
        """Corners (4, 2) [m] of the rectangle."""
        along, across = self.direction * self.width / 2, np.array((-np.sin(self.angle), np.cos(self.angle)))
        across = across * self.width / 8
        return np.array((self.x, self.y)) + np.array((along + across, along - across, -along - across, across - along))


@dataclass(frozen=True)
class Picture:
    """What a depth camera saw: colours (rows, columns, 3) in 0..1, heights z (rows, columns) [m], and its lens."""

    colours: Array
    heights: Array
    lens: Lens


def observe(
    colours: Image, heights: Array, lens: Lens, rng: np.random.Generator, depth_noise: float = 0.002
) -> Picture:
    """A picture with the noise of a depth camera: heights [m] noisy and smoothed, colours noisy by 0.02."""
    noisy = gaussian_filter(heights + depth_noise * rng.standard_normal(heights.shape), 0.7)
    tinted = np.clip(colours / 255.0 + 0.02 * rng.standard_normal(colours.shape), 0.0, 1.0)
    return Picture(tinted, noisy, lens)


def cut(picture: Picture, grasps: Sequence[Grasp], size: float, bounded: bool = True) -> NDArray[np.float32]:
    """Patches (n, 7, 24, 24) of a side [m] around the grasps, turned so that the fingers close along columns.

    Channels: colours, depth below the camera [m], surface normal in the frame of the grasp. bounded: cut off heights
    far from the grasp (what a depth camera returns beside the scene); heights are in m then.
    """
    if not grasps:
        return np.zeros((0, 7, SAMPLES, SAMPLES), dtype=np.float32)
    steps = (np.arange(SAMPLES) + 0.5) / SAMPLES * size - size / 2
    along, across = np.meshgrid(steps, -steps)
    x, y, z, angle = np.array([(g.x, g.y, g.z, g.angle) for g in grasps]).T[..., None, None]
    c, s = np.cos(angle), np.sin(angle)
    levels = z + np.zeros_like(along)
    points = np.stack((x + c * along - s * across, y + s * along + c * across, levels), axis=-1)
    pixels = picture.lens.project(points)
    where = (pixels[..., 1], pixels[..., 0])
    layers = [map_coordinates(picture.colours[..., c], where, order=1, mode="nearest") for c in range(3)]
    heights = map_coordinates(picture.heights, where, order=1, mode="nearest")
    level = points[..., 2]
    if bounded:
        heights = np.clip(heights, level - DEEPEST, level + HIGHEST)
    rise_y, rise_x = np.gradient(heights, size / SAMPLES, axis=(1, 2))
    norm = np.sqrt(1.0 + rise_x**2 + rise_y**2)
    layers += [picture.lens.position[2] - heights, -rise_x / norm, rise_y / norm, 1.0 / norm]
    return np.stack(layers, axis=1).astype(np.float32)
