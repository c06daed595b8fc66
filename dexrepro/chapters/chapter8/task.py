"""What the experiments of this chapter share: an arm under a tracking law, and the motion it follows."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dexrepro.control.impedance_learning import InteractionLaw, Reference
from dexrepro.control.task_space import ArmState, Motion, TrackingLaw
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.robots.arm import Arm
from dexrepro.robots.planar import planar

Array = NDArray[np.float64]


def two_link(arm: Any) -> Arm:
    """The arm of Table 8.1; ``inertia_about`` says whether the printed inertia is about the "centre" or the "joint"."""
    inertias = arm.inertias
    if arm.inertia_about == "joint":
        inertias = [i - m * c**2 for i, m, c in zip(arm.inertias, arm.masses, arm.centres)]
    return planar(arm.lengths, arm.masses, inertias, centres=arm.centres)


def circle(settings: Any) -> Callable[[float], Motion]:
    """The desired path of Eq. (8.46) as a function of time [s], from an angle ``phase`` [rad] on."""
    (cx, cy), radius, rate, phase = settings.centre, settings.radius, settings.rate, settings.phase

    def motion(time: float) -> Motion:
        angle = phase + rate * time
        c, s = radius * math.cos(angle), radius * math.sin(angle)
        return Motion(
            np.array((cx - c, cy + s)), np.array((rate * s, rate * c)), np.array((rate**2 * c, -(rate**2) * s))
        )

    return motion


class TaskController:
    """A tracking law on an arm: measures, lets the interaction law move one axis of the reference, returns torques.

    law: gives the force at the end point; desired: the motion of d axes over time [s]; model: the arm's kinematics.
    interaction: acts on the axis ``axis``. Everything probes and stop conditions ask for is an attribute.
    """

    def __init__(
        self,
        law: TrackingLaw,
        desired: Callable[[float], Motion],
        model: RigidBodyModel,
        interaction: InteractionLaw | None = None,
        axis: int = 0,
    ) -> None:
        self.law, self.desired, self.model = law, desired, model
        self.interaction, self.axis = interaction, axis
        self.path = self.reference = desired(0.0)
        self.axes = len(self.path.position)
        self.error = np.zeros(self.axes)

    def __call__(self, sense: Sense) -> Array:
        """Joint torques [N m]."""
        return self.jacobian(sense.position).T @ self.force(sense)

    def jacobian(self, position: Array) -> Array:
        """Rows of the task's axes, shape (d, n)."""
        return self.model.jacobian(position)[: self.axes]

    def force(self, sense: Sense) -> Array:
        """Force at the end point [N], shape (d,)."""
        axes = self.axes
        arm = ArmState(sense.position, sense.velocity, sense.tip[:axes], sense.tip_velocity[:axes])
        force = sense.force[:axes]
        self.path = self.reference = self.desired(sense.time)
        if self.interaction is not None:
            self.reference = self._displaced(self.interaction, arm.position, force)
        self.error = arm.position - self.reference.position
        return self.law(arm, self.reference, force)

    def _displaced(self, interaction: InteractionLaw, position: Array, force: Array) -> Motion:
        axis = self.axis
        desired = Reference(*(float(part[axis]) for part in self.path))
        displaced = interaction(desired, float(position[axis]), float(force[axis]))
        motion = Motion(*(part.copy() for part in self.path))
        for part, value in zip(motion, displaced):
            part[axis] = value
        return motion


def beyond(controller: TaskController, bound: Any) -> Callable[[float], str | None]:
    """Stop condition: the error has reached its bound [m] on some axis."""
    bounds = [float(value) for value in bound]

    def stop(time: float) -> str | None:
        for axis, (error, limit) in enumerate(zip(controller.error.tolist(), bounds)):
            if not abs(error) < limit:
                return f"error bound of axis {'xyz'[axis]} violated at {time:.4g} s"
        return None

    return stop
