"""Arms that follow a pose of their end point: closed-loop inverse kinematics, Eq. (1.3), under computed torque."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.robots.arm import Arm
from dexrepro.robots.planar import PlanarChain

Array = NDArray[np.float64]


def rotation_error(desired: Array, actual: Array) -> list[float]:
    """Rotation vector [rad], world frame, that turns ``actual`` (3, 3) into ``desired``; below half a turn."""
    (_, a, b), (c, _, d), (e, f, _) = difference = (desired @ actual.T).tolist()
    x, y, z = 0.5 * (f - d), 0.5 * (b - e), 0.5 * (c - a)
    sine = math.sqrt(x * x + y * y + z * z)
    cosine = 0.5 * (difference[0][0] + difference[1][1] + difference[2][2] - 1.0)
    share = math.atan2(sine, cosine) / sine if sine > 1e-9 else 1.0
    return [share * x, share * y, share * z]


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
        self.arm, self.home, self.dt = arm, np.array(home, float), dt
        self.gain, self.singular, self.posture = gain, singular**2 * np.eye(6), posture
        self.model = RigidBodyModel(arm, mass_error=mass_error)
        self.torque = ComputedTorque(self.model, bandwidth)

    def reset(self, position: Array) -> None:
        """Start from joint angles (7,) [rad]."""
        self.reference = np.array(position, float)
        self.torque.reset(self.reference)
        self.last: tuple[Array, Array] | None = None

    def go(self, sense: Sense, position: Array, rotation: Array) -> ComputedTorque:
        """Aim at a position (3,) [m] and rotation (3, 3); returns the controller of the coming control period."""
        here, attitude = self.model.forward(self.reference)
        jacobian = self.model.jacobian(self.reference)
        error = np.concatenate([position - here, rotation_error(rotation, attitude)])
        velocity = np.zeros(6)
        if self.last is not None:
            velocity[:3] = (position - self.last[0]) / self.dt
            velocity[3:] = np.array(rotation_error(rotation, self.last[1])) / self.dt
        self.last = np.array(position), np.array(rotation)
        inverse = jacobian.T @ np.linalg.inv(jacobian @ jacobian.T + self.singular)
        pull = self.posture * (self.home - self.reference)
        rate = inverse @ (velocity + self.gain * error) + pull - inverse @ (jacobian @ pull)
        rate = np.clip(rate, -self.arm.speed, self.arm.speed)
        after = np.clip(self.reference + self.dt * rate, self.arm.lower, self.arm.upper)
        rate = (after - self.reference) / self.dt
        # At the angles it has, not at those it should have: the difference buckles a light wrist under load.
        compensation = -self.model.jacobian(sense.position)[:3].T @ sense.force
        self.torque.refer(sense.time, self.reference, rate, compensation)
        self.reference = after
        return self.torque


def solve_pose(arm: Arm, start: Array, position: Array, rotation: Array, home: Array | None = None) -> Array:
    """Joint angles (n,) [rad] that bring the end point to a pose. Raises ValueError where none is found."""
    model = RigidBodyModel(arm)
    q = np.array(start, float)
    for k in range(400):
        here, attitude = model.forward(q)
        error = np.concatenate([position - here, rotation_error(rotation, attitude)])
        jacobian = model.jacobian(q)
        inverse = jacobian.T @ np.linalg.inv(jacobian @ jacobian.T + 1e-4 * np.eye(6))
        pull = 0.05 * ((start if home is None else home) - q) * (k < 150)
        step = 0.3 * inverse @ error + pull - inverse @ (jacobian @ pull)
        q = np.clip(q + step, arm.lower, arm.upper)
        if k >= 150 and np.abs(step).max() < 1e-12:
            break
    model.close()
    if np.linalg.norm(error) > 2e-3:
        raise ValueError(f"arm '{arm.name}' cannot reach {np.round(position, 3)} m: off by {np.linalg.norm(error):.3g}")
    return q


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
        (a1, a2, a3), (b1, b2, b3) = self.chain.jacobian(q)
        vx = (x - self.last[0]) / self.dt + self.gain * (x - hx)
        vy = (y - self.last[1]) / self.dt + self.gain * (y - hy)
        self.last = x, y
        aa, ab, bb = a1 * a1 + a2 * a2 + a3 * a3, a1 * b1 + a2 * b2 + a3 * b3, b1 * b1 + b2 * b2 + b3 * b3
        determinant = aa * bb - ab * ab
        u, v = (bb * vx - ab * vy) / determinant, (aa * vy - ab * vx) / determinant
        rate = (a1 * u + b1 * v, a2 * u + b2 * v, a3 * u + b3 * v)
        compensation = self.chain.tip_torque(sense.position.tolist(), (-sense.force[0], -sense.force[1]))
        self.torque.refer(sense.time, np.array(q), np.array(rate), np.array(compensation))
        dt = self.dt
        self.reference = (q[0] + dt * rate[0], q[1] + dt * rate[1], q[2] + dt * rate[2])
        return self.torque(sense)
