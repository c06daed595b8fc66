"""Arms that follow joints, a pose or a place: closed-loop inverse kinematics, Eq. (1.3), under computed torque."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.control.computed_torque import ComputedTorque
from dexrepro.control.contract import Measured
from dexrepro.control.motion import Motion
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.robots.arm import Arm
from dexrepro.robots.inverse_kinematics import InverseKinematics
from dexrepro.robots.planar import PlanarChain
from dexrepro.robots.rotations import rotation_error


class JointServo:
    """Computed torque along a joint reference that moves at a constant rate, the measured tip force compensated.

    model: what is known of the arm; bandwidth: [rad/s] of the critically damped error dynamics. A controller, or the
    inner one of a control period, for :meth:`World.run`.
    """

    def __init__(self, model: RigidBodyModel, bandwidth: float) -> None:
        self.law, self.still = ComputedTorque(model=model, frequency=bandwidth), np.zeros(model.dof)

    def reset(self, position: ArrayLike) -> None:
        """Take the joint angles (n,) [rad] as reference, at rest."""
        self.start, self.since = np.array(position, float), 0.0
        self.rate = self.compensation = self.force = self.still

    def refer(self, time: float, position: Array, rate: Array, compensation: Array | None = None) -> None:
        """From ``time`` [s] on: reference angles ``position`` moving at ``rate`` [rad/s], and torque -J^T F [N m]."""
        self.since, self.start, self.rate = time, position, rate
        self.compensation = self.still if compensation is None else compensation
        self.force = -self.compensation

    def __call__(self, sense: Sense) -> Array:
        reference = self.start + (sense.time - self.since) * self.rate
        measured = Measured(sense.time, sense.position, sense.velocity, self.force)
        return self.law(measured, Motion(reference, self.rate, self.still)).torque + self.compensation


class PoseServo:
    """A spatial arm led by poses of its end point, one a control period.

    dt: control period [s]; gain: k_E [1/s]; singular: damping of the pseudo-inverse [m]; posture: share of the pull
    towards ``home`` (n,) [1/s]; bandwidth: as for JointServo; mass_error: of the model the arm is moved with.
    """

    def __init__(
        self, arm: Arm, home: Array, *, dt: float, gain: float, singular: float, posture: float, bandwidth: float,
        mass_error: float,
    ) -> None:  # fmt: skip
        self.dt, self.model = dt, RigidBodyModel(arm, mass_error=mass_error)
        self.inverse = InverseKinematics(arm, "pose", gain, dt, singular, home, posture, self.model, redistribute=False)
        self.torque = JointServo(self.model, bandwidth)

    def reset(self, position: ArrayLike) -> None:
        """Start from joint angles (n,) [rad]."""
        self.inverse.reset(position)
        self.torque.reset(position)
        self.last: tuple[Array, Array] | None = None

    def go(self, sense: Sense, position: Array, rotation: Array) -> JointServo:
        """Aim at a position (3,) [m] and rotation (3, 3); returns the controller of the coming control period."""
        velocity = np.zeros(6)
        if self.last is not None:
            velocity[:3] = (position - self.last[0]) / self.dt
            velocity[3:] = rotation_error(rotation, self.last[1]) / self.dt
        self.last, before = (np.array(position), np.array(rotation)), self.inverse.position
        self.inverse(position, rotation, velocity)
        # At the angles it has, not at those it should have: the difference buckles a light wrist under load.
        compensation = -self.model.jacobian(sense.position)[:3].T @ sense.force
        self.torque.refer(sense.time, before, self.inverse.velocity, compensation)
        return self.torque


class PlanarServo:
    """A planar arm of three rods led by positions (x, y) of its end point [m], one a physics step dt [s].

    gain: k_E [1/s] of Eq. (1.3); a negative one is the printed sign with a positive gain.
    """

    def __init__(
        self, chain: PlanarChain[float], model: RigidBodyModel, *, dt: float, gain: float, bandwidth: float
    ) -> None:
        self.chain, self.dt, self.gain = chain, dt, gain
        self.torque = JointServo(model, bandwidth)

    def reset(self, position: ArrayLike) -> None:
        """Start from joint angles (3,) [rad]."""
        self.reference: list[float] = np.asarray(position, dtype=float).tolist()
        self.last = self.chain.forward(self.reference)
        self.torque.reset(position)

    def __call__(self, sense: Sense, x: float, y: float) -> Array:
        """Joint torques (3,) [N m] on the way to (x, y) [m]."""
        q, (hx, hy) = self.reference, self.chain.forward(self.reference)
        vx = (x - self.last[0]) / self.dt + self.gain * (x - hx)
        vy = (y - self.last[1]) / self.dt + self.gain * (y - hy)
        self.last = x, y
        rate = self.chain.rates(q, (vx, vy))
        fx, fy, _ = sense.force.tolist()
        compensation = self.chain.tip_torque(sense.position.tolist(), (-fx, -fy))
        self.torque.refer(sense.time, np.array(q), np.array(rate), np.array(compensation))
        self.reference = [angle + self.dt * speed for angle, speed in zip(q, rate)]
        return self.torque(sense)
