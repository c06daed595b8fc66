"""The box with an opening in its lid, the right arm with its gripper, and what is read off their runs."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.experiment import Config, Recording
from dexrepro.physics.elements import Carried
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.robots.arm import Arm, Pose, Shape
from dexrepro.robots.baxter import baxter, extension, posture, torso
from dexrepro.robots.inverse_kinematics import solve
from dexrepro.robots.kinematics import forward, joint_frames

ARM = "right"
# Joints whose origins are corners of the arm's centreline near the opening: elbow e1 and wrist w1.
ELBOW, WRIST = 3, 5
FOREARM = "upper_forearm"
LID: tuple[float, float, float, float] = (0.75, 0.72, 0.62, 1.0)
WALL: tuple[float, float, float, float] = (0.80, 0.82, 0.85, 0.35)
CUBE: tuple[float, float, float, float] = (0.0, 0.62, 0.45, 1.0)
CAMERA = Camera(target=(0.6, -0.15, 0.1), distance=1.6, yaw=40.0, pitch=-25.0)
FILMED = Camera(target=(0.55, -0.2, 0.13), distance=1.6, yaw=40.0, pitch=-25.0)


@cache
def gripper_arm(length: float) -> Arm:
    """Baxter's right arm with a straight, massless gripper that ends some length [m] beyond the flange's end point."""
    return baxter("right", extension(length) if length else None)


@cache
def start_posture(length: float, lift: float) -> tuple[float, ...]:
    """Joint angles [rad] of the untucked arm with its end point raised by ``lift`` [m], orientation kept."""
    arm, untucked = gripper_arm(length), posture("right")
    position, rotation = forward(arm, untucked)
    goal = position + np.array((0.0, 0.0, lift))
    return tuple(solve(arm, goal, rotation, untucked, "pose", rest=untucked, rest_gain=0.1).tolist())


def build(config: Config, centre: Callable[[float], Array] | None = None) -> World:
    """Box, lid and arm at its start; with ``centre`` the lid is carried along, its hole centred there at any time."""
    world = World(step=config.step, perturbation=config.perturbation)
    add_box(world, config.box, config.centre, centre)
    world.add_body("torso", torso(), (0.0, 0.0, 0.0), collides=False)
    if config.box.cube:
        world.add_box("cube", (config.box.cube,) * 3, config.target, colour=CUBE, collides=False)
    start = start_posture(config.gripper, config.lift)
    world.add_arm(ARM, gripper_arm(config.gripper), start, contacts=config.box.touchable)
    return world


def add_box(world: World, box: Config, opening: Any, centre: Callable[[float], Array] | None = None) -> None:
    """A box without top ("box") and its "lid" with a square hole centred at ``opening`` (3,) [m], both static.

    box.size: interior (x, y) [m]; box.height; box.middle: (x, y) of the interior's middle [m]; box.opening: side of
    the hole; box.thickness of all plates [m].
    """
    (width, depth), (mx, my), height, plate = box.size, box.middle, box.height, box.thickness
    shapes = [Shape("box", (width, depth, plate), Pose((0, 0, -height - plate / 2)), WALL)]
    for side in (-1, 1):
        across, along = side * (width + plate) / 2, side * (depth + plate) / 2
        shapes.append(Shape("box", (plate, depth + 2 * plate, height), Pose((across, 0, -height / 2)), WALL))
        shapes.append(Shape("box", (width, plate, height), Pose((0, along, -height / 2)), WALL))
    # The upper face of walls and the middle plane of the lid are at the height of the opening.
    world.add_body("box", shapes, (mx, my, opening[2] - plate / 2))
    world.add_body("lid", lid_shapes(box, opening), tuple(map(float, opening)))
    if centre is not None:
        world.add(Carried("lid", centre))


def cutaway(world: World, recording: Recording, config: Config) -> Recording:
    """For films: the box without the two walls before the camera, so that gripper and cube are seen inside."""
    (width, depth), (mx, my), height, plate = (
        config.box.size,
        config.box.middle,
        config.box.height,
        config.box.thickness,
    )
    shapes = [
        Shape("box", (width, depth, plate), Pose((0, 0, -height)), WALL),
        Shape("box", (plate, depth, height), Pose((-width / 2, 0, -height / 2)), WALL),
        Shape("box", (width, plate, height), Pose((0, depth / 2, -height / 2)), WALL),
    ]
    world.add_body("open_box", shapes, (mx, my, config.centre[2] - plate), collides=False)
    away = np.full((len(recording.time), 3), -9.0)
    return Recording({**recording.series, "box.pose": away})


def lid_shapes(box: Config, opening: Any) -> list[Shape]:
    """Four plates around the hole, in a frame at its centre."""
    half, plate = box.opening / 2, box.thickness
    west, east = box.middle[0] - box.size[0] / 2 - opening[0], box.middle[0] + box.size[0] / 2 - opening[0]
    south, north = box.middle[1] - box.size[1] / 2 - opening[1], box.middle[1] + box.size[1] / 2 - opening[1]
    pieces = [
        (west, -half, south, north),
        (half, east, south, north),
        (-half, half, south, -half),
        (-half, half, half, north),
    ]
    shapes = []
    for x0, x1, y0, y1 in pieces:
        if x1 - x0 > 1e-6 and y1 - y0 > 1e-6:
            place = Pose(((x0 + x1) / 2, (y0 + y1) / 2, 0.0))
            shapes.append(Shape("box", (x1 - x0, y1 - y0, plate), place, LID))
    return shapes


def centreline(arm: Arm, positions: Array) -> Array:
    """Corners (..., 3, 3) [m] of the arm's centreline: elbow e1, wrist w1, tip; for joint angles (..., n) [rad]."""
    frames = joint_frames(arm, positions)
    tip = frames[..., -1, :, :] @ arm.tip
    return np.stack((frames[..., ELBOW, :3, 3], frames[..., WRIST, :3, 3], tip[..., :3, 3]), axis=-2)


def distance_to_centre(arm: Arm, positions: Array, centres: Array) -> Array:
    """Dis_R (n,) [m]: shortest distance of the centreline to the remote centre at each sample."""
    corners = centreline(arm, positions)
    result = np.full(len(positions), np.inf)
    for start, end in ((corners[:, 0], corners[:, 1]), (corners[:, 1], corners[:, 2])):
        along, offset = end - start, centres - start
        share = np.clip((offset * along).sum(1) / (along * along).sum(1), 0.0, 1.0)
        result = np.minimum(result, np.linalg.norm(offset - share[:, None] * along, axis=1))
    return result


class Touching:
    """Probe: (number of contact points of the arm with lid and box, their total force [N], clearance [m]).

    The clearance, the smallest distance of the arm to lid or box (negative: overlap), is renewed every 20th sample.
    """

    EVERY = 20

    def __init__(self, world: World) -> None:
        self._world, self._calls, self._clearance = world, 0, 1.0

    def __call__(self) -> tuple[float, float, float]:
        if self._calls % self.EVERY == 0:
            self._clearance = min(self._world.distance(ARM, name, 0.2) for name in ("lid", "box"))
        self._calls += 1
        touches = self._world.contacts(ARM) if self._clearance < 0.02 else []
        forces = [touch.normal_force for touch in touches if touch.normal_force > 0.0]
        return float(len(forces)), sum(forces), self._clearance
