"""Planar arms: revolute joints about z, links along x, in the plane z = 0; descriptions and closed forms."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate
from math import cos, sin
from operator import add
from types import ModuleType
from typing import Generic, cast, overload

import numpy as np

from dexrepro.arrays import Array, Number, Real, Row
from dexrepro.robots.arm import Arm, Colour, Joint, Link, Pose, Shape, Tool
from dexrepro.robots.kinematics import forward

BLUE: Colour = (0.25, 0.45, 0.75, 1.0)
Links = tuple[Number, Number, Number, Number, Number, Number]
Known = Links[Number] | None  # where ``links(q)`` is at hand
Floats = Sequence[float]
Three = tuple[Number, Number, Number]


def planar(
    lengths: Sequence[float],
    masses: Sequence[float],
    inertias: str | Sequence[float] = "rods",
    centres: Sequence[float] | None = None,
    base: Pose | Sequence[float] = Pose(),
    effort: float = float("inf"),
    tool: Tool | None = None,
    radius: float = 0.02,
    colour: Colour = BLUE,
) -> Arm:
    """A planar arm of n links whose joint angles are measured from the link before, counterclockwise.

    lengths [m], masses [kg]: n numbers each.
    inertias: n moments about the centres of mass [kg m^2]; or "rods", m l^2 / 12 with the centre half-way (what we
        take where the book is silent); or "points", all mass at the far end of each link.
    centres: distance of the centre of mass from the link's joint [m]; by default half-way (at the end for "points").
    base: pose in the world, or (x, y) [m], or (x, y, heading) [m, rad].
    effort: largest torque of every joint [N m]. radius [m] of the capsule that stands for a link.
    Gravity belongs to the world: it acts along -y where the plane is meant to be vertical.
    """
    if isinstance(inertias, str) and inertias not in ("rods", "points"):
        raise ValueError(f"inertias: '{inertias}' is neither 'rods', 'points' nor a list of moments")
    points = inertias == "points"
    if centres is None:
        centres = [length if points else length / 2 for length in lengths]
    if isinstance(inertias, str):
        inertias = [0.0 if points else mass * length**2 / 12 for mass, length in zip(masses, lengths, strict=True)]
    if not isinstance(base, Pose):
        x, y, *heading = (float(value) for value in base)
        base = Pose((x, y, 0.0), (0.0, 0.0, heading[0] if heading else 0.0))
    links, joints, reach = [], [], 0.0
    for i, (length, mass, moment, centre) in enumerate(zip(lengths, masses, inertias, centres, strict=True), 1):
        shape = Shape.between((0, 0, 0), (length, 0, 0), radius, colour)
        # In the plane only izz matters; the others are those of a slender body along x.
        inertia = (1e-3 * moment, 0.0, 0.0, moment, 0.0, moment)
        links.append(Link(f"link{i}", float(mass), (float(centre), 0.0, 0.0), inertia, (shape,)))
        joints.append(Joint(f"joint{i}", Pose((reach, 0.0, 0.0)), effort=effort))
        reach = float(length)
    return Arm("planar", tuple(joints), tuple(links), end=Pose((reach, 0.0, 0.0)), tool=tool, base=base)


class PlanarTip:
    """Closed forms for one state of any planar arm in plain floats, for loops at 1 kHz.

    ``PlanarChain`` has those of three bare rods, batches and dynamics included, at less than half the time.
    """

    def __init__(self, arm: Arm) -> None:
        if not arm.is_planar:
            raise ValueError(f"arm '{arm.name}' does not stay in the plane z = const")
        first, *rest = arm.origins
        self.base = float(first[0, 3]), float(first[1, 3])
        self.height = float(forward(arm, np.zeros(arm.dof))[0][2])
        self._turns = [math.atan2(origin[1, 0], origin[0, 0]) for origin in arm.origins]
        self._sides = [(float(after[0, 3]), float(after[1, 3])) for after in (arm.tip, *reversed(rest))]

    def levers(self, q: Sequence[float]) -> list[tuple[float, float]]:
        """Vectors (x, y) [m] from each joint to the end point; the first one starts at ``base``."""
        angles = list(accumulate(map(add, self._turns, q)))
        x = y = 0.0
        result = []
        for (a, b), angle in zip(self._sides, reversed(angles)):  # from the tip to the base
            c, s = cos(angle), sin(angle)
            x += c * a - s * b
            y += s * a + c * b
            result.append((x, y))
        result.reverse()
        return result

    def tip(self, q: Sequence[float]) -> tuple[float, float]:
        """End point (x, y) [m]."""
        x, y = self.levers(q)[0]
        return self.base[0] + x, self.base[1] + y

    def jacobian(self, q: Sequence[float]) -> Array:
        """Jacobian of (x, y), shape (2, n) [m/rad]."""
        levers = self.levers(q)
        return np.array(([-y for _, y in levers], [x for x, _ in levers]))


class PlanarChain(Generic[Number]):
    """Kinematics and dynamics of three uniform rods moving in a horizontal plane.

    Joint quantities are three floats, or arrays of shape (3, ...) for a batch; then ``functions`` is ``numpy``. Methods
    that take ``links`` save the trigonometry where ``links(q)`` is at hand.

    lengths: [m]. masses: [kg]. base: position of the first joint (x, y) [m].
    """

    @overload
    def __init__(self: PlanarChain[float], lengths: Floats, masses: Floats, base: Row[float] = ...) -> None: ...

    @overload
    def __init__(
        self: PlanarChain[Array], lengths: Floats, masses: Floats, base: Row[Real], functions: ModuleType
    ) -> None: ...

    def __init__(
        self, lengths: Floats, masses: Floats, base: Row[Real] = (0.0, 0.0), functions: ModuleType = math
    ) -> None:
        self.lengths = tuple(lengths)
        self.base: Row[Number] = cast("Row[Number]", base)
        self._sin, self._cos = functions.sin, functions.cos
        self._moments = [
            length * (mass / 2 + sum(masses[i + 1 :])) for i, (length, mass) in enumerate(zip(lengths, masses))
        ]
        # Kinetic energy is 1/2 sum c_ij cos(t_i - t_j) dt_i dt_j in the absolute link angles t.
        beyond = [sum(masses[i + 1 :]) for i in range(3)]
        self._diagonal = tuple(lengths[i] ** 2 * (masses[i] / 3 + beyond[i]) for i in range(3))
        self._weights = masses[1] / 2 + beyond[1], masses[2] / 2

    def links(self, q: Row[Number]) -> Links[Number]:
        """Projections of the three links [m]: l cos(t) of each, then l sin(t) of each, t the absolute angles."""
        t2 = q[0] + q[1]
        t3 = t2 + q[2]
        l1, l2, l3 = self.lengths
        sin, cos = self._sin, self._cos
        return l1 * cos(q[0]), l2 * cos(t2), l3 * cos(t3), l1 * sin(q[0]), l2 * sin(t2), l3 * sin(t3)

    def _coupling(self, links: Links[Number]) -> Links[Number]:
        """c_ij cos(t_j - t_i) and c_ij sin(t_j - t_i) of the link pairs 12, 23, 13 [kg m^2]."""
        c1, c2, c3, s1, s2, s3 = links
        second, third = self._weights
        return (
            second * (c1 * c2 + s1 * s2), third * (c2 * c3 + s2 * s3), third * (c1 * c3 + s1 * s3),
            second * (c1 * s2 - s1 * c2), third * (c2 * s3 - s2 * c3), third * (c1 * s3 - s1 * c3),
        )  # fmt: skip

    def forward(self, q: Row[Number], links: Known[Number] = None) -> tuple[Number, Number]:
        """Tip position (x, y) [m]."""
        c1, c2, c3, s1, s2, s3 = links or self.links(q)
        return self.base[0] + c1 + c2 + c3, self.base[1] + s1 + s2 + s3

    def jacobian(self, q: Row[Number], links: Known[Number] = None) -> tuple[Three[Number], Three[Number]]:
        """Rows of the 2 x 3 Jacobian of the tip [m/rad]."""
        c1, c2, c3, s1, s2, s3 = links or self.links(q)
        return (-s1 - s2 - s3, -s2 - s3, -s3), (c1 + c2 + c3, c2 + c3, c3)

    def approach(self, q: Row[Number], target: Row[Number], damping: float = 1e-3) -> Three[Number]:
        """One damped Newton step of the joint angles [rad] towards a tip position [m]; closed-loop inverse kinematics.

        damping: lambda [m] of the damped pseudo-inverse.
        """
        links = self.links(q)
        x, y = self.forward(q, links)
        a, b, c = self.rates(q, (target[0] - x, target[1] - y), damping, links)
        return q[0] + a, q[1] + b, q[2] + c

    def rates(
        self, q: Row[Number], velocity: tuple[Number, Number], damping: float = 0.0, links: Known[Number] = None
    ) -> Three[Number]:
        """Joint rates J^T (J J^T + lambda^2 I)^-1 V [rad/s] for a tip velocity V (x, y) [m/s]; damping: lambda [m]."""
        (x1, x2, x3), (y1, y2, y3) = self.jacobian(q, links)
        vx, vy = velocity
        xx = x1 * x1 + x2 * x2 + x3 * x3 + damping * damping
        yy = y1 * y1 + y2 * y2 + y3 * y3 + damping * damping
        xy = x1 * y1 + x2 * y2 + x3 * y3
        determinant = xx * yy - xy * xy
        u, v = (yy * vx - xy * vy) / determinant, (xx * vy - xy * vx) / determinant
        return x1 * u + y1 * v, x2 * u + y2 * v, x3 * u + y3 * v

    def tip_torque(self, q: Row[Number], force: tuple[Number, Number], links: Known[Number] = None) -> Three[Number]:
        """Joint torques J^T F [N m] of a force (x, y) [N] at the tip."""
        c1, c2, c3, s1, s2, s3 = links or self.links(q)
        x, y = force
        third = c3 * y - s3 * x
        second = c2 * y - s2 * x + third
        return c1 * y - s1 * x + second, second, third

    def centripetal(self, q: Row[Number], dq: Row[Number]) -> tuple[Number, Number]:
        """Acceleration (x, y) of the tip [m/s^2] at joint rates [rad/s] without joint accelerations."""
        c1, c2, c3, s1, s2, s3 = self.links(q)
        w1 = dq[0]
        w2 = w1 + dq[1]
        w3 = w2 + dq[2]
        w1, w2, w3 = w1 * w1, w2 * w2, w3 * w3
        return -c1 * w1 - c2 * w2 - c3 * w3, -s1 * w1 - s2 * w2 - s3 * w3

    def torque(self, q: Row[Number], dq: Row[Number], ddq: Row[Number]) -> Three[Number]:
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

    def gravity(self, q: Row[Number], acceleration: float = 9.81) -> Three[Number]:
        """Joint torques [N m] that hold the arm against gravity [m/s^2] along -y, where the plane is vertical."""
        t2 = q[0] + q[1]
        third = acceleration * self._moments[2] * self._cos(t2 + q[2])
        second = acceleration * self._moments[1] * self._cos(t2) + third
        return acceleration * self._moments[0] * self._cos(q[0]) + second, second, third

    def acceleration(
        self, q: Row[Number], dq: Row[Number], torque: Row[Number], links: Known[Number] = None
    ) -> Three[Number]:
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
