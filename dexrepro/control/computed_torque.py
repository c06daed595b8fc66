"""Joint tracking by inverse dynamics: every joint follows its reference as the same second-order system."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray


class ComputedTorque:
    """Torque M(q) (w^2 (q_d - q) + 2 z w (dq_d - dq)) + C(q, dq) dq + G(q) from a nominal model of the arm.

    model: has ``inverse_dynamics(q, dq, ddq)``. frequency: w [rad/s]. damping_ratio: z.
    """

    def __init__(self, *, model: Any, frequency: float, damping_ratio: float = 1.0) -> None:
        self.model = model
        self._stiffness, self._damping = frequency**2, 2 * damping_ratio * frequency

    def __call__(
        self,
        reference: NDArray[Any],
        position: NDArray[Any],
        velocity: NDArray[Any],
        reference_velocity: NDArray[Any],
    ) -> NDArray[Any]:
        """Torque (n,) [N m] for joint angles [rad] and rates [rad/s], shape (n,)."""
        wanted = self._stiffness * (reference - position) + self._damping * (reference_velocity - velocity)
        torque: NDArray[Any] = self.model.inverse_dynamics(position, velocity, wanted)
        return torque
