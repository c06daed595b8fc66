"""Joint tracking by inverse dynamics: every joint follows its reference as the same second-order system."""

from __future__ import annotations

from typing import ClassVar

from dexrepro.arrays import Array
from dexrepro.control.contract import Command, Kind, Measured, NominalModel
from dexrepro.control.motion import Motion


class ComputedTorque:
    """Torque M(q) (w^2 (q_d - q) + 2 z w (dq_d - dq)) + C(q, dq) dq + G(q) from a nominal model of the arm.

    frequency: w [rad/s]. damping_ratio: z.
    """

    kind: ClassVar[Kind] = "joint"
    needs = ("model",)

    def __init__(self, *, model: NominalModel, frequency: float, damping_ratio: float = 1.0) -> None:
        self.model = model
        self._stiffness, self._damping = frequency**2, 2 * damping_ratio * frequency

    def reset(self, measured: Measured[Array]) -> None:
        """Nothing is remembered."""

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Torque (n,) [N m]; the desired acceleration is not fed forward."""
        _, q, dq, *_ = measured
        wanted = self._stiffness * (desired.position - q) + self._damping * (desired.velocity - dq)
        return Command(self.model.inverse_dynamics(q, dq, wanted))
