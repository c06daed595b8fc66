"""Adaptive estimate of an unseen partner's movement and of the object's stiffness from the contact force alone."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dexrepro.arrays import Real


class MovementEstimation:
    """Estimates the rest position x_c(t) = a_0 + a_1 t + ... and the stiffness k_o behind f = k_o (x_c - x_1).

    Eqs. (2.10)-(2.18), integrated with one explicit step a control period. Floats, or arrays for a batch of runs.

    stiffness: initial estimate of k_o [N/m].
    coefficients: initial estimates of a_0, a_1, ... [m, m/s, ...]; their number is the book's n.
    rates: the book's 1/gamma_1, 1/gamma_2, ... (one more than coefficients).
    window: length [s] after which the polynomial is re-expanded about a new origin of time, which keeps the regressor
        bounded; None counts time from the start, as printed.
    floor: smallest stiffness estimate [N/m]; guards the division in Eq. (2.18).
    implicit: divide the prediction error by 1 + dt sum(g_j Y_j^2), which is stable for every step.
    velocity: "coefficients" takes the rate of x_c from the coefficients, Eq. (2.12); "total" differentiates the
        estimate itself, so that the coefficients' own change counts (the acceleration is then taken as zero).
    smoothing: time constant [s] of the low-pass filter on the total derivative.
    """

    def __init__(
        self,
        *,
        stiffness: Real,
        coefficients: Sequence[Real],
        rates: Sequence[Real],
        dt: float,
        window: float | None = None,
        floor: float = 1.0,
        implicit: bool = False,
        velocity: str = "coefficients",
        smoothing: float = 0.01,
    ) -> None:
        if len(rates) != len(coefficients) + 1:
            raise ValueError(f"{len(coefficients)} coefficients need {len(coefficients) + 1} rates, not {len(rates)}")
        if velocity not in ("coefficients", "total"):
            raise ValueError(f"velocity is 'coefficients' or 'total', not '{velocity}'")
        self.dt, self.rates, self.floor, self.implicit = dt, tuple(rates), floor, implicit
        self.total = velocity == "total"
        self._blend = dt / (dt + smoothing)
        self._initial = stiffness, tuple(coefficients)
        # Samples are counted as integers: the floating-point remainder of t by the window misses some of its ends.
        self._samples = round(window / dt) if window else 0
        self._shift = [
            [math.comb(i, j) * window ** (i - j) for i in range(j, len(coefficients))] if window else []
            for j in range(len(coefficients))
        ]
        self.reset()

    def reset(self) -> None:
        """Start anew from the initial estimates, at time 0."""
        self.stiffness, initial = self._initial
        self.coefficients = list(initial)
        self._maximum = np.maximum if isinstance(self.stiffness, np.ndarray) else max
        self.position = self.coefficients[0]
        self.velocity: Real = 0.0
        self.acceleration: Real = 0.0
        self._sample = 0

    def __call__(self, position: Real, force: Real) -> None:
        """Take the arm's own position x_1 [m] and the contact force f_x [N] of one sample.

        Afterwards ``position``, ``velocity`` and ``acceleration`` are the estimate for this sample, before its
        correction, and ``stiffness`` and ``coefficients`` the corrected parameters.
        """
        if self._samples and self._sample == self._samples:
            self._move_origin()
        dt, rates, a = self.dt, self.rates, self.coefficients
        time = self._sample * dt
        self._predict(time)
        error = self.stiffness * (self.position - position) - force
        if self.implicit:
            load = rates[0] * position * position
            for j, rate in enumerate(rates[1:]):
                load = load + rate * time ** (2 * j)
            error = error / (1.0 + dt * load)
        stiffness_rate = rates[0] * position * error
        power, step = 1.0, dt / self.stiffness
        for j, rate in enumerate(rates[1:]):
            a[j] = a[j] - step * (rate * power * error + stiffness_rate * a[j])
            power *= time
        self.stiffness = self._maximum(self.floor, self.stiffness + dt * stiffness_rate)
        self._sample += 1

    def _predict(self, time: float) -> None:
        """Position, velocity and acceleration of the polynomial, by Horner's rule."""
        before = self.position
        position: Real = 0.0
        velocity: Real = 0.0
        acceleration: Real = 0.0
        for coefficient in reversed(self.coefficients):
            acceleration = acceleration * time + 2 * velocity
            velocity = velocity * time + position
            position = position * time + coefficient
        self.position = position
        if self.total:
            self.velocity = self.velocity + self._blend * ((position - before) / self.dt - self.velocity)
        else:
            self.velocity, self.acceleration = velocity, acceleration

    def _move_origin(self) -> None:
        a = self.coefficients
        self.coefficients = [sum(s * c for s, c in zip(row, a[j:])) for j, row in enumerate(self._shift)]
        self._sample = 0
