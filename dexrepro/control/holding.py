"""How far the assistive follower stays from its partner while both hold an object, Section 1.4.

Everything happens along the holding line. A displacement z [m] is measured from the first contact, away from the
partner; a force [N] is positive in compression. Every law is called with the measured force and displacement and
returns the reference displacement. All laws work on numbers and on arrays (a batch of independent runs) alike.

The book defines e_f = f_z - f_d, e_z = z_A - z_r, Eq. (1.25), (1.26); its laws are right for e_f = f_d - f_z,
e_z = z_r - z_A. ``error="printed"`` takes the book's definition of e_f and keeps the laws as they are.
"""

from __future__ import annotations

from typing import Any

import numpy as np

ERROR_SIGNS = {"reversed": -1.0, "printed": 1.0}


class AutoregressiveHolding:
    """Autoregressive estimate of the contact position with force feedback, Eq. (1.27)-(1.32).

    dt: control period [s]; desired: f_d [N]; gain: alpha [m/(s N)]; estimator_gain: L [1/s]; adaptation: beta [m/N].
    lags: number m of displacements in the regressor Z, which has m + 1 entries.
    adapt: let the weights change; otherwise they stay zero and what is left is dz_r/dt = -alpha e_f.
    speed_limit: largest speed of the reference [m/s].
    """

    def __init__(
        self,
        *,
        dt: float,
        desired: float,
        gain: Any,
        estimator_gain: Any,
        adaptation: float,
        lags: int,
        adapt: bool = True,
        error: str = "reversed",
        speed_limit: float = np.inf,
    ) -> None:
        self.dt, self.desired, self.gain = dt, desired, gain
        self.estimator_gain, self.adaptation, self.lags = estimator_gain, adaptation, lags
        self.adapt, self.sign, self.speed_limit = adapt, ERROR_SIGNS[error], speed_limit

    def reset(self, reference: Any = 0.0) -> None:
        """Start with zero weights from ``reference`` [m], whose shape is that of the batch."""
        start = np.array(reference, float)
        self.weights = np.zeros((self.lags + 1, *start.shape))
        self.regressor = np.zeros_like(self.weights)
        self.regressor[0] = 1.0
        self.estimate, self.reference = np.zeros_like(start), start

    def __call__(self, force: Any, displacement: Any, target: Any = None) -> Any:
        """Reference displacement z_r [m].

        target: the contact position z_d(t - dt) of Eq. (1.31), which nobody can measure; without it z_A stands for
            it, as the book says.
        """
        error = self.sign * (force - self.desired)
        self.regressor[2:] = self.regressor[1:-1]
        self.regressor[1] = displacement
        estimation_error = self.estimate - (displacement if target is None else target)
        feedback = self.estimator_gain * estimation_error
        estimate_rate = (self.weights * self.regressor).sum(0) - feedback  # Eq. (1.29)
        reference_rate = estimate_rate - self.gain * error + feedback  # Eq. (1.32)
        if self.adapt:
            self.weights -= self.dt * (estimation_error + self.adaptation * error) * self.regressor  # Eq. (1.30)
        self.estimate = self.estimate + self.dt * estimate_rate
        limit = self.speed_limit
        self.reference = self.reference + self.dt * np.minimum(np.maximum(reference_rate, -limit), limit)
        return self.reference


class ForceHolding:
    """The force controller of Section 1.5.1: each sample moves the reference by -gain e_f.

    gain: metres a newton and sample [m/N].
    """

    def __init__(
        self, *, dt: float, desired: float, gain: Any, error: str = "reversed", speed_limit: float = np.inf
    ) -> None:
        self.desired, self.gain, self.sign, self.limit = desired, gain, ERROR_SIGNS[error], speed_limit * dt

    def reset(self, reference: Any = 0.0) -> None:
        self.reference = np.array(reference, float)

    def __call__(self, force: Any, displacement: Any) -> Any:
        step = -self.gain * self.sign * (force - self.desired)
        self.reference = self.reference + np.minimum(np.maximum(step, -self.limit), self.limit)
        return self.reference


class Impedance:
    """Deviation from a reference under a force error: M e'' + D e' + K e = f - f_d, Eq. (1.26), semi-implicit Euler.

    mass [kg], damping [N s/m], stiffness [N/m].
    """

    def __init__(
        self, *, dt: float, desired: float, mass: Any, damping: Any, stiffness: float = 0.0, speed_limit: float = np.inf
    ) -> None:
        self.dt, self.desired, self.limit = dt, desired, speed_limit
        self.mass, self.damping, self.stiffness = mass, damping, stiffness

    def reset(self, reference: Any = 0.0) -> None:
        self.reference = np.array(reference, float)
        self.deviation, self.velocity = np.zeros_like(self.reference), np.zeros_like(self.reference)

    def follow(self, reference: Any, force: Any) -> Any:
        """Displacement [m] that a compliant follower takes around ``reference`` [m] under ``force`` [N]."""
        push = force - self.desired - self.damping * self.velocity - self.stiffness * self.deviation
        self.velocity = np.clip(self.velocity + self.dt * push / self.mass, -self.limit, self.limit)
        self.deviation = self.deviation + self.dt * self.velocity
        return reference + self.deviation

    def __call__(self, force: Any, displacement: Any) -> Any:
        """The passive impedance controller of Section 1.5: the reference stays where contact began."""
        return self.follow(self.reference, force)


class Compliant:
    """A holding law whose reference is followed through an impedance, as Eq. (1.26) asks."""

    def __init__(self, *, law: AutoregressiveHolding, impedance: Impedance) -> None:
        self.law, self.impedance = law, impedance

    def reset(self, reference: Any = 0.0) -> None:
        self.law.reset(reference)
        self.impedance.reset(reference)

    def __call__(self, force: Any, displacement: Any, target: Any = None) -> Any:
        return self.impedance.follow(self.law(force, displacement, target), force)


class FixedDistance:
    """Holding at a distance set beforehand: the reference goes to ``displacement`` [m] at ``speed`` [m/s] and stays."""

    def __init__(self, *, dt: float, displacement: float, speed: float) -> None:
        self.displacement, self.step = displacement, speed * dt

    def reset(self, reference: Any = 0.0) -> None:
        self.reference = np.array(reference, float)

    def __call__(self, force: Any, displacement: Any) -> Any:
        self.reference = self.reference + np.clip(self.displacement - self.reference, -self.step, self.step)
        return self.reference
