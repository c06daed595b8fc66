"""References along the holding line from an estimate of the partner's movement, with and without an impedance lead.

They are told the arm's own position x_1 [m] along the line and the contact force f_x on it [N, positive in
compression], and return the reference x_1,r [m].
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import ClassVar, TypedDict, Unpack

from dexrepro.arrays import Real
from dexrepro.control.contract import HoldingLaw, Kind, Measured, check, report
from dexrepro.control.movement_estimation import MovementEstimation


class Shared(TypedDict):
    """What both references take."""

    estimation: MovementEstimation | KnownMovement
    desired_force: Real
    smoothing_rate: float
    smoothing_power: float
    dt: float


class NonImpedanceReference:
    """Where the arm must stand for the estimated object to push with the desired force, Eq. (2.24).

    desired_force: f_x,d [N]. dt: control period [s].
    smoothing_rate, smoothing_power: mu, eta of the factor 1 - exp(-mu t^eta) that fades the reference in from the
        position at ``reset`` (the origin of the arm's own frame in the book).
    """

    kind: ClassVar[Kind] = "holding"
    needs = ("estimation",)

    def __init__(
        self,
        *,
        estimation: MovementEstimation | KnownMovement,
        desired_force: Real,
        smoothing_rate: float,
        smoothing_power: float,
        dt: float,
    ) -> None:
        self.estimation, self.desired_force, self.dt = estimation, desired_force, dt
        self.smoothing_rate, self.smoothing_power = smoothing_rate, smoothing_power

    def reset(self, measured: Measured[Real]) -> None:
        """Start the estimation anew and fade in from here."""
        self.estimation.reset()
        self._start, self._sample = measured.position, 0

    def diagnostics(self) -> Mapping[str, Real]:
        """The partner's rest position [m], its velocity [m/s] and the object's stiffness [N/m] as believed."""
        it = self.estimation
        return {"rest_position": it.position, "stiffness": it.stiffness, "rest_velocity": it.velocity}

    def __call__(self, measured: Measured[Real]) -> Real:
        """Reference [m]."""
        self.estimation(measured.position, measured.force)
        time = self._sample * self.dt
        self._sample += 1
        fade = -math.expm1(-self.smoothing_rate * time**self.smoothing_power)
        return self._start + fade * (self._target() - self._start)

    def _target(self) -> Real:
        estimate = self.estimation
        return estimate.position - self.desired_force / estimate.stiffness


class ImpedanceReference(NonImpedanceReference):
    """The same, led by the partner's estimated velocity and acceleration through an impedance, Eq. (2.32).

    mass, damping, stiffness: m [kg], b [N s/m], k [N/m] of the target impedance, Eq. (2.25).
    """

    def __init__(self, *, mass: Real, damping: Real, stiffness: Real, **shared: Unpack[Shared]) -> None:
        super().__init__(**shared)
        self.mass, self.damping, self.stiffness = mass, damping, stiffness

    def _target(self) -> Real:
        estimate = self.estimation
        lead = (self.damping * estimate.velocity + self.mass * estimate.acceleration) / self.stiffness
        return super()._target() + lead


class FadeIn:
    """Fades in the force that a law is asked for, from the one felt at contact; for any law of the force error.

    The law is told its force error against that: what it integrates never sees a step, as it would if its output faded.
    desired_force: that of the law [N]. smoothing_rate, smoothing_power: mu, eta. dt: control period [s].
    """

    kind: ClassVar[Kind] = "holding"

    def __init__(
        self, *, law: HoldingLaw, desired_force: Real, smoothing_rate: float, smoothing_power: float, dt: float
    ) -> None:
        self.law, self.desired_force, self.dt = check(law, "holding"), desired_force, dt
        self.smoothing_rate, self.smoothing_power = smoothing_rate, smoothing_power

    def reset(self, measured: Measured[Real]) -> None:
        """Start the law; the force felt at the next call is where its own begins."""
        self.law.reset(measured)
        self._lacking: Real = 0.0
        self._sample = 0

    def diagnostics(self) -> Mapping[str, Real]:
        """Those of the law."""
        return report(self.law)

    def __call__(self, measured: Measured[Real]) -> Real:
        """Reference [m]."""
        if self._sample == 0:
            self._lacking = self.desired_force - measured.force
        left = math.exp(-self.smoothing_rate * (self._sample * self.dt) ** self.smoothing_power)
        self._sample += 1
        return self.law(measured._replace(force=measured.force + left * self._lacking))


class KnownMovement:
    """Stands in for an estimation where the partner's movement and the object are known (Fig. 2.5).

    movement: function without arguments that gives the rest position x_c [m] and its velocity [m/s].
    stiffness: k_o [N/m]. dt: control period [s], over which the velocity is differenced.
    """

    def __init__(self, *, movement: Callable[[], tuple[float, float]], stiffness: float, dt: float) -> None:
        self._movement, self.stiffness, self._dt = movement, stiffness, dt
        self.position = self.velocity = self.acceleration = 0.0

    def reset(self) -> None:
        """Take the movement as it is now, without acceleration."""
        self.position, self.velocity = self._movement()

    def __call__(self, position: Real, force: Real) -> None:
        before = self.velocity
        self.position, self.velocity = self._movement()
        self.acceleration = (self.velocity - before) / self._dt


class ToldMovement:
    """Stands in for an estimation in a law that is told of the object what the estimation starts from, and no more.

    The rest position believed is the one told plus the displacement that ``law`` makes of the force error.
    law: a law of the force error, such as :class:`~dexrepro.control.passive_impedance.PassiveImpedance`.
    position: a_0 [m]. stiffness: k_o as told [N/m].
    """

    velocity = acceleration = 0.0

    def __init__(self, *, law: HoldingLaw, position: Real, stiffness: float) -> None:
        self.law, self._told, self.stiffness = check(law, "holding"), position, stiffness
        self.reset()

    def reset(self) -> None:
        """The object rests where told."""
        self.position = self._told
        self.law.reset(Measured(0.0, 0.0, 0.0, 0.0))

    def __call__(self, position: Real, force: Real) -> None:
        self.position = self._told + self.law(Measured(0.0, 0.0, 0.0, force))
