"""How far the assistive follower stays from its partner while both hold an object, Section 1.4.

Everything happens along the holding line. A displacement z [m] is measured from the first contact, away from the
partner; a force [N] is positive in compression. The laws are of kind "holding" and work on numbers and on arrays (a
batch of independent runs) alike. The force controller and the passive impedance to which the book compares them are
in ``control.force_control`` and ``control.passive_impedance``.

The book defines e_f = f_z - f_d, e_z = z_A - z_r, Eq. (1.25), (1.26); its laws are right for e_f = f_d - f_z,
e_z = z_r - z_A. ``printed=True`` takes the book's definition of e_f and keeps the laws as they are.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from dexrepro.arrays import Real
from dexrepro.control.contract import HoldingLaw, Kind, Measured, check, report
from dexrepro.control.passive_impedance import PassiveImpedance


class AutoregressiveHolding:
    """Autoregressive estimate of the contact position with force feedback, Eq. (1.27)-(1.32).

    dt: control period [s]; desired_force: f_d [N]; gain: alpha [m/(s N)]; estimator_gain: L [1/s].
    adaptation: beta [m/N].
    lags: number m of displacements in the regressor Z, which has m + 1 entries.
    adapt: let the weights change; otherwise they stay zero and what is left is dz_r/dt = -alpha e_f.
    printed: the sign of e_f. speed_limit: largest speed of the reference [m/s].
    """

    kind: ClassVar[Kind] = "holding"

    def __init__(
        self,
        *,
        dt: float,
        desired_force: float,
        gain: Real,
        estimator_gain: Real,
        adaptation: float,
        lags: int,
        adapt: bool = True,
        printed: bool = False,
        speed_limit: float = np.inf,
    ) -> None:
        self.dt, self.desired_force, self.gain = dt, desired_force, gain
        self.estimator_gain, self.adaptation, self.lags = estimator_gain, adaptation, lags
        self.adapt, self._sign, self.speed_limit = adapt, (1.0 if printed else -1.0), speed_limit

    def reset(self, measured: Measured[Real]) -> None:
        """Start with zero weights at the present position [m], whose shape is that of the batch."""
        start = np.array(measured.position, float)
        self.weights = np.zeros((self.lags + 1, *start.shape))
        self.regressor = np.zeros_like(self.weights)
        self.regressor[0] = 1.0
        self.estimate, self.reference = np.zeros_like(start), start

    def diagnostics(self) -> Mapping[str, Real]:
        """Weights (m + 1, …) and estimate of the contact position [m]."""
        return {"weights": self.weights, "estimate": self.estimate}

    def __call__(self, measured: Measured[Real], target: Real | None = None) -> Real:
        """Reference displacement z_r [m].

        target: the contact position z_d(t - dt) of Eq. (1.31), which nobody can measure; without it z_A stands for
            it, as the book says.
        """
        position, error = measured.position, self._sign * (measured.force - self.desired_force)
        self.regressor[2:] = self.regressor[1:-1]
        self.regressor[1] = position
        estimation_error = self.estimate - (position if target is None else target)
        feedback = self.estimator_gain * estimation_error
        estimate_rate = np.add.reduce(self.weights * self.regressor) - feedback  # Eq. (1.29)
        reference_rate = estimate_rate - self.gain * error + feedback  # Eq. (1.32)
        if self.adapt:
            self.weights -= self.dt * (estimation_error + self.adaptation * error) * self.regressor  # Eq. (1.30)
        self.estimate = self.estimate + self.dt * estimate_rate
        if (limit := self.speed_limit) < np.inf:
            reference_rate = np.minimum(np.maximum(reference_rate, -limit), limit)
        self.reference = self.reference + self.dt * reference_rate
        return self.reference


class Compliant:
    """A holding law whose reference is followed through an impedance, Eq. (1.26).

    e = z_A - z_r; the stiffness K is zero, as in the book's passive impedance.
    """

    kind: ClassVar[Kind] = "holding"

    def __init__(self, *, law: HoldingLaw, impedance: PassiveImpedance) -> None:
        self.law, self.impedance = check(law, "holding"), impedance

    def reset(self, measured: Measured[Real]) -> None:
        """Start both, the impedance from no lead."""
        self.law.reset(measured)
        self.impedance.reset(measured._replace(position=np.zeros_like(measured.position, dtype=float)))

    def diagnostics(self) -> Mapping[str, Real]:
        """Those of the law."""
        return report(self.law)

    def __call__(self, measured: Measured[Real], *target: Real) -> Real:
        """Reference [m]; ``target`` is handed on to the law."""
        return self.law(measured, *target) + self.impedance(measured)


class FixedDistance:
    """Holding at a distance set beforehand: the reference goes to ``displacement`` [m] at ``speed`` [m/s] and stays."""

    kind: ClassVar[Kind] = "holding"

    def __init__(self, *, dt: float, displacement: float, speed: float) -> None:
        self.displacement, self.step = displacement, speed * dt

    def reset(self, measured: Measured[Real]) -> None:
        """Start the reference where the arm is."""
        self.reference = np.array(measured.position, float)

    def __call__(self, measured: Measured[Real]) -> Real:
        """Reference [m]."""
        self.reference = self.reference + np.clip(self.displacement - self.reference, -self.step, self.step)
        return self.reference
