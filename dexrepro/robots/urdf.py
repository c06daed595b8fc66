"""An arm from a URDF file: the chain of joints from the root to one link, with all that is fixed to it."""

from __future__ import annotations

import difflib
import math
import os
import warnings
import xml.etree.ElementTree as xml
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Array
from dexrepro.robots.arm import GREY, Arm, Joint, Link, Pose, Shape
from dexrepro.robots.urdf_file import axis_of, by_name, floats, link_of, name_of, parsed, place, pose_of

TURNING = ("revolute", "continuous")
MESHES = (".stl", ".obj", ".dae")  # what the engine reads
TURN = 2 * math.pi + 0.01  # rad; what turns by more is likely to be in degrees
LARGEST = 10.0  # m; what is longer in an arm's file is likely to be in another unit
DENSEST = 1e8  # kg/m^3, 5000 times gold; so dense is a ball whose mass is in g, its moment in kg m^2
ROUNDING = 0.05
"""How far an inertia may be from a rigid body's and still be read: what its largest principal moment exceeds the sum of
the others by, or what its smallest is below zero, as a share of the largest. Makers' rounding stays below."""


def from_urdf(
    path: str,
    end: str,
    base: Sequence[float] = (0.0, 0.0, 0.0),
    root: str | None = None,
    packages: Mapping[str, str] | None = None,
) -> Arm:
    """The arm that a URDF file describes, up to the origin of the link ``end``, its end point.

    base: (x, y, z) or (x, y, z, roll, pitch, yaw) of the root link in the world [m, rad]. root: the link that stands
    in the world, by default the file's own root. packages: folders of the ROS packages that meshes are named by, where
    they are not above the file.

    Links behind fixed joints count to the body that carries them; joints off the chain stand still at 0. Boxes, spheres
    and cylinders are seen, and touched if they are collision shapes; visual meshes whose file is there are seen in
    pictures and touch nothing. An inertia within :data:`ROUNDING` of a rigid body's becomes one.
    Raises ValueError with one sentence where the file cannot be used; warns with one where it was mended.
    """
    if not _is_base(base):
        raise ValueError(f"base = {base} is not allowed: it must be x, y, z [m], or these with roll, pitch, yaw [rad]")
    if not isinstance(packages, Mapping | None):
        raise ValueError(f"packages = {packages} is not allowed: it must be names with folders, {{robot: ../robot}}")
    file = Path(os.path.expanduser(str(path)))
    try:
        tree = _Tree(parsed(file), file, {name: str(folder) for name, folder in (packages or {}).items()})
        arm = tree.arm(str(end), None if root is None else str(root), base)  # YAML makes a number of a link named 5
    except FileNotFoundError:
        raise ValueError(f"there is no URDF file '{path}'") from None
    except OSError as error:
        raise ValueError(f"cannot read the URDF file '{path}': {error.strerror}") from None
    except ValueError as error:
        raise ValueError(f"URDF file '{path}': {error}") from None
    if tree.mended:
        warnings.warn(f"URDF file '{path}': {'; '.join(tree.mended)}", stacklevel=2)
    return arm


def _is_base(base: object) -> bool:
    """Whether these are three or six numbers."""
    try:
        return np.array(base, dtype=float).shape in ((3,), (6,)) and not isinstance(base[0], str)  # type: ignore[index]
    except (TypeError, ValueError):
        return False


class _Tree:
    """Links by name and the joint that leads into each; ``mended``: what was not as it should be, as half sentences."""

    def __init__(self, robot: xml.Element, path: Path, packages: Mapping[str, str]) -> None:
        self.links = by_name(robot, "link")
        self.into: dict[str, xml.Element] = {}
        self.children: dict[str, list[str]] = {name: [] for name in self.links}
        self.path, self.packages, self.mended = path, packages, list[str]()
        self.zero: dict[str, list[str]] = {"effort": [], "velocity": []}  # joints with such a limit of 0
        for name, folder in packages.items():
            if not Path(folder).expanduser().is_dir():
                raise ValueError(f"packages.{name} = {folder} is not allowed: there is no such folder")
        for name, node in by_name(robot, "joint").items():
            node.set("type", node.get("type", "").strip().lower())
            for role in ("parent", "child"):
                if not (link := link_of(node, role)):
                    raise ValueError(f"joint '{name}' has no {role}; it needs <{role} link=\"...\"/>")
                if link not in self.links:
                    close = difflib.get_close_matches(link, self.links, n=1)
                    raise ValueError(
                        f"joint '{name}' names '{link}' as its {role}, and no link has that name"
                        f"{f'; did you mean {close[0]!r}?' if close else ''}"
                    )
            if (other := self.into.setdefault(link_of(node, "child"), node)) is not node:
                raise ValueError(
                    f"link '{link_of(node, 'child')}' hangs on two joints, '{name_of(other)}' and '{name}'"
                )
            self.children[link_of(node, "parent")].append(link_of(node, "child"))

    def arm(self, end: str, root: str | None, base: Sequence[float]) -> Arm:
        for name in (end, root):
            if name is not None and name not in self.links:
                close = difflib.get_close_matches(name, self.links, n=1)
                there = (
                    f"did you mean '{close[0]}'?" if close else f"there are: {', '.join([*self.links][:40]) or 'none'}"
                )
                raise ValueError(f"it has no link '{name}'; {there}")
        above = self.above(end)
        first = link_of(above[0], "parent") if above else end
        if root is None and (stray := [name for name in self.links if name not in self.into and name != first]):
            self.mended.append(f"link '{stray[0]}' hangs on no joint; only what hangs on '{first}' is read")
        root = root or first
        if len(self.above(root)) > len(above) or self.above(root) != above[: len(self.above(root))]:
            raise ValueError(f"link '{end}' does not hang on the link '{root}'")
        chain = [node for node in above[len(self.above(root)) :] if node.get("type") != "fixed"]
        if not chain:
            raise ValueError(f"no joint moves the link '{end}'")
        moving = [link_of(node, "child") for node in chain]
        self._check(chain, set(moving))
        joints = tuple(
            self._joint(node, Pose.of(self.between(parent, child)))
            for node, parent, child in zip(chain, [root, *moving], moving, strict=False)
        )
        for quantity, zero in self.zero.items():
            if zero:
                has = f"joints {', '.join(zero)} have" if len(zero) > 1 else f"joint '{zero[0]}' has"
                self.mended.append(f"{has} the {quantity} limit 0, which is taken for none")
        ends = [self.between(a, b)[:3, 3] for a, b in zip(moving, [*moving[1:], end], strict=True)]
        bodies, doubts = zip(*self._bodies(moving, ends))
        if off := [f"link {link.name} by {100 * share:.2g} %" for link, share in zip(bodies, doubts) if share > 1e-6]:
            self.mended.append(
                f"{', '.join(off)}: no rigid body has this inertia (a moment exceeds the sum of the other two, or is "
                f"negative, by that share of the largest); up to {100 * ROUNDING:g} % is taken for rounding and mended"
            )
        self.mended += _doubts(above, bodies)
        last, axis = bodies[-1], np.array(joints[-1].axis)
        if not axis @ last.inertia_matrix @ axis + last.mass * np.sum(np.cross(axis, last.com) ** 2) > 0:
            raise ValueError(f"link '{last.name}' has no inertia about joint '{joints[-1].name}'; give it one")
        stand = [shape for part, frame in self.carried(root, set(moving)) for shape in self.shapes(part, frame)]
        x, y, z, *turn = base
        if max(map(abs, turn), default=0.0) > TURN:
            self.mended.append(
                f"base = {[*base]} turns by {max(turn, key=abs):g} rad; its angles are in rad, not degrees"
            )
        placed = Pose((x, y, z), tuple(turn) or (0.0, 0.0, 0.0))  # type: ignore[arg-type]
        tip = Pose.of(self.between(moving[-1], end))
        return Arm(self.path.stem, joints, bodies, end=tip, base=placed, base_shapes=tuple(stand))

    def _check(self, chain: Sequence[xml.Element], moving: set[str]) -> None:
        """Refuse joints that no arm can have."""
        for node in chain:
            if (kind := node.get("type")) not in TURNING:
                ways = f"root: {link_of(node, 'child')} begins the arm behind it"
                if node is chain[-1]:
                    ways = f"end the arm before it, at {link_of(node, 'parent')}"
                raise ValueError(
                    f"joint '{name_of(node)}' is {kind or 'of no type'}; only revolute, continuous and fixed joints "
                    "can move an arm" + (f" ({ways})" if len(chain) > 1 else "")
                )
            if (mimic := node.find("mimic")) is not None:
                followed = f"joint '{mimic.get('joint')}'" if mimic.get("joint") else "a joint that it does not name"
                raise ValueError(
                    f"joint '{name_of(node)}' follows {followed} (mimic), but an arm's joints are "
                    f"free; end the arm before it, at {link_of(node, 'parent')}"
                )
        names = set(map(name_of, chain))
        for part in [part for name in moving for part, _ in self.carried(name, moving)]:
            mimic, kind = self.into[part].find("mimic"), self.into[part].get("type")
            if part not in moving and kind in ("floating", "planar"):
                self.mended.append(f"joint '{name_of(self.into[part])}' off the chain is {kind} and taken to be fixed")
            if mimic is not None and part not in moving and mimic.get("joint") in names:
                raise ValueError(
                    f"joint '{name_of(self.into[part])}' off the chain follows joint '{mimic.get('joint')}' of the arm "
                    "(mimic); a linkage that moves with the arm cannot be simulated"
                )

    def above(self, name: str) -> list[xml.Element]:
        """Joints from the root to a link."""
        chain: list[xml.Element] = []
        while name in self.into:
            if self.into[name] in chain:
                raise ValueError(f"the joints form a loop at link '{name}'; they must form a tree")
            chain.insert(0, self.into[name])
            name = link_of(chain[0], "parent")
        return chain

    def between(self, ancestor: str, name: str) -> Array:
        """Transform (4, 4) of a link in the frame of an ancestor, the joints between at 0."""
        result = np.eye(4)
        for node in self.above(name)[len(self.above(ancestor)) :]:
            result = self._behind(node, result)
        return result

    def _behind(self, node: xml.Element, frame: Array) -> Array:
        """Transform (4, 4) of a joint's child from that of its parent, the joint at 0."""
        behind: Array = frame @ pose_of(node).matrix @ self._still(node)
        return behind

    def _still(self, node: xml.Element) -> Array:
        """What a joint off the chain adds (4, 4): nothing at 0, or the offset of one that follows another (mimic)."""
        result, mimic = np.eye(4), node.find("mimic")
        offset = floats(mimic, "offset", "0")[0]
        if offset and node.get("type") == "prismatic":
            result[:3, 3] = offset * axis_of(node)
        elif offset and node.get("type") in TURNING:
            result[:3, :3] = Rotation.from_rotvec(offset * axis_of(node)).as_matrix()
        return result

    def carried(self, name: str, moving: set[str]) -> Iterator[tuple[str, Array]]:
        """A link and those that move with it, each with its transform (4, 4) in the frame of the first."""
        waiting = [(name, np.eye(4))]
        while waiting:
            part, frame = waiting.pop()
            yield part, frame
            still = [child for child in self.children[part] if child not in moving]
            waiting += [(child, self._behind(self.into[child], frame)) for child in reversed(still)]

    def _bodies(self, moving: Sequence[str], tips: Sequence[Array]) -> list[tuple[Link, float]]:
        """All of :meth:`body`. Says what is wrong with the first that is none, and which others are none."""
        found, wrong = [], dict[str, ValueError]()
        for name, tip in zip(moving, tips, strict=True):
            try:
                found.append(self.body(name, set(moving), tip))
            except ValueError as error:
                wrong[name] = error
        if wrong:
            first, *others = wrong
            more = f"; {', '.join(others)} cannot be used, either" if others else ""
            raise ValueError(f"{wrong[first]}{more}")
        return found

    def body(self, name: str, moving: set[str], tip: Array) -> tuple[Link, float]:
        """One rigid body of a moving link and all it carries, about their common centre of mass, and by which share
        its inertia was none of a rigid body."""
        parts, shapes = [], list[Shape]()
        for part, frame in self.carried(name, moving):
            shapes += self.shapes(part, frame)
            if (inertial := self.links[part].find("inertial")) is not None:
                parts.append((part, *_inertial(inertial, frame)))
                if inertial.find("inertia") is None:
                    self.mended.append(f"link '{part}' has no <inertia>, and is taken for a point mass")
                if parts[-1][1] < 0:
                    raise ValueError(f"link '{part}' has the mass {parts[-1][1]:g} kg; it must not be negative")
        mass = sum(m for _, m, _, _ in parts)
        if not parts or mass == 0:
            has = "has the mass 0 kg" if parts else "has no <inertial>"
            raise ValueError(f"link '{name}' moves but {has}; give it a mass, or fix its joint")
        com = sum(m * c for _, m, c, _ in parts) / mass
        total = np.zeros((3, 3))
        for _, m, centre, inertia in parts:
            offset = centre - com
            total += inertia + m * (offset @ offset * np.eye(3) - np.outer(offset, offset))
        rigid, share = _rigid(total, mass)
        if share > ROUNDING:
            worst, _, _, inertia = max(parts, key=lambda part: _rigid(part[3], part[1])[1])
            a, b, c = np.linalg.eigvalsh(inertia)
            raise ValueError(
                f"link '{worst}' has the principal moments {a:.4g}, {b:.4g} and {c:.4g} kg m^2 of no rigid body: "
                "none may be negative or exceed the sum of the other two (by more than "
                f"{100 * ROUNDING:g} % of the largest); compute its <inertia> from mass and shape"
            )
        if all(shape.mesh for shape in shapes) and np.linalg.norm(tip) > 0:
            shapes.append(replace(Shape.between((0, 0, 0), tip.tolist(), 0.02), collides=False))
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = rigid.tolist()
        return Link(name, float(mass), tuple(np.asarray(com).tolist()), (xx, xy, xz, yy, yz, zz), tuple(shapes)), share

    def shapes(self, part: str, at: Array) -> list[Shape]:
        """Collision shapes, or else visual ones that touch nothing, and visual meshes, of a link that stands ``at``
        (4, 4) in the frame of what carries it."""
        link = self.links[part]
        solid, visual = link.findall("collision"), link.findall("visual")
        if not solid and not visual:
            return []
        colour = floats(link.find("visual/material/color"), "rgba", "")
        look = colour if len(colour) == 4 else GREY
        frame, found = Pose.of(at), list[Shape]()
        for node in solid or visual:
            geometry = node.find("geometry")
            for kind, names in {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length")}.items():
                if geometry is not None and (shape := geometry.find(kind)) is not None:
                    size = tuple(
                        value for name in names for value in floats(shape, name, "0 0 0" if kind == "box" else "0")
                    )
                    if min(size) < 0:
                        raise ValueError(f"{place(shape, names[0])} of link '{part}' has a negative size")
                    found.append(Shape(kind, size, frame @ pose_of(node), look, collides=bool(solid)))
        for node in visual:
            mesh = node.find("geometry/mesh")
            if mesh is not None and (file := self._mesh(mesh.get("filename", ""))):
                scale = floats(mesh, "scale", "")[:3] or (1.0, 1.0, 1.0)  # some files have a fourth number
                if len(scale) < 3 or not all(scale):
                    raise ValueError(f"{place(mesh, 'scale')} must hold three numbers, none of them 0")
                found.append(Shape("mesh", scale, frame @ pose_of(node), look, collides=False, mesh=str(file)))
        return found

    def _mesh(self, name: str) -> Path | None:
        """The file of a mesh, if it is there: beside the URDF file, or in a package of the user's or above the file."""
        scheme, _, rest = name.rpartition("://")
        if scheme in ("package", "model"):
            package, _, rest = rest.partition("/")
            above = [folder if folder.name == package else folder / package for folder in self.path.resolve().parents]
            folders = [Path(self.packages[package]).expanduser()] if package in self.packages else above
        else:
            folders = [self.path.parent]
        found = [(folder / rest).resolve() for folder in folders if os.path.isfile(folder / rest)]
        return found[0] if found and found[0].suffix.lower() in MESHES else None

    def _joint(self, node: xml.Element, origin: Pose) -> Joint:
        name, limit, bounded = name_of(node), node.find("limit"), node.get("type") == "revolute"
        (lower,), (upper,) = floats(limit, "lower", "0"), floats(limit, "upper", "0")
        (effort,), (velocity,) = floats(limit, "effort", "inf"), floats(limit, "velocity", "inf")
        if bounded and lower > upper:
            raise ValueError(f"joint '{name}' has the limits {lower:g} to {upper:g}; the lower must not be above")
        for quantity, value in {"effort": effort, "velocity": velocity}.items():
            if value < 0:
                raise ValueError(f"joint '{name}' has the {quantity} limit {value:g}; it must not be negative")
            if value == 0:
                self.zero[quantity].append(name)
        if bounded and lower == upper:
            if lower:
                raise ValueError(f"joint '{name}' has the limits {lower:g} to {upper:g}; it cannot move")
            self.mended.append(f"joint '{name}' has no limits or 0 to 0, and is taken to be without")
            bounded = False
        if bounded and 2 * TURN < max(-lower, upper) <= 360:
            self.mended.append(f"joint '{name}' has the limits {lower:g} to {upper:g}; they are in rad, not in degrees")
        bounds = (lower, upper) if bounded else (-math.inf, math.inf)
        return Joint(name, origin, tuple(axis_of(node).tolist()), *bounds, effort or math.inf, velocity or math.inf)


def _doubts(above: Sequence[xml.Element], bodies: Sequence[Link]) -> Iterator[str]:
    """What can be simulated but no arm has, so that another unit than rad, m or kg is likely."""
    for node in above:
        turn = floats(node.find("origin"), "rpy", "0 0 0")
        if max(map(abs, turn)) > TURN:
            shown = " ".join(f"{angle:g}" for angle in turn)
            yield f"joint '{name_of(node)}' has the rpy {shown}; it is in rad, not in degrees"
        if (away := math.hypot(*floats(node.find("origin"), "xyz", "0 0 0"))) > LARGEST:
            yield f"joint '{name_of(node)}' stands {away:g} m from what carries it; lengths are in m"
    for link in bodies:
        if (away := math.hypot(*link.com)) > LARGEST:
            yield f"link '{link.name}' has its centre of mass {away:g} m from its joint; lengths are in m"
        moment = max(float(np.linalg.eigvalsh(link.inertia_matrix)[-1]), 0.0)
        radius = math.sqrt(2.5 * moment / link.mass)  # of a ball
        if radius > LARGEST / 2 or 0 < 4 / 3 * math.pi * radius**3 * DENSEST < link.mass:
            yield f"link '{link.name}' has {moment:g} kg m^2 at {link.mass:g} kg; its units are kg and m"


def _inertial(node: xml.Element, frame: Array) -> tuple[float, Array, Array]:
    """Mass [kg], centre (3,) [m] and inertia about it (3, 3) [kg m^2] in the frame of the body that carries it."""
    pose = Pose.of(frame) @ pose_of(node)
    moments = node.find("inertia")
    xx, xy, xz, yy, yz, zz = (floats(moments, name, "0")[0] for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    turn = Rotation.from_euler("xyz", pose.rpy).as_matrix()
    inertia = turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
    return floats(node.find("mass"), "value", "0")[0], np.array(pose.xyz), inertia


def _rigid(inertia: Array, mass: float) -> tuple[Array, float]:
    """An inertia (3, 3) that a rigid body can have, and how far the given one is off, a share of its largest moment
    (of a point mass: of that at a radius of 1 um). Its smallest and largest moments bear the change, which goes the
    1e-12 further that the engine's test needs to survive rounding."""
    moments, axes = np.linalg.eigh(inertia)
    largest = max(moments[2], 1e-12 * mass, 1e-300)
    share = max(-moments[0], moments[2] - moments[0] - moments[1], 0.0) / largest
    low, middle, high = np.maximum(moments, 0.0)
    excess = high - (low + middle) * (1 - 1e-12)
    if not share and excess <= 0:
        return inertia, 0.0
    mended = np.array((low, middle, high)) + max(excess, 0.0) / 2 * np.array((1, 0, -1))
    return axes @ np.diag(mended) @ axes.T, float(share)
