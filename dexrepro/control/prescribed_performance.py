"""Bounds on a tracking error that shrink in time, and the barrier that keeps the error inside them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array


@dataclass(frozen=True)
class PerformanceBound:
    """-lower nu(t) < error < upper nu(t) with nu = (initial - final) exp(-decay t) + final, Eqs. (4.15), (4.16).

    initial, final: nu_0 and nu_inf, positive, the same for all axes. decay: m [1/s]. lower, upper: beta_a, beta_b.
    The bounds have the unit of the error (beta is dimensionless here, nu in metres).
    """

    initial: float
    final: float
    decay: float
    lower: float = 1.0
    upper: float = 1.0

    def nu(self, time: ArrayLike) -> Array:
        """nu at the instants ``time`` [s]."""
        return (self.initial - self.final) * np.exp(-self.decay * np.asarray(time)) + self.final

    def rate(self, time: float) -> tuple[float, float, float]:
        """nu, the relative rate r = nu'/nu [1/s] and its derivative r' [1/s^2]."""
        excess = (self.initial - self.final) * math.exp(-self.decay * time)
        nu = excess + self.final
        ratio = -self.decay * excess / nu
        return nu, ratio, -self.decay * ratio - ratio * ratio

    def limit(self, error: Array, nu: float | Array) -> float | Array:
        """The bound that the error's sign selects, as a positive number [unit of the error]; broadcasts."""
        if self.lower == self.upper:
            return self.upper * nu
        return np.where(error >= 0, self.upper * nu, self.lower * nu)

    def usage(self, error: Array, nu: float | Array) -> Array:
        """chi (d,), the share of the bound that ``error`` (d,) uses, with its sign; the bound holds while |chi| < 1."""
        return error / self.limit(error, nu)

    def barrier_gradient(self, error: Array, nu: float, clip: float = 0.995) -> Array:
        """P (d,), the gradient of the barrier function sum of 1/2 ln 1/(1 - chi^2), Eqs. (4.17), (4.19).

        The book's chi^2 / ((1 - chi^2) error) without its 0/0 at zero error. |chi| is taken as ``clip`` at most, so
        that a sample outside the bound is pushed back with a large, finite force.
        """
        return np.array([self._slope(component, nu, clip) for component in error.tolist()])

    def _slope(self, error: float, nu: float, clip: float) -> float:
        limit = (self.upper if error >= 0 else self.lower) * nu
        chi = min(max(error / limit, -clip), clip)
        return chi / (limit * (1.0 - chi * chi))
