"""Closed-form kinematics of the pen arm."""

import numpy as np
import pytest

from dexrepro.robots.kinematics import forward
from dexrepro.robots.pen_arm import LENGTH, gripper, pen, pen_arm, pen_arm_angles, pen_arm_tip

ANGLES = np.random.default_rng(0).uniform((-1, -0.5, -2.2), (1, 1, -0.3), size=(20, 3))


def test_tip_is_that_of_the_description():
    arm = pen_arm(tool=pen())
    np.testing.assert_allclose([forward(arm, q)[0] for q in ANGLES], pen_arm_tip(ANGLES), atol=1e-12)


def test_angles_bring_the_tip_back():
    np.testing.assert_allclose(pen_arm_angles(pen_arm_tip(ANGLES)), ANGLES, atol=1e-9)


def test_positions_out_of_reach_are_refused():
    with pytest.raises(ValueError, match="out of the arm's reach"):
        pen_arm_angles(np.array([0.3, 0.0, 0.0]))


def ends(shape):
    """Centres (2, 3) [m] of the two ends of a capsule or cylinder, in the frame of its link."""
    half = 0.5 * shape.size[1]
    return np.array([(shape.pose.matrix @ (0, 0, side * half, 1))[:3] for side in (-1, 1)])


def test_what_is_seen_and_touched_is_where_the_bodies_are():
    arm = pen_arm(tool=pen())
    (turret,), *rods = (link.shapes for link in arm.links)
    for (rod,) in rods:
        np.testing.assert_allclose(ends(rod), [(0, 0, 0), (LENGTH, 0, 0)], atol=1e-12)
    (stand,) = arm.base_shapes
    np.testing.assert_allclose(ends(turret)[0], ends(stand)[1], atol=1e-12, err_msg="the turret stands on the stand")
    moments = arm.links[0].inertia_matrix
    assert moments[0, 0] == moments[1, 1], "round about the axis that it turns about"
    assert ends(turret)[1][2] < 0, "and the upper arm passes above it"
    (body,) = pen().shapes
    np.testing.assert_allclose(
        ends(body)[0] - (0, 0, body.size[0]), 0, atol=1e-12, err_msg="its point is the end point"
    )
    sides = np.array([jaw.pose.xyz for jaw in gripper().shapes])
    np.testing.assert_allclose(sides[0] * (1, -1, 1), sides[1])


def test_inertias_scale_with_masses():
    heavy, light = pen_arm(masses=(0.2, 0.12, 0.08)), pen_arm()
    for more, less in zip(heavy.links, light.links):
        np.testing.assert_allclose(more.inertia_matrix, 2 * less.inertia_matrix)
    tool = pen(0.03)
    np.testing.assert_allclose(np.sqrt(np.diag(np.reshape(tool.inertia, (2, 3))[:, ::2]) / 0.03), 0.01)
