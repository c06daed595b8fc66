"""From a law of any kind to the joint torques of the scene's arm."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.control.computed_torque import ComputedTorque
from dexrepro.control.contract import KINDS, Command, Measured, build
from dexrepro.control.holding_line import HoldingLineRegulation
from dexrepro.control.motion import Motion, Path, rest
from dexrepro.errors import InputError
from dexrepro.experiment import Config
from dexrepro.physics.drive import EndPointDrive, HoldingDrive, JointDrive, Limited, Posture
from dexrepro.physics.plant import Sense
from dexrepro.robots.inverse_kinematics import InverseKinematics


class Joints:
    """The joints' motion that takes the end point along a path (3,) [m], by closed-loop inverse kinematics.

    start: joint angles (n,) [rad]. To be asked once a control period, in the order of time.
    """

    def __init__(self, config: Config, path: Path, start: Array) -> None:
        servo = config.servo
        self._path, self._step, self._rate = path, config.step, np.zeros(0)
        self._inverse = InverseKinematics(
            config.arm, gain=servo.ik_gain, period=config.step, rest=start, rest_gain=servo.rest_gain,
            kinematics=config.model,
        )  # fmt: skip
        self._inverse.reset(start)

    def __call__(self, time: float) -> Motion[Array]:
        wanted = self._path(time)
        return self.towards(wanted.position, wanted.velocity)

    def towards(self, position: Array, velocity: Array | None = None) -> Motion[Array]:
        """The same for a place (3,) [m] and a velocity [m/s]."""
        angles = self._inverse(position) if velocity is None else self._inverse(position, velocity=velocity)
        rate = self._inverse.velocity
        before, self._rate = self._rate if len(self._rate) else rate, rate
        return Motion(angles, rate, (rate - before) / self._step)


class Holding:
    """A holding law along the offset, the lateral force regulated to zero, Eq. (2.8).

    The law knows the arm's displacement along the line [m] and the force along it [N], nothing of the leader; inverse
    kinematics and computed torque take the arm to its ``reference`` (3,) [m].
    """

    def __init__(self, law: Any, config: Config, home: Array, start: Array) -> None:
        length = np.linalg.norm(config.offset)
        if not length > 0:
            raise InputError("scene.offset = [0, 0, 0] is not allowed: a holding law needs the direction it acts along")
        self._line, self._home, self.reference = np.array(config.offset, dtype=float) / length, home, home
        self.law, self._joints, self._model = HoldingDrive(law), Joints(config, rest(home), start), config.model
        self._servo = ComputedTorque(model=config.model, frequency=config.servo.frequency)
        self._regulation = HoldingLineRegulation(gain=config.regulation)

    def __call__(self, sense: Sense) -> Command:
        line, force, q = self._line, sense.force, sense.position
        along = float(line @ force)
        lateral = self._regulation(force - along * line)
        reference = self.law(sense.time, float(line @ (sense.tip - self._home)), along)
        self.reference = self._home + reference * line + lateral
        contact = force @ self._model.jacobian(q)[:3]
        measured = Measured(sense.time, q, sense.velocity, contact)
        return Command(self._servo(measured, self._joints.towards(self.reference)).torque - contact)


def driver(config: Config, leader: Path, start: Array) -> tuple[Callable[[Sense], Command], Callable[[float], Array]]:
    """What drives the arm, and where its end point should be (3,) [m] at a time [s] that has just been simulated.

    start: joint angles (n,) [rad]. Raises InputError for a law without a kind.
    """
    offset, model, law = np.array(config.offset, dtype=float), config.model, build(config.law, model=config.model)

    def beside(time: float) -> Motion[Array]:
        position, velocity, acceleration = leader(time)
        return Motion(position + offset, velocity, acceleration)

    def in_plane(time: float) -> Motion[Array]:
        return Motion(*(part[:axes] for part in beside(time)))

    controller: Any
    axes, kind = 2 if config.arm.is_planar else 3, getattr(law, "kind", None)
    if kind == "joint":
        controller = JointDrive(
            law, Joints(config, beside, start), lambda sense: sense.force @ model.jacobian(sense.position)[:3]
        )
    elif kind == "end_point":
        posture = Posture(model, start, 25.0) if len(start) > axes else None
        controller = EndPointDrive(law, in_plane, model, posture=posture)
    elif kind == "holding":
        controller = holding = Holding(law, config, beside(0.0).position, start)
    else:
        if law is None:
            raise InputError("scene.law = null is not allowed: name a law, or cases that each name one")
        raise InputError(f"scene law {type(law).__name__} must declare its kind, one of {', '.join(KINDS)}")
    reference = (lambda _: holding.reference) if kind == "holding" else (lambda time: beside(time).position)
    return (Limited(controller, support=model) if config.gravity_compensation else controller), reference
