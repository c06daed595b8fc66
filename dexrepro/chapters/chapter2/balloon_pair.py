"""The two arms of a simulated Baxter with a balloon between their grippers (Sect. 2.4.2): scene, controllers, run."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from dexrepro.arrays import Array, Rng
from dexrepro.control.holding_line import HoldingLineRegulation
from dexrepro.errors import InputError
from dexrepro.experiment import Config, Recording
from dexrepro.physics.drive import HoldingDrive
from dexrepro.physics.elements import Elastic
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.physics.rendering import Camera
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.servo import JointServo
from dexrepro.physics.world import World
from dexrepro.robots.arm import Arm
from dexrepro.robots.baxter import baxter, torso
from dexrepro.robots.inverse_kinematics import InverseKinematics, Unreachable, solve

# The grippers face each other along y: columns are the gripper's axes in the torso frame.
FACING = {
    "right": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
    "left": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]]),
}
RECORD_EVERY = 5  # steps
BALLOON = (0.95, 0.55, 0.15, 1.0)
VIEW = Camera(target=(0.42, 0.11, 0.2), distance=1.5, yaw=115.0, pitch=-15.0)
ROLES = {"leader": "right", "follower": "left"}


def start(config: Config, role: str) -> Array:
    """Where the gripper of a role starts, shape (3,) [m]; the follower's is off the leader's line in x and z."""
    place = np.array(config[role].start, dtype=float)
    if role == "follower":
        place[[0, 2]] += config.discrepancy
    return place


def scene(config: Config, rng: Rng | None = None) -> World:
    """Both arms, each with a force sensor at its gripper, and a massless balloon that pushes them apart."""
    world = World(step=config.step, perturbation=config.perturbation)
    world.add_body("torso", torso(), (0, 0, 0), collides=False)
    sensor = Sensor(force_noise=config.sensor.noise, force_cutoff=config.sensor.cutoff)
    for role, side in ROLES.items():
        arm = config[role].get("arm") or baxter(side)
        posture = ready(arm, start(config, role), FACING[side], config[role].posture)
        noise = rng(f"{role} sensor") if rng else np.random.default_rng(0)
        world.add_arm(role, arm, posture, sensor=sensor, rng=noise)
    between = ("follower", "leader")
    world.add(Elastic("object", between, config.stiffness, config.rest_length, unilateral=True))
    return world


def ready(arm: Arm, place: Array, facing: Array, posture: list[float]) -> Array:
    """Joint angles (n,) [rad] with the gripper at a place (3,) [m] and turned as the task asks.

    Raises InputError where an arm of the user's cannot do that.
    """
    if not isinstance(arm, Arm):
        raise InputError("follower_arm is no arm: name one by its _target_, such as dexrepro.robots.urdf.from_urdf")
    try:
        return solve(arm, place, facing, start=posture if len(posture) == arm.dof else None, task="pose")
    except Unreachable as error:
        where = ", ".join(f"{value:.3g}" for value in place)
        raise InputError(f"follower_arm does not reach ({where}) m from where its base= puts it: {error}") from error


def stage(world: World, recording: Recording, config: Config) -> Recording:
    """Shows the balloon: on the leader's gripper until it is held, then between the two."""
    leader, way = recording["leader.tip"], recording["follower.tip"] - recording["leader.tip"]
    length = np.linalg.norm(way, axis=1, keepdims=True)
    centre = leader + way / length * np.minimum(length, config.rest_length) / 2
    world.add_sphere("balloon", config.rest_length / 2 - 0.03, centre[0], colour=BALLOON, collides=False)
    recording.series |= {"balloon.pose": centre}
    return recording


def run(config: Config, rng: Rng, path: Callable[[float], Array]) -> Recording:
    """Approach, then hold for the configured duration; time counts from the contact that triggers the law.

    path: displacement (3,) [m] of the leader's gripper at the time [s] since then; the operator sees the contact.
    Besides the World's channels, records the follower's ``reference`` (3,) [m].
    """
    with scene(config, rng) as world:
        follower = Follower(config, world.arm("follower").arm)
        leader = Leader(config, world.arm("leader").arm, path, lambda now: follower.since_contact(now))

        balloon: Any = world.elements[0]
        guard, duration = config.guard, config.duration

        def stop(now: float) -> str | None:
            if balloon.force > guard:
                return f"diverged at {now:.4g} s: the force is {balloon.force:.4g} N"
            return "finished" if now - follower.contact_time >= duration else None

        recording = world.run(
            config.duration + config.longest_approach,
            {"leader": leader, "follower": follower},
            probes={"reference": lambda: follower.reference},
            stop=stop,
            record_every=RECORD_EVERY,
            on_divergence="stop",
        )
    recording.series["time"] -= follower.contact_time if math.isfinite(follower.contact_time) else 0.0
    return recording


class GripperServo:
    """Keeps the gripper's orientation and takes it to a place: inverse kinematics before computed torque (exact model).

    Joint references are solved every 4 ms and torques every 2 ms, far faster than the joints' 30 rad/s.
    """

    def __init__(self, config: Config, arm: Arm, rotation: Array) -> None:
        servo = config.servo
        self._model, self._rotation, self._step = RigidBodyModel(arm), rotation, config.step
        self._inverse = InverseKinematics(
            arm, "pose", servo.ik_gain, 4 * config.step, servo.ik_damping, rest_gain=servo.rest_gain,
            kinematics=self._model,
        )  # fmt: skip
        self._servo = JointServo(self._model, servo.frequency)
        self._sample = 0
        self._torque = [0.0] * arm.dof

    @property
    def due(self) -> bool:
        """Whether the next call looks at its target."""
        return self._sample % 4 == 0

    def __call__(self, sense: Sense, target: Array) -> list[float]:
        """Torque (7,) [N m] towards a place (3,) [m], the measured contact force compensated."""
        inverse = self._inverse
        if self._sample == 0:
            inverse.reset(sense.position)
            inverse.rest = sense.position
        if self.due:
            before = inverse.position
            inverse(target, self._rotation)
            # A torque acts for two steps: it is that of the reference in their middle.
            self._servo.refer(sense.time - self._step, before, inverse.velocity)
        if self._sample % 2 == 0:
            self._torque = (self._servo(sense) - self._model.tip_torque(sense.position, sense.felt)).tolist()
        self._sample += 1
        return self._torque


class Leader:
    """The directly teleoperated follower, Eq. (2.1): the hand's displacement, turned by R and scaled by s.

    The operator watches the gripper, so it is the gripper's ``path`` that is given and the hand's that follows from it.
    """

    def __init__(
        self, config: Config, arm: Arm, path: Callable[[float], Array], elapsed: Callable[[float], float]
    ) -> None:
        self._servo, self._home = GripperServo(config, arm, FACING["right"]), start(config, "leader")
        self._map = config.scale * np.array(config.rotation)
        self._hand = np.linalg.inv(self._map)
        self._path, self._elapsed = path, elapsed

    def __call__(self, sense: Sense) -> list[float]:
        if self._servo.due:
            hand = self._hand @ self._path(self._elapsed(sense.time))
            self._target = self._home + self._map @ hand
        return self._servo(sense, self._target)


class Follower:
    """The assistive follower: approaches until it feels contact, then holds; it sees its own state and force only.

    reference: the place asked of the gripper (3,) [m]. contact_time: instant of contact [s], infinite before it.
    """

    def __init__(self, config: Config, arm: Arm) -> None:
        self._servo, self.law = GripperServo(config, arm, FACING["left"]), HoldingDrive(config.law)
        self._approach, self._threshold = config.approach_speed * config.step, config.contact_force
        self._regulations = [HoldingLineRegulation(gain=config.regulation) for _ in "xz"]
        self.reference = self._home = start(config, "follower")
        self.contact_time = math.inf

    def since_contact(self, now: float) -> float:
        """Time [s] since contact, 0 before it."""
        return max(now - self.contact_time, 0.0)

    def __call__(self, sense: Sense) -> list[float]:
        fx, fy, fz = sense.felt
        if self.contact_time == math.inf:
            self.reference = self.reference - np.array((0.0, self._approach, 0.0))
            if math.sqrt(fx * fx + fy * fy + fz * fz) > self._threshold:
                self.contact_time = sense.time
                self._home[1] = sense.tip[1]
                self.law.reset(sense.time, 0.0)
        else:
            along = self.law(sense.time, sense.tip[1] - self._home[1], fy)
            (x, z), home = (law(force) for law, force in zip(self._regulations, (fx, fz))), self._home
            self.reference = np.array((home[0] + x, home[1] + along, home[2] + z))
        return self._servo(sense, self.reference)
