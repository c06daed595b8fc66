"""An arm read from a URDF file is the one that Pinocchio reads from the same file."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.kinematics import forward
from dexrepro.robots.urdf import from_urdf

pin = pytest.importorskip("pinocchio")
bullet = pytest.importorskip("pybullet")

from dexrepro.physics.engines.pybullet import connect, disconnect, load_arm  # noqa: E402

INERTIAL = """<inertial><origin xyz="{0} 0.02 -0.01" rpy="0.3 0.1 {0}"/><mass value="{1}"/>
<inertia ixx="0.01" ixy="0.001" ixz="0" iyy="0.02" iyz="0.002" izz="0.025"/></inertial>"""
MOMENTS = INERTIAL[INERTIAL.index("<inertia ") : INERTIAL.index("</inertial>")]
URDF = f"""<robot name="three">
<link name="floor"/>
<joint name="stand" type="fixed"><origin xyz="0.1 0.2 0.3" rpy="0 0 0.5"/>
<parent link="floor"/><child link="base"/></joint>
<link name="base">{INERTIAL.format(0.1, 5)}</link>
<joint name="yaw" type="continuous"><origin xyz="0 0 0.1"/><parent link="base"/><child link="one"/>
<axis xyz="0 0 1"/><limit effort="30" velocity="2"/></joint>
<link name="one">{INERTIAL.format(0.05, 2)}<collision><geometry><box size="0.1 0.1 0.2"/></geometry></collision></link>
<joint name="plate" type="fixed"><origin xyz="0 0.1 0.2" rpy="1 0 0"/><parent link="one"/><child link="two"/></joint>
<link name="two">{INERTIAL.format(0.02, 1)}</link>
<joint name="pitch" type="revolute"><origin xyz="0.1 0 0" rpy="0 0.4 0"/><parent link="two"/><child link="three"/>
<axis xyz="1 1 0"/><limit lower="-1" upper="2" effort="9" velocity="3"/></joint>
<link name="three">{INERTIAL.format(0.1, 0.5)}</link>
<joint name="camera" type="fixed"><origin xyz="0 0 0.1"/><parent link="three"/><child link="eye"/></joint>
<link name="eye">{INERTIAL.format(0.0, 0.2)}</link>
<joint name="mount" type="fixed"><origin xyz="0.2 0 0.1" rpy="0 1 0"/><parent link="three"/><child link="tip"/></joint>
<link name="tip"><inertial><mass value="1e-9"/>
<inertia ixx="1e-9" ixy="0" ixz="0" iyy="1e-9" iyz="0" izz="1e-9"/></inertial></link>
</robot>"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    (tmp_path / "three.urdf").write_text(URDF)
    return tmp_path / "three.urdf"


def test_dynamics_and_end_point_are_those_of_the_file(path: Path) -> None:
    arm = from_urdf(str(path), "tip")
    q, dq, ddq = np.array([0.7, -0.4]), np.array([1.0, 2.0]), np.array([3.0, -1.0])
    reference = pin.buildModelFromXML(URDF)
    data = reference.createData()
    angles = np.array([np.cos(q[0]), np.sin(q[0]), q[1]])  # a continuous joint is a point on the circle there
    torque = pin.rnea(reference, data, angles, dq, ddq)
    pin.framesForwardKinematics(reference, data, angles)
    tip = data.oMf[reference.getFrameId("tip")].translation
    assert RigidBodyModel(arm).inverse_dynamics(q, dq, ddq) == pytest.approx(torque, rel=1e-5)
    assert forward(arm, q)[0] == pytest.approx(tip, abs=1e-9)


@pytest.mark.parametrize("base", [(), (0, 0), (0, 0, 0, 1), True, None, "000", ["a", "b", "c"], [[0, 0, 0]]])
def test_a_base_has_three_or_six_numbers(path: Path, base: Any) -> None:
    with pytest.raises(
        ValueError, match=r"base = .* is not allowed: it must be x, y, z .m., or these with roll, pitch"
    ):
        from_urdf(str(path), "tip", base=base)


def test_the_type_of_a_joint_is_read_in_any_case(path: Path) -> None:
    arm = from_urdf(str(path), "tip")
    path.write_text(URDF.replace('"revolute"', '" Revolute"').replace('"fixed"', '"FIXED"'))
    assert from_urdf(str(path), "tip") == arm


def test_a_link_may_be_called_by_a_number_as_yaml_reads_it(path: Path) -> None:
    arm = from_urdf(str(path), "tip", root="base")
    path.write_text(URDF.replace('"tip"', '"5"').replace('"base"', '"1"'))
    assert from_urdf(str(path), 5, root=1) == arm  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ({"path": None}, "there is no URDF file 'None'"),
        ({"path": "~nobody-of-this-name/a.urdf"}, "there is no URDF file '~nobody"),
        ({"end": 5}, "it has no link '5'"),
        ({"end": ["tip"]}, "it has no link '..tip"),
        ({"packages": ["a"]}, "packages = ..a.. is not allowed: it must be names with folders"),
        ({"packages": {"a": 5}}, "packages.a = 5 is not allowed: there is no such folder"),
    ],
)
def test_what_is_no_name_gets_one_sentence(path: Path, words: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        from_urdf(**{"path": str(path), "end": "tip", **words})


def test_limits_and_base_are_those_given(path: Path) -> None:
    arm = from_urdf(str(path), "tip", base=[1, 0, 0, 0, 0, np.pi / 2])
    assert arm.lower.tolist() == [-np.inf, -1]
    assert arm.effort.tolist() == [30, 9]
    moved = forward(from_urdf(str(path), "tip"), [0.0, 0.0])[0]
    assert forward(arm, [0.0, 0.0])[0] == pytest.approx([1 - moved[1], moved[0], moved[2]])


def test_a_base_that_seems_to_be_in_degrees_is_said(path: Path) -> None:
    with pytest.warns(UserWarning, match=r"base = .1, 0, 0, 0, 0, -90. turns by -90 rad; its angles are in rad"):
        from_urdf(str(path), "tip", base=[1, 0, 0, 0, 0, -90])


def test_what_the_link_named_root_hangs_on_is_left_out(path: Path) -> None:
    whole, part = from_urdf(str(path), "tip"), from_urdf(str(path), "tip", root="base")
    moved = forward(whole, [0.3, 0.2])[0] - (0.1, 0.2, 0.3)
    c, s = np.cos(0.5), np.sin(0.5)
    assert forward(part, [0.3, 0.2])[0] == pytest.approx(
        [c * moved[0] + s * moved[1], c * moved[1] - s * moved[0], moved[2]]
    )
    with pytest.raises(ValueError, match="link 'base' does not hang on the link 'eye'"):
        from_urdf(str(path), "base", root="eye")


LIMIT = '<limit lower="-1" upper="2" effort="9" velocity="3"/>'
LOOP = '<joint name="loop" type="revolute"><parent>three</parent><child>one</child></joint>'


ROBOT = '<robot name="three">'
HANGING = "".join(  # a thousand frames, each fixed to the one before
    f'<link name="f{k}"/><joint name="g{k}" type="fixed"><parent link="{f"f{k - 1}" if k else "tip"}"/>'
    f'<child link="f{k}"/></joint>' for k in range(1100))  # fmt: skip
BOMB = "<!DOCTYPE robot [<!ENTITY e0 'xxxxxxxxxx'>" + "".join(
    f"<!ENTITY e{k + 1} '{f'&e{k};' * 20}'>" for k in range(9)) + "]><robot a='&e9;'"  # fmt: skip


@pytest.mark.parametrize(
    ("change", "encoding"),
    [
        (("", ""), "utf-8-sig"),
        (("", ""), "utf-16"),
        (("", ""), "utf-16-le"),
        (("<robot", '<?xml version="1.0" encoding="utf-16"?><robot'), "utf-16"),
        (("<robot", '<?xml version="1.0" encoding="utf-16"?><robot'), "utf-8"),
        (("<robot", '<?xml version="1.0" encoding="latin-1"?><!-- für --><robot'), "latin-1"),
        (("<robot", "\n\n  <?xml version='1.0'?><robot"), "utf-8"),
        (('velocity="2"', 'velocity="2" drake:acceleration="3"'), "utf-8"),
        (("</robot>", f"<gazebo>{LOOP}</gazebo><ignition:plugin/></robot>"), "utf-8"),
        (("</robot>", f"<transmission>{LOOP}<link name='one'/></transmission></robot>"), "utf-8"),
        (("</robot>", "</robot>\n\0\0\0"), "utf-8"),
        (
            ("</collision>", f"</collision><visual><geometry><mesh filename='{'m' * 5000}'/></geometry></visual>"),
            "utf-8",
        ),
        (('<mass value="2"/>', '<mass value="2"/><!-- ${mass} -->'), "utf-8"),
        (("<robot", "<!------ arm -- of 2019 --- -->\n<robot"), "utf-8"),
        (("<robot", "<!-- of 2019 -->\n\n<?xml version='1.0'\nencoding='utf-8'?>\r\n<robot"), "utf-8"),
        (("<robot", '<!DOCTYPE robot [<!ENTITY two "2">]><robot'), "utf-8"),
        (("<robot", "<robot xmlns='http://www.ros.org' xmlns:xacro='http://www.ros.org/wiki/xacro'"), "utf-8"),
        (("</robot>", f"<ros2_control><joint name='yaw'/>{LOOP}</ros2_control></robot>"), "utf-8"),
        (('<axis xyz="1 1 0"/>', '<axis xyz="1E1  1.0e+01\t0"/><dynamics damping="0.1" friction="1"/>'), "utf-32"),
        (("</robot>", f"<!--{'x' * 10_000_000}--></robot>"), "utf-8"),
        (("</robot>", HANGING + "</robot>"), "utf-8"),
    ],
)
def test_what_real_files_hold_beside_the_arm_changes_nothing(
    path: Path, change: tuple[str, str], encoding: str
) -> None:
    arm = from_urdf(str(path), "tip")
    path.write_bytes(URDF.replace(*change, 1).encode(encoding))
    assert from_urdf(str(path), "tip") == arm


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("</robot>", ""), "it is no XML file"),
        (("robot", "mujoco"), "it is an MJCF file of MuJoCo"),
        (('<parent link="base"/>', ""), "joint 'yaw' has no parent; it needs <parent link="),
        (("robot", "html"), "it is a web page; download the file itself that it shows"),
        (("robot", "model"), "it is no URDF: it begins with <model>"),
        (("0.1 0.1 0.2", "0.1 -0.1 0.2"), 'line 1: <box size="0.1 -0.1 0.2"> of link .one. has a negative size'),
        ((ROBOT, f"<!DOCTYPE robot [<!ENTITY hand SYSTEM 'hand.xml'>]>{ROBOT}&hand;"), "'hand.xml', which is not read"),
        (("<robot", BOMB), "it is no XML file: limit on input amplification"),
        (('value="2"', 'value="0,2"'), 'line 1: <mass value="0,2"> does not hold one number'),
        (('<mass value="1"/>', "<mass>1</mass>"), 'line 1: <mass value=""> does not hold one number'),
        (('<mass value="2"/><inertia ixx', '<mass value="2"/><inertia Ixx'), '<inertia ixx=""> does not hold one'),
        (('<box size="0.1 0.1 0.2"/>', '<cylinder radius="0.1"/>'), '<cylinder length=""> does not hold one number'),
        (('value="2"', 'value="inf"'), '<mass value="inf"> does not hold one number'),
        (('xyz="0.1 0 0"', 'xyz="0.1, 0, 0"'), '<origin xyz="0.1, 0, 0"> does not hold 3 numbers .*as 0.25 0.25 0.25$'),
        (('<axis xyz="1 1 0"/>', "<axis><xyz>1 1 0</xyz></axis>"), 'line 1: <axis> has no xyz; write its numbers'),
        (('<origin xyz="0 0 0.1"/>', "<origin>0 0 0.1</origin>"), 'line 1: <origin> has no xyz or rpy; write its num'),
        (('<origin xyz="0 0 0.1"/>', '<origin XYZ="0 0 0.1"/>'), 'line 1: <origin> has no xyz or rpy; write its num'),
        (('<origin xyz="0 0 0.1"/>', '<Origin xyz="0 0 0.1"/>'), "line 1: <Origin> must be <origin>, in small letters"),
        (('<link name="floor"/>', '<Link name="floor"/>'), "line 1: <Link> must be <link>, in small letters"),
        (('xyz="0.1 0 0"', 'xyz="inf 0 0"'), '<origin xyz="inf 0 0"> does not hold 3 numbers'),
        (('"camera" type="fixed">', '"camera" type="prismatic"><mimic joint="yaw" multiplier="-1"/>'), "'camera' off"),
        (('value="2"', 'value="${m}"'), "it still holds xacro; turn it into URDF first"),
        (("</robot>", "<xacro:hand/></robot>"), "it still holds xacro; turn it into URDF first"),
        (('<link name="tip"', '<link name="tipp"'), "names .tip. as its child, and no link .*did you mean .tipp"),
        (('<link name="eye"', '<link name="two"'), "there are two links 'two'"),
        (('<joint name="camera"', '<joint name="plate"'), "there are two joints 'plate'"),
        (('<link name="eye"', "<link"), "a link has no name"),
        (('child link="eye"', 'child link="two"'), "link 'two' hangs on two joints, 'plate' and 'camera'"),
        (("continuous", "prismatic"), "joint 'yaw' is prismatic; .*root: one begins the arm behind it"),
        (('"stand" type="fixed"', '"stand" type="floating"'), "joint 'stand' is floating; .*root: base begins"),
        (('"pitch" type="revolute"', '"pitch" type=" Prismatic "'), "joint 'pitch' is prismatic; .*before it, at two"),
        ((LIMIT, LIMIT + "<mimic/>"), "joint 'pitch' follows a joint that it does not name .mimic.*before it, at two"),
        (('rpy="0 0 0.5"', 'quat_xyzw="0 0 0 2"'), '<origin quat_xyzw="0 0 0 2"> is not read; write rpy="0 0 0" in'),
        (('value="0.2"', 'value="-0.2"'), "link 'eye' has the mass -0.2 kg"),
        (('value="2"', 'value="heavy"'), '<mass value="heavy"> does not hold one number'),
        (('value="2"', 'value="nan"'), '<mass value="nan"> does not hold one number'),
        (('parent link="floor"', 'parent link="one"'), "the joints form a loop at link 'one'"),
        (('parent link="floor"', 'parent link="flor"'), "'stand' names .flor. as its parent, .*did you mean .floor"),
        (('value="2"', 'value="-4"'), "link 'one' has the mass -4 kg; it must not be negative"),
        ((LIMIT, '<limit lower="2" upper="-1"/>'), "joint 'pitch' has the limits 2 to -1"),
        ((LIMIT, '<limit lower="1" upper="1"/>'), "joint 'pitch' has the limits 1 to 1; it cannot move"),
        ((LIMIT, '<limit lower="-1" upper="1" effort="-3"/>'), "joint 'pitch' has the effort limit -3"),
        ((LIMIT, '<limit lower="-1" upper="1" velocity="-3"/>'), "joint 'pitch' has the velocity limit -3"),
        ((LIMIT, LIMIT + '<mimic joint="yaw"/>'), "joint 'pitch' follows joint 'yaw' .mimic.*before it, at two"),
        (('"camera" type="fixed">', '"camera" type="revolute"><mimic joint="pitch"/>'), "'camera' off the chain foll"),
        ((f"<axis xyz=\"1 1 0\"/>{LIMIT}", '<axis xyz="0 0 0"/>'), "joint 'pitch' has the axis 0 0 0; it must have"),
        (('<axis xyz="1 1 0"/>', '<axis xyz="1e300 0 0"/>'), "joint 'pitch' has the axis 1e.300 0 0; it must"),
        (('<axis xyz="1 1 0"/>', '<axis xyz="0 1e-300 0"/>'), "joint 'pitch' has the axis 0 1e-300 0; it must"),
        (('joint name="pitch"', f'joint name="{"p" * 5000}"'), "name of joint 'p{40}…' has 5000 letters, 255 at most"),
        (('link name="eye"', f'link name="{"e" * 256}"'), "the name of link 'e{40}…' has 256 letters, 255 at most"),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_used_gets_one_sentence(path: Path, change: tuple[str, str], sentence: str) -> None:
    text = URDF.replace("\n", "")
    assert change[0] in text
    count = -1 if change[0] == "robot" else 1
    path.write_text(text.replace(*change, count))
    with pytest.raises(ValueError, match=f"three.urdf': .*{sentence}") as caught:
        from_urdf(str(path), "tip")
    assert "\n" not in str(caught.value)


def test_a_body_weighs_what_it_carries(path: Path) -> None:
    path.write_text(URDF.replace(INERTIAL.format(0.1, 0.5), ""))
    assert from_urdf(str(path), "tip").links[1].mass == pytest.approx(0.2)
    path.write_text(URDF.replace(INERTIAL.format(0.05, 2), "").replace(INERTIAL.format(0.02, 1), ""))
    with pytest.raises(ValueError, match="link 'one' moves but has no <inertial>; give it a mass, or fix its joint"):
        from_urdf(str(path), "tip")
    path.write_text(re.sub("<inertial>.*?</inertial>", "", URDF, flags=re.DOTALL))
    with pytest.raises(ValueError, match=r"fix its joint; three cannot be used, either$"):
        from_urdf(str(path), "eye")
    path.write_text(URDF.replace('value="2"', 'value="0"').replace('value="1"', 'value="0"'))
    with pytest.raises(ValueError, match="link 'one' moves but has the mass 0 kg; give it a mass, or fix its joint"):
        from_urdf(str(path), "tip")


ROD = """<robot name="rod"><link name="base"/>
<joint name="{0}" type="revolute"><parent link="base"/><child link="bar"/><axis xyz="0 1 0"/>
<limit lower="-3" upper="3" effort="50" velocity="5"/></joint>
<link name="bar"><inertial><origin xyz="0.2 0 0" rpy="{1}"/><mass value="{2}"/>
<inertia ixx="{3}" iyy="{4}" izz="{5}" ixy="{6}" ixz="{7}" iyz="{8}"/></inertial></link>
<joint name="mount" type="fixed"><parent link="bar"/><child link="tip"/><origin xyz="0.4 0 0"/></joint>
<link name="tip"/></robot>"""


def rod(folder: Path, moments: tuple[float, ...], mass: float = 1.0, rpy: str = "0 0 0") -> str:
    (folder / "rod.urdf").write_text(ROD.format("turn", rpy, mass, *moments, *(0,) * (6 - len(moments))))
    return str(folder / "rod.urdf")


@pytest.mark.parametrize("excess", [0.009, 0.03])
def test_a_makers_rounding_is_mended_with_one_warning(tmp_path: Path, excess: float) -> None:
    path = rod(tmp_path, (0.003, 0.02, 0.023 / (1 - excess)))
    with pytest.warns(UserWarning, match=rf"rod.urdf': link bar by {100 * excess:.2g} %") as caught:
        arm = from_urdf(path, "tip")
    assert len(caught) == 1
    a, b, c = np.linalg.eigvalsh(arm.links[0].inertia_matrix)
    assert c == pytest.approx(a + b)
    assert [a, b, c] == pytest.approx([0.003, 0.02, 0.023], abs=excess * 0.023)
    torque = RigidBodyModel(arm).inverse_dynamics(np.zeros(1), np.zeros(1), np.ones(1))
    assert torque == pytest.approx([0.04 + 0.02 - 9.81 * 0.2], abs=excess * 0.023)


@pytest.mark.parametrize(
    ("moments", "numbers"),
    [
        ((0.003, 0.02, 0.03), "0.003, 0.02 and 0.03 kg m.2"),
        ((-0.003, 0.02, 0.02), "-0.003, 0.02 and 0.02"),
        ((0.02, 0.02, 0.02, 0.03), "-0.01, 0.02 and 0.05"),
    ],
)
def test_what_is_no_rounding_is_refused_with_the_numbers(
    tmp_path: Path, moments: tuple[float, ...], numbers: str
) -> None:
    with pytest.raises(ValueError, match=f"rod.urdf': link 'bar' has the principal moments {numbers}.*compute its <in"):
        from_urdf(rod(tmp_path, moments), "tip")


@pytest.mark.parametrize("rpy", ["0 0 0", "0.3 0.7 -0.2", "0 1.5707963267948966 0", "0.4 -1.5707963267948966 0.3"])
@pytest.mark.parametrize(
    ("moments", "mass"),
    [
        ((0.0, 0.02, 0.02), 1.0),  # a thin rod: the largest moment is the sum of the others
        ((0.01, 0.02, 0.03), 1.0),  # a plate
        ((180.42, 177.68, 20.495, -0.83462, 0.32549, -20.82), 950.0),  # an industrial arm's
        ((0.0, 0.0, 0.0), 1.0),  # a point mass
    ],
)
@pytest.mark.filterwarnings("error")
def test_rounding_stops_no_engine(tmp_path: Path, rpy: str, moments: tuple[float, ...], mass: float) -> None:
    path = rod(tmp_path, moments, mass, rpy)
    arm, reference = from_urdf(path, "tip"), pin.buildModelFromUrdf(path)
    q, dq, ddq = np.array([[0.3], [0.5], [2.0]])
    wanted = pin.rnea(reference, reference.createData(), q, dq, ddq)
    assert RigidBodyModel(arm).inverse_dynamics(q, dq, ddq) == pytest.approx(wanted, rel=1e-5)
    with World(gravity=(0, 0, 0)) as world:
        world.add_arm("arm", arm, [0.0])
        speed = world.run(0.01, {"arm": lambda sense: (np.array([5.0]), np.array([1e-9]))})["arm.velocity"][-1]
    inertia = pin.crba(reference, reference.createData(), q)[0, 0]
    assert speed == pytest.approx([5.0 * 0.009 / inertia], rel=0.12), "with damping, which asks for the mass matrix"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (" \n", "it is empty"),
        ("<robot name='three'><group name='arm'/></robot>", "it is an SRDF file of MoveIt, which holds no links; name"),
        ("<robot name='three'/>", "it has no link 'tip'; there are: none"),
    ],
)
def test_a_file_without_an_arm_is_named_for_what_it_is(path: Path, text: str, sentence: str) -> None:
    path.write_text(text)
    with pytest.raises(ValueError, match=f"three.urdf': {sentence}"):
        from_urdf(str(path), "tip")


def test_no_limits_or_zeros_are_none(path: Path) -> None:
    path.write_text(URDF.replace(LIMIT, ""))
    with pytest.warns(UserWarning, match="joint 'pitch' has no limits or 0 to 0"):
        assert from_urdf(str(path), "tip").upper.tolist() == [np.inf, np.inf]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("</robot>", '<link name="stray"/></robot>'), "link 'stray' hangs on no joint; only what hangs on 'floor' is"),
        (('"camera" type="fixed"', '"camera" type="floating"'), "joint 'camera' off the chain is floating and taken"),
        ((LIMIT, '<limit lower="-170" upper="170"/>'), "joint 'pitch' has the limits -170 to 170; they are in rad"),
        ((LIMIT, '<limit lower="-30" upper="45"/>'), "joint 'pitch' has the limits -30 to 45; they are in rad"),
        (('rpy="0 0.4 0"', 'rpy="0 90 0"'), "joint 'pitch' has the rpy 0 90 0; it is in rad, not in degrees"),
        (('effort="9"', 'effort="0"'), "joint 'pitch' has the effort limit 0, which is taken for none$"),
        (('value="2"/>' + MOMENTS, 'value="2"/>'), "link 'one' has no <inertia>, and is taken for a point mass"),
        (
            ("0.05 0.02 -0.01", "50 20 -10"),
            "link 'one' has its centre of mass 36.5.* m from its joint; lengths are in m; link 'one' has",
        ),
        (('"0.2 0 0.1"', '"200 0 100"'), "joint 'mount' stands 223.607 m from what carries it; lengths are in m"),
        (('"0.1 0 0" rpy', '"100 0 0" rpy'), "joint 'pitch' stands 100 m from what carries it; lengths are in m"),
        (
            ('value="2"/>' + MOMENTS, 'value="2"/><inertia ixx="90" iyy="80" izz="70"/>'),
            "link 'one' has 9.* kg m.2 at 3 kg",
        ),
        (('value="2"/>', 'value="2000000"/>'), "link 'one' has .* kg m.2 at 2e.06 kg; its units are kg and m"),
    ],
)
def test_what_is_read_though_it_is_doubtful_is_said(path: Path, change: tuple[str, str], sentence: str) -> None:
    path.write_text(URDF.replace("\n", "").replace(*change, 1))
    with pytest.warns(UserWarning, match=f"three.urdf': {sentence}") as caught:
        arm = from_urdf(str(path), "tip")
    assert len(caught) == 1
    assert arm.links[1].mass == pytest.approx(0.7)


def test_a_follower_off_the_chain_stands_at_its_offset(path: Path) -> None:
    plain = from_urdf(str(path), "tip")
    turning = '"camera" type="revolute"><axis xyz="0 1 0"/><mimic joint="else" offset="0.5"/>'
    path.write_text(URDF.replace('"camera" type="fixed">', turning))
    turned = from_urdf(str(path), "tip")
    assert turned.links[1].mass == plain.links[1].mass
    assert turned.links[1].com != pytest.approx(plain.links[1].com, abs=1e-6)
    sliding = '"camera" type="prismatic"><axis xyz="0 2 0"/><mimic joint="else" offset="0.3"/>'
    path.write_text(URDF.replace('"camera" type="fixed">', sliding))
    body, moved = plain.links[1], from_urdf(str(path), "tip").links[1]
    np.testing.assert_allclose(np.subtract(moved.com, body.com), [0, 0.3 * 0.2 / body.mass, 0], atol=1e-12)


OBJ = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.3\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n"
VISUAL = '<visual><origin xyz="0 0 0.1"/><geometry><mesh filename="{}" scale="2 2 2"/></geometry></visual>'


@pytest.mark.parametrize(
    ("name", "place", "packages"),
    [
        ("meshes/a.obj", "meshes", None),
        ("package://my arm/meshes/a.obj", "elsewhere/meshes", {"my arm": "elsewhere"}),
        ("package://my_arm/a.obj", "my_arm", None),
        ("file://{}/a.obj", "", None),
    ],
)
def test_meshes_that_are_there_are_seen_and_touch_nothing(
    tmp_path: Path, name: str, place: str, packages: dict[str, str] | None
) -> None:
    (tmp_path / place).mkdir(parents=True, exist_ok=True)
    (tmp_path / place / "a.obj").write_text(OBJ)
    path = tmp_path / "rod.urdf"
    path.write_text(ROD.format("turn", "0 0 0", 1, 0.001, 0.02, 0.02, 0, 0, 0).replace(
        "</inertial>", "</inertial>" + VISUAL.format(name.format(tmp_path))))  # fmt: skip
    folders = packages and {key: str(tmp_path / value) for key, value in packages.items()}
    arm = from_urdf(str(path), "tip", packages=folders)
    kinds = [shape.kind for shape in arm.links[0].shapes]
    assert kinds == ["mesh", "capsule"]
    assert not any(shape.collides for shape in arm.links[0].shapes)
    for meshes, expected in ((True, bullet.GEOM_MESH), (False, bullet.GEOM_CAPSULE)):
        client = connect()
        (seen,) = bullet.getVisualShapeData(load_arm(client, arm, meshes), physicsClientId=client)
        disconnect(client)
        assert seen[2] == expected
        assert seen[3] == pytest.approx((2, 2, 2)) or not meshes


def test_a_mesh_without_a_scale_is_as_large_as_its_file_says(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(OBJ)
    path, text = tmp_path / "rod.urdf", ROD.format("turn", "0 0 0", 1, 0.001, 0.02, 0.02, 0, 0, 0)
    path.write_text(text.replace("</inertial>", "</inertial>" + VISUAL.format("a.obj").replace(' scale="2 2 2"', "")))
    assert from_urdf(str(path), "tip").links[0].shapes[0].size == (1, 1, 1)


def test_meshes_that_are_not_there_are_capsules(tmp_path: Path) -> None:
    path = tmp_path / "rod.urdf"
    text = ROD.format("turn", "0 0 0", 1, 0.001, 0.02, 0.02, 0, 0, 0)
    path.write_text(text.replace("</inertial>", "</inertial>" + VISUAL.format("package://no/a.obj")))
    assert [shape.kind for shape in from_urdf(str(path), "tip").links[0].shapes] == ["capsule"]
    for scale in ("1,1,1", "0.001 0.001", "0 0 0"):
        path.write_text(text.replace("</inertial>", "</inertial>" + VISUAL.format("rod.obj").replace("2 2 2", scale)))
        (tmp_path / "rod.obj").write_text(OBJ)
        with pytest.raises(ValueError, match=rf'line 5: <mesh scale="{scale}"> '):
            from_urdf(str(path), "tip")
    with pytest.raises(ValueError, match=r"packages.no = .*gone is not allowed: there is no such folder"):
        from_urdf(str(path), "tip", packages={"no": str(tmp_path / "gone")})
