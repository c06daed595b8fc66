"""A planar arm of three rods in closed form, for plain floats (fast in a control loop) and for batches of arms."""

from __future__ import annotations

import math
from types import ModuleType
from typing import Any

Triple = Any  # three floats, or an array of shape (3, ...)
Point = Any  # two floats, or an array of shape (2, ...)


class PlanarChain:
    """Kinematics and dynamics of three uniform rods moving in a horizontal plane.

    Joint quantities are three floats, or arrays of shape (3, ...) for a batch; then ``functions`` is ``numpy``.

    lengths: [m]. masses: [kg]. base: position of the first joint (x, y) [m].
    """

    def __init__(self, lengths: Triple, masses: Triple, base: Point = (0.0, 0.0), functions: ModuleType = math) -> None:
        self.lengths, self.base = tuple(lengths), base
        self._sin, self._cos = functions.sin, functions.cos
        self._moments = [
            length * (mass / 2 + sum(masses[i + 1 :])) for i, (length, mass) in enumerate(zip(lengths, masses))
        ]
        # Kinetic energy is 1/2 sum c_ij cos(t_i - t_j) dt_i dt_j in the absolute link angles t.
        beyond = [sum(masses[i + 1 :]) for i in range(3)]
        self._inertia = [
            [
                lengths[i] ** 2 * (masses[i] / 3 + beyond[i])
                if i == j
                else lengths[i] * lengths[j] * (masses[max(i, j)] / 2 + beyond[max(i, j)])
                for j in range(3)
            ]
            for i in range(3)
        ]

    def _projections(self, q: Triple) -> tuple[Any, ...]:
        """Projections l cos(t), l sin(t) of the three links."""
        t2 = q[0] + q[1]
        t3 = t2 + q[2]
        l1, l2, l3 = self.lengths
        sin, cos = self._sin, self._cos
        return l1 * cos(q[0]), l2 * cos(t2), l3 * cos(t3), l1 * sin(q[0]), l2 * sin(t2), l3 * sin(t3)

    def forward(self, q: Triple) -> Point:
        """Tip position (x, y) [m]."""
        c1, c2, c3, s1, s2, s3 = self._projections(q)
        return self.base[0] + c1 + c2 + c3, self.base[1] + s1 + s2 + s3

    def jacobian(self, q: Triple) -> tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]:
        """Rows of the 2 x 3 Jacobian of the tip [m/rad]."""
        c1, c2, c3, s1, s2, s3 = self._projections(q)
        return (-s1 - s2 - s3, -s2 - s3, -s3), (c1 + c2 + c3, c2 + c3, c3)

    def approach(self, q: Triple, target: Point, damping: float = 1e-3) -> tuple[Any, Any, Any]:
        """One damped Newton step of the joint angles [rad] towards a tip position [m]; closed-loop inverse kinematics.

        damping: lambda [m] of the damped pseudo-inverse.
        """
        c1, c2, c3, s1, s2, s3 = self._projections(q)
        x1, y1 = -s1 - s2 - s3, c1 + c2 + c3
        x2, y2, x3, y3 = -s2 - s3, c2 + c3, -s3, c3
        ex, ey = target[0] - self.base[0] - y1, target[1] - self.base[1] + x1
        xx = x1 * x1 + x2 * x2 + x3 * x3 + damping * damping
        yy = y1 * y1 + y2 * y2 + y3 * y3 + damping * damping
        xy = x1 * y1 + x2 * y2 + x3 * y3
        determinant = xx * yy - xy * xy
        u, v = (yy * ex - xy * ey) / determinant, (xx * ey - xy * ex) / determinant
        return q[0] + x1 * u + y1 * v, q[1] + x2 * u + y2 * v, q[2] + x3 * u + y3 * v

    def tip_torque(self, q: Triple, force: Point) -> tuple[Any, Any, Any]:
        """Joint torques J^T F [N m] of a force (x, y) [N] at the tip."""
        (x1, x2, x3), (y1, y2, y3) = self.jacobian(q)
        return x1 * force[0] + y1 * force[1], x2 * force[0] + y2 * force[1], x3 * force[0] + y3 * force[1]

    def gravity(self, q: Triple, acceleration: Any = 9.81) -> tuple[Any, Any, Any]:
        """Joint torques [N m] that hold the arm against gravity [m/s^2] along -y, where the plane is vertical."""
        t2 = q[0] + q[1]
        third = acceleration * self._moments[2] * self._cos(t2 + q[2])
        second = acceleration * self._moments[1] * self._cos(t2) + third
        return acceleration * self._moments[0] * self._cos(q[0]) + second, second, third

    def acceleration(self, q: Triple, dq: Triple, torque: Triple) -> tuple[Any, Any, Any]:
        """Joint accelerations [rad/s^2] under joint torques [N m] (those of tip forces included), without gravity."""
        c = self._inertia
        sin, cos = self._sin, self._cos
        t13 = q[1] + q[2]
        c12, c23, c13 = c[0][1] * cos(q[1]), c[1][2] * cos(q[2]), c[0][2] * cos(t13)
        s12, s23, s13 = c[0][1] * sin(q[1]), c[1][2] * sin(q[2]), c[0][2] * sin(t13)
        w1 = dq[0]
        w2 = w1 + dq[1]
        w3 = w2 + dq[2]
        w1, w2, w3 = w1 * w1, w2 * w2, w3 * w3
        b1 = torque[0] - torque[1] + s12 * w2 + s13 * w3
        b2 = torque[1] - torque[2] - s12 * w1 + s23 * w3
        b3 = torque[2] - s13 * w1 - s23 * w2
        # Symmetric 3 x 3 system by elimination.
        f2, f3 = c12 / c[0][0], c13 / c[0][0]
        m22, m23, m33 = c[1][1] - f2 * c12, c23 - f2 * c13, c[2][2] - f3 * c13
        b2, b3 = b2 - f2 * b1, b3 - f3 * b1
        g = m23 / m22
        a3 = (b3 - g * b2) / (m33 - g * m23)
        a2 = (b2 - m23 * a3) / m22
        a1 = (b1 - c12 * a2 - c13 * a3) / c[0][0]
        return a1, a2 - a1, a3 - a2
