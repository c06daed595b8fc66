"""What task-space tracking laws share: what they are told, and what they return.

A tracking law is called once a control period as ``law(arm, reference, force)`` and returns the force F [N] that it
wants at the end effector, shape (d,); the joint torque is J^T F.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class ArmState(NamedTuple):
    """Measured joint position [rad] and velocity [rad/s], (n,); end-effector position [m] and velocity [m/s], (d,)."""

    joint_position: Array
    joint_velocity: Array
    position: Array
    velocity: Array


class Motion(NamedTuple):
    """Desired end-effector position [m], velocity [m/s] and acceleration [m/s^2], each of shape (d,)."""

    position: Array
    velocity: Array
    acceleration: Array


class TrackingLaw(Protocol):
    def reset(self) -> None: ...

    def __call__(self, arm: ArmState, reference: Motion, force: Array) -> Array: ...
