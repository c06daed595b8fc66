"""The arm's controller: fixed-time law for the reach, remote-centre torque in its null space, momentum observer."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.chapters.chapter3.scene import ARM, ELBOW, WRIST, gripper_arm, start_posture
from dexrepro.control.contract import Command, Measured, report
from dexrepro.control.motion import Motion, quintic
from dexrepro.control.null_space import consistent_damping, consistent_inverse, damped_inverse
from dexrepro.control.remote_centre import centre_force, closest_point, printed_centre_force, tool_axis
from dexrepro.experiment import Config, Recording
from dexrepro.physics.drive import JointDrive
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.physics.world import World
from dexrepro.robots.arm import Arm
from dexrepro.robots.inverse_kinematics import solve
from dexrepro.robots.kinematics import forward, joint_frames
from dexrepro.robots.rotations import cross, rotation_matrix, tilt

BEYOND = 1.6  # a retreat's length over that of the insertion
CARRIERS = (5, 6)  # number of joints that move the segments e1-w1 and w1-tip (turning w2 leaves its axis in place)


class Reference:
    """Where the tool's end point and axis should be: start -> remote centre -> target -> hold (Sect. 3.5.2).

    Straight lines with the quintic law s = 10 u^3 - 15 u^4 + 6 u^5. On the way to the centre the axis turns from its
    first direction to the one that it has inside, then it passes through the centre. A fourth phase, if there is one,
    goes back through the centre and beyond it.
    """

    def __init__(self, config: Config, tip: Array, axis: Array, centre: Array) -> None:
        self.start, self.centre, self.target = tip, centre, np.array(config.target, dtype=float)
        self.approach, self.insertion, hold, *retreat = config.phases
        self._leave, self._retreat = self.approach + self.insertion + hold, retreat[0] if retreat else 0.0
        self._lever = config.lever
        self._straight = config.straight
        self._axis = axis
        self.turn = -tilt(tool_axis(centre, centre, self.target, self._lever), axis)

    def __call__(self, time: float, centre: Array) -> tuple[Array, Array, Array, Array]:
        """Position [m], velocity [m/s], tool axis and its angular velocity [rad/s], (3,) each."""
        if self._straight:
            share, rate = quintic(time, self.approach + self.insertion)
            way = self.target - self.start
            return self.start + share * way, rate * way, self._axis, np.zeros(3)
        if time < self.approach:
            share, rate = quintic(time, self.approach)
            way = self.centre - self.start
            axis = rotation_matrix(share * self.turn) @ self._axis
            return self.start + share * way, rate * way, axis, rate * self.turn
        share, rate = quintic(time - self.approach, self.insertion)
        if self._retreat and time > self._leave:
            back, rate = quintic(time - self._leave, self._retreat)
            share, rate = 1.0 - BEYOND * back, -BEYOND * rate
        way = self.target - self.centre
        position = self.centre + share * way
        return position, rate * way, tool_axis(position, centre, self.target, self._lever), np.zeros(3)


class State:
    """Pose, centreline and Jacobians of one joint state, from the arm's geometry alone."""

    def __init__(self, arm: Arm, q: Array) -> None:
        frames = joint_frames(arm, q)
        tip = frames[-1].dot(arm.tip)
        self.tip, self.rotation = tip[:3, 3], tip[:3, :3]
        self.axes = frames[:, :3, 2]  # every joint of the arm turns about the z axis of its link
        self.corners = (frames[ELBOW, :3, 3], frames[WRIST, :3, 3], self.tip)
        self._screws = list(zip(self.axes.tolist(), frames[:, :3, 3].tolist()))

    def jacobian(self, point: Array, joints: int) -> Array:
        """Linear Jacobian (3, n), axis x (point - origin), of a point that the first ``joints`` joints move."""
        result = np.zeros((3, len(self._screws)))
        p, q, r = point.tolist()
        result.T[:joints] = [  # plain floats: a third of the time that arrays of three take
            (y * (r - w) - z * (q - v), z * (p - u) - x * (r - w), x * (q - v) - y * (p - u))
            for (x, y, z), (u, v, w) in self._screws[:joints]
        ]
        return result


class Reach:
    """From what the arm measures of itself and the camera's two points to joint torques; nothing else is known.

    The nominal model, wrong by ``config.model.mass_error``, serves gravity compensation, projector and observer; an
    error that all masses and inertias share leaves the projector as it is, one that differs by link does not.
    centre: P_R(t) as the camera sees it. applied: the torque that the motors report [N m].
    distance, observed, reference, force: of the last call, for recording.
    """

    def __init__(self, config: Config, centre: Callable[[float], Array], applied: Callable[[], Any]) -> None:
        self.arm = gripper_arm(config.gripper)
        self.model = nominal_model(self.arm, config.model.mass_error)
        # Attributes of a Config are looked up at twenty times the cost of a plain one.
        self.config = SimpleNamespace(**config)
        self.null_space = SimpleNamespace(**{"projected": True, "consistent_damping": False} | config.null_space)
        self.law, self.observer = JointDrive(config.law), config.observer
        self.support = config.model.gravity_compensation
        if config.adaptation == "task":  # what of e2 moves the task drives the weights
            config.law.part = self._moving
        self._centre, self._applied = centre, applied
        self._plan = partial(Reference, config)
        self._reference: Reference | None = None
        self._joints: Array | None = None
        self._postures: tuple[Array, ...] = ()
        self.tracking = 0.0
        self.observed = np.zeros(7)

    def __call__(self, sense: Sense) -> Command:
        config, null_space, q, dq = self.config, self.null_space, sense.position, sense.velocity
        centre, state = self._centre(sense.time), State(self.arm, q)
        mass, bias, gravity = self.model.mass_matrix(q), self.model.bias(q, dq), self.model.gravity(q)
        self.observed = self.observer(mass, dq, bias, np.array(self._applied()))
        if self._reference is None:
            self._reference = self._plan(state.tip, state.rotation[:, 2], centre)
        wanted = self._reference(sense.time, centre)
        self.tracking = math.dist(state.tip, wanted[0])
        error, jacobian, rate = self._task(state, wanted)
        self._jacobian = jacobian
        self._inverse, projector = consistent_inverse(mass, jacobian)
        if config.reference == "postures":
            joints, joint_rate = self._interpolated(sense.time, centre)
        elif config.reference == "joint":
            joints, joint_rate = self._solved(q, wanted)
        else:
            back = self._inverse if config.task == "position" else damped_inverse(jacobian, config.damping)
            joints, joint_rate = q - back @ error, back @ rate
        desired = Motion(joints, joint_rate, np.zeros(len(q)))
        torque, damping, _ = self.law.command(Measured(sense.time, q, dq, self.observed), desired)
        torque = torque + self.support * gravity
        if null_space.enabled:
            subtask = self._subtask(state, centre)
            torque += projector @ subtask if null_space.projected else subtask
        if null_space.consistent_damping and damping is not None:
            damping = consistent_damping(damping, jacobian, self._inverse, projector)
        return Command(torque, damping)

    def _moving(self, error: Array) -> Array:
        """What of a joint rate (n,) moves the task."""
        moving: Array = self._inverse @ (self._jacobian @ error)
        return moving

    def _task(self, state: State, wanted: tuple[Array, Array, Array, Array]) -> tuple[Array, Array, Array]:
        """Task error xi (m,), Jacobian (m, n) and desired rate (m,)."""
        position, velocity, axis, spin = wanted
        linear = state.jacobian(state.tip, 7)
        offset = state.tip - position
        if self.config.task == "position":
            return offset, linear, velocity
        turn = tilt(axis, state.rotation[:, 2])
        if self.config.task == "pose":
            # Roll is that of the actual orientation, Eq. (3.21): its error is zero by definition.
            sign = -1.0 if self.config.printed else 1.0
            rows = np.eye(3)
        else:
            sign, rows = 1.0, state.rotation.T[:2]
        error = np.concatenate((offset, sign * (rows @ turn)))
        if self.config.task == "roll":
            rows = np.vstack((rows, axis))
            error = np.append(error, self._roll_error(state.rotation, axis))
        jacobian = np.concatenate((linear, rows @ state.axes.T))
        return error, jacobian, np.concatenate((velocity, rows @ spin))

    def _roll_error(self, rotation: Array, axis: Array) -> float:
        """Angle about the tool's axis from the direction in which the fingers should close to theirs [rad].

        Fingers have no sides: the nearer of the two directions counts. It is bounded, so that the wrist turns slowly.
        """
        wanted = np.array((math.cos(self.config.roll), math.sin(self.config.roll), 0.0))
        side = cross(axis, rotation[:, 0])
        angle = math.atan2(float(wanted @ side), float(wanted @ rotation[:, 0]))
        turn = -((angle + math.pi / 2) % math.pi - math.pi / 2)
        return min(max(turn, -0.1), 0.1)

    def _solved(self, q: Array, wanted: tuple[Array, Array, Array, Array]) -> tuple[Array, Array]:
        """q_d and dq_d from closed-loop inverse kinematics."""
        if self._joints is None:
            self._joints = q.copy()
        error, jacobian, rate = self._task(State(self.arm, self._joints), wanted)
        desired = damped_inverse(jacobian, self.config.damping) @ (rate - 20.0 * error)
        self._joints = self._joints + self.config.step * desired
        return self._joints, desired

    def _interpolated(self, time: float, centre: Array) -> tuple[Array, Array]:
        """q_d and dq_d between postures at the start, in the opening and at the target, which know of no centre."""
        assert self._reference is not None
        if not self._postures:
            target, start = self._reference.target, np.array(start_posture(self.config.gripper, self.config.lift))
            turn = self._reference.turn
            inside = solve(self.arm, centre, rotation_matrix(turn) @ forward(self.arm, start)[1], start, "axis")
            end = solve(self.arm, target, forward(self.arm, inside)[1], inside, "axis")
            self._postures = start, inside, end
        approach, insertion = self._reference.approach, self._reference.insertion
        part = int(time >= approach)
        share, rate = quintic(time - part * approach, insertion if part else approach)
        way = self._postures[part + 1] - self._postures[part]
        return self._postures[part] + share * way, rate * way

    def _subtask(self, state: State, centre: Array) -> Array:
        """tau_sub (n,) [N m], Eq. (3.30): pull the nearest point of the arm to the centre, take out what pushes it."""
        null = self.null_space
        segment, point = closest_point(centre, state.corners)
        joints = CARRIERS[segment]
        if null.printed:
            pull = -printed_centre_force(centre, state.tip, state.corners[1], null.stiffness)
        else:
            pull = centre_force(centre, point, null.stiffness)
        force = pull if null.arrows == "inward" else -pull
        jacobian = state.jacobian(point, joints)
        if null.jacobian == "last3":
            jacobian[:, :4] = 0.0
        torque = force @ jacobian
        return torque - self.observed if null.compensate else torque


def run(
    world: World,
    config: Config,
    centre: Callable[[float], Array],
    touching: Callable[[], Any],
    events: Sequence[tuple[float, Callable[[], Any]]] = (),
) -> Recording:
    """Run a scene; adds ``tracking`` [m], ``observed`` [N m], ``contact`` and ``nodes`` to the World's channels.

    The status says which joint was at its limit, and since when.
    """
    plant = world.arm(ARM)
    reach = Reach(config, centre, lambda: plant.torque)
    probes = {
        "tracking": lambda: reach.tracking,
        "observed": lambda: reach.observed,
        "nodes": lambda: report(config.law).get("nodes", 0),
        "contact": touching,
    }
    try:
        result = world.run(sum(config.phases), {ARM: reach}, probes=probes, events=events, on_divergence="stop")
    finally:
        reach.model.close()
    positions = result[f"{ARM}.position"]
    over = (positions <= reach.arm.lower) | (positions >= reach.arm.upper)
    if over.any():
        sample, joint = np.argwhere(over)[0]
        result.status += f", {reach.arm.joints[joint].name} at its limit at {result.time[sample]:.2f} s"
    return result


def nominal_model(arm: Arm, error: float | Sequence[float]) -> RigidBodyModel:
    """The model that a law has of an arm: masses and inertias off by a share, one for all links or one for each."""
    if isinstance(error, (int, float)):
        return RigidBodyModel(arm, mass_error=error)
    links = tuple(link.scaled(1.0 + share) for link, share in zip(arm.links, error, strict=True))
    fixed = tuple((pose, link.scaled(1.0 + error[-1])) for pose, link in arm.fixed)
    return RigidBodyModel(replace(arm, links=links, fixed=fixed))
