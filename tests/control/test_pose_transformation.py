import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from dexrepro.control.pose_transformation import ConstantScaling, RelativePose, SpeedScaling, scaled_path

seeds = st.integers(0, 2**32 - 1)
quick = settings(deadline=None, max_examples=25)


def rotation(rng):
    return Rotation.random(random_state=rng).as_matrix()


def minimum_jerk(amplitude, duration, dt=0.01):
    t = np.arange(round(duration / dt) + 1) * dt / duration
    return amplitude * (10 * t**3 - 15 * t**4 + 6 * t**5)


@given(seeds)
@quick
def test_fixing_again_moves_nothing_and_later_rotations_are_the_leaders(seed):
    rng = np.random.default_rng(seed)
    frame, before, after = rotation(rng), rotation(rng), rotation(rng)
    tool, position = rotation(rng), rng.normal(size=3)
    pose = RelativePose(scaling=ConstantScaling(factor=3.0), dt=0.01, leader_to_follower=frame)
    pose.reset(np.zeros(3), before, position, tool)
    at_fix = pose(np.zeros(3), before)
    np.testing.assert_allclose(at_fix[1], tool, atol=1e-12)
    np.testing.assert_array_equal(at_fix[0], position)
    turned = pose(np.zeros(3), after)[1]
    np.testing.assert_allclose(turned @ tool.T, frame @ after @ before.T @ frame.T, atol=1e-12)


@given(seeds)
@quick
def test_incremental_and_total_displacement_agree_for_a_constant_scale(seed):
    rng = np.random.default_rng(seed)
    path = np.cumsum(rng.normal(scale=1e-3, size=(50, 3)), axis=0)
    ends = []
    for incremental in (True, False):
        pose = RelativePose(scaling=ConstantScaling(factor=4.5), dt=0.01, incremental=incremental)
        pose.reset(path[0], np.eye(3), np.ones(3), np.eye(3))
        ends.append([pose(x, np.eye(3))[0] for x in path])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-12)
    np.testing.assert_allclose(ends[0][-1] - 1.0, 4.5 * (path[-1] - path[0]), atol=1e-12)


def test_total_displacement_with_adaptive_scale_pulls_the_tool_back():
    hand = np.c_[minimum_jerk(0.06, 0.4), np.zeros((41, 2))]
    tools = {}
    for incremental in (True, False):
        pose = RelativePose(scaling=SpeedScaling(), dt=0.01, incremental=incremental)
        pose.reset(hand[0], np.eye(3), np.zeros(3), np.eye(3))
        tools[incremental] = np.array([pose(x, np.eye(3))[0][0] for x in hand])
    assert np.all(np.diff(tools[True]) >= 0)
    assert tools[True][-1] == pytest.approx(0.337, abs=0.005)
    assert tools[False].max() > 0.28
    assert tools[False][-1] == pytest.approx(0.06)


@given(st.floats(0.0, 2.0), st.floats(0.0, 2.0))
@quick
def test_scaling_is_bounded_and_grows_with_speed(a, b):
    scaling = SpeedScaling()
    low, high = scaling(min(a, b)), scaling(max(a, b))
    assert 1.0 <= low <= high <= 8.0


def test_scaling_has_the_printed_ends():
    np.testing.assert_allclose(SpeedScaling()(np.array([0.0, 0.05, 0.175, 0.3, 1.0])), [1, 1, 4.5, 8, 8])


def test_a_whole_path_is_scaled_as_sample_by_sample():
    path = np.cumsum(np.random.default_rng(1).normal(scale=1.5e-3, size=(80, 3)), axis=0)
    pose = RelativePose(scaling=SpeedScaling(), dt=0.01)
    pose.reset(path[0], np.eye(3), np.zeros(3), np.eye(3))
    expected = [pose(x, np.eye(3))[0] for x in path]
    moved, scale = scaled_path(path, SpeedScaling(), 0.01)
    np.testing.assert_allclose(moved, expected, atol=1e-14)
    assert scale.min() == 1.0 < np.median(scale) < scale.max()
