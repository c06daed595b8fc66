"""What the experiments on two Baxter arms share: the teleoperated right arm (DFR) and the assistive left one (AFR)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from dexrepro.arrays import Array, Rng
from dexrepro.experiment import Config
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.servo import PoseServo
from dexrepro.physics.world import World
from dexrepro.robots.arm import Tool
from dexrepro.robots.baxter import baxter, posture
from dexrepro.robots.inverse_kinematics import nearest

SIDES = {"leader": "right", "follower": "left"}
LEVEL = np.stack([(0.0, 0.0, -1.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], axis=1)  # R_D while the line is level
FLIP = np.diag([1.0, -1.0, -1.0])
ALONG = np.array([0.0, 1.0, 0.0])  # from DFR to AFR while the line is level
BALL, TABLE = (0.35, 0.65, 0.85, 1.0), (0.85, 0.82, 0.78, 1.0)


def add_arms(
    world: World, places: Mapping[str, Array], sensor: Sensor | None = None, rng: Rng | None = None,
    tool: Tool | None = None,
) -> None:  # fmt: skip
    """Both arms with their end points at ``places`` (3,) [m], facing each other along the level line.

    sensor: of the follower's force, if there are random numbers for it. tool: touches what it meets.
    """
    for name, side in SIDES.items():
        arm = baxter(side, tool=tool)
        start = nearest(arm, posture(side), places[name], LEVEL if name == "leader" else LEVEL @ FLIP)
        noise = rng("force sensor") if rng and name == "follower" else None
        felt = sensor if sensor and noise else Sensor()
        world.add_arm(name, arm, start, contacts=tool is not None, sensor=felt, rng=noise)


def servos(world: World, config: Config) -> dict[str, PoseServo]:
    """What takes the end points of both arms to poses, one a control period, from where they are."""
    found = {}
    for name, plant in world.arms.items():
        start = np.array(plant.q)
        found[name] = PoseServo(plant.arm, start, dt=config.control_period, **config.arm)
        found[name].reset(start)
    return found


def joint_channels(joints: Array) -> dict[str, Array]:
    """Joint angles (n, 14) [rad] of both arms as the channels of the World."""
    return {f"{name}.position": joints[:, 7 * k : 7 * (k + 1)] for k, name in enumerate(SIDES)}
