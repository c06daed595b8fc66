"""Reactive skills: what is added to the forcing term of a learned movement primitive when something is in the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit

from .kernels import GaussianKernels

Array = NDArray[np.float64]


@dataclass(frozen=True)
class EnhancedKernels:
    """Gaussian kernels with random enhancement nodes eta_j(s) = zeta(phi(s) W_j + beta_j), Eqs. (7.13)-(7.19).

    weights W (n, m), biases beta (m,); the activation zeta must be positive: Gamma(s) = 1 + sum eta / sum phi divides
    the features, and a sign change of the nodes gives them poles.
    """

    kernels: GaussianKernels
    weights: Array
    biases: Array
    activation: Callable[[Array], Array] = expit

    @classmethod
    def draw(
        cls,
        kernels: GaussianKernels,
        groups: int,
        nodes: int,
        rng: np.random.Generator,
        weight_scale: float = 2.0,
        bias_scale: float = 1.0,
    ) -> EnhancedKernels:
        """``groups`` of ``nodes`` each, drawn one after the other: fewer groups from the same seed are a prefix."""
        drawn = [
            (
                rng.uniform(-weight_scale, weight_scale, (kernels.count, nodes)),
                rng.uniform(-bias_scale, bias_scale, nodes),
            )
            for _ in range(groups)
        ]
        weights = [weight for weight, _ in drawn] or [np.empty((kernels.count, 0))]
        biases = [bias for _, bias in drawn] or [np.empty(0)]
        return cls(kernels, np.concatenate(weights, axis=1), np.concatenate(biases))

    @property
    def count(self) -> int:
        return self.kernels.count + len(self.biases)

    def nodes(self, phases: Array) -> tuple[Array, Array]:
        """eta (N, m) and 1 / Gamma (N, 1)."""
        activations = self.kernels.activations(phases)
        eta = self.activation(activations @ self.weights + self.biases)
        total = activations.sum(axis=1, keepdims=True)
        return eta, total / (total + eta.sum(axis=1, keepdims=True))

    def blocks(self, phases: Array) -> tuple[Array, Array]:
        """(1/Gamma - 1) Psi (N, n) and (1 - 1/Gamma) Upsilon (N, m): how the old features change, and the new ones."""
        eta, share = self.nodes(phases)
        total = eta.sum(axis=1, keepdims=True)
        upsilon = eta * phases[:, None] / total if eta.shape[1] else eta
        return (share - 1) * self.kernels.features(phases), (1 - share) * upsilon

    def features(self, phases: Array) -> Array:
        """Xi^A (N, n + m), Eq. (7.19); each row sums to zero, since the features of old and of new sum to s."""
        return np.concatenate(self.blocks(phases), axis=1)


def ridge_weights(features: Array, target: Array, ridge: float) -> Array:
    """Weights (p, k) of ``features`` (N, p) for ``target`` (N, k); ``ridge`` is relative to the mean power."""
    gram = features.T @ features
    gram[np.diag_indices_from(gram)] += ridge * np.trace(gram) / len(gram)
    return np.asarray(np.linalg.solve(gram, features.T @ target))


def fit_reaction(
    enhanced: EnhancedKernels, phases: Array, target: Array, ridge: float, ordinary: Array | None = None
) -> Array:
    """Weights theta^N (n + m, k) of a reaction Delta f = Xi^A theta^N for ``target`` (N, k), Eq. (7.24).

    ordinary: weights theta (n, k) of the ordinary skill, which then stay the old nodes' weights, as in (7.17)-(7.18):
    only the new nodes learn. Without them every weight is free, the other reading of (7.19).
    """
    old, new = enhanced.blocks(phases)
    if ordinary is None:
        return ridge_weights(np.concatenate([old, new], axis=1), target, ridge)
    return np.concatenate([ordinary, ridge_weights(new, target - old @ ordinary, ridge)])


@dataclass(frozen=True)
class Styles:
    """Reactions of several styles as a common basis and style parameters: Delta f^k = sum_r lambda_kr B_r, Eq. (7.26).

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

    def fit(self, enhanced: EnhancedKernels, phases: Array, ridge: float) -> Array:
        """Weights (K, n + m, d) of every style from weights of the common basis, Eq. (7.28)."""
        flat = self.basis.transpose(1, 0, 2).reshape(len(phases), -1)
        weights = fit_reaction(enhanced, phases, flat, ridge).reshape(enhanced.count, *self.basis.shape[::2])
        return np.einsum("pdr,drk->kpd", weights, self.factors)


def path_scaling(old_axes: ArrayLike, new_axes: ArrayLike, factors: ArrayLike) -> Array:
    """Matrix S (d, d) that carries a forcing term to a new task: F_new = S F.

    old_axes, new_axes: rows are the axes of the path's frame in both tasks (d, d); factors (d,): stretch along each. It
    replaces the factor g - x0 a coordinate of (7.36), which vanishes where start and goal agree and turns no path.
    """
    return np.asarray(new_axes).T @ (np.asarray(factors)[:, None] * np.asarray(old_axes))
