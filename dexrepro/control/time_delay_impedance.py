"""Joint impedance with time-delay estimation: whatever the model misses is what acted one period ago."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.control.contract import Command, Kind, Measured, NominalModel, coriolis, printed_forms
from dexrepro.control.motion import Motion


class Impedance(Protocol):
    """K_imp [N m s/rad] a joint from the muscle stiffness X^stf and r (n,)."""

    def __call__(self, stiffness: float, error: Array) -> Array: ...


class MuscleImpedance:
    """K_imp = k_s X^stf, Eq. (7.37). ``stiffness_gain`` k_s [N m s/rad] for a normalised muscle stiffness."""

    def __init__(self, stiffness_gain: float) -> None:
        self.stiffness_gain = stiffness_gain

    def __call__(self, stiffness: float, error: Array) -> Array:
        return np.full_like(error, self.stiffness_gain * stiffness)


class ConstantImpedance:
    """K_imp = ``gain`` [N m s/rad], whatever the muscle does."""

    def __init__(self, gain: float) -> None:
        self.gain = gain

    def __call__(self, stiffness: float, error: Array) -> Array:
        return np.full_like(error, self.gain)


class RobustImpedance:
    """K_imp = max(k_s X^stf, Gamma eps / max(|r|, layer)) a joint, Eq. (7.40).

    ``switching_gain`` Gamma times ``force_bound`` eps is the torque of the relay that the second branch is; the printed
    form, sign(r) Gamma eps / r, is infinite at r = 0, hence the ``boundary_layer`` [rad/s].
    """

    def __init__(self, stiffness_gain: float, switching_gain: float, force_bound: float, boundary_layer: float) -> None:
        self.stiffness_gain = stiffness_gain
        self.relay_torque = switching_gain * force_bound
        self.boundary_layer = boundary_layer

    def __call__(self, stiffness: float, error: Array) -> Array:
        return np.maximum(
            self.stiffness_gain * stiffness, self.relay_torque / np.maximum(abs(error), self.boundary_layer)
        )


#: Signs of the delayed estimate and of K_imp r in the torque. The print subtracts its tau_hat in (7.38), and the two
#: lines of (7.39) differ in the sign of the estimate; only the corrected ones give M r' + (C + K) r = small.
SIGNS = {"second_line": (1.0, -1.0), "first_line": (-1.0, -1.0)}


def no_stiffness(time: float) -> float:
    """X^stf of a relaxed muscle."""
    return 0.0


class TimeDelayImpedance:
    """tau = M (q_d'' + k e') + C (q_d' + k e) + G + tau_hat, Eqs. (7.38), (7.39) with the sign of tau_hat corrected.

    e = q_d - q, r = e' + k e, tau_hat = (tau - M q'' - C q' - G)(t - L) + K_imp r. M, C, G come from a nominal
    ``model``; ``dt`` [s] is the control period and the delay L; ``error_slope`` k [1/s]; ``impedance`` gives K_imp from
    the muscle ``stiffness`` X^stf at a time [s] and r. ``printed`` takes the signs of the "first_line" or
    "second_line" of Eq. (7.39). ``estimation`` switches the delayed term. ``velocity_filter`` is the coefficient (0..1,
    1: none) of the first-order low pass that the measured velocity went through: the delayed torque has to pass the
    same filter, or the loop is unstable. ``torque_limit`` [N m] clips the torque, also the one the next estimate sees.
    ``integral_rate`` [1/s], of a rival without estimation: its integral over time of K_imp r is added to the torque,
    held in the joints whose torque is at its limit.
    """

    kind: ClassVar[Kind] = "joint"
    needs = ("model", "stiffness")

    def __init__(
        self,
        model: NominalModel,
        dt: float,
        error_slope: float,
        impedance: Impedance,
        stiffness: Callable[[float], float] = no_stiffness,
        printed: Collection[str] = (),
        estimation: bool = True,
        velocity_filter: float = 1.0,
        torque_limit: float = np.inf,
        integral_rate: float = 0.0,
    ) -> None:
        self.model, self.dt, self.error_slope, self.impedance = model, dt, error_slope, impedance
        (form,) = printed_forms(printed, SIGNS) or (None,)
        self._estimate_sign, self._impedance_sign = (1.0, 1.0) if form is None else SIGNS[form]
        self.stiffness, self.estimation = stiffness, estimation
        self.velocity_filter, self.torque_limit, self.integral_rate = velocity_filter, torque_limit, integral_rate
        self._previous: tuple[Array, Array, Array, Array] | None = None
        self._integral: Array | float = 0.0
        self.error = self.gain = np.zeros(0)

    def reset(self, measured: Measured[Array]) -> None:
        """Forget the torque of the last period and the integral."""
        self._previous, self._integral = None, 0.0

    def diagnostics(self) -> Mapping[str, Array]:
        """r (n,) [rad/s] and K_imp (n,) [N m s/rad] of the last call."""
        return {"filtered_error": self.error, "impedance": self.gain}

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Torque (n,) [N m]."""
        (time, position, velocity, *_), (q_d, dq_d, ddq_d) = measured, desired
        e, de = q_d - position, dq_d - velocity
        self.error = r = de + self.error_slope * e
        mass = self.model.mass_matrix(position)
        gravity = self.model.gravity(position)
        bias = self.model.bias(position, velocity)
        target = dq_d + self.error_slope * e
        torque = mass @ (ddq_d + self.error_slope * de) + coriolis(self.model, position, velocity, target) + gravity
        self.gain = self.impedance(self.stiffness(time), r)
        restoring = self._impedance_sign * self.gain * r
        torque += restoring + self._integral
        if self._previous and self.estimation:
            delayed, old_velocity, old_mass, old_bias = self._previous
            acceleration = (velocity - old_velocity) / self.dt
            torque += self._estimate_sign * (delayed - old_mass @ acceleration - old_bias)
        if self.integral_rate:
            free = abs(torque) < self.torque_limit
            self._integral = self._integral + self.integral_rate * self.dt * restoring * free
        torque = np.minimum(np.maximum(torque, -self.torque_limit), self.torque_limit)
        delayed = self._previous[0] if self._previous else torque
        delayed = delayed + self.velocity_filter * (torque - delayed)
        self._previous = (delayed, velocity, mass, bias)
        return Command(torque)


class GravityImpedance:
    """tau = G(q) + K_imp r: the plain rival, with the same error r, impedance, stiffness and nominal ``model``."""

    kind: ClassVar[Kind] = "joint"
    needs = ("model", "stiffness")

    def __init__(
        self,
        model: NominalModel,
        error_slope: float,
        impedance: Impedance,
        stiffness: Callable[[float], float] = no_stiffness,
        torque_limit: float = np.inf,
    ) -> None:
        self.model, self.error_slope, self.impedance = model, error_slope, impedance
        self.stiffness, self.torque_limit = stiffness, torque_limit
        self.error = self.gain = np.zeros(0)

    def reset(self, measured: Measured[Array]) -> None:
        """Nothing is remembered but the last error."""

    def diagnostics(self) -> Mapping[str, Array]:
        """r (n,) [rad/s] and K_imp (n,) [N m s/rad] of the last call."""
        return {"filtered_error": self.error, "impedance": self.gain}

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Torque (n,) [N m]."""
        q = measured.position
        self.error = r = desired.velocity - measured.velocity + self.error_slope * (desired.position - q)
        self.gain = self.impedance(self.stiffness(measured.time), r)
        torque = self.model.gravity(q) + self.gain * r
        return Command(np.minimum(np.maximum(torque, -self.torque_limit), self.torque_limit))


def sampled_spectral_radius(mass: ArrayLike, nominal_mass: ArrayLike, impedance: ArrayLike, dt: float) -> float:
    """Spectral radius of the sampled loop in (r, L z), z = commanded minus actual acceleration; stable below 1.

    ``mass`` and ``nominal_mass`` (n, n) [kg m^2], ``impedance`` K_imp scalar or (n,) [N m s/rad], period ``dt`` L [s].
    One axis: stable for 0 < Mb/M < 2 and 0 < K < (4 M - 2 Mb)/L; the continuous-time proof (7.44) has no upper bound.
    """
    inverse = np.linalg.inv(np.atleast_2d(mass))
    eye = np.eye(len(inverse))
    pull = dt * inverse @ (np.asarray(impedance, float) * eye)
    missed = eye - inverse @ np.atleast_2d(nominal_mass)
    return float(np.abs(np.linalg.eigvals(np.block([[eye - pull, missed], [-pull, missed]]))).max())
