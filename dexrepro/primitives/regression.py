"""Estimators of weights that a forcing term is linear in."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Array

from .kernels import GaussianKernels, TruncatedKernels


def least_squares(features: Array, target: Array, rcond: float = 1e-10, ridge: float = 0.0) -> Array:
    """Weights (..., p, k) of ``features`` (..., N, p) for ``target`` (N, k) or (..., N, k).

    Without ``ridge`` the least-squares solution of smallest norm, singular values below rcond times the largest being
    dropped. With it, the minimiser of |target - features w|^2 + ridge |w|^2.
    """
    if ridge > 0:
        gram = np.swapaxes(features, -1, -2) @ features
        gram[..., range(gram.shape[-1]), range(gram.shape[-1])] += ridge
        return np.asarray(np.linalg.solve(gram, np.swapaxes(features, -1, -2) @ target), float)
    if features.ndim == 2 and target.ndim == 2:
        return np.asarray(np.linalg.lstsq(features, target, rcond=rcond)[0], float)
    batch = np.broadcast_shapes(features.shape[:-2], target.shape[:-2])
    flat = np.broadcast_to(features, batch + features.shape[-2:]).reshape(-1, *features.shape[-2:])
    wanted = np.broadcast_to(target, batch + target.shape[-2:]).reshape(-1, *target.shape[-2:])
    solved = [np.linalg.lstsq(x, y, rcond=rcond)[0] for x, y in zip(flat, wanted, strict=True)]
    return np.reshape(solved, (*batch, features.shape[-1], target.shape[-1]))


def locally_weighted(kernels: GaussianKernels, phases: Array, target: Array) -> Array:
    """Locally weighted regression, one kernel at a time: w_i = sum phi_i s f / sum phi_i s^2, shape (..., n, k)."""
    activations = np.exp(kernels.exponents(phases))
    return (activations @ (phases[:, None] * target)) / (activations @ phases**2)[..., None]


def locally_weighted_affine(truncated: TruncatedKernels, phases: Array, target: Array) -> Array:
    """The same for DMP+: each kernel's own w_i s + b_i, weights [w; b] of shape (2 n, k) for a target (N, k)."""
    share = truncated.features(phases)[:, truncated.kernels.count :]
    affine = np.stack([phases, np.ones_like(phases)], axis=1)
    pairs = [
        np.linalg.lstsq(np.sqrt(w)[:, None] * affine, np.sqrt(w)[:, None] * target, rcond=1e-12)[0] for w in share.T
    ]
    return np.concatenate(np.swapaxes(pairs, 0, 1))
