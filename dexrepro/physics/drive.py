"""From a control law of any kind to an arm of a World: the adapters that every chapter and your own scene use."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

import numpy as np

from dexrepro.arrays import Array
from dexrepro.control.contract import Command, HoldingLaw, Law, Measured, NominalModel, Undefined, check, number
from dexrepro.control.motion import Motion, Path
from dexrepro.physics.plant import Sense


class JointDrive:
    """A joint law along a joint path; a controller for :meth:`World.run`.

    path: where the joints should be over time, or None where :meth:`command` is told at every call. contact: external
    joint torque (n,) [N m] as the arm estimates it from what it senses; without it the law is told 0. ``desired`` is
    the motion of the last call.
    """

    def __init__(self, law: Law, path: Path | None = None, contact: Callable[[Sense], Array] | None = None) -> None:
        self.law: Law = check(law, "joint")
        self.path, self.contact = path, contact
        self.desired: Motion[Array] | None = None

    def __call__(self, sense: Sense) -> Command:
        q = sense.position
        force = np.zeros(len(q)) if self.contact is None else self.contact(sense)
        assert self.path is not None
        return self.command(Measured(sense.time, q, sense.velocity, force), self.path(sense.time))

    def command(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """What the law commands; it is reset before its first call."""
        if self.desired is None:
            self.law.reset(measured)
        self.desired = desired
        return self.law(measured, desired)


class Kinematics(Protocol):
    """An end point (d,) [m] and its Jacobian (d, n) at joint angles (n,) [rad]."""

    def position(self, q: Array) -> Array:
        """End point (d,) [m]."""

    def jacobian(self, q: Array) -> Array:
        """Its Jacobian (d, n) [m/rad]."""


class EndPointDrive:
    """An end-point law along a path of the end point; a controller for :meth:`World.run`.

    model: gives the Jacobian, whose first d rows are the task's, and what ``posture`` needs. kinematics: takes the
    place of the sensed end point. displaced: moves the path by what is measured. posture: holds the joints that the
    task leaves free. ``path``, ``desired``, ``error`` (x - x_d) [m] are those of the last call.
    """

    def __init__(
        self,
        law: Law,
        path: Path,
        model: NominalModel | None,
        *,
        kinematics: Kinematics | None = None,
        displaced: Callable[[Measured[Array], Motion[Array]], Motion[Array]] | None = None,
        posture: Posture | None = None,
    ) -> None:
        self.law: Law = check(law, "end_point")
        self._path, self._model, self._kinematics = path, model, kinematics
        self._displaced, self._posture, self._fresh = displaced, posture, True
        self.path = self.desired = path(0.0)
        self.axes = len(self.path.position)
        self.error = np.zeros(self.axes)

    def __call__(self, sense: Sense) -> Command:
        measured = self.measure(sense)
        if self._fresh:
            self._fresh = False
            self.law.reset(measured)
        self.path = self.desired = self._path(sense.time)
        if self._displaced is not None:
            self.desired = self._displaced(measured, self.path)
        self.error = measured.position - self.desired.position
        command = self.law(measured, self.desired)
        if self._posture is not None:
            return self._posture(measured.angles, measured.rates, self.jacobian(measured.angles), command)
        if command.force is None:
            return command
        return Command(self.jacobian(measured.angles).T @ command.force, command.damping)

    def measure(self, sense: Sense) -> Measured[Array]:
        """What the law is told."""
        axes, q = self.axes, sense.position
        position = sense.tip[:axes] if self._kinematics is None else self._kinematics.position(q)
        return Measured(sense.time, position, sense.tip_velocity[:axes], sense.force[:axes], q, sense.velocity)

    def jacobian(self, q: Array) -> Array:
        """Rows of the task's axes, shape (d, n)."""
        if self._kinematics is not None:
            return self._kinematics.jacobian(q)
        assert self._model is not None
        return self._model.jacobian(q)[: self.axes]


class Posture:
    """Holds the joints that a task leaves free near their start, without moving the task.

    Their accelerations stiffness (q_0 - q) - 2 sqrt(stiffness) dq [1/s^2] are projected with the inertia of ``model``.
    """

    def __init__(self, model: NominalModel, start: Array, stiffness: float) -> None:
        self.model, self.start, self.stiffness, self.damping = model, start, stiffness, 2.0 * math.sqrt(stiffness)

    def __call__(self, q: Array, dq: Array, jacobian: Array, command: Command) -> Command:
        """The command with what holds the posture, all as torque."""
        mass = self.model.mass_matrix(q)
        wanted = self.stiffness * (self.start - q) - self.damping * dq
        coupling = jacobian @ np.linalg.solve(mass, jacobian.T)
        force = -np.linalg.solve(coupling, jacobian @ wanted)
        if command.force is None:
            return Command(command.torque + (jacobian.T @ force + mass @ wanted), command.damping)
        return Command(jacobian.T @ (command.force + force) + mass @ wanted, command.damping)


class Limited:
    """A controller whose torques stay within +- limit [N m].

    support: a model whose gravity torque is added, what holds the arm alone, as an arm's maker does.
    """

    def __init__(
        self,
        controller: Callable[[Sense], Command],
        limit: Array | float = math.inf,
        support: NominalModel | None = None,
    ) -> None:
        self.law, self.limit, self.support = controller, limit, support

    def __call__(self, sense: Sense) -> Command:
        torque, damping, _ = self.law(sense)
        if self.support is not None:
            torque = torque + self.support.gravity(sense.position)
        if not np.all(np.isfinite(torque)):
            raise Undefined(f"it gave {torque}, and a torque is finite numbers [N m]")
        return Command(np.minimum(np.maximum(torque, -self.limit), self.limit), damping)


class HoldingDrive:
    """Where a holding law wants its arm along the line of contact, [m].

    limit: largest change of the reference in one call [m]. ``reference`` is that of the last call.
    """

    def __init__(self, law: HoldingLaw, limit: float = math.inf) -> None:
        self.law: HoldingLaw = check(law, "holding")
        self._limit = limit
        self.reset(0.0, 0.0)

    def reset(self, time: float, position: float, force: float = 0.0) -> None:
        """Start anew at a displacement [m] along the line."""
        self.reference, self._before = position, (time, position)
        self.law.reset(Measured(time, position, 0.0, force))

    def __call__(self, time: float, position: float, force: float) -> float:
        """Reference [m] from the arm's displacement [m] and the force in compression [N]; its rate is differenced."""
        since, last = self._before
        rate = (position - last) / (time - since) if time > since else 0.0
        self._before = time, position
        wanted = number(self.law(Measured(time, position, rate, force)))
        limit = self._limit
        self.reference = wanted if limit == math.inf else self.reference + clip(wanted - self.reference, limit)
        return self.reference


def clip(value: float, limit: float) -> float:
    """The number nearest to a value within +- limit."""
    return min(limit, max(-limit, value))
