"""Adjustable artificial potential field that leads the assistive follower to the object, Section 1.3.4."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dexrepro.arrays import Array


class PotentialField:
    """Position of the assistive follower before contact, Eq. (1.18)-(1.24).

    ready_distance: d_2 [m]; repulsion_range: rho_1,0 [m]; lower, upper: bounds of the distance between the
        teleoperated follower and the object that move the weights, rho_D,o [m].
    reach: varpi [-], at most 2; gains: eta_1 [N m^3], eta_2, eta_3 [N/m].
    compliance: k_p [m/N]; max_step: largest component of a step [m] a sampling period.
    weights: fixed weights w_1, w_2, w_3 in place of the adjustable ones of Eq. (1.23).
    """

    def __init__(
        self,
        *,
        ready_distance: float,
        repulsion_range: float,
        lower: float,
        upper: float,
        reach: float,
        gains: Sequence[float],
        compliance: float,
        max_step: float,
        weights: Sequence[float] | None = None,
    ) -> None:
        self.ready_distance, self.repulsion_range = ready_distance, repulsion_range
        self.lower, self.upper, self.reach = lower, upper, reach
        self.gains, self.compliance, self.max_step = tuple(gains), compliance, max_step
        self.fixed_weights = None if weights is None else tuple(weights)

    def reset(self, position: Array) -> None:
        """Start from ``position`` [m], shape (3,)."""
        self.position = np.array(position, float)

    def weights(self, projection: float) -> tuple[float, float, float]:
        """Weights for the object's distance from the teleoperated follower along the holding line [m], Eq. (1.23)."""
        if self.fixed_weights is not None:
            return self.fixed_weights  # type: ignore[return-value]
        far = min(1.0, max(0.0, (projection - self.lower) / (self.upper - self.lower)))
        return far, far, 1.0 - far

    def place(self, partner: Array, axis: Array, measured: Array) -> None:
        """Move the three sub-fields.

        partner: position X_D of the teleoperated follower [m]; axis: its unit z axis; measured: object X_o [m].
        """
        offset = measured - partner
        distance = float(np.sqrt(offset @ offset))
        third = self.upper if distance > self.upper else self.reach * distance  # Eq. (1.20)
        self.active = self.weights(float(offset @ axis))
        self.points = np.stack([measured, measured + self.ready_distance * axis, partner + third * axis])

    def potential(self, position: Array) -> Array:
        """U [J] at ``position`` [m], shape (..., 3) -> (...), Eq. (1.18), (1.21)."""
        w1, w2, w3 = self.active
        eta1, eta2, eta3 = self.gains
        rho1, rho2, rho3 = (np.linalg.norm(position - point, axis=-1) for point in self.points)
        barrier = np.maximum(1.0 / rho1 - 1.0 / self.repulsion_range, 0.0)
        return 0.5 * (w1 * eta1 * barrier**2 + w2 * eta2 * rho2**2 + w3 * eta3 * rho3**2)

    def force(self, position: Array) -> Array:
        """F = -grad U [N] at ``position`` [m], shape (..., 3), Eq. (1.22)."""
        w1, w2, w3 = self.active
        eta1, eta2, eta3 = self.gains
        away = position - self.points[0]
        rho = np.linalg.norm(away, axis=-1, keepdims=True)
        barrier = np.maximum(1.0 / rho - 1.0 / self.repulsion_range, 0.0)
        repulsion = w1 * eta1 * barrier * away / rho**3
        return repulsion - w2 * eta2 * (position - self.points[1]) - w3 * eta3 * (position - self.points[2])

    def __call__(self, partner: Array, axis: Array, measured: Array) -> Array:
        """Next position X_A [m], shape (3,), Eq. (1.24)."""
        self.place(partner, axis, measured)
        step = self.compliance * self.force(self.position)
        self.position = self.position + np.clip(step, -self.max_step, self.max_step)
        return self.position
