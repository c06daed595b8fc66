"""What moves in a World while it runs: arms and rigid bodies, each a place where forces can act.

Every one offers x, y, z [m], vx, vy, vz [m/s] (of an arm: its end point; of a body: its centre of mass), all in the
world frame, and ``push(fx, fy, fz)`` [N]. Plain floats: at 1 kHz small arrays cost more than the physics.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Sequence
from operator import add
from typing import NamedTuple

import numpy as np
import pybullet as bullet
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Array
from dexrepro.control.contract import Command, Undefined, Unusable
from dexrepro.physics.loading import connect, disconnect, lighter, load_arm
from dexrepro.physics.sensor import ForceChannel, JointChannel, Sensor
from dexrepro.robots.arm import Arm
from dexrepro.robots.kinematics import forward, jacobian
from dexrepro.robots.planar import PlanarTip
from dexrepro.robots.rotations import rotated


class Point:
    """A place fixed in the world."""

    x = y = z = vx = vy = vz = 0.0

    def __init__(self, position: tuple[float, float, float]) -> None:
        self.x, self.y, self.z = map(float, position)

    def push(self, fx: float, fy: float, fz: float) -> None:
        """The world does not move."""


class RigidBody(Point):
    """A box, sphere or compound; static if its mass is 0."""

    def __init__(self, client: int, body: int, mass: float) -> None:
        super().__init__((0.0, 0.0, 0.0))
        self.client, self.body, self.mass = client, body, mass
        self.orientation = (0.0, 0.0, 0.0, 1.0)
        self.spin = (0.0, 0.0, 0.0)
        self.read()

    def read(self) -> None:
        """Take pose and velocity from the engine."""
        (self.x, self.y, self.z), self.orientation = bullet.getBasePositionAndOrientation(
            self.body, physicsClientId=self.client
        )
        (self.vx, self.vy, self.vz), self.spin = bullet.getBaseVelocity(self.body, physicsClientId=self.client)

    def place(self, position: tuple[float, float, float]) -> None:
        """Put the body somewhere else [m], its orientation kept."""
        self.x, self.y, self.z = position
        bullet.resetBasePositionAndOrientation(self.body, position, self.orientation, physicsClientId=self.client)

    def push(self, fx: float, fy: float, fz: float) -> None:
        """Add a force [N], world frame, at the centre of mass."""
        bullet.applyExternalForce(
            self.body, -1, (fx, fy, fz), (self.x, self.y, self.z), bullet.WORLD_FRAME, physicsClientId=self.client
        )


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


class SimulatedArm(Point):
    """One arm in a World: its state, the forces on its end point and the torque it gets this step."""

    def __init__(
        self,
        client: int,
        name: str,
        arm: Arm,
        position: Array,
        sensor: Sensor,
        rng: np.random.Generator | None,
        meshes: bool = False,
    ) -> None:
        super().__init__((0.0, 0.0, 0.0))
        self.client, self.name, self.arm, self.dof = client, name, arm, arm.dof
        self.body = load_arm(client, arm, meshes)
        self._dynamics = client, self.body, lighter(arm)
        if self._dynamics[2] < 1:
            self._dynamics = _twin(client, arm)
            weakref.finalize(self, disconnect, self._dynamics[0])
        self.links = [link.name for link in arm.links] + [link.name for _, link in arm.bodies]
        self.feels_contact = False
        self._indices = list(range(arm.dof))
        self._zeros = [0.0] * arm.dof
        self.limits: list[float] | None = arm.effort.tolist() if np.isfinite(arm.effort).any() else None
        self._sensor, self._rng = sensor, rng
        self.force_channel: ForceChannel | None = None
        self.joint_channel: JointChannel | None = None
        self.end = EndPoint(client, self.body, arm)
        self._planar = PlanarTip(arm) if arm.is_planar else None
        self._levers: list[tuple[float, float]] = []
        self.z = self._planar.height if self._planar else 0.0
        self.load = self._zeros
        self.q: tuple[float, ...] = ()
        self.dq: tuple[float, ...] = ()
        self.torque: Sequence[float] = self._zeros
        self.fx = self.fy = self.fz = 0.0
        self._located = False
        self.reset(position)
        self.sense = Sense(self)

    def reset(self, position: Array, velocity: Array | None = None) -> None:
        """Put the joints at given angles [rad] and rates [rad/s] (at rest by default)."""
        rates = self._zeros if velocity is None else np.asarray(velocity, dtype=float).tolist()
        for index, angle, rate in zip(self._indices, np.asarray(position, dtype=float).tolist(), rates, strict=True):
            bullet.resetJointState(self.body, index, angle, rate, physicsClientId=self.client)
        self.read()

    def prepare(self, period: float) -> None:
        """Set up the sensors for a run with a control period [s], and let go of any torque of a run before."""
        self.torque = self._zeros
        sensor = self._sensor
        self.force_channel = None if sensor.exact_force else ForceChannel(sensor, period, self._rng)
        self.joint_channel = None if sensor.exact_joints else JointChannel(sensor, period, self._rng)

    def read(self) -> None:
        """Take the joint state from the engine and forget last step's forces."""
        states = bullet.getJointStates(self.body, self._indices, physicsClientId=self.client)
        self.q, self.dq, _, _ = zip(*states)
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
        state = bullet.getLinkState(self.body, self.end.link, 1, 1, physicsClientId=self.client)
        (cx, cy, cz), (rx, ry, rz) = state[0], rotated(state[1], self.end.from_com)
        (ux, uy, uz), (ox, oy, oz) = state[6], state[7]
        self.x, self.y, self.z = cx + rx, cy + ry, cz + rz
        self.vx, self.vy, self.vz = ux + oy * rz - oz * ry, uy + oz * rx - ox * rz, uz + ox * ry - oy * rx

    def push(self, fx: float, fy: float, fz: float) -> None:
        """Add a force on the end point [N], felt by the arm's force sensor."""
        self.fx += fx
        self.fy += fy
        self.fz += fz
        self.push_unsensed(fx, fy, fz)

    def push_link(self, link: str, point: tuple[float, float, float], force: tuple[float, float, float]) -> None:
        """Add a force [N], world frame, at a point of a link frame [m]."""
        index = self.links.index(link)
        state = bullet.getLinkState(self.body, index, 0, 1, physicsClientId=self.client)
        place = [a + b for a, b in zip(state[4], rotated(state[5], point), strict=True)]
        bullet.applyExternalForce(self.body, index, force, place, bullet.WORLD_FRAME, physicsClientId=self.client)

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
        bullet.setJointMotorControlArray(
            self.body, self._indices, bullet.TORQUE_CONTROL, forces=total, physicsClientId=self.client
        )

    def _damped(self, torque: Array, damping: Torque, step: float) -> Array:
        """Torque minus damping times the velocity at the END of the step.

        From M dq+ = M dq + h (torque + load - bias - D dq+) follows the acceleration a of (M + h D) a = torque + load
        - bias - D dq, and the torque to apply is torque - D (dq + h a). D is a vector (diagonal) or a matrix.
        """
        client, body, factor = self._dynamics
        damping = np.asarray(damping, dtype=float)
        multiply = np.multiply if damping.ndim == 1 else np.matmul
        rate = np.array(self.dq)
        mass = np.array(bullet.calculateMassMatrix(body, self.q, physicsClientId=client)) / factor
        bias = np.array(bullet.calculateInverseDynamics(body, self.q, self.dq, self._zeros, physicsClientId=client))
        bias /= factor
        rest = torque + self.load - bias - multiply(damping, rate)
        if self._planar is None and (self.fx or self.fy or self.fz):
            linear, _ = bullet.calculateJacobian(
                body, self.end.link, self.end.for_jacobian, self.q, self.dq, self._zeros, physicsClientId=client
            )
            rest += np.array((self.fx, self.fy, self.fz)) @ np.array(linear)
        if damping.ndim == 1:
            mass.flat[:: self.dof + 1] += step * damping
        else:
            mass += step * damping
        return torque - multiply(damping, rate + step * np.linalg.solve(mass, rest))

    def push_unsensed(self, fx: float, fy: float, fz: float) -> None:
        """Add a force on the end point [N] that the force sensor does not see."""
        if not self._located:
            self.locate()
        if self._planar is not None:
            self.load = [load + x * fy - y * fx for load, (x, y) in zip(self.load, self._levers)]
        else:
            bullet.applyExternalForce(
                self.body, self.end.link, (fx, fy, fz), (self.x, self.y, self.z), bullet.WORLD_FRAME,
                physicsClientId=self.client,
            )  # fmt: skip

    def _feel(self) -> None:
        """Add last step's contact forces on the last moving link and what it carries to the sensed force."""
        touching = [touch for touch in touches(self.client, self.body) if touch.link >= self.dof - 1]
        self.fx += sum(touch.force[0] for touch in touching)
        self.fy += sum(touch.force[1] for touch in touching)
        self.fz += sum(touch.force[2] for touch in touching)


class Touch(NamedTuple):
    """A contact point of a body: its own link, the other body, place [m], normal force [N] and whole force (3,) [N]
    on the body, friction included, world frame."""

    link: int
    other: int
    position: tuple[float, float, float]
    normal_force: float
    force: tuple[float, float, float]


def touches(client: int, body: int) -> list[Touch]:
    """Contact points of a body as of the last step.

    The engine is asked for all of its points: when it is asked for one body's, it turns the normal but not the
    directions of friction where that body is the second of a pair.
    """
    result = []
    for point in bullet.getContactPoints(physicsClientId=client):
        if body not in point[1:3]:
            continue
        first = point[1] == body
        sign = 1.0 if first else -1.0
        parts = ((point[9], point[7]), (point[10], point[11]), (point[12], point[13]))
        x, y, z = (sign * sum(size * direction[i] for size, direction in parts) for i in range(3))
        link, other = (point[3], point[2]) if first else (point[4], point[1])
        result.append(Touch(link, other, point[6], point[9], (x, y, z)))
    return result


class EndPoint:
    """Where an arm's end point is on the body that carries it, in the frames the engine asks for.

    link: the engine's index of that body; from_com: place [m] from the centre of mass, along the principal axes;
    for_jacobian: place [m] from the link's origin, along the principal axes, as calculateJacobian takes it; rotation:
    of the end point's frame relative to the principal axes. (The engine's link frame itself is of single precision.)
    """

    def __init__(self, client: int, body: int, arm: Arm) -> None:
        poses = [pose.matrix for pose, _ in arm.bodies]
        self.link = arm.dof - 1 + len(poses)
        local = arm.tip
        for pose in poses:
            local = np.linalg.inv(pose) @ local
        info = bullet.getDynamicsInfo(body, self.link, physicsClientId=client)
        axes = Rotation.from_quat(info[4]).as_matrix()
        self.rotation = axes.T @ local[:3, :3]
        self.from_com: tuple[float, ...] = tuple((axes.T @ (local[:3, 3] - info[3])).tolist())
        self.for_jacobian: tuple[float, ...] = tuple((axes.T @ local[:3, 3]).tolist())


def _twin(client: int, arm: Arm) -> tuple[int, int, float]:
    """A client of its own, under the same gravity, with an arm light enough for inverse dynamics, and its factor."""
    parameters, factor = bullet.getPhysicsEngineParameters(physicsClientId=client), lighter(arm)
    twin = connect()
    bullet.setGravity(*(parameters[f"gravityAcceleration{axis}"] for axis in "XYZ"), physicsClientId=twin)
    return twin, load_arm(twin, arm.scaled(factor)), factor
