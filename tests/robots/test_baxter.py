"""Shapes of Baxter: capsules that reach from joint to joint."""

import numpy as np
import pytest

from dexrepro.robots.arm import Pose
from dexrepro.robots.baxter import baxter, extension, mirrored, palm, posture
from dexrepro.robots.kinematics import forward

ARM = baxter("left")


def ends(shape):
    """Centres (2, 3) [m] of the two ends of a capsule, in the frame of its link."""
    half = 0.5 * shape.size[1]
    return np.array([(shape.pose.matrix @ (0, 0, side * half, 1))[:3] for side in (-1, 1)])


def test_a_capsule_reaches_from_each_joint_to_the_next():
    following = [joint.origin.xyz for joint in ARM.joints[1:]]
    for link, end in zip(ARM.links, following):
        np.testing.assert_allclose(ends(link.shapes[0]), [(0, 0, 0), end], atol=1e-12)


def test_an_arm_tapers_from_shoulder_to_hand():
    radii = [link.shapes[0].size[0] for link in ARM.links]
    assert radii == sorted(radii, reverse=True)
    assert radii[0] < 0.1


def test_an_extension_ends_at_its_tip_and_a_palm_is_a_uniform_plate():
    tool = extension(0.2)
    np.testing.assert_allclose(ends(tool.shapes[0]), [(0, 0, 0), tool.tip.xyz], atol=1e-12)
    assert tool.mass == 0
    plate = palm((0.3, 0.2, 0.1), mass=1.2)
    assert plate.tip.xyz == (0, 0, 0.05)
    assert plate.inertia == pytest.approx((0.1 * 0.05, 0, 0, 0.1 * 0.10, 0, 0.1 * 0.13))


def test_the_arms_are_mirror_images():
    right, left = (baxter(side, mount=Pose()) for side in ("right", "left"))
    angles = np.random.default_rng(0).uniform(-1, 1, 7)
    np.testing.assert_allclose(mirrored(mirrored(angles)), angles)
    np.testing.assert_array_equal(mirrored(angles, "right"), angles)
    np.testing.assert_array_equal(posture("left"), mirrored(posture("right")))
    place, twin = (forward(arm, q)[0] for arm, q in ((right, angles), (left, mirrored(angles))))
    np.testing.assert_allclose(twin, place * (1, -1, 1), atol=1e-6)
