"""From a law of any signature of the library to the joint torques of one arm."""

from __future__ import annotations

import inspect
import math
from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dexrepro.chapters.own.paths import Path
from dexrepro.config import InputError
from dexrepro.control.computed_torque import ComputedTorque
from dexrepro.control.holding_line import HoldingLineRegulation
from dexrepro.control.task_space import ArmState, Motion
from dexrepro.experiment import Config
from dexrepro.physics.plant import Sense
from dexrepro.robots.inverse_kinematics import InverseKinematics

Array = NDArray[np.float64]


class Driver(ABC):
    """Joint torques from what the arm senses; ``reference`` is where the end point should be (3,) [m].

    law: the user's; config: the scene's; path: of the leader; start: joint angles (n,) [rad].
    """

    def __init__(self, law: Any, config: Config, path: Path, start: Array) -> None:
        arm, servo = config.arm, config.servo
        self.law, self.model, self.path, self.start = law, config.model, path, start
        self.offset = np.array(config.offset, dtype=float)
        self.compensate = config.gravity_compensation
        self.inverse = InverseKinematics(
            arm, gain=servo.ik_gain, period=config.step, rest=start, rest_gain=servo.rest_gain, kinematics=config.model
        )
        self.inverse.reset(start)
        self.reference = path(0.0).position + self.offset
        self.reset()

    def reset(self) -> None:
        if hasattr(self.law, "reset"):
            self.law.reset()

    def __call__(self, sense: Sense) -> Any:
        command = self.torque(sense)
        if not self.compensate:
            return command
        gravity = self.model.gravity(sense.position)
        return (command[0] + gravity, command[1]) if isinstance(command, tuple) else command + gravity

    @abstractmethod
    def torque(self, sense: Sense) -> Any:
        """Joint torques (n,) [N m], or torques and an implicit damping, before the scene compensates gravity."""

    def motion(self, time: float) -> Motion:
        """The leader's motion at the distance ``offset``."""
        position, velocity, acceleration = self.path(time)
        self.reference = position + self.offset
        return Motion(self.reference, velocity, acceleration)


class ForceDriver(Driver):
    """A holding law ``law(position, force)`` along the offset, the lateral force regulated to zero, Eq. (2.8).

    The law knows the arm's displacement along the line [m] and the force along it [N], nothing of the leader; inverse
    kinematics and computed torque take the arm to its reference.
    """

    def __init__(self, law: Any, config: Config, path: Path, start: Array) -> None:
        super().__init__(law, config, path, start)
        self.servo = ComputedTorque(model=self.model, frequency=config.servo.frequency)
        self.regulation = HoldingLineRegulation(gain=config.regulation)

    def reset(self) -> None:
        length = np.linalg.norm(self.offset)
        if not length > 0:
            raise InputError("scene.offset = [0, 0, 0] is not allowed: a force law needs the direction it acts along")
        self.line, self.home = self.offset / length, self.reference
        self.law.reset(0.0)

    def torque(self, sense: Sense) -> Array:
        along, force = float(self.line @ (sense.tip - self.home)), float(self.line @ sense.force)
        lateral = self.regulation(sense.force - force * self.line)
        self.reference = self.home + self.law(along, force) * self.line + lateral
        angles = self.inverse(self.reference)
        torque = self.servo(angles, sense.position, sense.velocity, self.inverse.velocity)
        return torque - sense.force @ self.model.jacobian(sense.position)[:3]


class TaskDriver(Driver):
    """A tracking law ``law(arm, reference, force)`` that returns the force at the end point, Eq. (8.25).

    Joints that the task leaves free are held near their start, without moving the task.
    """

    def torque(self, sense: Sense) -> Array:
        axes = 2 if self.inverse.arm.is_planar else 3
        q, dq = sense.position, sense.velocity
        arm = ArmState(q, dq, sense.tip[:axes], sense.tip_velocity[:axes])
        reference = Motion(*(part[:axes] for part in self.motion(sense.time)))
        force = self.law(arm, reference, sense.force[:axes])
        jacobian = self.model.jacobian(q)[:axes]
        if len(q) == axes:
            return jacobian.T @ force
        mass = self.model.mass_matrix(q)
        wanted = 25.0 * (self.start - q) - 2 * math.sqrt(25.0) * dq
        coupling = jacobian @ np.linalg.solve(mass, jacobian.T)
        torque: Array = jacobian.T @ (force - np.linalg.solve(coupling, jacobian @ wanted)) + mass @ wanted
        return torque


class JointDriver(Driver):
    """A joint law behind closed-loop inverse kinematics of the leader's path; see :data:`DRIVERS`."""

    def __init__(self, law: Any, config: Config, path: Path, start: Array) -> None:
        super().__init__(law, config, path, start)
        self.parameters = parameters(law)
        self.step, self.rate = config.step, None  # type: Any, Any

    def torque(self, sense: Sense) -> Any:
        q, dq = sense.position, sense.velocity
        wanted = self.motion(sense.time)
        angles = self.inverse(wanted.position, velocity=wanted.velocity)
        rate = self.inverse.velocity
        before, self.rate = rate if self.rate is None else self.rate, rate
        if self.parameters[0] == "reference":
            return self.law(angles, q, dq, rate)
        more = {}
        if "contact_torque" in self.parameters:
            more["contact_torque"] = sense.force @ self.model.jacobian(q)[:3]
        return self.law(q, dq, (angles, rate, (rate - before) / self.step), **more)


DRIVERS: dict[tuple[str, ...], type[Driver]] = {
    ("position", "force"): ForceDriver,
    ("arm", "reference", "force"): TaskDriver,
    ("reference", "position", "velocity", "reference_velocity"): JointDriver,
    ("q", "dq", "desired"): JointDriver,
    ("position", "velocity", "desired"): JointDriver,
}
"""Parameters that the call of a law begins with, and who drives the arm with it."""


def parameters(law: Any) -> tuple[str, ...]:
    return tuple(inspect.signature(law).parameters) if callable(law) else ()


def driver(law: Any, config: Config, path: Path, start: Array) -> Driver:
    """The driver for a law's signature. Raises InputError where it has none of those of :data:`DRIVERS`."""
    names = parameters(law)
    for known, kind in DRIVERS.items():
        if names[: len(known)] == known:
            return kind(law, config, path, start)
    known_ones = " or ".join(f"({', '.join(known)})" for known in DRIVERS)
    raise InputError(f"scene law {type(law).__name__} is called with ({', '.join(names)}); it must be {known_ones}")
