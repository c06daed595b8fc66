"""What moves in a World while it runs: arms and rigid bodies, each a place where forces can act.

Every one offers x, y, z [m], vx, vy, vz [m/s] (of an arm: its end point; of a body: its centre of mass), all in the
world frame, and ``push(fx, fy, fz)`` [N]. Plain floats: at 1 kHz small arrays cost more than the physics.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from operator import add
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgesv

from dexrepro.arrays import Array
from dexrepro.control.contract import Command, Undefined, Unusable
from dexrepro.physics.sensor import ForceChannel, JointChannel, Sensor
from dexrepro.robots.arm import Arm
from dexrepro.robots.kinematics import forward, jacobian
from dexrepro.robots.planar import PlanarTip

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class Point:
    """A place fixed in the world."""

    x = y = z = vx = vy = vz = 0.0

    def __init__(self, position: tuple[float, float, float]) -> None:
        self.x, self.y, self.z = map(float, position)

    def push(self, fx: float, fy: float, fz: float) -> None:
        """The world does not move."""


class RigidBody(Point, ABC):
    """A box, sphere or compound of one engine; static if its mass is 0. ``body`` is its number in the scene."""

    orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)
    spin: Vector = (0.0, 0.0, 0.0)

    def __init__(self, body: int, mass: float) -> None:
        super().__init__((0.0, 0.0, 0.0))
        self.body, self.mass = body, mass
        self.read()

    @abstractmethod
    def read(self) -> None:
        """Take pose and velocity from the engine."""

    @abstractmethod
    def place(self, position: Sequence[float], orientation: Sequence[float] | None = None) -> None:
        """Put the body somewhere else [m], its orientation (x, y, z, w) kept where none is given, at rest."""

    def push(self, fx: float, fy: float, fz: float) -> None:
        """Add a force [N], world frame, at the centre of mass."""
        self.push_at((fx, fy, fz), (self.x, self.y, self.z))

    @abstractmethod
    def push_at(self, force: Vector, place: Vector) -> None:
        """Add a force [N] at a place [m], both in the world frame."""


class Sense:
    """What one arm may know at an instant; nothing of its partner.

    time [s]; position, velocity: joint angles and rates as measured, shape (n,) [rad, rad/s]; force: the force on its
    end point as its sensor reports it, shape (3,), world frame [N]. The arrays are new at every access; ``angles``,
    ``rates`` and ``felt`` are the same as plain floats, for laws quicker without arrays.
    """

    __slots__ = ("_plant", "angles", "felt", "rates", "time")

    def __init__(self, plant: SimulatedArm) -> None:
        self._plant = plant
        self.time = 0.0
        self.angles: Sequence[float] = (0.0,) * plant.dof
        self.rates: Sequence[float] = (0.0,) * plant.dof
        self.felt: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def position(self) -> Array:
        """Measured joint angles (n,) [rad]."""
        return np.array(self.angles)

    @property
    def velocity(self) -> Array:
        """Measured joint rates (n,) [rad/s]."""
        return np.array(self.rates)

    @property
    def force(self) -> Array:
        """Force on the end point as the sensor reports it, (3,), world frame [N]."""
        return np.array(self.felt)

    @property
    def tip(self) -> Array:
        """End point, shape (3,), world frame [m], from the measured joint angles."""
        plant = self._plant
        if plant.joint_channel is None:
            plant.locate()
            return np.array((plant.x, plant.y, plant.z))
        return forward(plant.arm, self.position)[0]

    @property
    def tip_velocity(self) -> Array:
        """Velocity of the end point, shape (3,), world frame [m/s], from the measured joint angles and rates."""
        plant = self._plant
        if plant.joint_channel is None:
            plant.locate()
            return np.array((plant.vx, plant.vy, plant.vz))
        return jacobian(plant.arm, self.position)[:3] @ self.velocity


Torque = Sequence[float] | Array
Answer = Torque | tuple[Torque, Torque] | Command
Reply = Answer | Callable[[Sense], Answer]
Controller = Callable[[Sense], Reply]
"""What drives an arm: joint torques, a tuple (torque, damping), or an inner loop; see ``World.run``."""


class SimulatedArm(Point, ABC):
    """One arm in a World: its state, the forces on its end point and the torque it gets this step.

    An engine gives it its state and takes its torque and forces; ``body`` is its number in the scene.
    """

    def __init__(
        self, body: int, name: str, arm: Arm, position: Array, sensor: Sensor, rng: np.random.Generator | None
    ) -> None:
        super().__init__((0.0, 0.0, 0.0))
        self.body, self.name, self.arm, self.dof = body, name, arm, arm.dof
        self.links = [link.name for link in arm.links] + [link.name for _, link in arm.bodies]
        self.feels_contact = False
        self._indices = list(range(arm.dof))
        self._zeros = [0.0] * arm.dof
        self.limits: list[float] | None = arm.effort.tolist() if np.isfinite(arm.effort).any() else None
        self._sensor, self._rng = sensor, rng
        self.force_channel: ForceChannel | None = None
        self.joint_channel: JointChannel | None = None
        self._planar = PlanarTip(arm) if arm.is_planar else None
        self._levers: list[tuple[float, float]] = []
        self.z = self._planar.height if self._planar else 0.0
        self.load = self._zeros
        self.q: tuple[float, ...] = ()
        self.dq: tuple[float, ...] = ()
        self.torque: Sequence[float] = self._zeros
        self.fx = self.fy = self.fz = 0.0
        self._located = False
        self.burdened = False  # whether anything may act on it that neither ``load`` nor its force sensor tells
        self._before: tuple[Array, Array, Array] | None = None
        self.reset(position)
        self.sense = Sense(self)

    @abstractmethod
    def _state(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Joint angles and rates of the engine."""

    @abstractmethod
    def _put(self, angles: list[float], rates: list[float]) -> None:
        """Give the engine joint angles and rates."""

    @abstractmethod
    def _give(self, torque: Sequence[float]) -> None:
        """Hand the joint torques of the coming step to the engine."""

    @abstractmethod
    def _end(self) -> tuple[float, float, float, float, float, float]:
        """Position [m] and velocity [m/s] of the end point of a spatial arm, world frame."""

    @abstractmethod
    def _push(self, force: Vector) -> None:
        """Add a force [N] on the end point of a spatial arm for the coming step."""

    @abstractmethod
    def _dynamics(self) -> tuple[Array, Array]:
        """Mass matrix (n, n) and bias torque (n,) at the state last read; the arrays are the caller's."""

    @abstractmethod
    def _felt_torque(self) -> Array:
        """Joint torques J^T F (n,) [N m] of the force on the end point of a spatial arm, at the state last read."""

    @abstractmethod
    def touches(self) -> list[Touch]:
        """Contact points as of the last step."""

    @abstractmethod
    def push_link(self, link: str, point: Vector, force: Vector) -> None:
        """Add a force [N], world frame, at a point of a link frame [m]."""

    @abstractmethod
    def set_mass(self, link: str, mass: float) -> None:
        """Change the mass [kg] of one body; its moments of inertia are kept, or by PyBullet those of its shapes."""

    def reset(self, position: Array, velocity: Array | None = None) -> None:
        """Put the joints at given angles [rad] and rates [rad/s] (at rest by default)."""
        rates = self._zeros if velocity is None else np.asarray(velocity, dtype=float).tolist()
        self._put(np.asarray(position, dtype=float).tolist(), rates)
        self._before = None
        self.read()

    def prepare(self, period: float) -> None:
        """Set up the sensors for a run with a control period [s], and let go of any torque of a run before."""
        self.torque, self._before = self._zeros, None
        sensor = self._sensor
        self.force_channel = None if sensor.exact_force else ForceChannel(sensor, period, self._rng)
        self.joint_channel = None if sensor.exact_joints else JointChannel(sensor, period, self._rng)

    def read(self) -> None:
        """Take the joint state from the engine and forget last step's forces."""
        self.q, self.dq = self._state()
        self._located = False
        self.fx = self.fy = self.fz = 0.0
        self.load = self._zeros
        if self.feels_contact:
            self._feel()

    def locate(self) -> None:
        """Compute position and velocity of the end point for the joint state last read."""
        if self._located:
            return
        self._located = True
        if self._planar is not None:
            self._levers = levers = self._planar.levers(self.q)
            self.x, self.y = self._planar.base[0] + levers[0][0], self._planar.base[1] + levers[0][1]
            vx = vy = 0.0
            for rate, (x, y) in zip(self.dq, levers):
                vx -= rate * y
                vy += rate * x
            self.vx, self.vy = vx, vy
            return
        self.x, self.y, self.z, self.vx, self.vy, self.vz = self._end()

    def push(self, fx: float, fy: float, fz: float) -> None:
        """Add a force on the end point [N], felt by the arm's force sensor."""
        self.fx += fx
        self.fy += fy
        self.fz += fz
        self._pull(fx, fy, fz)

    def add_load(self, torque: Sequence[float] | Array) -> None:
        """Add joint torques [N m] that are not the controller's (friction, drag)."""
        self.load = [a + float(b) for a, b in zip(self.load, torque, strict=True)]

    def observe(self, time: float, sample: bool) -> Sense:
        """What the controller sees at a time [s]; imperfect sensors have news at control instants (``sample``)."""
        sense = self.sense
        sense.time = time
        if self.joint_channel is None:
            sense.angles, sense.rates = self.q, self.dq
        elif sample:
            position, velocity = self.joint_channel(np.array(self.q), np.array(self.dq))
            sense.angles, sense.rates = position.tolist(), velocity.tolist()
        if self.force_channel is None:
            sense.felt = self.fx, self.fy, self.fz
        elif sample:
            sense.felt = self.force_channel((self.fx, self.fy, self.fz))
        return sense

    def command(self, torque: Torque, damping: Torque | None, step: float) -> None:
        """Set this step's joint torque [N m], with damping [N m s/rad] applied implicitly, within the effort limits.

        Raises Unusable.
        """
        if damping is not None:
            torque = self._damped(np.asarray(torque, dtype=float), damping, step)
        elif self.burdened:
            self._before = None
        torque = torque.tolist() if isinstance(torque, np.ndarray) else torque
        try:  # a sum is cheap and is not finite if any of its terms is not
            finite, right = -np.inf < sum(torque) < np.inf, len(torque) == self.dof
        except TypeError:
            finite = right = False
        if not (finite and right):
            self.torque = torque if right else self._zeros
            kind = Undefined if right else Unusable
            raise kind(f"it gave {str(torque)[:80]}, and a torque is {self.dof} finite numbers [N m]")
        if self.limits is not None:
            torque = [-top if t < -top else top if t > top else t for t, top in zip(torque, self.limits)]
        self.torque = torque

    def apply(self) -> None:
        """Hand torque and other joint loads to the engine for the coming step."""
        total = self.torque
        if self.load is not self._zeros:
            total = list(map(add, total, self.load))
        self._give(total)

    def _damped(self, torque: Array, damping: Torque, step: float) -> Array:
        """Torque minus damping times the velocity at the END of the step.

        From M dq+ = M dq + h (torque + load - bias - D dq+) follows the acceleration a of (M + h D) a = torque + load
        - bias - D dq, and the torque to apply is torque - D (dq + h a). D is a vector (diagonal) or a matrix. What else
        acts on a burdened arm is taken to be what it was in the step before, M dq+ - M dq - h (...) of that step.
        """
        damping = np.asarray(damping, dtype=float)
        brake = damping.__mul__ if damping.ndim == 1 else damping.dot
        rate = np.array(self.dq)
        mass, bias = self._dynamics()
        rest = torque - bias - brake(rate) if self.load is self._zeros else torque + self.load - bias - brake(rate)
        if self._planar is None and (self.fx or self.fy or self.fz):
            rest += self._felt_torque()
        if self.burdened:
            told, before = rest + brake(rate) - torque, self._before
            self._before = mass.copy(), told, rate
            if before is not None:  # ``torque`` of the arm is still that of the step before
                rest += before[0].dot(rate - before[2]) / step - before[1] - self.torque
        if damping.ndim == 1:
            mass.reshape(-1)[:: self.dof + 1] += step * damping
        else:
            mass += step * damping
        _, _, acceleration, singular = dgesv(mass, rest)  # np.linalg.solve takes four times as long
        if singular:
            raise np.linalg.LinAlgError("the mass matrix with its damping is singular")
        return torque - brake(rate + step * acceleration)

    def push_unsensed(self, fx: float, fy: float, fz: float) -> None:
        """Add a force on the end point [N] that the force sensor does not see."""
        self.burdened = self.burdened or self._planar is None
        self._pull(fx, fy, fz)

    def _pull(self, fx: float, fy: float, fz: float) -> None:
        if not self._located:
            self.locate()
        if self._planar is not None:
            self.load = [load + x * fy - y * fx for load, (x, y) in zip(self.load, self._levers)]
        else:
            self._push((fx, fy, fz))

    def _feel(self) -> None:
        """Add last step's contact forces on the last moving link and what it carries to the sensed force."""
        for touch in self.touches():
            self.burdened = True
            if touch.link >= self.dof - 1:
                x, y, z = touch.force
                self.fx, self.fy, self.fz = self.fx + x, self.fy + y, self.fz + z


class Touch(NamedTuple):
    """A contact point of a body: its own link, the other body, place [m], normal force [N] and whole force (3,) [N]
    on the body, friction included, world frame."""

    link: int
    other: int
    position: tuple[float, float, float]
    normal_force: float
    force: tuple[float, float, float]
