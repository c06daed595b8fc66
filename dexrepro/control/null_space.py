"""Torques that do not accelerate the task: the dynamically consistent null space, Eq. (3.29)."""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dposv

from dexrepro.arrays import Array


def consistent_inverse(mass: Array, jacobian: Array, damping: float = 1e-6) -> tuple[Array, Array]:
    """Inertia-weighted inverse Jbar = M^-1 J^T (J M^-1 J^T + damping)^-1, (n, m), and U = I - J^T Jbar^T, (n, n).

    U maps any joint torque to one that gives the task no acceleration (up to the damping): J M^-1 U = 0.
    mass: (n, n), positive definite [kg m^2]; jacobian: (m, n).
    """
    weighted = dposv(mass, jacobian.T)[1]
    square = jacobian.dot(weighted)
    square.reshape(-1)[:: len(square) + 1] += damping
    inverse = dposv(square, weighted.T)[1].T
    projector = -jacobian.T.dot(inverse.T)
    projector.reshape(-1)[:: len(mass) + 1] += 1.0
    return inverse, projector


def consistent_damping(damping: Array, jacobian: Array, inverse: Array, projector: Array) -> Array:
    """Damping (n, n) that acts on null-space motion through the projector, and on the task's motion as before.

    A torque -damping * dq brakes the null-space motion too, and as it is not dynamically consistent the task feels
    that. damping: (n,) [N m s/rad], one a joint; inverse, projector: of :func:`consistent_inverse` for ``jacobian``.
    """
    eye = np.eye(len(damping))
    return np.diag(damping) - (eye - projector) @ (damping[:, None] * (eye - inverse @ jacobian))


def damped_inverse(jacobian: Array, damping: float) -> Array:
    """J^T (J J^T + damping I)^-1, shape (n, m)."""
    square = jacobian @ jacobian.T
    square.reshape(-1)[:: len(square) + 1] += damping
    result: Array = dposv(square, jacobian)[1].T
    return result
