"""What an arm is: joints, links, shapes, an optional tool, and the URDF text a physics engine loads.

An :class:`Arm` is plain data, valid without any physics engine. Lengths in m, masses in kg, angles in rad.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Array

Vector = tuple[float, float, float]
Colour = tuple[float, float, float, float]
Inertia = tuple[float, float, float, float, float, float]
GREY: Colour = (0.62, 0.62, 0.65, 1.0)


class InvalidInertia(ValueError):
    """A link's inertia is not that of a rigid body; physics engines drop such inertias silently."""


@dataclass(frozen=True)
class Pose:
    """Position [m] and roll, pitch, yaw [rad] (URDF convention, Rz(yaw) Ry(pitch) Rx(roll)) in the parent frame."""

    xyz: Vector = (0.0, 0.0, 0.0)
    rpy: Vector = (0.0, 0.0, 0.0)

    @cached_property
    def matrix(self) -> Array:
        """Homogeneous transform, shape (4, 4), that takes child coordinates to the parent frame."""
        result = np.eye(4)
        result[:3, :3] = Rotation.from_euler("xyz", self.rpy).as_matrix()
        result[:3, 3] = self.xyz
        return result

    @property
    def quaternion(self) -> tuple[float, float, float, float]:
        """Orientation as (x, y, z, w)."""
        return tuple(Rotation.from_euler("xyz", self.rpy).as_quat().tolist())

    @classmethod
    def of(cls, matrix: ArrayLike) -> Pose:
        """Pose of a homogeneous transform of shape (4, 4)."""
        m = np.asarray(matrix, dtype=float)
        cosine = math.hypot(m[0, 0], m[1, 0])
        if cosine > 1e-6:
            return cls(tuple(m[:3, 3].tolist()), tuple(Rotation.from_matrix(m[:3, :3]).as_euler("xyz").tolist()))
        yaw = math.atan2(m[1, 0], m[0, 0])  # roll and yaw turn about one axis: any yaw will do, roll makes up for it
        c, s = math.cos(yaw), math.sin(yaw)
        roll = math.atan2(s * m[0, 2] - c * m[1, 2], c * m[1, 1] - s * m[0, 1])
        return cls(tuple(m[:3, 3].tolist()), (roll, math.atan2(-m[2, 0], cosine), yaw))

    def __matmul__(self, other: Pose) -> Pose:
        return Pose.of(self.matrix @ other.matrix)


@dataclass(frozen=True)
class Shape:
    """Geometry in a link frame, seen by contacts and cameras.

    kind: "box" with size (x, y, z) [m]; "sphere" with (radius,); "capsule" and "cylinder" with (radius, length) along
    the local z axis, the capsule's length without its caps; "mesh" with its scale (x, y, z), seen in pictures alone.
    """

    kind: str
    size: tuple[float, ...]
    pose: Pose = Pose()
    colour: Colour = GREY
    collides: bool = True
    mesh: str = ""

    @classmethod
    def between(cls, start: Sequence[float], end: Sequence[float], radius: float, colour: Colour = GREY) -> Shape:
        """Capsule of a radius [m] whose axis runs between two points [m] of the link frame."""
        a, b = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
        x, y, z = (b - a).tolist()
        pitch, yaw = math.atan2(math.hypot(x, y), z), math.atan2(y, x)
        middle = tuple(((a + b) / 2).tolist())
        return cls("capsule", (radius, math.hypot(x, y, z)), Pose(middle, (0.0, pitch, yaw)), colour)

    def urdf(self, seen: bool = True) -> str:
        """Its ``<visual>``, if it is to be seen, and ``<collision>``, where it collides, of a URDF link."""
        names = {"box": "size", "sphere": "radius", "mesh": "scale"}
        if self.kind in names:
            attributes = f"{names[self.kind]}={quoteattr(_numbers(self.size))}"
        else:
            attributes = f"radius='{self.size[0]!r}' length='{self.size[1]!r}'"
        if self.mesh:
            attributes += f" filename={quoteattr(self.mesh)}"
        body = f"{_origin(self.pose)}<geometry><{self.kind} {attributes}/></geometry>"
        name = f"c{hash(self.colour) & 0xFFFFFFFF:x}"
        paint = f"<material name='{name}'><color rgba={quoteattr(_numbers(self.colour))}/></material>"
        collision = f"<collision>{body}</collision>" if self.collides else ""
        return (f"<visual>{body}{paint}</visual>" if seen else "") + collision


def _shapes(shapes: Sequence[Shape], meshes: bool) -> str:
    """Shapes as URDF text; where meshes are wanted and there are any, they are seen in the place of the others."""
    meshes = meshes and any(shape.mesh for shape in shapes)
    return "".join(shape.urdf(seen=bool(shape.mesh) == meshes) for shape in shapes)


@dataclass(frozen=True)
class Link:
    """A rigid body: mass [kg], centre of mass [m] in the link frame, inertia about it and the shapes it shows.

    inertia: (ixx, ixy, ixz, iyy, iyz, izz) [kg m^2] about the centre of mass, along the axes of the link frame.
    Raises InvalidInertia if the principal moments are negative or break the triangle inequality.
    """

    name: str
    mass: float
    com: Vector
    inertia: Inertia
    shapes: tuple[Shape, ...] = ()

    def __post_init__(self) -> None:
        a, b, c = np.linalg.eigvalsh(self.inertia_matrix)
        if self.mass <= 0 or a < 0 or c > (a + b) * (1 + 1e-9):
            raise InvalidInertia(
                f"link '{self.name}': mass {self.mass:g} kg with principal moments ({a:.4g}, {b:.4g}, {c:.4g}) kg m^2 "
                "is no rigid body; each moment must be at most the sum of the other two"
            )

    @property
    def inertia_matrix(self) -> Array:
        """Inertia (3, 3) [kg m^2] about the centre of mass, along the axes of the link frame."""
        xx, xy, xz, yy, yz, zz = self.inertia
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

    def scaled(self, factor: float) -> Link:
        """The same body with mass and inertia multiplied by a factor."""
        scaled = _scaled(self.inertia, factor)
        return replace(self, mass=factor * self.mass, inertia=scaled)

    def urdf(self, meshes: bool = False) -> str:
        """Its ``<link>`` of a URDF file; meshes: seen in the place of the other shapes, if it has some."""
        names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        inertia = " ".join(f"{name}='{float(value)!r}'" for name, value in zip(names, self.inertia, strict=True))
        inertial = f"{_origin(Pose(self.com))}<mass value='{float(self.mass)!r}'/><inertia {inertia}/>"
        shapes = _shapes(self.shapes, meshes)
        return f"<link name={quoteattr(self.name)}><inertial>{inertial}</inertial>{shapes}</link>"


@dataclass(frozen=True)
class Joint:
    """A revolute joint: pose of the child link in the parent at angle 0, axis in the child frame, limits.

    lower, upper [rad] (infinite: none), effort [N m], velocity [rad/s].
    """

    name: str
    origin: Pose
    axis: Vector = (0.0, 0.0, 1.0)
    lower: float = -math.inf
    upper: float = math.inf
    effort: float = math.inf
    velocity: float = math.inf


@dataclass(frozen=True)
class Tool:
    """What an arm carries at its end frame.

    mount: pose of the tool frame in the arm's end frame; tip: pose of the tool's end point in the tool frame.
    mass [kg], com [m] and inertia (about com) in the tool frame; a tool of mass 0 moves the end point and shows its
    shapes, no more. replaces: names of arm links whose shapes the tool takes the place of (their inertia stays).
    """

    name: str = "tool"
    mount: Pose = Pose()
    tip: Pose = Pose()
    mass: float = 0.0
    com: Vector = (0.0, 0.0, 0.0)
    inertia: Inertia = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    shapes: tuple[Shape, ...] = ()
    replaces: tuple[str, ...] = ()


@dataclass(frozen=True)
class Arm:
    """A serial arm on a fixed base.

    joints[i] moves links[i]. ``fixed`` are bodies rigidly behind the last moving link, each with its pose in the body
    before. ``end`` is the end frame in the last of all bodies; a tool is mounted there. ``base`` is the pose of the
    arm's base in the world; positions and Jacobians of an arm are always in the world frame.
    """

    name: str
    joints: tuple[Joint, ...]
    links: tuple[Link, ...]
    fixed: tuple[tuple[Pose, Link], ...] = ()
    end: Pose = Pose()
    tool: Tool | None = None
    base: Pose = Pose()
    base_shapes: tuple[Shape, ...] = ()

    @property
    def dof(self) -> int:
        """Number n of joints."""
        return len(self.joints)

    @cached_property
    def effort(self) -> Array:
        """Largest joint torques [N m], shape (n,)."""
        return np.array([joint.effort for joint in self.joints])

    @cached_property
    def lower(self) -> Array:
        """Lower joint limits [rad], shape (n,)."""
        return np.array([joint.lower for joint in self.joints])

    @cached_property
    def upper(self) -> Array:
        """Upper joint limits [rad], shape (n,)."""
        return np.array([joint.upper for joint in self.joints])

    @cached_property
    def speed(self) -> Array:
        """Largest joint speeds [rad/s], shape (n,)."""
        return np.array([joint.velocity for joint in self.joints])

    @cached_property
    def origins(self) -> tuple[Array, ...]:
        """Transforms parent -> child at angle 0, (4, 4) each; the first one starts in the world frame."""
        first, *rest = (joint.origin.matrix for joint in self.joints)
        return (self.base.matrix @ first, *rest)

    @cached_property
    def axes(self) -> Array:
        """Joint axes in the frames of their links, shape (n, 3)."""
        return np.array([joint.axis for joint in self.joints])

    @cached_property
    def turns(self) -> tuple[Array, Array, Array]:
        """O, O K and O K^2 of every joint, (n, 4, 4) each: its origin and the cross-product matrix of its axis.

        Turned by an angle q, the transform is O + sin(q) O K + (1 - cos(q)) O K^2 (Rodrigues' formula).
        """
        origins = np.array(self.origins)
        cross = np.zeros_like(origins)
        for matrix, (x, y, z) in zip(cross, self.axes, strict=True):
            matrix[:3, :3] = ((0, -z, y), (z, 0, -x), (-y, x, 0))
        return origins, origins @ cross, origins @ cross @ cross

    @cached_property
    def tip(self) -> Array:
        """Transform of the end point (of the tool, if there is one) in the last moving link, (4, 4)."""
        transform = np.eye(4)
        for pose, _ in self.fixed:
            transform = transform @ pose.matrix
        transform = transform @ self.end.matrix
        if self.tool:
            transform = transform @ self.tool.mount.matrix @ self.tool.tip.matrix
        return transform

    @cached_property
    def is_planar(self) -> bool:
        """True if every joint turns about the world's z axis and the end point stays in one plane z = const."""
        return all(
            np.allclose(origin[:3, :3] @ axis, (0, 0, 1)) and np.allclose(origin[2, :3], (0, 0, 1))
            for origin, axis in zip(self.origins, (joint.axis for joint in self.joints), strict=True)
        )

    def placed(self, base: Pose) -> Arm:
        """The same arm with its base elsewhere in the world [m, rad]."""
        return replace(self, base=base)

    def scaled(self, factor: float) -> Arm:
        """The same arm with the masses and inertias of all bodies, tool included, multiplied by a factor."""
        tool = self.tool
        if tool:
            scaled = _scaled(tool.inertia, factor)
            tool = replace(tool, mass=factor * tool.mass, inertia=scaled)
        fixed = tuple((pose, link.scaled(factor)) for pose, link in self.fixed)
        return replace(self, links=tuple(link.scaled(factor) for link in self.links), fixed=fixed, tool=tool)

    @cached_property
    def bodies(self) -> tuple[tuple[Pose, Link], ...]:
        """The bodies behind the last moving link, tool included, each with its pose in the body before it."""
        if not (self.tool and self.tool.mass > 0):
            return self.fixed
        tool = self.tool
        link = Link(tool.name, tool.mass, tool.com, tool.inertia, tool.shapes)
        return (*self.fixed, (self.end @ tool.mount, link))

    @cached_property
    def shown(self) -> tuple[Link, ...]:
        """The root link "world", then every body, each with the shapes that it shows."""
        hidden = self.tool.replaces if self.tool else ()
        bodies = [*self.links, *(link for _, link in self.bodies)]
        links = [replace(link, shapes=() if link.name in hidden else link.shapes) for link in bodies]
        if self.tool and self.tool.mass == 0:
            mount = self.end @ self.tool.mount
            shapes = tuple(replace(shape, pose=mount @ shape.pose) for shape in self.tool.shapes)
            links[-1] = replace(links[-1], shapes=(*links[-1].shapes, *shapes))
        base = tuple(replace(shape, pose=self.base @ shape.pose) for shape in self.base_shapes)
        return (Link("world", 1.0, (0, 0, 0), (1, 0, 0, 1, 0, 1), base), *links)

    def urdf(self, meshes: bool = False) -> str:
        """The arm as URDF text: root link "world", then one link for every body, all with explicit inertials.

        meshes: seen in the place of the other shapes, where a body has some.
        One element a line: PyBullet breaks lines of more than 8 kB anywhere, even within a number.
        """
        links = self.shown
        chain = [_revolute(joint, Pose.of(origin)) for joint, origin in zip(self.joints, self.origins, strict=True)]
        chain += [_fixed(link.name, pose) for pose, link in self.bodies]
        joints = [joint(parent.name, child.name) for joint, (parent, child) in zip(chain, pairwise(links))]
        body = "".join([link.urdf(meshes) for link in links] + joints)
        return f"<robot name={quoteattr(self.name)}>{body}</robot>".replace("><", ">\n<")


def _scaled(inertia: Inertia, factor: float) -> Inertia:
    xx, xy, xz, yy, yz, zz = inertia
    return factor * xx, factor * xy, factor * xz, factor * yy, factor * yz, factor * zz


@dataclass(frozen=True)
class _JointText:
    kind: str
    name: str
    body: str = field(repr=False)

    def __call__(self, parent: str, child: str) -> str:
        ends = f"<parent link={quoteattr(parent)}/><child link={quoteattr(child)}/>"
        return f"<joint name={quoteattr(self.name)} type='{self.kind}'>{ends}{self.body}</joint>"


def _revolute(joint: Joint, origin: Pose) -> _JointText:
    bounded = math.isfinite(joint.lower) and math.isfinite(joint.upper)
    limits = f"lower='{joint.lower!r}' upper='{joint.upper!r}' " if bounded else ""
    effort, velocity = (value if math.isfinite(value) else 1e9 for value in (joint.effort, joint.velocity))
    limit = f"<limit {limits}effort='{effort!r}' velocity='{velocity!r}'/>"
    body = f"{_origin(origin)}<axis xyz='{_numbers(joint.axis)}'/>{limit}"
    return _JointText("revolute" if bounded else "continuous", joint.name, body)


def _fixed(name: str, origin: Pose) -> _JointText:
    return _JointText("fixed", f"{name}_mount", _origin(origin))


def _numbers(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def _origin(pose: Pose) -> str:
    return f"<origin xyz='{_numbers(pose.xyz)}' rpy='{_numbers(pose.rpy)}'/>"
