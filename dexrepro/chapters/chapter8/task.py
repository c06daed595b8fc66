"""What the experiments of this chapter share: an arm under a tracking law, and the motion it follows."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.control.contract import Measured
from dexrepro.control.impedance_learning import InteractionLaw
from dexrepro.control.motion import Motion, Path
from dexrepro.physics.drive import EndPointDrive
from dexrepro.robots.arm import Arm
from dexrepro.robots.planar import planar


def two_link(arm: Any) -> Arm:
    """The arm of Table 8.1; ``inertia_about`` says whether the printed inertia is about the "centre" or the "joint"."""
    inertias = arm.inertias
    if arm.inertia_about == "joint":
        inertias = [i - m * c**2 for i, m, c in zip(arm.inertias, arm.masses, arm.centres)]
    return planar(arm.lengths, arm.masses, inertias, centres=arm.centres)


def circle(settings: Any) -> Path:
    """The desired path of Eq. (8.46) as a function of time [s], from an angle ``phase`` [rad] on."""
    (cx, cy), radius, rate, phase = settings.centre, settings.radius, settings.rate, settings.phase

    def motion(time: float) -> Motion[Array]:
        angle = phase + rate * time
        c, s = radius * math.cos(angle), radius * math.sin(angle)
        return Motion(
            np.array((cx - c, cy + s)), np.array((rate * s, rate * c)), np.array((rate**2 * c, -(rate**2) * s))
        )

    return motion


def displaced(interaction: InteractionLaw, axis: int) -> Callable[[Measured[Array], Motion[Array]], Motion[Array]]:
    """Lets the interaction law move one axis of a path by what is measured along it."""

    def moved(measured: Measured[Array], path: Motion[Array]) -> Motion[Array]:
        position, velocity, force = (float(part[axis]) for part in measured[1:4])
        told = Measured(measured.time, position, velocity, force)
        virtual = interaction(told, Motion(*(float(part[axis]) for part in path)))
        motion = Motion(*(part.copy() for part in path))
        for part, value in zip(motion, virtual):
            part[axis] = value
        return motion

    return moved


def beyond(drive: EndPointDrive, bound: Any) -> Callable[[float], str | None]:
    """Stop condition: the error has reached its bound [m] on some axis."""
    bounds = [float(value) for value in bound]

    def stop(time: float) -> str | None:
        for axis, (error, limit) in enumerate(zip(drive.error.tolist(), bounds)):
            if not abs(error) < limit:
                return f"error bound of axis {'xyz'[axis]} violated at {time:.4g} s"
        return None

    return stop
