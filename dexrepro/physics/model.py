"""The rigid-body model of one arm: what a control law may know of the robot it moves."""

# mypy: disable-error-code="empty-body"
# Nothing is ever of this class alone: whoever makes one gets that of the engine.

from __future__ import annotations

from collections.abc import Sequence

from dexrepro.arrays import Array
from dexrepro.physics import engine
from dexrepro.robots.arm import Arm


class RigidBodyModel:
    """Mass matrix, bias torque, gravity, Jacobian and pose of an arm, by the engine of the process.

    arm: joint angles are measured and the world frame lies as in the arm's own description (its base included).
    mass_error: every mass and inertia is (1 + mass_error) times that of the arm, -0.3 for a model 30 % too light.
    gravity: (3,) [m/s^2]. All arguments q, dq, ddq have shape (n,) [rad, rad/s, rad/s^2].
    """

    def __new__(cls, *_: object, **__: object) -> RigidBodyModel:
        """A model of the engine in use, as ``pathlib.Path`` is one of the system in use."""
        return super().__new__(engine.engine().Model if cls is RigidBodyModel else cls)

    def __init__(self, arm: Arm, gravity: Sequence[float] = (0.0, 0.0, -9.81), mass_error: float = 0.0) -> None:
        self.arm = arm.scaled(1.0 + mass_error) if mass_error else arm
        self.dof = arm.dof
        self._load(gravity)

    def _load(self, gravity: Sequence[float]) -> None:
        """Load the arm into the engine."""

    def close(self) -> None:
        """Give back what the engine holds; also done when the model is no longer used."""

    def mass_matrix(self, q: Array) -> Array:
        """M(q), shape (n, n) [kg m^2]."""

    def inverse_dynamics(self, q: Array, dq: Array, ddq: Array) -> Array:
        """M(q) ddq + C(q, dq) dq + G(q), shape (n,) [N m]."""

    def bias(self, q: Array, dq: Array) -> Array:
        """C(q, dq) dq + G(q), shape (n,) [N m]."""

    def gravity(self, q: Array) -> Array:
        """G(q), the torque that holds the arm still, shape (n,) [N m]."""

    def coriolis(self, q: Array, dq: Array) -> Array:
        """C(q, dq) dq, shape (n,) [N m]."""
        return self.bias(q, dq) - self.gravity(q)

    def jacobian(self, q: Array) -> Array:
        """Geometric Jacobian of the end point, shape (6, n): linear [m/rad] over angular rows, world frame."""

    def tip_torque(self, q: Array, force: Sequence[float]) -> Array:
        """Joint torques J^T F (n,) [N m] of a force (x, y, z) [N] on the end point."""

    def forward(self, q: Array) -> tuple[Array, Array]:
        """Position (3,) [m] and rotation (3, 3) of the end point in the world frame."""
