"""Fixed sets of Gaussian features: arbitrary centres, and lattices evaluated as a product over dimensions."""

from __future__ import annotations

import itertools
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array


class Basis(ABC):
    """A feature vector G(z) of an input z.

    dimension: length of the input; capacity: largest number of features there can ever be; grows: whether nodes are
    added; centres: of the present nodes, (nodes, dimension); features_per_node: how many features each gives.
    The array that a call returns is a buffer, overwritten by the next call.
    """

    dimension: int
    capacity: int
    grows: ClassVar[bool] = False
    features_per_node = 1

    @property
    def nodes(self) -> int:
        """How many nodes there are now."""
        return self.capacity

    def reset(self, centres: ArrayLike | None = None) -> None:
        """Start again from ``centres`` (n, dimension) or from none; a basis that does not grow stays as it is."""
        return

    @property
    @abstractmethod
    def centres(self) -> Array:
        """Centres of the present nodes, (nodes, dimension)."""

    @abstractmethod
    def __call__(self, z: ArrayLike, grow: bool = False) -> Array:
        """Features at ``z`` (dimension,), shape (n,). With ``grow``, a growing basis may add a node first."""


class Gaussians(Basis):
    """Gaussian functions s_i(z) = exp(-|z - c_i|^2 / width^2) at fixed centres, Eq. (4.5); note: no factor 2.

    centres: shape (n, dimension). width: a number, in the unit of the input. ``normalised`` divides by the sum.
    """

    def __init__(self, centres: ArrayLike, width: float, normalised: bool = False) -> None:
        self._centres = np.array(centres, dtype=float)
        self.width, self.normalised = float(width), normalised
        self.capacity, self.dimension = self._centres.shape
        self._difference = np.empty_like(self._centres)
        self._features = np.empty(self.capacity)

    @property
    def centres(self) -> Array:
        """Centres, (nodes, dimension)."""
        return self._centres

    def __call__(self, z: ArrayLike, grow: bool = False) -> Array:
        squared_distances(self._centres, z, self._difference, self._features)
        self._features *= -1.0 / self.width**2
        np.exp(self._features, out=self._features)
        return _normalise(self._features) if self.normalised else self._features


class Lattice(Basis):
    """Gaussians at every combination of the levels of each dimension, in the order of ``itertools.product``.

    The exponential of a sum is a product: 2^14 Gaussians cost 28 exponentials and one outer product. ``normalised``
    divides by the sum, which makes it the rule base of a zero-order fuzzy network: one Gaussian membership function a
    level, firing strength by product, weights as the rules' consequents.

    levels: one sequence of centre coordinates a dimension. width: as for :class:`Gaussians`.
    """

    def __init__(self, levels: Sequence[ArrayLike], width: float, normalised: bool = False) -> None:
        self.levels = [np.array(level, dtype=float) for level in levels]
        self.width, self.normalised = float(width), normalised
        sizes = [len(level) for level in self.levels]
        self.dimension, self.capacity = len(sizes), int(np.prod(sizes))
        self._coordinates = np.concatenate(self.levels)
        self._dimension_of = np.repeat(np.arange(self.dimension), sizes)
        ends = np.cumsum(sizes)
        self._slices = [slice(end - size, end) for size, end in zip(sizes, ends)]
        # Halves of about the square root of the lattice's size: all but one of the products are then small.
        self._half = int(np.searchsorted(np.cumsum(np.log(sizes)), 0.5 * np.log(self.capacity))) + 1
        rows = int(np.prod(sizes[: self._half]))
        self._features = np.empty((rows, self.capacity // rows))

    @property
    def centres(self) -> Array:
        """All centres, shape (capacity, dimension)."""
        return np.array(list(itertools.product(*self.levels)))

    def __call__(self, z: ArrayLike, grow: bool = False) -> Array:
        factors = np.exp(-(((np.asarray(z, dtype=float)[self._dimension_of] - self._coordinates) / self.width) ** 2))
        if self.normalised:  # a sum of products over a lattice is the product of the sums
            for part in self._slices:
                _normalise(factors[part])
        rows = _product([factors[part] for part in self._slices[: self._half]])
        columns = _product([factors[part] for part in self._slices[self._half :]])
        np.multiply(rows[:, None], columns, out=self._features)
        return self._features.reshape(-1)


def squared_distances(centres: Array, z: ArrayLike, difference: Array, out: Array) -> Array:
    """|z - c_i|^2 for each row of ``centres`` (n, dimension), into ``out`` (n,); ``difference`` is scratch."""
    np.subtract(centres, z, out=difference)
    np.einsum("ij,ij->i", difference, difference, out=out)
    return out


def _product(factors: list[Array]) -> Array:
    result = np.ones(1)
    for factor in factors:
        result = np.multiply.outer(result, factor).reshape(-1)
    return result


def _normalise(features: Array) -> Array:
    """Divide by the sum, in place; where all have underflowed, the features stay zero."""
    total = features.sum()
    if total > 0:
        features /= total
    return features
