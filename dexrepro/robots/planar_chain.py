"""A planar arm of three rods in closed form, for plain floats (fast in a control loop) and for batches of arms."""

from __future__ import annotations

import math
from types import ModuleType
from typing import Any

Triple = Any  # three floats, or an array of shape (3, ...)
Links = tuple[Any, Any, Any, Any, Any, Any]
Point = Any  # two floats, or an array of shape (2, ...)


class PlanarChain:
    """Kinematics and dynamics of three uniform rods moving in a horizontal plane.

    Joint quantities are three floats, or arrays of shape (3, ...) for a batch; then ``functions`` is ``numpy``. Methods
    that take ``links`` save the trigonometry where ``links(q)`` is at hand.

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
        self._diagonal = tuple(lengths[i] ** 2 * (masses[i] / 3 + beyond[i]) for i in range(3))
        self._weights = masses[1] / 2 + beyond[1], masses[2] / 2

    def links(self, q: Triple) -> Links:
        """Projections of the three links [m]: l cos(t) of each, then l sin(t) of each, t the absolute angles."""
        t2 = q[0] + q[1]
        t3 = t2 + q[2]
        l1, l2, l3 = self.lengths
        sin, cos = self._sin, self._cos
        return l1 * cos(q[0]), l2 * cos(t2), l3 * cos(t3), l1 * sin(q[0]), l2 * sin(t2), l3 * sin(t3)

    def _coupling(self, links: Links) -> tuple[Any, ...]:
        """c_ij cos(t_j - t_i) and c_ij sin(t_j - t_i) of the link pairs 12, 23, 13 [kg m^2]."""
        c1, c2, c3, s1, s2, s3 = links
        second, third = self._weights
        return (
            second * (c1 * c2 + s1 * s2), third * (c2 * c3 + s2 * s3), third * (c1 * c3 + s1 * s3),
            second * (c1 * s2 - s1 * c2), third * (c2 * s3 - s2 * c3), third * (c1 * s3 - s1 * c3),
        )  # fmt: skip

    def forward(self, q: Triple, links: Links | None = None) -> Point:
        """Tip position (x, y) [m]."""
        c1, c2, c3, s1, s2, s3 = links or self.links(q)
        return self.base[0] + c1 + c2 + c3, self.base[1] + s1 + s2 + s3

    def jacobian(self, q: Triple, links: Links | None = None) -> tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]:
        """Rows of the 2 x 3 Jacobian of the tip [m/rad]."""
        c1, c2, c3, s1, s2, s3 = links or self.links(q)
        return (-s1 - s2 - s3, -s2 - s3, -s3), (c1 + c2 + c3, c2 + c3, c3)

    def approach(self, q: Triple, target: Point, damping: float = 1e-3) -> tuple[Any, Any, Any]:
        """One damped Newton step of the joint angles [rad] towards a tip position [m]; closed-loop inverse kinematics.

        damping: lambda [m] of the damped pseudo-inverse.
        """
        c1, c2, c3, s1, s2, s3 = self.links(q)
        x1, y1 = -s1 - s2 - s3, c1 + c2 + c3
        x2, y2, x3, y3 = -s2 - s3, c2 + c3, -s3, c3
        ex, ey = target[0] - self.base[0] - y1, target[1] - self.base[1] + x1
        xx = x1 * x1 + x2 * x2 + x3 * x3 + damping * damping
        yy = y1 * y1 + y2 * y2 + y3 * y3 + damping * damping
        xy = x1 * y1 + x2 * y2 + x3 * y3
        determinant = xx * yy - xy * xy
        u, v = (yy * ex - xy * ey) / determinant, (xx * ey - xy * ex) / determinant
        return q[0] + x1 * u + y1 * v, q[1] + x2 * u + y2 * v, q[2] + x3 * u + y3 * v

    def tip_torque(self, q: Triple, force: Point, links: Links | None = None) -> tuple[Any, Any, Any]:
        """Joint torques J^T F [N m] of a force (x, y) [N] at the tip."""
        c1, c2, c3, s1, s2, s3 = links or self.links(q)
        x, y = force
        third = c3 * y - s3 * x
        second = c2 * y - s2 * x + third
        return c1 * y - s1 * x + second, second, third

    def centripetal(self, q: Triple, dq: Triple) -> Point:
        """Acceleration (x, y) of the tip [m/s^2] at joint rates [rad/s] without joint accelerations."""
        c1, c2, c3, s1, s2, s3 = self.links(q)
        w1 = dq[0]
        w2 = w1 + dq[1]
        w3 = w2 + dq[2]
        w1, w2, w3 = w1 * w1, w2 * w2, w3 * w3
        return -c1 * w1 - c2 * w2 - c3 * w3, -s1 * w1 - s2 * w2 - s3 * w3

    def torque(self, q: Triple, dq: Triple, ddq: Triple) -> tuple[Any, Any, Any]:
        """Joint torques [N m] of a motion, without gravity: the inverse of ``acceleration``."""
        m1, m2, m3 = self._diagonal
        c12, c23, c13, s12, s23, s13 = self._coupling(self.links(q))
        w1, a1 = dq[0], ddq[0]
        w2, a2 = w1 + dq[1], a1 + ddq[1]
        w3, a3 = w2 + dq[2], a2 + ddq[2]
        w1, w2, w3 = w1 * w1, w2 * w2, w3 * w3
        third = c13 * a1 + c23 * a2 + m3 * a3 + s13 * w1 + s23 * w2
        second = c12 * a1 + m2 * a2 + c23 * a3 + s12 * w1 - s23 * w3 + third
        return m1 * a1 + c12 * a2 + c13 * a3 - s12 * w2 - s13 * w3 + second, second, third

    def gravity(self, q: Triple, acceleration: Any = 9.81) -> tuple[Any, Any, Any]:
        """Joint torques [N m] that hold the arm against gravity [m/s^2] along -y, where the plane is vertical."""
        t2 = q[0] + q[1]
        third = acceleration * self._moments[2] * self._cos(t2 + q[2])
        second = acceleration * self._moments[1] * self._cos(t2) + third
        return acceleration * self._moments[0] * self._cos(q[0]) + second, second, third

    def acceleration(self, q: Triple, dq: Triple, torque: Triple, links: Links | None = None) -> tuple[Any, Any, Any]:
        """Joint accelerations [rad/s^2] under joint torques [N m] (those of tip forces included), without gravity."""
        m1, m2, m3 = self._diagonal
        c12, c23, c13, s12, s23, s13 = self._coupling(links or self.links(q))
        w1 = dq[0]
        w2 = w1 + dq[1]
        w3 = w2 + dq[2]
        w1, w2, w3 = w1 * w1, w2 * w2, w3 * w3
        b1 = torque[0] - torque[1] + s12 * w2 + s13 * w3
        b2 = torque[1] - torque[2] - s12 * w1 + s23 * w3
        b3 = torque[2] - s13 * w1 - s23 * w2
        # Symmetric 3 x 3 system by elimination.
        f2, f3 = c12 / m1, c13 / m1
        m22, m23, m33 = m2 - f2 * c12, c23 - f2 * c13, m3 - f3 * c13
        b2, b3 = b2 - f2 * b1, b3 - f3 * b1
        g = m23 / m22
        a3 = (b3 - g * b2) / (m33 - g * m23)
        a2 = (b2 - m23 * a3) / m22
        a1 = (b1 - c12 * a2 - c13 * a3) / m1
        return a1, a2 - a1, a3 - a2
