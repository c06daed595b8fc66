"""The transformation system of a movement primitive, a spring-damper, and the ways of integrating it.

A primitive's forcing term depends on the phase, hence on time alone, so the primitive is a linear time-invariant system
driven by a known signal. With the forcing linear between samples its solution is exact for any step; it is computed as
two first-order recursions, without a loop over the samples and for any number of movements at once. A coupling that
depends on the state is stepped: :func:`exact`, :func:`runge_kutta` and :func:`semi_implicit` take each other's place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import expm
from scipy.signal import lfilter

from dexrepro.arrays import Array


@dataclass(frozen=True)
class Discretisation:
    """Coefficients of one step for the factored system u' = second u + F, y' = first y + u; see ``SpringDamper``.

    u+ = decay_u u + force_u . (F, F+),  y+ = decay_y y + cross u + force_y . (F, F+), with velocity v = u + first y.
    """

    first: complex
    decay_u: complex
    decay_y: complex
    cross: complex
    force_u: tuple[complex, complex]
    force_y: tuple[complex, complex]


@lru_cache(maxsize=64)
def _discretise(stiffness: float, damping: float, step: float) -> Discretisation:
    discriminant = damping**2 / 4 - stiffness
    if abs(discriminant) < 1e-12 * damping**2:
        discriminant = 0.0  # critically damped up to rounding: keep the arithmetic real
    root = np.sqrt(discriminant) if discriminant >= 0 else 1j * np.sqrt(-discriminant)
    first, second = -damping / 2 + root, -damping / 2 - root
    hold = np.array([[second, 0, 1, 0], [1, first, 0, 0], [0, 0, 0, 1], [0, 0, 0, 0]])
    u, y = expm(step * hold)[:2]
    return Discretisation(first, u[0], y[1], y[0], (u[2] - u[3] / step, u[3] / step), (y[2] - y[3] / step, y[3] / step))


@dataclass(frozen=True)
class SpringDamper:
    """Transformation system tau v' = K (g - x) - D v + F, tau x' = v; Eq. (5.1), with F = A f(s).

    stiffness, damping: K and D, in units of normalised time t / tau (dimensionless); D = 2 sqrt(K) is critical.
    Positions are arrays (..., d) or, over time, (..., N, d); leading axes are a batch. The velocity ``v`` of this class
    is scaled, v = tau dx/dt.
    """

    stiffness: float
    damping: float

    def __post_init__(self) -> None:
        if self.stiffness <= 0 or self.damping <= 0:
            raise ValueError(f"stiffness {self.stiffness} and damping {self.damping} must be positive")

    @classmethod
    def critical(cls, stiffness: float) -> SpringDamper:
        """Critically damped: D = 2 sqrt(K)."""
        return cls(stiffness, 2 * stiffness**0.5)

    def forcing(
        self, position: Array, velocity: Array, acceleration: Array, goal: ArrayLike, printed: bool = False
    ) -> Array:
        """F that makes the system follow a path: v' - K (g - x) + D v; ``printed``: - D v as in Eqs. (5.5), (7.21).

        velocity = tau dx/dt and acceleration = tau^2 d2x/dt2, all (..., N, d); goal (..., d).
        """
        error = np.asarray(goal)[..., None, :] - position
        return acceleration - self.stiffness * error + (-self.damping if printed else self.damping) * velocity

    def acceleration(self, position: Array, velocity: Array, goal: Array, forcing: Array) -> Array:
        """tau v' = tau^2 d2x/dt2 at a state (scaled velocity)."""
        return self.stiffness * (goal - position) - self.damping * velocity + forcing

    def discretise(self, step: float) -> Discretisation:
        """Exact coefficients for a step of normalised time t / tau with F linear in between."""
        return _discretise(float(self.stiffness), float(self.damping), float(step))

    def solve(
        self, forcing: ArrayLike, step: float, start: ArrayLike = 0.0, goal: ArrayLike = 0.0, velocity: ArrayLike = 0.0
    ) -> tuple[Array, Array]:
        """Position and scaled velocity at every sample, both (..., N, d).

        forcing: F at the samples, (..., N, d), linear in between; step: normalised, dt / tau;
        start, goal, velocity: initial position, goal and initial scaled velocity, (..., d).
        """
        c = self.discretise(step)
        force = np.asarray(forcing, dtype=float)
        goal = np.asarray(goal, dtype=float)
        initial = np.asarray(start, dtype=float) - goal
        velocity = np.asarray(velocity, dtype=float)
        batch = np.broadcast_shapes(force.shape[:-2], initial.shape[:-1], velocity.shape[:-1])
        force = np.broadcast_to(force, batch + force.shape[-2:])
        drive = np.empty(force.shape, dtype=type(c.first * 1.0))
        drive[..., 0, :] = velocity - c.first * initial
        drive[..., 1:, :] = c.force_u[0] * force[..., :-1, :] + c.force_u[1] * force[..., 1:, :]
        u = lfilter([1.0], [1.0, -c.decay_u], drive, axis=-2)
        drive[..., 0, :] = initial
        drive[..., 1:, :] = (
            c.force_y[0] * force[..., :-1, :] + c.force_y[1] * force[..., 1:, :] + c.cross * u[..., :-1, :]
        )
        y = lfilter([1.0], [1.0, -c.decay_y], drive, axis=-2)
        return y.real + (goal[..., None, :] if goal.ndim else goal), (u + c.first * y).real

    def solve_printed(
        self, forcing: ArrayLike, step: float, start: ArrayLike, goal: ArrayLike, time_constant: float
    ) -> Array:
        """Positions (..., N, d) from rest under tau x' = v' as Eq. (7.33) prints it, so x = x0 + v / tau.

        What is left is tau v' = -(D + K / tau) v + K (g - x0) + F, of first order; arguments as for ``solve``, and
        time_constant: tau [s].
        """
        start, goal = np.asarray(start, dtype=float)[..., None, :], np.asarray(goal, dtype=float)[..., None, :]
        rate = (self.damping + self.stiffness / time_constant) * step
        decay = np.exp(-rate)
        hold = (1 - decay) / rate
        later = (1 - hold) / rate
        drive = step * (np.asarray(forcing, dtype=float) + self.stiffness * (goal - start))
        drive[..., 1:, :] = (hold - later) * drive[..., :-1, :] + later * drive[..., 1:, :]
        drive[..., 0, :] = 0.0
        velocity: Array = lfilter([1.0], [1.0, -decay], drive, axis=-2)
        return start + velocity / time_constant

    def step(
        self, position: Array, velocity: Array, goal: Array, forcing: Array, following: Array, step: float
    ) -> tuple[Array, Array]:
        """One step of ``solve``: F goes from ``forcing`` to ``following``. Returns position and scaled velocity."""
        c = self.discretise(step)
        y = position - goal
        u = velocity - c.first * y
        y_next = c.decay_y * y + c.cross * u + c.force_y[0] * forcing + c.force_y[1] * following
        u_next = c.decay_u * u + c.force_u[0] * forcing + c.force_u[1] * following
        return y_next.real + goal, (u_next + c.first * y_next).real


@dataclass(frozen=True)
class Step:
    """One step of tau v' = K (g - x) - D v + F + p(x, v), tau x' = v + C, for any of the integrators below.

    goal: g (..., d); time_constant: tau [s], a number or one a run (..., 1); forcing: F at both ends of the step, each
    (..., d); coupling: p as a function of position and scaled velocity (..., d); drift: C (..., d), held meanwhile.
    """

    system: SpringDamper
    goal: Array
    time_constant: float | Array
    forcing: tuple[Array, Array]
    coupling: Callable[[Array, Array], Array] | None = None
    drift: Array | None = None

    def acceleration(self, share: float, position: Array, velocity: Array) -> Array:
        """v' (..., d) after a share of the step, 0, 1/2 or 1."""
        first, last = self.forcing
        forcing = first if share == 0 else last if share == 1 else (first + last) / 2
        own = self.system.acceleration(position, velocity, self.goal, forcing) / self.time_constant
        return own if self.coupling is None else own + self.coupling(position, velocity) / self.time_constant

    def rate(self, velocity: Array) -> Array:
        """x' (..., d)."""
        return (velocity if self.drift is None else velocity + self.drift) / self.time_constant


Integrator = Callable[[Step, Array, Array, float], tuple[Array, Array]]
"""``integrator(step, x, v, dt)``: position and scaled velocity (..., d) after a time dt [s]."""


def exact(step: Step, position: Array, velocity: Array, dt: float) -> tuple[Array, Array]:
    """The closed form for a forcing linear and a coupling constant during the step; one time constant for all runs."""
    coupling = 0.0 if step.coupling is None else step.coupling(position, velocity)
    drift = 0.0 if step.drift is None else step.drift
    # w = v + C obeys the system with the additional forcing D C.
    first, last = (forcing + coupling + step.system.damping * drift for forcing in step.forcing)
    tau = float(step.time_constant)
    position, velocity = step.system.step(position, velocity + drift, step.goal, first, last, dt / tau)
    return position, velocity - drift


def runge_kutta(step: Step, position: Array, velocity: Array, dt: float) -> tuple[Array, Array]:
    """The classical method of fourth order.

    A steering term turns v without braking it; explicit Euler steps would speed it up and blame the term.
    """
    rate_x = rate_v = total_x = total_v = np.zeros(())
    for share, weight in ((0.0, 1), (0.5, 2), (0.5, 2), (1.0, 1)):
        x, v = position + share * dt * rate_x, velocity + share * dt * rate_v
        rate_x, rate_v = step.rate(v), step.acceleration(share, x, v)
        total_x, total_v = total_x + weight * rate_x, total_v + weight * rate_v
    return position + dt / 6 * total_x, velocity + dt / 6 * total_v


def semi_implicit(step: Step, position: Array, velocity: Array, dt: float) -> tuple[Array, Array]:
    """First the velocity, by the acceleration at the start, then the position with the new velocity."""
    velocity = velocity + dt * step.acceleration(0.0, position, velocity)
    return position + dt * step.rate(velocity), velocity
