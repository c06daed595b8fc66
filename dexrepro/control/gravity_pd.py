"""Joint PD control with gravity compensation from a nominal model."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class GravityModel(Protocol):
    def gravity(self, position: Array) -> Array: ...


class GravityPD:
    """tau = k_p e + k_d e' + G(q_d) - tau_e, e = q_d - q.

    stiffness k_p [N m/rad] and damping k_d [N m s/rad]: numbers or one a joint. torque_limit [N m].
    After a call: ``error`` e [rad], ``velocity_error`` e' [rad/s].
    """

    def __init__(
        self, model: GravityModel, *, stiffness: ArrayLike, damping: ArrayLike, torque_limit: float = math.inf
    ) -> None:
        self.model, self.torque_limit = model, torque_limit
        self.stiffness, self.damping = np.asarray(stiffness, dtype=float), np.asarray(damping, dtype=float)
        self.reset()

    def reset(self) -> None:
        """Nothing is remembered but the last errors."""
        self.error = self.velocity_error = np.zeros(0)

    def __call__(
        self, q: Array, dq: Array, desired: tuple[Array, Array, Array], contact_torque: ArrayLike = 0.0
    ) -> Array:
        """Joint torque (n,) [N m]; arguments as for :class:`dexrepro.control.bounded_neural.BoundedNeuralTracking`."""
        q_d, dq_d, _ = desired
        self.error, self.velocity_error = q_d - q, dq_d - dq
        torque = self.stiffness * self.error + self.damping * self.velocity_error + self.model.gravity(q_d)
        return np.clip(torque - np.asarray(contact_torque), -self.torque_limit, self.torque_limit)
