"""Closed-form kinematics of the pen arm."""

import numpy as np
import pytest

from dexrepro.robots.kinematics import forward
from dexrepro.robots.pen_arm import pen, pen_arm, pen_arm_angles, pen_arm_tip

ANGLES = np.random.default_rng(0).uniform((-1, -0.5, -2.2), (1, 1, -0.3), size=(20, 3))


def test_tip_is_that_of_the_description():
    arm = pen_arm(tool=pen())
    np.testing.assert_allclose([forward(arm, q)[0] for q in ANGLES], pen_arm_tip(ANGLES), atol=1e-12)


def test_angles_bring_the_tip_back():
    np.testing.assert_allclose(pen_arm_angles(pen_arm_tip(ANGLES)), ANGLES, atol=1e-9)


def test_positions_out_of_reach_are_refused():
    with pytest.raises(ValueError, match="out of the arm's reach"):
        pen_arm_angles(np.array([0.3, 0.0, 0.0]))
