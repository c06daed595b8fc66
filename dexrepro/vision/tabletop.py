"""Scenes of objects on the floor of a box, seen from above, and which grasps in them are good (Sect. 3.4)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dexrepro.arrays import Array
from dexrepro.physics.rendering import Overhead
from dexrepro.physics.world import World
from dexrepro.robots.arm import Colour, Pose, Shape
from dexrepro.vision.patches import Grasp, Picture, cut, observe

SAFE, UNSAFE, BAD = 0, 1, 2  # the three classes of Eq. (3.45)
FINGER = 0.006  # m, free floor needed around a finger point
WIDEST = 0.07  # m, widest object that the open gripper takes


@dataclass(frozen=True)
class Item:
    """A cuboid (sides ``size``, turned by ``yaw``) or an upright disc (``size[0]`` = diameter) on the floor; m, rad."""

    x: float
    y: float
    yaw: float
    size: tuple[float, float, float]
    round: bool
    colour: tuple[float, float, float, float]

    @property
    def reach(self) -> float:
        """Radius of the circle around it [m]."""
        return self.size[0] / 2 if self.round else math.hypot(self.size[0], self.size[1]) / 2

    def local(self, points: Array) -> Array:
        """Points (..., 2) [m] in the item's frame."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        x, y = points[..., 0] - self.x, points[..., 1] - self.y
        return np.stack((c * x + s * y, c * y - s * x), axis=-1)

    def covers(self, point: Array, margin: float = 0.0) -> bool:
        """Whether it, grown by a margin [m], lies under a point (2,) [m]."""
        x, y = self.local(point).tolist()
        if self.round:
            return math.hypot(x, y) <= self.size[0] / 2 + margin
        return abs(x) <= self.size[0] / 2 + margin and abs(y) <= self.size[1] / 2 + margin

    @property
    def short_side(self) -> float:
        """Direction of the short side [rad]."""
        return self.yaw + (0.0 if self.size[0] <= self.size[1] else math.pi / 2)

    @property
    def thickness(self) -> float:
        """What fingers that close along the short side have to span [m]."""
        return self.size[0] if self.round else min(self.size[:2])


@dataclass(frozen=True)
class Box:
    """Interior (x, y) [m] around a middle (x, y) [m], floor at ``floor`` and walls ``height`` high [m]."""

    size: tuple[float, float]
    middle: tuple[float, float] = (0.0, 0.0)
    floor: float = 0.0
    height: float = 0.3

    def clearance(self, point: Array) -> float:
        """Distance to the nearest wall [m], negative outside."""
        return float(min(s / 2 - abs(p - m) for p, m, s in zip(point, self.middle, self.size)))


def scatter(
    rng: np.random.Generator, box: Box, count: int, area: tuple[float, float, float, float] | None = None
) -> list[Item]:
    """Items that do not overlap, at least 3 mm from the walls; within ``area`` (x0, x1, y0, y1) [m] if given."""
    x0, x1, y0, y1 = area or (
        box.middle[0] - box.size[0] / 2, box.middle[0] + box.size[0] / 2,
        box.middle[1] - box.size[1] / 2, box.middle[1] + box.size[1] / 2,
    )  # fmt: skip
    items: list[Item] = []
    for _ in range(200):
        if len(items) == count:
            break
        item = _random_item(rng, x0, x1, y0, y1)
        clear = box.clearance(np.array((item.x, item.y))) - item.reach >= 0.003
        apart = all(math.dist((item.x, item.y), (o.x, o.y)) > item.reach + o.reach + 0.003 for o in items)
        if clear and apart:
            items.append(item)
    return items


def _random_item(rng: np.random.Generator, x0: float, x1: float, y0: float, y1: float) -> Item:
    disc = bool(rng.random() < 0.4)
    if disc:
        sides = (float(rng.uniform(0.02, 0.11)),) * 2
    else:
        a, b = rng.uniform(0.02, 0.13, 2).tolist()
        sides = (a, b)
    colour = (*rng.uniform(0.1, 0.95, 3).tolist(), 1.0)
    x, y = float(rng.uniform(x0, x1)), float(rng.uniform(y0, y1))
    return Item(x, y, float(rng.uniform(-math.pi, math.pi)), (*sides, float(rng.uniform(0.03, 0.08))), disc, colour)


def furnish(world: World, box: Box, items: list[Item], rng: np.random.Generator) -> None:
    """Put floor, walls (in random shades) and items into a world."""

    def shade() -> Colour:
        red, green, blue = np.clip(rng.uniform(0.3, 0.8) + rng.uniform(-0.1, 0.1, 3), 0, 1).tolist()
        return red, green, blue, 1.0

    (mx, my), (width, depth), plate = box.middle, box.size, 0.01
    shapes = [Shape("box", (width, depth, plate), Pose((0, 0, -plate / 2)), shade())]
    wall = shade()
    for side in (-1, 1):
        shapes.append(
            Shape(
                "box",
                (plate, depth + 2 * plate, box.height),
                Pose((side * (width + plate) / 2, 0, box.height / 2)),
                wall,
            )
        )
        shapes.append(
            Shape("box", (width, plate, box.height), Pose((0, side * (depth + plate) / 2, box.height / 2)), wall)
        )
    world.add_body("box", shapes, (mx, my, box.floor))
    place_items(world, box, items)


def place_items(world: World, box: Box, items: list[Item], mass: float = 0.0) -> list[str]:
    """Put items on a box's floor; returns their names. mass [kg] of each (0: fixed)."""
    names = []
    for index, item in enumerate(items):
        a, b, c = item.size
        shape = (
            Shape("cylinder", (a / 2, c), colour=item.colour)
            if item.round
            else Shape("box", (a, b, c), colour=item.colour)
        )
        world.add_body(
            f"item{index}", [shape], (item.x, item.y, box.floor + c / 2), (0.0, 0.0, item.yaw), mass=mass, friction=0.8
        )
        names.append(f"item{index}")
    return names


def photograph(box: Box, items: list[Item], camera: Overhead, rng: np.random.Generator) -> Picture:
    """An open box with items as the depth camera sees it, noise included."""
    with World() as world:
        furnish(world, box, items, rng)
        return observe(*world.look_down(camera), camera, rng)


def label(grasp: Grasp, items: list[Item], box: Box, margin: float) -> int:
    """SAFE, UNSAFE (a good grasp nearer than ``margin`` [m] to a wall) or BAD, from the true scene."""
    target = taken(grasp, items)
    if target is None:
        return BAD
    centre = np.array((grasp.x, grasp.y))
    fingers = [centre + side * grasp.direction * grasp.width / 2 for side in (-1, 1)]
    free = all(box.clearance(f) > FINGER and not any(item.covers(f, FINGER) for item in items) for f in fingers)
    if not free:
        return BAD
    return SAFE if box.clearance(centre) > margin else UNSAFE


def taken(grasp: Grasp, items: list[Item]) -> int | None:
    """Index of the item that the closing fingers would hold: centred across, aligned, and not too wide."""
    for index, item in enumerate(items):
        offset = np.array((item.x - grasp.x, item.y - grasp.y))
        along = float(offset @ grasp.direction)
        across = abs(float(offset @ (-grasp.direction[1], grasp.direction[0])))
        turn = abs((grasp.angle - item.short_side + math.pi / 2) % math.pi - math.pi / 2)
        aligned = item.round or turn < math.radians(15)
        between = abs(along) < (grasp.width - item.thickness) / 2
        if across < 0.01 and aligned and between and item.thickness < WIDEST:
            return index
    return None


def candidates(rng: np.random.Generator, items: list[Item], box: Box, each: int = 6) -> list[Grasp]:
    """For every item, half of the rectangles near its centre along its short side, half of them anywhere around it."""
    result = []
    for item in items:
        for k in range(each):
            good = k < each // 2
            spread, turn = (0.004, 0.08) if good else (0.03, math.pi)
            x, y = (np.array((item.x, item.y)) + spread * rng.standard_normal(2)).tolist()
            angle = item.short_side + (turn * rng.standard_normal() if good else rng.uniform(-turn, turn))
            result.append(Grasp(x, y, float(angle), box.floor + item.size[2]))
    return result


class Sight(Protocol):
    """How scenes are seen and judged: heights and distances [m], angle of view [degrees]."""

    camera_height: float
    safety_margin: float
    field_of_view: float


def training_set(
    config: Sight, interior: Sequence[float], scenes: int, rng: np.random.Generator, size: float
) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Patches (n, 7, 24, 24) of a side [m] and labels (n,) of so many random scenes in a box (x, y) [m]."""
    width, depth = interior
    box = Box((width, depth))
    camera = Overhead((0.0, 0.0, config.camera_height), size=(180, 140), field_of_view=config.field_of_view)
    patches, labels = [], []
    for _ in range(scenes):
        items = scatter(rng, box, int(rng.integers(2, 5)))
        picture = photograph(box, items, camera, rng)
        grasps = candidates(rng, items, box)
        patches.append(cut(picture, grasps, size))
        labels += [label(grasp, items, box, config.safety_margin) for grasp in grasps]
    return np.concatenate(patches), np.array(labels)
