"""An arm read from a URDF file is the one that Pinocchio reads from the same file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.kinematics import forward
from dexrepro.robots.urdf import from_urdf

pin = pytest.importorskip("pinocchio")

INERTIAL = """<inertial><origin xyz="{0} 0.02 -0.01" rpy="0.3 0.1 {0}"/><mass value="{1}"/>
<inertia ixx="0.01" ixy="0.001" ixz="0" iyy="0.02" iyz="0.002" izz="0.025"/></inertial>"""
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
<axis xyz="1 1 0"/><limit lower="-1" upper="2" effort="0" velocity="3"/></joint>
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


def test_limits_and_base_are_those_given(path: Path) -> None:
    arm = from_urdf(str(path), "tip", base=[1, 0, 0, 0, 0, np.pi / 2])
    assert arm.lower.tolist() == [-np.inf, -1]
    assert arm.effort.tolist() == [30, np.inf], "an effort of 0 stands for none given"
    moved = forward(from_urdf(str(path), "tip"), [0.0, 0.0])[0]
    assert forward(arm, [0.0, 0.0])[0] == pytest.approx([1 - moved[1], moved[0], moved[2]])


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("</robot>", ""), "is no XML file"),
        (('<link name="tip"', '<link name="toe"'), "has no link 'tip'; there are: floor"),
        (("continuous", "prismatic"), "joint 'yaw' of .* is prismatic"),
        ((INERTIAL.format(0.1, 0.5), ""), None),
        (('value="0.2"', 'value="-0.2"'), "link 'eye' of .* has the mass -0.2 kg"),
        (('value="2"', 'value="heavy"'), '<mass value="heavy"> does not hold 1 numbers'),
        (('value="2"', 'value="nan"'), '<mass value="nan"> does not hold 1 numbers'),
        (('parent link="floor"', 'parent link="one"'), "the joints form a loop at link 'one'"),
        (('parent link="floor"', 'parent link="flor"'), "joint '.*' of .* has no parent link that is in the file"),
        (('value="2"', 'value="-4"'), "link 'one' of .* has the mass -4 kg; it must not be negative"),
    ],
)
def test_a_file_that_cannot_be_used_gets_one_sentence(path: Path, change: tuple[str, str], sentence: str) -> None:
    path.write_text(URDF.replace(*change))
    if sentence is None:
        assert from_urdf(str(path), "tip").links[1].mass == pytest.approx(0.2), "what it carries still has mass"
        return
    with pytest.raises(ValueError, match=sentence):
        from_urdf(str(path), "tip")
