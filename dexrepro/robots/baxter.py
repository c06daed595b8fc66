"""One arm of the Baxter robot, from baxter.yaml beside this file; a two-armed robot is a left and a right arm."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
import yaml
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.robots.arm import Arm, Colour, Joint, Link, Pose, Shape, Tool

RED: Colour = (0.70, 0.13, 0.13, 1.0)
DARK: Colour = (0.25, 0.25, 0.27, 1.0)
# Capsules from each joint to the next, chosen to enclose the real links [m].
RADII = (0.075, 0.075, 0.065, 0.065, 0.06, 0.055, 0.045, 0.035)
GRIPPER_RADIUS = 0.025
MIRRORED = np.array([-1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


@cache
def _data() -> dict[str, Any]:
    """The maker's numbers, as in baxter.yaml (SI units)."""
    text = files("dexrepro.robots").joinpath("baxter.yaml").read_text(encoding="utf-8")
    result: dict[str, Any] = yaml.safe_load(text)
    return result


def baxter(side: str, tool: Tool | None = None, base: Pose = Pose(), mount: Pose | None = None) -> Arm:
    """The seven-joint arm of one side, "left" or "right", in the torso frame (x forward, y left, z up).

    base: pose of the torso in the world. mount: pose of the arm in the torso frame, by default that of the side.
    The end frame is the gripper's end point, z along the approach direction. Torque limits 50, 100, 50, 50, 15, 15,
    15 N m. Rotor inertia, friction and the series springs of the real joints are not modelled.
    """
    robot = _data()
    if mount is None:
        mount = _pose(robot["mount"][side])
    joints = tuple(
        Joint(
            f"{side}_{row['name']}",
            _pose(row),
            (0.0, 0.0, 1.0),
            *(float(row[key]) for key in ("lower", "upper", "effort", "velocity")),
        )
        for row in robot["joints"]
    )
    ends = [row["xyz"] for row in robot["joints"][1:]] + [robot["hand"]["xyz"], robot["gripper"]["xyz"]]
    *links, hand = [_link(row, end, r) for row, end, r in zip(robot["links"], ends, RADII, strict=True)]
    finger = Shape("sphere", (GRIPPER_RADIUS,), _pose(robot["gripper"]), DARK)
    hand = replace(hand, shapes=(*hand.shapes, finger))
    return Arm(
        f"baxter_{side}",
        joints,
        tuple(links),
        fixed=((_pose(robot["hand"]), hand),),
        end=_pose(robot["gripper"]),
        tool=tool,
        base=base @ mount,
    )


def posture(side: str) -> Array:
    """Joint angles [rad], shape (7,), of the untucked arm; the left arm mirrors s0, e0, w0 and w2."""
    return mirrored(_data()["poses"]["untuck"], side)


def mirrored(right: ArrayLike, side: str = "left") -> Array:
    """Angles for one side, shape (..., 7), from those of the right arm: the left arm mirrors s0, e0, w0 and w2."""
    angles = np.asarray(right, dtype=float)
    return angles * MIRRORED if side == "left" else angles


def torso() -> tuple[Shape, ...]:
    """Shapes of the body between the arms, in the torso frame, to be looked at."""
    return (
        Shape("box", (0.20, 0.34, 0.50), Pose((-0.02, 0.0, 0.10)), DARK, collides=False),
        Shape("cylinder", (0.12, 0.70), Pose((-0.02, 0.0, -0.50)), DARK, collides=False),
        Shape("box", (0.04, 0.24, 0.16), Pose((0.10, 0.0, 0.50)), DARK, collides=False),
    )


def extension(length: float = 0.15, radius: float = 0.015) -> Tool:
    """A massless gripper of some length [m] along the tool's z axis; its end point is the tip."""
    shape = Shape.between((0, 0, 0), (0, 0, length), radius, DARK)
    return Tool("gripper", tip=Pose((0.0, 0.0, length)), shapes=(shape,))


def palm(size: tuple[float, float, float] = (0.10, 0.10, 0.02), mass: float = 0.1) -> Tool:
    """A flat pad [m], centred at the gripper frame, in place of hand and wrist; its outer face is the tip."""
    x, y, z = size
    inertia = (mass * (y * y + z * z) / 12, 0.0, 0.0, mass * (x * x + z * z) / 12, 0.0, mass * (x * x + y * y) / 12)
    shape = Shape("box", size, colour=DARK)
    tip = Pose((0.0, 0.0, z / 2))
    return Tool("palm", tip=tip, mass=mass, inertia=inertia, shapes=(shape,), replaces=("wrist", "hand"))


def _pose(row: dict[str, Any]) -> Pose:
    return Pose(tuple(map(float, row["xyz"])), tuple(map(float, row["rpy"])))  # type: ignore[arg-type]


def _link(row: dict[str, Any], end: list[float], radius: float) -> Link:
    inertia = tuple(float(row[key]) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    shape = Shape.between((0, 0, 0), end, radius, RED if radius > 0.05 else DARK)
    return Link(row["name"], float(row["mass"]), tuple(map(float, row["com"])), inertia, (shape,))  # type: ignore[arg-type]
