"""Passive impedance along the holding line: the force error moves a virtual mass with a damper."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from dexrepro.arrays import Real
from dexrepro.control.contract import Kind, Measured


class PassiveImpedance:
    """Reference that obeys m a + b v = f_x - f_x,d (Sect. 2.4.1.3), by the second-order Runge-Kutta method.

    mass: m_pi [kg]. damping: b_pi [N s/m]. desired_force: [N]. dt: control period [s], over which the force is held.
    speed_limit: largest speed of the reference [m/s]; the virtual mass gains no speed beyond it.
    ``velocity`` is the reference's [m/s]. Behind a partner of constant velocity v it keeps the force error b_pi v.
    """

    kind: ClassVar[Kind] = "holding"

    def __init__(
        self, *, mass: Real, damping: Real, desired_force: Real, dt: float, speed_limit: float = np.inf
    ) -> None:
        self.mass, self.damping, self.desired_force, self.dt = mass, damping, desired_force, dt
        self.speed_limit = speed_limit

    def reset(self, measured: Measured[Real]) -> None:
        """Start the reference at rest where the arm is."""
        self._position = measured.position
        self.velocity: Real = 0.0

    def __call__(self, measured: Measured[Real]) -> Real:
        """Reference [m]."""
        error, velocity = measured.force - self.desired_force, self.velocity
        middle = self._limited(velocity + 0.5 * self.dt * (error - self.damping * velocity) / self.mass)
        self._position = self._position + self.dt * middle
        self.velocity = self._limited(velocity + self.dt * (error - self.damping * middle) / self.mass)
        return self._position

    def _limited(self, velocity: Real) -> Real:
        if self.speed_limit == np.inf:
            return velocity
        return np.minimum(np.maximum(velocity, -self.speed_limit), self.speed_limit)
