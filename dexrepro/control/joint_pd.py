"""Joint-space PD control."""

from __future__ import annotations

from typing import ClassVar

from dexrepro.arrays import Array, Real
from dexrepro.control.contract import Command, Kind, Measured
from dexrepro.control.motion import Motion


class JointPD:
    """Torque K_p (q_d - q) + K_d (dq_d - dq), joint by joint.

    stiffness: K_p [N m/rad], damping: K_d [N m s/rad], one entry a joint.
    """

    kind: ClassVar[Kind] = "joint"

    def __init__(self, *, stiffness: Real, damping: Real) -> None:
        self.stiffness, self.damping = stiffness, damping

    def reset(self, measured: Measured[Array]) -> None:
        """Nothing is remembered."""

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Torque (n,) [N m]."""
        error, rate = desired.position - measured.position, measured.velocity - desired.velocity
        return Command(self.stiffness * error - self.damping * rate)
