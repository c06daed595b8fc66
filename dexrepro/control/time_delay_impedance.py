"""Joint impedance with time-delay estimation: whatever the model misses is what acted one period ago."""

from __future__ import annotations

from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class NominalModel(Protocol):
    def mass_matrix(self, position: Array) -> Array: ...
    def gravity(self, position: Array) -> Array: ...
    def bias(self, position: Array, velocity: Array) -> Array: ...


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
#: lines of (7.39) differ in the sign of the estimate; only "corrected" gives the closed loop M r' + (C + K) r = small.
SIGNS = {"corrected": (1.0, 1.0), "printed": (1.0, -1.0), "printed_first_line": (-1.0, -1.0)}


class TimeDelayImpedance:
    """tau = M (q_d'' + k e') + C (q_d' + k e) + G + tau_hat, Eqs. (7.38), (7.39) with the sign of tau_hat corrected.

    e = q_d - q, r = e' + k e, tau_hat = (tau - M q'' - C q' - G)(t - L) + K_imp r. M, C, G come from a nominal
    ``model``; ``dt`` [s] is the control period and the delay L; ``error_slope`` k [1/s]; ``impedance`` gives K_imp from
    the muscle stiffness and r. ``estimation`` switches the delayed term. ``velocity_filter`` is the coefficient (0..1,
    1: none) of the first-order low pass that the measured velocity went through: the delayed torque has to pass the
    same filter, or the loop is unstable. ``torque_limit`` [N m] clips the torque, also the one the next estimate sees.
    """

    def __init__(
        self,
        model: NominalModel,
        dt: float,
        error_slope: float,
        impedance: Impedance,
        sign: Literal["corrected", "printed", "printed_first_line"] = "corrected",
        estimation: bool = True,
        velocity_filter: float = 1.0,
        torque_limit: float = np.inf,
    ) -> None:
        self.model, self.dt, self.error_slope, self.impedance = model, dt, error_slope, impedance
        self.estimate_sign, self.impedance_sign = SIGNS[sign]
        self.estimation = estimation
        self.velocity_filter, self.torque_limit = velocity_filter, torque_limit
        self.reset()

    def reset(self) -> None:
        self._previous: tuple[Array, Array, Array, Array] | None = None
        self.error = np.zeros(0)

    def __call__(
        self, position: Array, velocity: Array, desired: tuple[Array, Array, Array], stiffness: float = 0.0
    ) -> Array:
        """Joint torque [N m] for measured position [rad] and velocity [rad/s].

        ``desired`` holds position, velocity and acceleration of the reference, ``stiffness`` is the muscle's X^stf.
        """
        q_d, dq_d, ddq_d = desired
        e, de = q_d - position, dq_d - velocity
        self.error = r = de + self.error_slope * e
        mass = self.model.mass_matrix(position)
        gravity = self.model.gravity(position)
        bias = self.model.bias(position, velocity)
        target = dq_d + self.error_slope * e
        # Coriolis matrix times another vector from inverse dynamics alone: C(q, a) b = [h(a + b) - h(a - b)] / 4.
        plus, minus = self.model.bias(position, velocity + target), self.model.bias(position, velocity - target)
        torque = mass @ (ddq_d + self.error_slope * de) + (plus - minus) / 4 + gravity
        torque += self.impedance_sign * self.impedance(stiffness, r) * r
        if self._previous and self.estimation:
            delayed, old_velocity, old_mass, old_bias = self._previous
            acceleration = (velocity - old_velocity) / self.dt
            torque += self.estimate_sign * (delayed - old_mass @ acceleration - old_bias)
        torque = np.clip(torque, -self.torque_limit, self.torque_limit)
        delayed = self._previous[0] if self._previous else torque
        delayed = delayed + self.velocity_filter * (torque - delayed)
        self._previous = (delayed, velocity, mass, bias)
        return torque


class GravityImpedance:
    """tau = G(q) + K_imp r: the plain rival, with the same signature, error r and nominal ``model``."""

    def __init__(
        self, model: NominalModel, dt: float, error_slope: float, impedance: Impedance, torque_limit: float = np.inf
    ) -> None:
        self.model, self.dt, self.error_slope, self.impedance = model, dt, error_slope, impedance
        self.torque_limit = torque_limit
        self.reset()

    def reset(self) -> None:
        self.error = np.zeros(0)

    def __call__(
        self, position: Array, velocity: Array, desired: tuple[Array, Array, Array], stiffness: float = 0.0
    ) -> Array:
        """Joint torque [N m], as for :class:`TimeDelayImpedance`."""
        self.error = r = desired[1] - velocity + self.error_slope * (desired[0] - position)
        torque = self.model.gravity(position) + self.impedance(stiffness, r) * r
        return np.clip(torque, -self.torque_limit, self.torque_limit)


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
