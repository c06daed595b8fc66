"""A network linear in its weights, which learns while it controls."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.networks.basis import Basis


class AdaptiveNetwork:
    """Y(z) = W^T G(z), Eq. (4.4), with the weight law dW/dt = gain G e^T - leakage W, Eq. (4.30).

    Its steps are explicit Euler steps. The weights of nodes to come, W_ex of Eq. (4.11), are reserved and zero, so a
    new node leaves the output unchanged.

    basis: the features G. outputs: length of Y. gain: adaptation gain (Delta, Gamma), a number or one an output.
    leakage: forgetting rate [1/s]; the book's Delta gamma. step: period of :meth:`adapt` [s].
    """

    def __init__(self, basis: Basis, outputs: int, *, gain: float | ArrayLike, leakage: float, step: float) -> None:
        self.basis, self.step, self.leakage = basis, step, leakage
        self.gain = gain
        self._kept = np.asarray(1.0 - step * leakage)  # as an array, which is quicker to multiply by than a number
        self._weights = np.zeros((outputs, basis.capacity))  # one row an output: long rows, fast updates
        self.features = np.empty(0)
        self._use(0)

    def _use(self, features: int) -> None:
        """Put so many weights to use, in rows without gaps between them, which are quicker to update."""
        self._used = np.ascontiguousarray(self._weights[:, :features])
        self._change = np.empty_like(self._used)

    @property
    def gain(self) -> Array:
        """Adaptation gain, () or (outputs,)."""
        return self._gain

    @gain.setter
    def gain(self, gain: ArrayLike) -> None:
        self._gain = np.asarray(gain, dtype=float)
        self._rate = np.asarray(self.step * self._gain)

    @property
    def weights(self) -> Array:
        """W, shape (features at the last output, outputs); a view."""
        return self._used.T

    def reset(self, weights: ArrayLike | None = None) -> None:
        """Set the first rows of W to ``weights`` (n, outputs), n <= capacity, and all others to zero."""
        self._weights[:] = 0.0
        if weights is not None:
            rows = np.asarray(weights, dtype=float)
            self._weights[:, : len(rows)] = rows.T
        self._use(len(self.features))

    @property
    def nodes(self) -> int:
        """How many nodes the basis has now."""
        return self.basis.nodes

    def diagnostics(self) -> Mapping[str, float]:
        """Nodes, |G|^2 and largest feature at the last input."""
        features = self.features
        return {
            "nodes": self.nodes,
            "feature_energy": features.dot(features),
            "activation": features[features.argmax()] if len(features) else 0.0,
        }

    def forget(self) -> None:
        """Start anew: weights zero, and the nodes the basis had at first."""
        self.reset()
        self.basis.reset()

    def output(self, z: ArrayLike, grow: bool = False) -> Array:
        """Y(z), shape (outputs,); ``grow`` lets the basis add a node for ``z`` first."""
        return self.value(self.basis(z, grow))

    def value(self, features: Array) -> Array:
        """Y (outputs,) where the features of ``basis`` are at hand, as they are where another network shares it."""
        self.features = features
        count = self._used.shape[1]
        if len(features) != count:
            self._weights[:, :count] = self._used
            self._use(len(features))
        return self._used.dot(features)

    def adapt(self, error: Array) -> None:
        """One step of the weight law, at the input of the last :meth:`output`; ``error`` e has shape (outputs,)."""
        weights, change = self._used, self._change
        if self.leakage:
            weights *= self._kept
        np.multiply((self._rate * error)[:, None], self.features, out=change)
        weights += change
