"""Arms that follow a pose of their end point: closed-loop inverse kinematics, Eq. (1.3), under computed torque."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.robots.arm import Arm
from dexrepro.robots.inverse_kinematics import InverseKinematics
from dexrepro.robots.planar import PlanarChain
from dexrepro.robots.rotations import rotation_error


class ComputedTorque:
    """Torque that makes an arm's joints follow a moving reference, with the measured tip force compensated.

    model: what is known of the arm; bandwidth: [rad/s] of the critically damped error dynamics. Called with a Sense.
    """

    def __init__(self, model: RigidBodyModel, bandwidth: float) -> None:
        self.model, self.bandwidth = model, bandwidth

    def reset(self, position: Array) -> None:
        """Take the joint angles (n,) [rad] as reference, at rest."""
        self.start, self.rate, self.since = np.array(position, float), np.zeros(len(position)), 0.0
        self.compensation = np.zeros(len(position))

    def refer(self, time: float, position: Array, rate: Array, compensation: Array) -> None:
        """From ``time`` [s] on: reference angles ``position`` moving at ``rate`` [rad/s], and torque -J^T F [N m]."""
        self.since, self.start, self.rate, self.compensation = time, position, rate, compensation

    def __call__(self, sense: Sense) -> Array:
        w = self.bandwidth
        error = self.start + (sense.time - self.since) * self.rate - sense.position
        wanted = w * w * error + 2.0 * w * (self.rate - sense.velocity)
        return self.model.inverse_dynamics(sense.position, sense.velocity, wanted) + self.compensation


class Follower:
    """A spatial arm led by poses of its end point, one a control period.

    gain: k_E [1/s]; singular: damping of the pseudo-inverse [m]; posture: share of the pull towards ``home`` [1/s].
    """

    def __init__(
        self, arm: Arm, home: Array, *, dt: float, gain: float, singular: float, posture: float, bandwidth: float,
        mass_error: float,
    ) -> None:  # fmt: skip
        self.dt, self.model = dt, RigidBodyModel(arm, mass_error=mass_error)
        self.inverse = InverseKinematics(arm, "pose", gain, dt, singular, home, posture, self.model, redistribute=False)
        self.torque = ComputedTorque(self.model, bandwidth)

    def reset(self, position: Array) -> None:
        """Start from joint angles (7,) [rad]."""
        self.inverse.reset(position)
        self.torque.reset(position)
        self.last: tuple[Array, Array] | None = None

    def go(self, sense: Sense, position: Array, rotation: Array) -> ComputedTorque:
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


class PlanarFollower:
    """A planar arm led by positions (x, y) of its end point [m], one a physics step.

    gain: k_E [1/s] of Eq. (1.3); a negative one is the printed sign with a positive gain.
    """

    def __init__(self, chain: PlanarChain, model: RigidBodyModel, *, dt: float, gain: float, bandwidth: float) -> None:
        self.chain, self.dt, self.gain = chain, dt, gain
        self.torque = ComputedTorque(model, bandwidth)

    def reset(self, position: Array) -> None:
        """Start from joint angles (3,) [rad]."""
        self.reference = tuple(float(angle) for angle in position)
        self.last = self.chain.forward(self.reference)
        self.torque.reset(np.array(self.reference))

    def __call__(self, sense: Sense, x: float, y: float) -> Any:
        """Joint torques (3,) [N m] on the way to (x, y) [m]."""
        q, (hx, hy) = self.reference, self.chain.forward(self.reference)
        vx = (x - self.last[0]) / self.dt + self.gain * (x - hx)
        vy = (y - self.last[1]) / self.dt + self.gain * (y - hy)
        self.last = x, y
        rate = self.chain.rates(q, (vx, vy))
        compensation = self.chain.tip_torque(sense.position.tolist(), (-sense.force[0], -sense.force[1]))
        self.torque.refer(sense.time, np.array(q), np.array(rate), np.array(compensation))
        dt = self.dt
        self.reference = (q[0] + dt * rate[0], q[1] + dt * rate[1], q[2] + dt * rate[2])
        return self.torque(sense)
