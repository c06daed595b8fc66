"""Joint-space PD control."""

from __future__ import annotations

from typing import Any


class JointPD:
    """Torque K_p (q_d - q) - K_d dq, joint by joint.

    stiffness: K_p [N m/rad], damping: K_d [N m s/rad], one entry a joint. A reference velocity is used only where
    one is given; the book's simulations give none.
    """

    def __init__(self, *, stiffness: Any, damping: Any) -> None:
        self.stiffness, self.damping = stiffness, damping

    def reset(self) -> None:
        """Nothing is remembered."""

    def __call__(self, reference: Any, position: Any, velocity: Any, reference_velocity: Any = None) -> Any:
        """Torque [N m] for joint angles [rad] and velocities [rad/s], one array of joints each."""
        error = velocity if reference_velocity is None else velocity - reference_velocity
        return self.stiffness * (reference - position) - self.damping * error
