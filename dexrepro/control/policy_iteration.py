"""Policy iteration from measured data: the optimal feedback of an unknown linear system, Algorithm 8.1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dexrepro.arrays import Array


class NotExcited(ValueError):
    """The data do not determine the gain: the rank condition of Algorithm 8.1 fails."""


@dataclass(frozen=True)
class Windows:
    """Integrals of Eq. (8.10) over l windows, for a state of p and an input of d entries.

    change: increments of the products of states, shape (l, p (p + 1)/2); state_state: integrals of state x state,
    shape (l, p^2); state_input: integrals of state x input, shape (l, p d).
    """

    change: Array
    state_state: Array
    state_input: Array

    @classmethod
    def of(cls, states: Array, inputs: Array, dt: float, length: int) -> Windows:
        """Cut samples into windows of ``length`` steps and integrate them by the trapezoidal rule.

        states: (n, p), inputs: (n, d), both sampled every ``dt`` [s]. Samples after the last whole window are unused.
        """
        states, inputs = np.asarray(states, float), np.asarray(inputs, float)
        count = (len(states) - 1) // length
        edges = np.arange(count + 1) * length

        def products(left: Array, right: Array) -> Array:
            return (left[:, :, None] * right[:, None, :]).reshape(len(left), -1)

        def integrals(signal: Array) -> Array:
            total = np.zeros_like(signal)
            np.cumsum(0.5 * dt * (signal[1:] + signal[:-1]), axis=0, out=total[1:])
            return np.diff(total[edges], axis=0)

        upper = np.ravel_multi_index(np.triu_indices(states.shape[1]), (states.shape[1],) * 2)
        return cls(
            change=np.diff(products(states[edges], states[edges])[:, upper], axis=0),
            state_state=integrals(products(states, states)),
            state_input=integrals(products(states, inputs)),
        )

    @property
    def required_rank(self) -> int:
        """Number of unknowns of the regression, p (p + 1) / 2 of P and p d of K."""
        return self.change.shape[1] + self.state_input.shape[1]

    @property
    def rank(self) -> int:
        """Rank of [I_zz, I_zu], with its columns scaled to unit length."""
        if not len(self.change):
            return 0
        return int(np.linalg.matrix_rank(_scaled(np.hstack([self.state_state, self.state_input]))[0], tol=1e-9))

    @property
    def excited(self) -> bool:
        """Rank test of Algorithm 8.1, step 4."""
        return self.rank == self.required_rank


@dataclass(frozen=True)
class Learned:
    """Result of policy iteration: gains K_0 ... K_m (m + 1, d, p), value matrices P_0 ... P_{m-1} (m, p, p), their
    changes |P_k - P_{k-1}| (m,; first nan), conditions of the scaled regression (m,), and whether the stop was met."""

    gains: Array
    values: Array
    changes: Array
    conditions: Array
    converged: bool

    @property
    def gain(self) -> Array:
        """Optimal gain, shape (d, p)."""
        return self.gains[-1]


def policy_iteration(
    windows: Windows, state_weight: Array, effort: Array, initial: Array, tolerance: float, limit: int = 30
) -> Learned:
    """Optimal gain K of u = -K state, without A and B: Eqs. (8.12), (8.13), steps 5 to 9 of Algorithm 8.1.

    state_weight: (p, p); effort: (d, d); initial: a stabilising gain (d, p); tolerance: on |P_m - P_{m-1}|; limit:
    largest number of iterations. The data may come from any input that excites. Raises NotExcited.
    """
    if not windows.excited:
        raise NotExcited(f"the data have rank {windows.rank} of {windows.required_rank}: excite longer or richer")
    gains, values = [np.atleast_2d(np.asarray(initial, float))], list[Array]()
    changes, conditions = [np.nan], list[float]()
    converged = False
    while not converged and len(values) < limit:
        value, gain, condition = _improve(windows, state_weight, effort, gains[-1])
        if values:
            changes.append(float(np.linalg.norm(value - values[-1])))
            converged = changes[-1] <= tolerance
        gains.append(gain)
        values.append(value)
        conditions.append(condition)
    return Learned(np.array(gains), np.array(values), np.array(changes), np.array(conditions), converged)


def _improve(windows: Windows, state_weight: Array, effort: Array, gain: Array) -> tuple[Array, Array, float]:
    """Value of a gain, the gain that is greedy for it, and the condition of their joint regression, Eq. (8.12)."""
    inputs, size = gain.shape
    identity = np.eye(size)
    policy_term = windows.state_state @ np.kron(identity, gain.T @ effort)
    regressors = np.hstack([windows.change, -2.0 * policy_term - 2.0 * windows.state_input @ np.kron(identity, effort)])
    target = -windows.state_state @ (state_weight + gain.T @ effort @ gain).ravel()
    scaled, norms = _scaled(regressors)
    solution, _, _, singular = np.linalg.lstsq(scaled, target, rcond=None)
    solution = solution / norms
    rows, columns = np.triu_indices(size)
    value = np.zeros((size, size))
    value[rows, columns] = solution[: len(rows)] / np.where(rows == columns, 1.0, 2.0)
    value = value + np.triu(value, 1).T
    return value, solution[len(rows) :].reshape(size, inputs).T, float(singular[0] / singular[-1])


def _scaled(columns: Array) -> tuple[Array, Array]:
    """Columns of unit length and their lengths (1 for a column of zeros)."""
    norms = np.linalg.norm(columns, axis=0)
    norms[norms == 0] = 1.0
    return columns / norms, norms
