"""The pseudo-inverse of a matrix that gains columns."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Array


def extended_pseudo_inverse(matrix: Array, inverse: Array, columns: Array, tolerance: float = 1e-9) -> Array:
    """Pseudo-inverse (n + m, N) of [A | a] from that of A, for any rank; completes Lemma 5.1, Eq. (5.9).

    matrix: A (N, n); inverse: A^+ (n, N); columns: a (N, m). What is left of a column after projection on A counts as
    dependent below ``tolerance`` times the largest column. With d = A^+ a and c = a - A d,
    b = c^+ + E (I + E d^T d E)^-1 d^T A^+ (I - a c^+), E = I - c^+ c, and [A | a]^+ = [A^+ - d b; b]. For an
    independent block E = 0 and b = c^+, for a dependent one c = 0 and b = (I + d^T d)^-1 d^T A^+, as printed.
    """
    d = inverse @ columns
    c = columns - matrix @ d
    c -= matrix @ (inverse @ c)  # once more: the first projection leaves rounding of the size of a
    scale = np.sqrt(np.einsum("ij,ij->j", columns, columns).max())
    left, singular, right = np.linalg.svd(c, full_matrices=False)
    rank = int((singular > tolerance * scale).sum())
    c_inverse = (right[:rank].T / singular[:rank]) @ left[:, :rank].T
    b = c_inverse
    if rank < columns.shape[1]:
        null = right[rank:].T  # orthonormal, so that E = null null^T
        inner = d @ null
        small = np.linalg.solve(np.eye(null.shape[1]) + inner.T @ inner, inner.T @ (inverse - d @ c_inverse))
        b = c_inverse + null @ small
    return np.concatenate([inverse - d @ b, b])


class GrowingRegression:
    """Least squares of smallest norm for a matrix that gains columns: each update costs O(N n m), not O(N (n + m)^2).

    matrix: A (N, n); ``inverse`` is A^+ (n, N).
    """

    def __init__(self, matrix: Array, rcond: float = 1e-10, tolerance: float = 1e-9) -> None:
        self.matrix = np.asarray(matrix, dtype=float)
        self.inverse = np.linalg.pinv(self.matrix, rcond=rcond)
        self.tolerance = tolerance

    def append(self, columns: Array) -> None:
        """Add columns a (N, m)."""
        self.inverse = extended_pseudo_inverse(self.matrix, self.inverse, columns, self.tolerance)
        self.matrix = np.concatenate([self.matrix, columns], axis=1)

    def weights(self, target: Array) -> Array:
        """Weights (n, k) for a target (N, k)."""
        return self.inverse @ target
