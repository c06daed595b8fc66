"""Many pairs of planar arms with an elastic object between them, stepped together for searches and sensitivity studies.

Published figures come from the World; this plant is the same model (semi-implicit steps of rigid rods, torque renewed
every step) for hundreds of runs at once.
"""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Array, Mask, Real
from dexrepro.robots.planar import PlanarChain


class PlanarPairs:
    """A batch of pairs: arm 0 leads, arm 1 follows, a massless central spring joins their tips.

    position: joint angles [rad], shape (3, 2, runs). stiffness [N/m], rest_length [m]: floats or shape (runs,).
    unilateral: the object pushes and cannot pull. dt: step [s].
    """

    def __init__(
        self,
        chain: PlanarChain[Array],
        position: Array,
        *,
        stiffness: Real,
        rest_length: Real,
        dt: float,
        unilateral: bool | Mask = True,
    ) -> None:
        self.chain, self.dt = chain, dt
        self.position, self.velocity = position.copy(), np.zeros_like(position)
        self.stiffness, self.rest_length = stiffness, rest_length
        self._least = np.where(unilateral, 0.0, -np.inf)

    def contact(self) -> tuple[tuple[Array, Array], Array, Array]:
        """Tips (x, y), each of shape (2, runs) [m]; the force on arm 1, shape (2, runs) [N]; its magnitude [N]."""
        self._links = self.chain.links(self.position)
        x, y = self.chain.forward(self.position, self._links)
        dx, dy = x[1] - x[0], y[1] - y[0]
        length = np.sqrt(dx * dx + dy * dy)
        magnitude = np.maximum(self._least, self.stiffness * (self.rest_length - length))
        pressure = magnitude / length
        return (x, y), np.array((pressure * dx, pressure * dy)), magnitude

    def step(self, torque: Array, force: Array, compensated: Array | None = None) -> None:
        """Advance by one semi-implicit step from the state of the last ``contact``.

        torque: joint torques (3, 2, runs) [N m]. force: the contact force (2, runs) on arm 1 [N]. compensated: part of
        it that both arms cancel with a joint torque of their own.
        """
        links = self._links
        rest = force if compensated is None else force - compensated
        if rest.any():
            pair = np.array((-rest[0], rest[0])), np.array((-rest[1], rest[1]))
            torque = torque + np.array(self.chain.tip_torque(self.position, pair, links))
        self.velocity += self.dt * np.array(self.chain.acceleration(self.position, self.velocity, torque, links))
        self.position += self.dt * self.velocity
