"""Forces of a scene: elastic objects, pushes and loads, evaluated at every physics step from time and state.

An element is bound to a World once and then called with the time [s]. An end is named by an arm (its end point), a
rigid body (its centre of mass) or given as a fixed point (x, y, z) [m].
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from dexrepro.arrays import Array
from dexrepro.physics.plant import Point, RigidBody, SimulatedArm

Place = str | Sequence[float]
Force = Sequence[float] | Array
Load = Callable[[float, list[float], list[float]], Force]


class Ends(Protocol):
    """Where elements look up what they act on."""

    bodies: dict[str, RigidBody]

    def end(self, place: Place) -> Point:
        """What a name or a fixed point (x, y, z) [m] stands for."""

    def arm(self, name: str) -> SimulatedArm:
        """The arm of a name. Raises KeyError where there is none."""


class Element(Protocol):
    """Anything that exerts forces; ``channels`` are recorded as ``<name>.<channel>``.

    One that is ``blind`` looks at joints alone, so that for its sake no end point need be located; may be absent.
    """

    name: str

    def bind(self, world: Ends) -> Callable[[float], None]:
        """Return the function of time [s] that applies the forces of one physics step."""

    def channels(self) -> dict[str, float]:
        """Numbers of the step last applied."""


class Elastic:
    """A massless elastic object held between two ends: a central spring along the line that joins them.

    f = k (L0 - L) - c dL/dt, positive in compression, along (x_a - x_b) / L on end a and the opposite on end b (the
    only form consistent with the regulation law, Eqs. (2.3)-(2.5)). ``stiffness`` k [N/m] is a number or a function
    of time [s]; ``rest_length`` L0 [m]; ``damping`` c [N s/m]. With ``unilateral`` it never pulls. ``law``(time,
    length, rate) -> f [N] replaces the spring law. Channels: force [N], length [m].
    """

    def __init__(
        self,
        name: str,
        between: tuple[Place, Place],
        stiffness: float | Callable[[float], float] = 0.0,
        rest_length: float = 0.0,
        damping: float = 0.0,
        unilateral: bool = False,
        law: Callable[[float, float, float], float] | None = None,
    ) -> None:
        self.name, self.between, self.unilateral = name, between, unilateral
        self.force, self.length = 0.0, math.nan
        self._law = law or self._spring(stiffness, rest_length, damping)

    @staticmethod
    def _spring(
        stiffness: float | Callable[[float], float], rest_length: float, damping: float
    ) -> Callable[[float, float, float], float]:
        if callable(stiffness):
            varying = stiffness
            return lambda time, length, rate: varying(time) * (rest_length - length) - damping * rate
        return lambda time, length, rate: stiffness * (rest_length - length) - damping * rate

    def bind(self, world: Ends) -> Callable[[float], None]:
        a, b = (world.end(place) for place in self.between)
        law, unilateral = self._law, self.unilateral

        def apply(time: float) -> None:
            x, y, z = a.x - b.x, a.y - b.y, a.z - b.z
            length = math.sqrt(x * x + y * y + z * z) or 1e-12
            x, y, z = x / length, y / length, z / length
            rate = (a.vx - b.vx) * x + (a.vy - b.vy) * y + (a.vz - b.vz) * z
            force = float(law(time, length, rate))
            if unilateral and force < 0.0:
                force = 0.0
            self.force, self.length = force, length
            if force:
                x, y, z = force * x, force * y, force * z
                a.push(x, y, z)
                b.push(-x, -y, -z)

        return apply

    def channels(self) -> dict[str, float]:
        return {"force": self.force, "length": self.length}


class TipForce:
    """A force on an arm's end point (or a body's centre) that depends on time and its state: a wall, a sponge, a field.

    ``law``(time, position (3,), velocity (3,)) -> force (3,), world frame [s, m, m/s, N]. An arm's force sensor
    feels it. Channels: x, y, z [N].
    """

    def __init__(
        self,
        name: str,
        on: str,
        law: Callable[[float, Array, Array], Force],
    ) -> None:
        self.name, self.on, self.law = name, on, law
        self.force = (0.0, 0.0, 0.0)

    def bind(self, world: Ends) -> Callable[[float], None]:
        end = world.end(self.on)

        def apply(time: float) -> None:
            position, velocity = np.array((end.x, end.y, end.z)), np.array((end.vx, end.vy, end.vz))
            x, y, z = self.law(time, position, velocity)
            self.force = float(x), float(y), float(z)
            if any(self.force):
                end.push(*self.force)

        return apply

    def channels(self) -> dict[str, float]:
        return dict(zip("xyz", self.force, strict=True))


class Push:
    """A push on an arm as a function of time: ``force``(time) -> (3,), world frame [N].

    It acts at ``point`` [m] in the frame of ``link``, or at the end point where no link is named; a wrist sensor
    does not feel it. Channels: x, y, z [N].
    """

    def __init__(
        self,
        arm: str,
        force: Callable[[float], Force],
        link: str | None = None,
        point: tuple[float, float, float] = (0.0, 0.0, 0.0),
        name: str = "push",
    ) -> None:
        self.name, self._arm, self._law, self._link, self._point = name, arm, force, link, point
        self.force = (0.0, 0.0, 0.0)

    def bind(self, world: Ends) -> Callable[[float], None]:
        arm = world.arm(self._arm)
        link, point = self._link, self._point

        def apply(time: float) -> None:
            x, y, z = self._law(time)
            self.force = float(x), float(y), float(z)
            if not any(self.force):
                return
            if link is None:
                arm.push_unsensed(*self.force)
            else:
                arm.burdened = True
                arm.push_link(link, point, self.force)

        return apply

    def channels(self) -> dict[str, float]:
        return dict(zip("xyz", self.force, strict=True))


class Carried:
    """A static body that is carried along a path: ``path``(time) -> position (x, y, z) [m]. Channels: x, y, z [m]."""

    def __init__(self, body: str, path: Callable[[float], Force]) -> None:
        self.name, self._path, self.position = body, path, (0.0, 0.0, 0.0)

    def bind(self, world: Ends) -> Callable[[float], None]:
        body, path = world.end(self.name), self._path
        if not isinstance(body, RigidBody) or body.mass > 0:
            raise ValueError(f"'{self.name}' is not a static body, so it cannot be carried")

        def apply(time: float) -> None:
            x, y, z = path(time)
            self.position = float(x), float(y), float(z)
            body.place(self.position)

        return apply

    def channels(self) -> dict[str, float]:
        return dict(zip("xyz", self.position, strict=True))


class JointLoad:
    """Joint torques of the plant itself, such as friction: ``law``(time, angles, rates) -> torque (n,) [N m].

    angles and rates are lists of n floats [rad, rad/s]; the law works on them at every physics step.
    """

    blind = True

    def __init__(self, arm: str, law: Load) -> None:
        self.name, self._arm, self._law = "load", arm, law

    def bind(self, world: Ends) -> Callable[[float], None]:
        arm, law = world.arm(self._arm), self._law
        return lambda time: arm.add_load(law(time, list(arm.q), list(arm.dq)))

    def channels(self) -> dict[str, float]:
        return {}


def joint_friction(viscous: float, coulomb: float, width: float = 0.05) -> Load:
    """Law of a JointLoad: -(viscous dq + coulomb tanh(dq / width)), in N m s/rad, N m and rad/s."""
    tanh = math.tanh
    return lambda _, __, rates: [-(viscous * rate + coulomb * tanh(rate / width)) for rate in rates]
