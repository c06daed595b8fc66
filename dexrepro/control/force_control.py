"""Explicit force control along the holding line: the force error sets the position, or its rate."""

from __future__ import annotations

from typing import ClassVar

from dexrepro.arrays import Real
from dexrepro.control.contract import Kind, Measured


class ForceControl:
    """Reference proportional to the force error, x_1 = x_1(0) + gain (f_x - f_x,d) (Sect. 2.4.1.3).

    gain: [m/N]. desired_force: [N]. Against a spring k_o it leaves the error (f(0) - f_d) / (1 + gain k_o).
    """

    kind: ClassVar[Kind] = "holding"

    def __init__(self, *, gain: Real, desired_force: Real) -> None:
        self.gain, self.desired_force = gain, desired_force

    def reset(self, measured: Measured[Real]) -> None:
        """Take the present position as x_1(0)."""
        self._start = measured.position

    def __call__(self, measured: Measured[Real]) -> Real:
        """Reference [m]."""
        return self._start + self.gain * (measured.force - self.desired_force)


class IntegralForceControl:
    """Reference that moves with a velocity proportional to the force error.

    rate: [m/(s N)]. desired_force: [N]. dt: control period [s].
    """

    kind: ClassVar[Kind] = "holding"

    def __init__(self, *, rate: Real, desired_force: Real, dt: float) -> None:
        self.rate, self.desired_force, self.dt = rate, desired_force, dt

    def reset(self, measured: Measured[Real]) -> None:
        """Start the reference where the arm is."""
        self._reference = measured.position

    def __call__(self, measured: Measured[Real]) -> Real:
        """Reference [m]."""
        self._reference = self._reference + self.dt * self.rate * (measured.force - self.desired_force)
        return self._reference
