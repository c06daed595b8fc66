"""Gaussian features whose nodes are added where the input goes, with trigonometric enhancement."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.networks.basis import Basis, squared_distances


class GrowingGaussians(Basis):
    """Gaussians that gain a node whenever the input is far from the nearest nodes, Eqs. (3.4)-(3.7), (4.5)-(4.10).

    With c the mean of the ``neighbours`` centres nearest to z (all, while there are fewer), a node is added at
    c + placement (z - c) when |z - c| > threshold. The first input becomes the first node.

    width, threshold: in the unit of the input. placement: a number or one a dimension (1: the node sits at the input).
    interval: growth is considered at every ``interval``-th call that asks for it (the book's T over the control
    period). enhanced: beside s_i each node has the features cos(s_i) and sin(s_i), Eq. (4.8). Of the features [F | H]
    of (4.3), (8.16) those of one node stand together, so that growth appends, Eq. (8.17). max_nodes: memory is reserved
    for as many; once full, no node is added.
    """

    grows: ClassVar[bool] = True

    def __init__(
        self,
        dimension: int,
        *,
        width: float,
        threshold: float,
        neighbours: int = 1,
        placement: float | Array = 1.0,
        interval: int = 1,
        enhanced: bool = True,
        max_nodes: int = 500,
    ) -> None:
        self.dimension, self.width, self.threshold = dimension, float(width), float(threshold)
        self.neighbours, self.placement, self.interval = neighbours, np.asarray(placement, dtype=float), interval
        self.enhanced, self.max_nodes = enhanced, max_nodes
        self.features_per_node = 3 if enhanced else 1
        self.capacity = max_nodes * self.features_per_node
        self._centres = np.empty((max_nodes, dimension))
        self._scale = np.asarray(-1.0 / self.width**2)  # as an array, which is quicker to multiply by than a number
        self.reset()

    def reset(self, centres: ArrayLike | None = None) -> None:
        """Start again from ``centres`` (n, dimension), or from none."""
        known = np.empty((0, self.dimension)) if centres is None else np.asarray(centres, dtype=float)
        if len(known) > self.max_nodes:
            raise ValueError(f"{len(known)} centres do not fit: the network holds at most {self.max_nodes} nodes")
        self._centres[: len(known)] = known
        self._calls = 0
        self._hold(len(known))

    def _hold(self, count: int) -> None:
        """Have so many nodes: the centres in use, and room for what is computed from them."""
        self._count, self._used = count, self._centres[:count]
        self._difference, self._squared = np.empty_like(self._used), np.empty(count)
        features = np.empty((count, self.features_per_node))
        self._columns, self._flat = features.T, features.reshape(-1)

    @property
    def nodes(self) -> int:
        """How many nodes there are now."""
        return self._count

    @property
    def centres(self) -> Array:
        """Centres of the present nodes, shape (nodes, dimension); a view."""
        return self._used

    def __call__(self, z: ArrayLike, grow: bool = False) -> Array:
        """Features at ``z``, shape (nodes features_per_node,)."""
        if self._count == 0:
            self._append(np.asarray(z, dtype=float))
        squared = self._distances(z)
        if grow:
            if self._calls % self.interval == 0 and self._grow(np.asarray(z, dtype=float), squared):
                squared = self._distances(z)
            self._calls += 1
        squared *= self._scale
        if not self.enhanced:
            return np.exp(squared, out=squared)
        gaussian, cosine, sine = self._columns
        np.exp(squared, out=gaussian)
        np.cos(gaussian, out=cosine)
        np.sin(gaussian, out=sine)
        return self._flat

    def _distances(self, z: ArrayLike) -> Array:
        """|z - c_i|^2 of the present nodes, (nodes,)."""
        return squared_distances(self._used, z, self._difference, self._squared)

    def _grow(self, z: Array, squared: Array) -> bool:
        if self._count == self.max_nodes:
            return False
        if self.neighbours == 1:
            index = squared.argmin()
            if squared[index] <= self.threshold**2:
                return False
            nearest = self._centres[index]
        else:
            near = self.centres
            if self._count > self.neighbours:
                near = near[np.argpartition(squared, self.neighbours - 1)[: self.neighbours]]
            nearest = np.add.reduce(near) / len(near)  # half the time of numpy's mean
        offset = z - nearest
        if float(offset @ offset) <= self.threshold**2:
            return False
        self._append(nearest + self.placement * offset)
        return True

    def _append(self, centre: Array) -> None:
        self._centres[self._count] = centre
        self._hold(self._count + 1)
