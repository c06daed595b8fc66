"""The XML of a URDF file: its elements by name and the numbers in their attributes, or what is wrong with them."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as xml
from pathlib import Path
from xml.parsers import expat

import numpy as np
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Array
from dexrepro.robots.arm import Pose
from dexrepro.text import decoded

FOREIGN = {
    "mujoco": "an MJCF file of MuJoCo",
    "mujocoinclude": "a part of an MJCF file of MuJoCo",
    "sdf": "an SDF file of Gazebo",
    "COLLADA": "a COLLADA mesh",
}
SEMANTIC = {"group", "group_state", "end_effector", "virtual_joint", "disable_collisions"}  # of an SRDF file of MoveIt
NEEDED = ("value", "ixx", "iyy", "izz", "size", "radius", "length")  # of an element that is there, as in ROS
TAGS = {"link", "joint", "parent", "child", "origin", "axis", "limit", "mimic", "inertial", "mass", "inertia", "visual",
        "collision", "geometry"}  # fmt: skip
LONGEST = 255  # letters of a name; PyBullet ends the process for some thousand bytes


def parsed(path: Path) -> xml.Element:
    """The root element <robot>. Prefixes stay part of the names: many published files do not declare theirs."""
    data = path.read_bytes()
    declared = re.match(rb"\s*<\?xml[^>]*encoding=[\"']([\w.-]+)", data)
    eight_bits = declared and not declared[1].lower().startswith(b"utf")
    text = decoded(data, declared[1].decode() if declared and eight_bits else None)
    if not text.strip():
        raise ValueError("it is empty")
    text = re.sub(r"<\?xml\s.*?\?>", "", text, count=1, flags=re.DOTALL)  # it may stand behind a comment
    # What ROS reads of comments, "--" within them, no strict parser does.
    text = re.sub("<!--.*?-->", lambda comment: "\n" * comment[0].count("\n"), text, flags=re.DOTALL)
    builder, parser = xml.TreeBuilder(element_factory=_Node), expat.ParserCreate("utf-8")

    def start(tag: str, attributes: dict[str, str]) -> None:
        builder.start(tag, attributes).line = parser.CurrentLineNumber  # type: ignore[attr-defined]

    def elsewhere(_name: str, _base: str | None, file: str | None, _public: str | None) -> int:
        raise ValueError(f"it takes in another file, '{file}', which is not read; put the text of that in its place")

    parser.StartElementHandler, parser.EndElementHandler = start, builder.end
    parser.ExternalEntityRefHandler, parser.CharacterDataHandler = elsewhere, builder.data
    try:
        parser.Parse(text.rstrip().encode(), True)
    except expat.ExpatError as error:
        raise ValueError(f"it is no XML file: {error}") from None
    robot = builder.close()
    if robot.tag != "robot":
        raise ValueError(f"it is {FOREIGN.get(robot.tag, 'no URDF')}: it begins with <{robot.tag}> instead of <robot>")
    parts = [part for child in robot if child.tag in ("link", "joint") for part in child.iter()]
    if any(node.tag.startswith("xacro:") for node in robot.iter()) or any(
        "${" in value or "$(" in value for part in parts for value in part.attrib.values()
    ):
        raise ValueError("it still holds xacro; turn it into URDF first: xacro FILE > arm.urdf")
    for node in [*robot, *parts]:
        if node.tag not in TAGS and (right := node.tag.lower()) in TAGS:
            raise ValueError(f"line {getattr(node, 'line', 0)}: <{node.tag}> must be <{right}>, in small letters")
    if robot.find("link") is None and any(child.tag in SEMANTIC for child in robot):
        raise ValueError("it is an SRDF file of MoveIt, which holds no links; name the URDF file that it is about")
    return robot


class _Node(xml.Element):
    """An element that knows its ``line`` in the file."""

    line = 0


def by_name(robot: xml.Element, kind: str) -> dict[str, xml.Element]:
    """Children of <robot>; what stands deeper, such as the joints of <gazebo> or <transmission>, is none of the arm."""
    found: dict[str, xml.Element] = {}
    for node in robot.findall(kind):
        if not name_of(node):
            raise ValueError(f"a {kind} has no name")
        if len(name_of(node)) > LONGEST:
            raise ValueError(
                f"the name of {kind} '{name_of(node)[:40]}…' has {len(name_of(node))} letters, {LONGEST} at most"
            )
        if found.setdefault(name_of(node), node) is not node:
            raise ValueError(f"there are two {kind}s '{name_of(node)}'; names must differ")
    return found


def name_of(node: xml.Element) -> str:
    """The name of a link or joint, empty where it has none."""
    return node.get("name", "")


def link_of(joint: xml.Element, role: str) -> str:
    """The link that a joint has as its parent or child, empty where it names none."""
    node = joint.find(role)
    return "" if node is None else node.get("link", "")


def place(node: xml.Element | None, attribute: str) -> str:
    """An attribute as it stands in the file, for a sentence."""
    if node is None:
        return attribute
    return f'line {getattr(node, "line", 0)}: <{node.tag} {attribute}="{node.get(attribute, "")}">'


def floats(node: xml.Element | None, attribute: str, default: str) -> tuple[float, ...]:
    """The numbers in an attribute, as many as in ``default``, which stands for one that is not there."""
    text = default if node is None else node.get(attribute, "" if attribute in NEEDED else default)
    try:
        values = tuple(map(float, text.split()))
        bad = math.isnan if node is None or node.tag == "limit" else lambda value: not math.isfinite(value)
        if any(map(bad, values)) or len(values) != len(default.split() or values):
            raise ValueError
    except ValueError:
        count = len(default.split())
        wanted = f"{count} numbers parted by blanks" if count > 1 else "one number" if count else "numbers"
        shown = " ".join(["0.25"] * (count or 1))
        raise ValueError(f"{place(node, attribute)} does not hold {wanted}, such as {shown}") from None
    return values


def _check_attributes(node: xml.Element | None, *names: str) -> None:
    """Refuse an element that says something, as SDF files do, but nothing in these attributes."""
    if (
        node is not None
        and not node.attrib.keys() & {*names}
        and (node.attrib or len(node) or (node.text or "").strip())
    ):
        line = getattr(node, "line", 0)
        raise ValueError(f"line {line}: <{node.tag}> has no {' or '.join(names)}; write its numbers there")


def pose_of(node: xml.Element) -> Pose:
    """Where an element stands in the frame of what holds it."""
    origin = node.find("origin")
    if origin is not None and "quat_xyzw" in origin.attrib:
        turn = Rotation.from_quat(floats(origin, "quat_xyzw", "0 0 0 1")).as_euler("xyz")
        raise ValueError(
            f'{place(origin, "quat_xyzw")} is not read; write rpy="{" ".join(f"{x:.9g}" for x in turn)}" in its place'
        )
    _check_attributes(origin, "xyz", "rpy")
    return Pose(floats(origin, "xyz", "0 0 0"), floats(origin, "rpy", "0 0 0"))  # type: ignore[arg-type]


def axis_of(node: xml.Element) -> Array:
    """Unit vector (3,) of a joint's axis."""
    _check_attributes(node.find("axis"), "xyz")
    axis = np.array(floats(node.find("axis"), "xyz", "1 0 0"))
    if not 1e-12 < math.hypot(*axis) < 1e12:
        raise ValueError(
            f"joint '{name_of(node)}' has the axis {' '.join(f'{x:g}' for x in axis)}; it must have a direction"
        )
    return axis / np.linalg.norm(axis)
