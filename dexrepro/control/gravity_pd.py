"""Joint PD control with gravity compensation from a nominal model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.control.contract import Command, Kind, Measured, NominalModel
from dexrepro.control.motion import Motion


class GravityPD:
    """tau = k_p e + k_d e' + G(q_d) - tau_e, e = q_d - q.

    stiffness k_p [N m/rad] and damping k_d [N m s/rad]: numbers or one a joint. torque_limit [N m].
    """

    kind: ClassVar[Kind] = "joint"
    needs = ("model",)

    def __init__(
        self, model: NominalModel, *, stiffness: ArrayLike, damping: ArrayLike, torque_limit: float = math.inf
    ) -> None:
        self.model, self.torque_limit = model, torque_limit
        self.stiffness, self.damping = np.asarray(stiffness, dtype=float), np.asarray(damping, dtype=float)
        self.velocity_error = np.zeros(0)

    def reset(self, measured: Measured[Array]) -> None:
        """Nothing is remembered but the last error."""

    def diagnostics(self) -> Mapping[str, Array]:
        """e' (n,) [rad/s] of the last call."""
        return {"velocity_error": self.velocity_error}

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Torque (n,) [N m]; tau_e is the measured external torque."""
        q_d, dq_d, _ = desired
        error, self.velocity_error = q_d - measured.position, dq_d - measured.velocity
        torque = self.stiffness * error + self.damping * self.velocity_error + self.model.gravity(q_d)
        return Command(np.clip(torque - measured.force, -self.torque_limit, self.torque_limit))
