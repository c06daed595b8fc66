"""An arm from a URDF file: the chain of joints from the root to one link, with all that is fixed to it."""

from __future__ import annotations

import math
import xml.etree.ElementTree as xml
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Array
from dexrepro.robots.arm import GREY, Arm, Joint, Link, Pose, Shape

TURNING = ("revolute", "continuous")


def from_urdf(path: str, end: str, base: Sequence[float] = (0.0, 0.0, 0.0)) -> Arm:
    """The arm that a URDF file describes, up to the origin of the link ``end``, its end point.

    base: (x, y, z) or (x, y, z, roll, pitch, yaw) of the root link in the world [m, rad]. Links behind fixed joints
    count to the body that carries them; joints off the chain stand still at 0. Boxes, spheres and cylinders are seen,
    and touched if they are collision shapes; meshes are neither. Raises ValueError with one sentence where the file
    cannot be used.
    """
    if not Path(path).is_file():
        raise ValueError(f"there is no URDF file '{path}'")
    try:
        robot = xml.parse(path).getroot()
    except xml.ParseError as error:
        raise ValueError(f"'{path}' is no XML file: {error}") from None
    links = {_name(node): node for node in robot.iter("link")}
    into = {_name(node.find("child"), "link"): node for node in robot.iter("joint") if node.find("child") is not None}
    if end not in links:
        raise ValueError(f"'{path}' has no link '{end}'; there are: {', '.join(links)}")
    tree = _Tree(links, into)
    for node in into.values():
        if _name(node.find("parent"), "link") not in links:
            raise ValueError(f"joint '{_name(node)}' of '{path}' has no parent link that is in the file")
    chain = [node for node in tree.above(end) if node.get("type") != "fixed"]
    for node in chain:
        if node.get("type") not in TURNING:
            raise ValueError(
                f"joint '{_name(node)}' of '{path}' is {node.get('type')}; only revolute, continuous and fixed joints "
                "can move an arm"
            )
    if not chain:
        raise ValueError(f"no joint moves the link '{end}' of '{path}'")
    moving = [_name(node.find("child"), "link") for node in chain]
    root = _name(tree.above(end)[0].find("parent"), "link")
    origins = [tree.between(parent, child) for parent, child in zip([root, *moving], moving)]
    joints = tuple(_joint(node, Pose.of(origin)) for node, origin in zip(chain, origins))
    ends = [tree.between(a, b)[:3, 3] for a, b in zip(moving, [*moving[1:], end])]
    bodies = tuple(tree.body(name, set(moving), tip, path) for name, tip in zip(moving, ends))
    tip = Pose.of(tree.between(moving[-1], end))
    x, y, z, *turn = base
    placed = Pose((x, y, z), tuple(turn) or (0.0, 0.0, 0.0))  # type: ignore[arg-type]
    return Arm(Path(path).stem, joints, bodies, end=tip, base=placed)


class _Tree:
    """Links by name and the joint that leads into each."""

    def __init__(self, links: dict[str, xml.Element], into: dict[str, xml.Element]) -> None:
        self.links, self.into = links, into

    def above(self, name: str) -> list[xml.Element]:
        """Joints from the root to a link."""
        chain: list[xml.Element] = []
        while name in self.into:
            if self.into[name] in chain:
                raise ValueError(f"the joints form a loop at link '{name}'; they must form a tree")
            chain.insert(0, self.into[name])
            name = _name(chain[0].find("parent"), "link")
        return chain

    def between(self, ancestor: str, name: str) -> Array:
        """Transform (4, 4) of a link in the frame of an ancestor, all joints at 0."""
        result = np.eye(4)
        for node in self.above(name)[len(self.above(ancestor)) :]:
            result = result @ _pose(node).matrix
        return result

    def carried(self, name: str, moving: set[str]) -> Iterator[str]:
        """A link and those that move with it."""
        yield name
        for child, node in self.into.items():
            if child not in moving and _name(node.find("parent"), "link") == name:
                yield from self.carried(child, moving)

    def body(self, name: str, moving: set[str], tip: Array, path: str) -> Link:
        """One rigid body of a moving link and all it carries, about their common centre of mass."""
        parts, shapes = [], []
        for part in self.carried(name, moving):
            frame = self.between(name, part)
            shapes += _shapes(self.links[part], Pose.of(frame))
            if (inertial := self.links[part].find("inertial")) is not None:
                parts.append(_inertial(inertial, frame))
                if parts[-1][0] < 0:
                    raise ValueError(
                        f"link '{part}' of '{path}' has the mass {parts[-1][0]:g} kg; it must not be negative"
                    )
        if not parts:
            raise ValueError(f"link '{name}' of '{path}' moves but has no <inertial>")
        mass = sum(m for m, _, _ in parts)
        com = sum(m * c for m, c, _ in parts) / (mass or 1.0)
        total = np.zeros((3, 3))
        for m, centre, inertia in parts:
            offset = centre - com
            total += inertia + m * (offset @ offset * np.eye(3) - np.outer(offset, offset))
        if not shapes and np.linalg.norm(tip) > 0:
            shapes = [replace(Shape.between((0, 0, 0), tip.tolist(), 0.02), collides=False)]
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = total.tolist()
        return Link(name, float(mass), tuple(np.asarray(com).tolist()), (xx, xy, xz, yy, yz, zz), tuple(shapes))


def _name(node: xml.Element | None, attribute: str = "name") -> str:
    return "" if node is None else node.get(attribute, "")


def _floats(node: xml.Element | None, attribute: str, default: str) -> tuple[float, ...]:
    text = default if node is None else node.get(attribute, default)
    try:
        values = tuple(map(float, text.split()))
        if any(map(math.isnan, values)) or len(values) != len(default.split() or values):
            raise ValueError
    except ValueError:
        tag = "" if node is None else node.tag
        raise ValueError(
            f'<{tag} {attribute}="{text}"> does not hold {len(default.split()) or "finite"} numbers'
        ) from None
    return values


def _pose(node: xml.Element) -> Pose:
    origin = node.find("origin")
    return Pose(_floats(origin, "xyz", "0 0 0"), _floats(origin, "rpy", "0 0 0"))  # type: ignore[arg-type]


def _joint(node: xml.Element, origin: Pose) -> Joint:
    axis = np.array(_floats(node.find("axis"), "xyz", "1 0 0"))
    limit, bounded = node.find("limit"), node.get("type") == "revolute"
    (lower,), (upper,) = _floats(limit, "lower", "0"), _floats(limit, "upper", "0")
    if not np.any(axis):
        raise ValueError(f"joint '{_name(node)}' has the axis 0 0 0; it must have a direction")
    if bounded and lower > upper:
        raise ValueError(f"joint '{_name(node)}' has the limits {lower:g} to {upper:g}; the lower must not be above")
    (effort,), (velocity,) = _floats(limit, "effort", "inf"), _floats(limit, "velocity", "inf")
    return Joint(
        _name(node),
        origin,
        tuple((axis / np.linalg.norm(axis)).tolist()),
        lower if bounded else -math.inf,
        upper if bounded else math.inf,
        effort or math.inf,
        velocity or math.inf,
    )


def _inertial(node: xml.Element, frame: Array) -> tuple[float, Array, Array]:
    """Mass [kg], centre (3,) [m] and inertia about it (3, 3) [kg m^2] in the frame of the body that carries it."""
    pose = Pose.of(frame) @ _pose(node)
    moments = node.find("inertia")
    xx, xy, xz, yy, yz, zz = (_floats(moments, name, "0")[0] for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    turn = Rotation.from_euler("xyz", pose.rpy).as_matrix()
    inertia = turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
    return _floats(node.find("mass"), "value", "0")[0], np.array(pose.xyz), inertia


def _shapes(link: xml.Element, frame: Pose) -> list[Shape]:
    """Collision shapes, or else visual ones that touch nothing, in the frame of the body that carries them."""
    nodes = link.findall("collision")
    colour = _floats(link.find("visual/material/color"), "rgba", "")
    found = []
    for node in nodes or link.findall("visual"):
        geometry = node.find("geometry")
        for kind, names in {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length")}.items():
            if geometry is not None and (shape := geometry.find(kind)) is not None:
                size = tuple(
                    value for name in names for value in _floats(shape, name, "0 0 0" if kind == "box" else "0")
                )
                look = colour if len(colour) == 4 else GREY
                found.append(Shape(kind, size, frame @ _pose(node), look, collides=bool(nodes)))
    return found
