"""Descriptions of arms: bodies that can exist, URDF that engines take as it is."""

from dataclasses import replace

import numpy as np
import pytest

from dexrepro.physics.loading import LoadingError
from dexrepro.robots.arm import Arm, InvalidInertia, Joint, Link, Pose, Shape, Tool
from dexrepro.robots.baxter import _data, baxter
from dexrepro.robots.planar import planar

bullet = pytest.importorskip("pybullet")

from dexrepro.physics.engines.pybullet import connect, load_arm  # noqa: E402


@pytest.mark.parametrize("inertia", [(1e-3, 0, 0, 1e-3, 0, 3e-3), (-1e-3, 0, 0, 1e-3, 0, 1e-3)])
def test_inertia_no_rigid_body_can_have_is_refused(inertia):
    with pytest.raises(InvalidInertia, match="link 'stone'"):
        Link("stone", 1.0, (0, 0, 0), inertia)


def test_engine_holds_the_inertias_of_the_description():
    client = connect()
    arm = baxter("left")
    body = load_arm(client, arm)
    for index, link in enumerate([*arm.links, arm.bodies[0][1]]):
        mass, _, moments, *_ = bullet.getDynamicsInfo(body, index, physicsClientId=client)
        assert mass == pytest.approx(link.mass)
        np.testing.assert_allclose(np.sort(moments), np.linalg.eigvalsh(link.inertia_matrix), rtol=1e-9)
    bullet.disconnect(physicsClientId=client)


def test_what_the_importer_complains_about_is_an_error():
    class Broken(Arm):
        def urdf(self, meshes=False):
            return super().urdf(meshes).replace("<inertial>", "<ignored>").replace("</inertial>", "</ignored>")

    arm = planar([0.5], [1.0])
    broken = Broken(arm.name, arm.joints, arm.links, end=arm.end)
    client = connect()
    with pytest.raises(LoadingError, match="arm 'planar'"):
        load_arm(client, broken)
    bullet.disconnect(physicsClientId=client)


def test_uniform_rods_and_point_masses_have_the_textbook_moments():
    rod, point = planar([0.5], [1.5]).links[0], planar([0.5], [1.5], "points").links[0]
    assert (rod.com[0], rod.inertia[5]) == pytest.approx((0.25, 1.5 * 0.25 / 12))
    assert (point.com[0], point.inertia[5]) == (0.5, 0.0)


def test_links_and_joints_of_a_planar_arm_are_counted_from_one():
    arm = planar([0.5, 0.3], [1.0, 1.0])
    assert [link.name for link in arm.links] == ["link1", "link2"]
    assert [joint.name for joint in arm.joints] == ["joint1", "joint2"]


def test_unknown_inertia_model_is_refused():
    with pytest.raises(ValueError, match="'discs' is neither"):
        planar([0.5], [1.0], "discs")


def test_capsule_between_two_points_ends_at_them():
    shape = Shape.between((0.1, 0.2, 0.3), (0.4, -0.1, 0.5), 0.01)
    half = np.array((0, 0, shape.size[1] / 2, 1))
    np.testing.assert_allclose((shape.pose.matrix @ half)[:3], (0.4, -0.1, 0.5), atol=1e-12)
    half[2] *= -1
    np.testing.assert_allclose((shape.pose.matrix @ half)[:3], (0.1, 0.2, 0.3), atol=1e-12)


def test_tool_without_mass_moves_the_end_point_alone():
    arm = baxter("right")
    longer = replace(arm, tool=Tool(tip=Pose((0.0, 0.0, 0.15))))
    assert len(longer.bodies) == len(arm.bodies)
    np.testing.assert_allclose(longer.tip[2, 3] - arm.tip[2, 3], 0.15)


def test_baxter_carries_the_makers_limits_and_masses():
    arm = baxter("left")
    np.testing.assert_array_equal(arm.effort, [50, 100, 50, 50, 15, 15, 15])
    total = sum(link.mass for link in arm.links) + arm.bodies[0][1].mass
    assert total == pytest.approx(sum(row["mass"] for row in _data()["links"]))


def test_only_arms_in_a_horizontal_plane_are_planar():
    assert planar([0.5, 0.3], [1, 1], base=(0.1, 0.2, 0.3)).is_planar
    assert not planar([0.5], [1.0], base=Pose(rpy=(0.5, 0, 0))).is_planar
    assert not baxter("left").is_planar


def test_joints_without_limits_have_infinite_ones():
    joint = Joint("free", Pose())
    assert joint.lower == -np.inf
    assert joint.upper == np.inf
