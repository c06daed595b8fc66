"""A rigid-body model of one arm: what a control law may know of the robot it moves."""

from __future__ import annotations

import weakref
from collections.abc import Sequence

import numpy as np
import pybullet as bullet

from dexrepro.arrays import Array
from dexrepro.physics.loading import connect, disconnect, lighter, load_arm
from dexrepro.physics.plant import EndPoint
from dexrepro.robots.arm import Arm
from dexrepro.robots.rotations import rotated


class RigidBodyModel:
    """Mass matrix, bias torque, gravity, Jacobian and pose of an arm, from a physics client that is never stepped.

    arm: joint angles are measured and the world frame lies as in the arm's own description (its base included).
    mass_error: every mass and inertia is (1 + mass_error) times that of the arm, -0.3 for a model 30 % too light.
    gravity: (3,) [m/s^2]. All arguments q, dq, ddq have shape (n,) [rad, rad/s, rad/s^2].
    """

    def __init__(self, arm: Arm, gravity: Sequence[float] = (0.0, 0.0, -9.81), mass_error: float = 0.0) -> None:
        self.arm = arm.scaled(1.0 + mass_error) if mass_error else arm
        self.dof = arm.dof
        self._client = connect()
        self._close = weakref.finalize(self, disconnect, self._client)
        self._factor = lighter(self.arm)
        self._body = load_arm(self._client, self.arm.scaled(self._factor) if self._factor < 1 else self.arm)
        bullet.setGravity(*gravity, physicsClientId=self._client)
        self._zeros = [0.0] * arm.dof
        self._indices = list(range(arm.dof))
        self._end = EndPoint(self._client, self._body, arm)

    def close(self) -> None:
        """Give the physics client back; also done when the model is no longer used."""
        self._close()

    def mass_matrix(self, q: Array) -> Array:
        """M(q), shape (n, n) [kg m^2]."""
        return np.array(bullet.calculateMassMatrix(self._body, _list(q), physicsClientId=self._client)) / self._factor

    def inverse_dynamics(self, q: Array, dq: Array, ddq: Array) -> Array:
        """M(q) ddq + C(q, dq) dq + G(q), shape (n,) [N m]."""
        torque = bullet.calculateInverseDynamics(
            self._body, _list(q), _list(dq), _list(ddq), physicsClientId=self._client
        )
        return np.array(torque) / self._factor

    def bias(self, q: Array, dq: Array) -> Array:
        """C(q, dq) dq + G(q), shape (n,) [N m]."""
        torque = bullet.calculateInverseDynamics(
            self._body, _list(q), _list(dq), self._zeros, physicsClientId=self._client
        )
        return np.array(torque) / self._factor

    def gravity(self, q: Array) -> Array:
        """G(q), the torque that holds the arm still, shape (n,) [N m]."""
        torque = bullet.calculateInverseDynamics(
            self._body, _list(q), self._zeros, self._zeros, physicsClientId=self._client
        )
        return np.array(torque) / self._factor

    def coriolis(self, q: Array, dq: Array) -> Array:
        """C(q, dq) dq, shape (n,) [N m]."""
        return self.bias(q, dq) - self.gravity(q)

    def jacobian(self, q: Array) -> Array:
        """Geometric Jacobian of the end point, shape (6, n): linear [m/rad] over angular rows, world frame."""
        linear, angular = bullet.calculateJacobian(
            self._body,
            self._end.link,
            self._end.for_jacobian,
            _list(q),
            self._zeros,
            self._zeros,
            physicsClientId=self._client,
        )
        return np.array(linear + angular)

    def tip_torque(self, q: Array, force: Sequence[float]) -> Array:
        """Joint torques J^T F (n,) [N m] of a force (x, y, z) [N] on the end point."""
        linear, _ = bullet.calculateJacobian(
            self._body, self._end.link, self._end.for_jacobian, _list(q), self._zeros, self._zeros,
            physicsClientId=self._client,
        )  # fmt: skip
        fx, fy, fz = force
        return np.array([fx * x + fy * y + fz * z for x, y, z in zip(*linear)])

    def forward(self, q: Array) -> tuple[Array, Array]:
        """Position (3,) [m] and rotation (3, 3) of the end point in the world frame."""
        angles = [[angle] for angle in _list(q)]
        bullet.resetJointStatesMultiDof(self._body, self._indices, angles, physicsClientId=self._client)
        state = bullet.getLinkState(self._body, self._end.link, 0, 1, physicsClientId=self._client)
        rotation = np.array(bullet.getMatrixFromQuaternion(state[1])).reshape(3, 3)
        (x, y, z), (a, b, c) = state[0], rotated(state[1], self._end.from_com)
        return np.array((x + a, y + b, z + c)), rotation @ self._end.rotation


def _list(values: Array) -> list[float]:
    return values.tolist() if isinstance(values, np.ndarray) else list(values)
