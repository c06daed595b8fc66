"""A law of the force error that is told as much about the object as the estimating laws begin with."""

from __future__ import annotations

import math
from typing import ClassVar

from dexrepro.arrays import Real
from dexrepro.control.contract import HoldingLaw, Kind, Measured


class ToldStart:
    """Fades in to where an object as first believed gives the desired force, Eq. (2.24), and lets a law correct it.

    law: any holding law, one whose desired force fades in as fast (``FadeIn``); its displacement is added.
    rest_position: a_0 [m]; stiffness: khat_o [N/m]; desired_force: that of the law [N]. smoothing_rate,
    smoothing_power: mu, eta. dt: control period [s].
    """

    kind: ClassVar[Kind] = "holding"

    def __init__(
        self,
        *,
        law: HoldingLaw,
        rest_position: Real,
        stiffness: Real,
        desired_force: Real,
        smoothing_rate: float,
        smoothing_power: float,
        dt: float,
    ) -> None:
        self.law, self.dt = law, dt
        self.target = rest_position - desired_force / stiffness
        self.smoothing_rate, self.smoothing_power = smoothing_rate, smoothing_power

    def reset(self, measured: Measured[Real]) -> None:
        """Start the law and fade in from here."""
        self.law.reset(measured)
        self._start, self._sample = measured.position, 0

    def __call__(self, measured: Measured[Real]) -> Real:
        """Reference [m]."""
        fade = -math.expm1(-self.smoothing_rate * (self._sample * self.dt) ** self.smoothing_power)
        self._sample += 1
        return self.law(measured) + fade * (self.target - self._start)
