"""From end-point paths to a Baxter arm that follows them under torque."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from dexrepro.arrays import Array
from dexrepro.control.contract import build
from dexrepro.control.motion import Sampled
from dexrepro.physics.drive import JointDrive
from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.arm import Arm
from dexrepro.robots.inverse_kinematics import InverseKinematics


def joint_path(
    arm: Arm, model: RigidBodyModel, time: Array, positions: Array, rotations: Array, task: str, start: ArrayLike,
    rest_gain: float,
) -> tuple[CubicSpline, float]:  # fmt: skip
    """Joint angles over time for an end-point path (n, 3) [m] with rotations (3, 3) or (n, 3, 3).

    start: joint angles that reach the first point; they are also pulled at. Returns a spline and the largest task
    error left.
    """
    period = float(time[1] - time[0])
    follower = InverseKinematics(
        arm, task, 1 / period, period, damping=1e-4, rest=start, rest_gain=rest_gain, kinematics=model
    )
    follower.reset(start)
    angles, worst = np.empty((len(time), arm.dof)), 0.0
    turns = np.broadcast_to(rotations, (len(time), 3, 3))
    for k, (place, turn) in enumerate(zip(positions, turns)):
        for _ in range(3):
            follower(place, turn)
        worst = max(worst, float(np.abs(follower.error).max()))
        angles[k] = follower.position
    return CubicSpline(time, angles), worst


def follow(model: RigidBodyModel, path: CubicSpline, law: Any, step: float, duration: float) -> JointDrive:
    """Drives an arm along a joint path with a law of its own like the one given."""
    time = step * np.arange(round(duration / step) + 1)
    wanted = Sampled(step, *(path(time, derivative) for derivative in range(3)))
    return JointDrive(build(deepcopy(law), model=model), wanted)
