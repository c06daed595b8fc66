"""A soft object with mass between the end points of two arms: viscoelastic squeeze and friction at both contacts."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from dexrepro.arrays import Real
from dexrepro.physics.elements import Ends
from dexrepro.physics.plant import RigidBody, SimulatedArm
from dexrepro.robots.rotations import rotated

Vector = tuple[float, float, float]


class Cushion:
    """One side of a soft object: an elastic, a fast and a slow Maxwell branch in parallel, compression only.

    stiffness: of the whole object [N/m], two sides in series; fast, slow: the branches' shares of the elastic
    stiffness [-], with their times fast_time, slow_time [s]; dt: time step [s]. Works on numbers and on arrays.
    """

    def __init__(
        self, stiffness: Real, dt: float, *, fast: float, slow: float, fast_time: float, slow_time: float
    ) -> None:
        self.side, self.fast, self.slow = 2.0 * stiffness, fast, slow
        self.fast_share, self.slow_share = -math.expm1(-dt / fast_time), -math.expm1(-dt / slow_time)
        self.fast_state: Real = 0.0
        self.slow_state: Real = 0.0

    def force(self, compression: Real, scale: Real = 1.0) -> Real:
        """Force [N] of a compression [m], the elastic branch multiplied by ``scale``; one call a time step.

        The branches relax where there is a gap, which is a negative compression.
        """
        compression = compression * (compression > 0.0)  # type: ignore[assignment]  # as wide as numpy says
        self.fast_state = self.fast_state + self.fast_share * (compression - self.fast_state)
        self.slow_state = self.slow_state + self.slow_share * (compression - self.slow_state)
        branches = self.fast * (compression - self.fast_state) + self.slow * (compression - self.slow_state)
        force = self.side * (scale * compression + branches)
        return force * ((force > 0.0) & (compression > 0.0)) if isinstance(force, np.ndarray) else (
            force if force > 0.0 < compression else 0.0
        )  # fmt: skip


class SoftObject:
    """Force element that squeezes a rigid body between two arms.

    body: name of the body, whose centre is the middle of the object; arms: names of the two arms; length: free
    distance [m] of their end points; cushions: one a side. friction: Coulomb coefficient; shear, shear_damping:
    tangential stiffness [N/m] and damping [N s/m] of a contact that sticks. scale: factor of the elastic stiffness as
    a function of time [s]. Channels: force_<arm> [N] along the line of the end points, slip [m], the distance slid.
    """

    def __init__(
        self,
        name: str,
        body: str,
        arms: tuple[str, str],
        cushions: tuple[Cushion, Cushion],
        *,
        length: float,
        friction: float,
        shear: float,
        shear_damping: float,
        scale: Callable[[float], float],
    ) -> None:
        self.name, self.body, self.arms, self.cushions = name, body, arms, cushions
        self.length, self.friction, self.shear, self.shear_damping = length, friction, shear, shear_damping
        self.scale = scale
        self.forces, self.slip = [0.0, 0.0], 0.0

    def bind(self, world: Ends) -> Callable[[float], None]:
        ends = [world.arm(name) for name in self.arms]
        body = world.bodies[self.body]
        anchors: list[Vector | None] = [None, None]

        def apply(time: float) -> None:
            a, b = ends
            nx, ny, nz = b.x - a.x, b.y - a.y, b.z - a.z
            distance = math.sqrt(nx * nx + ny * ny + nz * nz) or 1e-12
            line = nx / distance, ny / distance, nz / distance
            along = line[0] * (body.x - a.x) + line[1] * (body.y - a.y) + line[2] * (body.z - a.z)
            scale, half = self.scale(time), 0.5 * self.length
            for side, gap in enumerate((along, distance - along)):
                force = float(self.cushions[side].force(half - gap, scale))
                self.forces[side] = force
                if force == 0.0:
                    anchors[side] = None
                    continue
                end, inward = ends[side], (-force if side else force)
                (dx, dy, dz), anchors[side] = self._stick(end, body, line, force, anchors[side])
                fx, fy, fz = inward * line[0] + dx, inward * line[1] + dy, inward * line[2] + dz
                end.push(-fx, -fy, -fz)
                body.push_at((fx, fy, fz), (end.x, end.y, end.z))

        return apply

    def _stick(
        self, end: SimulatedArm, body: RigidBody, line: Vector, normal: float, anchor: Vector | None
    ) -> tuple[Vector, Vector]:
        """Friction force on the body [N] and the point of the body, in its frame, that the end point sticks to."""
        rx, ry, rz = end.x - body.x, end.y - body.y, end.z - body.z
        if anchor is None:
            anchor = rotated(_inverse(body.orientation), (rx, ry, rz))
        ax, ay, az = rotated(body.orientation, anchor)
        wx, wy, wz = body.spin
        offset = _across((rx - ax, ry - ay, rz - az), line)
        rate = _across(
            (
                end.vx - body.vx - wy * rz + wz * ry,
                end.vy - body.vy - wz * rx + wx * rz,
                end.vz - body.vz - wx * ry + wy * rx,
            ),
            line,
        )
        k, d = self.shear, self.shear_damping
        px, py, pz = k * offset[0] + d * rate[0], k * offset[1] + d * rate[1], k * offset[2] + d * rate[2]
        size, limit = math.sqrt(px * px + py * py + pz * pz), self.friction * normal
        if size <= limit:
            return (px, py, pz), anchor
        share = limit / size
        px, py, pz = share * px, share * py, share * pz
        # The anchor follows until the elastic part alone gives the largest friction.
        mx, my, mz = offset[0] - px / k, offset[1] - py / k, offset[2] - pz / k
        self.slip += math.sqrt(mx * mx + my * my + mz * mz)
        return (px, py, pz), rotated(_inverse(body.orientation), (ax + mx, ay + my, az + mz))

    def channels(self) -> dict[str, float]:
        return {f"force_{arm}": force for arm, force in zip(self.arms, self.forces)} | {"slip": self.slip}


def _across(vector: Vector, line: Vector) -> Vector:
    """Part of a vector across a unit line."""
    along = vector[0] * line[0] + vector[1] * line[1] + vector[2] * line[2]
    return vector[0] - along * line[0], vector[1] - along * line[1], vector[2] - along * line[2]


def _inverse(quaternion: tuple[float, ...]) -> tuple[float, ...]:
    """Inverse of a unit quaternion (x, y, z, w)."""
    i, j, k, w = quaternion
    return -i, -j, -k, w
