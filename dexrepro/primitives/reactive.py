"""Reactive skills: what is added to the forcing term of a learned movement primitive when something is in the way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array

from .incremental import ExtendedKernels
from .regression import least_squares


def ridge_weights(features: Array, target: Array, ridge: float) -> Array:
    """Weights (p, k) of ``features`` (N, p) for ``target`` (N, k); ``ridge`` is relative to the mean power."""
    return least_squares(features, target, ridge=ridge * float(np.mean(features**2) * len(features)))


def fit_reaction(
    features: ExtendedKernels, phases: Array, target: Array, ridge: float, ordinary: Array | None = None
) -> Array:
    """Weights theta^N (n + m, k) of a reaction Delta f = Xi^A theta^N for ``target`` (N, k), Eq. (7.24).

    Xi^A = [(1/Gamma - 1) Psi | (1 - 1/Gamma) Upsilon] is ``features.blocks(phases).change``, Eq. (7.19).
    ordinary: weights theta (n, k) of the ordinary skill, which then stay the old nodes' weights, as in (7.17)-(7.18):
    only the new nodes learn. Without them every weight is free, the other reading of (7.19).
    """
    change, count = features.blocks(phases).change, features.kernels.count
    if ordinary is None:
        return ridge_weights(change, target, ridge)
    old, new = change[:, :count], change[:, count:]
    return np.concatenate([ordinary, ridge_weights(new, target - old @ ordinary, ridge)])


@dataclass(frozen=True)
class Styles:
    """Reactions of several styles, Eq. (7.25), as a common basis and style parameters.

    Delta f^k = sum_r lambda_kr B_r, Eq. (7.26).

    basis (d, N, R), factors lambda (d, R, K): one set a coordinate. spectrum: singular values of the targets, (d, q),
    or (1, q) for factors shared by the coordinates.
    """

    basis: Array
    factors: Array
    spectrum: Array

    @classmethod
    def separate(cls, targets: Array, rank: int, shared: bool = False) -> Styles:
        """Leading ``rank`` components of the singular value decomposition of ``targets`` (K, N, d), Eq. (7.27).

        Rank 1 is (7.26) with scalar style factors. ``shared``: one set of factors for all coordinates.
        """
        styles, samples, dimensions = targets.shape
        columns = np.moveaxis(targets, 0, -1)
        if shared:
            left, values, right = np.linalg.svd(columns.reshape(samples * dimensions, styles), full_matrices=False)
            basis = (left[:, :rank] * values[:rank]).reshape(samples, dimensions, -1).transpose(1, 0, 2)
            factors = np.broadcast_to(right[:rank], (dimensions, *right[:rank].shape))
            return cls(basis, factors, values[None])
        left, values, right = np.linalg.svd(columns.transpose(1, 0, 2), full_matrices=False)
        return cls(left[..., :rank] * values[:, None, :rank], right[:, :rank], values)

    @property
    def targets(self) -> Array:
        """What the components represent of the targets, (K, N, d)."""
        return np.einsum("dnr,drk->knd", self.basis, self.factors)

    def fit(self, features: ExtendedKernels, phases: Array, ridge: float) -> Array:
        """Weights (K, n + m, d) of every style from weights of the common basis, Eq. (7.28)."""
        flat = self.basis.transpose(1, 0, 2).reshape(len(phases), -1)
        weights = fit_reaction(features, phases, flat, ridge).reshape(-1, *self.basis.shape[::2])
        return np.einsum("pdr,drk->kpd", weights, self.factors)


def path_scaling(old_axes: ArrayLike, new_axes: ArrayLike, factors: ArrayLike) -> Array:
    """Matrix S (d, d) that carries a forcing term to a new task: F_new = S F.

    old_axes, new_axes: rows are the axes of the path's frame in both tasks (d, d); factors (d,): stretch along each. It
    replaces the factor g - x0 a coordinate of (7.36), which vanishes where start and goal agree and turns no path.
    """
    return np.asarray(new_axes).T @ (np.asarray(factors)[:, None] * np.asarray(old_axes))
