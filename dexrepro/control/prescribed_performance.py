"""Bounds on a tracking error that shrink in time, and the barrier that keeps the error inside them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PerformanceBound:
    """-lower nu(t) < error < upper nu(t) with nu = (initial - final) exp(-decay t) + final, Eqs. (4.15), (4.16).

    initial, final: nu_0 and nu_inf, numbers or one an axis, positive. decay: m [1/s]. lower, upper: beta_a, beta_b.
    The bounds have the unit of the error (beta is dimensionless here, nu in metres).
    """

    initial: ArrayLike
    final: ArrayLike
    decay: float
    lower: float = 1.0
    upper: float = 1.0

    def nu(self, time: ArrayLike) -> Array:
        """nu at ``time`` [s]; shapes of ``initial`` and ``time`` broadcast."""
        final = np.asarray(self.final, dtype=float)
        return (np.asarray(self.initial, dtype=float) - final) * np.exp(-self.decay * np.asarray(time)) + final

    def rate(self, time: float) -> tuple[Array, Array, Array]:
        """nu, the relative rate r = nu'/nu [1/s] and its derivative r' [1/s^2]."""
        nu = self.nu(time)
        slope = -self.decay * (nu - np.asarray(self.final, dtype=float))
        ratio = slope / nu
        return nu, ratio, -self.decay * ratio - ratio**2

    def usage(self, error: ArrayLike, nu: ArrayLike) -> Array:
        """chi, the share of the bound that ``error`` uses, with the error's sign; the bound holds while |chi| < 1."""
        error = np.asarray(error, dtype=float)
        return error / (np.where(error >= 0, self.upper, self.lower) * np.asarray(nu))

    def barrier_gradient(self, error: ArrayLike, nu: ArrayLike, limit: float = 0.995) -> Array:
        """P, the gradient of the barrier function sum of 1/2 ln 1/(1 - chi^2), Eqs. (4.17), (4.19).

        The book's chi^2 / ((1 - chi^2) error) without its 0/0 at zero error. |chi| is taken as ``limit`` at most, so
        that a sample outside the bound is pushed back with a large, finite force.
        """
        error = np.asarray(error, dtype=float)
        bound = np.where(error >= 0, self.upper, self.lower) * np.asarray(nu)
        chi = np.clip(error / bound, -limit, limit)
        return chi / (bound * (1.0 - chi**2))
