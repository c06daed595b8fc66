import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from dexrepro.control.remote_centre import (
    aligned,
    centre_force,
    closest_point,
    printed_centre_force,
    tool_axis,
)
from dexrepro.robots.rotations import tilt

seeds = st.integers(0, 10_000)


def unit(rng):
    vector = rng.standard_normal(3)
    return vector / np.linalg.norm(vector)


@given(seeds)
@settings(max_examples=30, deadline=None)
def test_corrected_orientation_is_a_rotation_with_the_desired_axis(seed):
    rng = np.random.default_rng(seed)
    actual, desired = Rotation.random(rng=rng).as_matrix(), unit(rng)
    turned = aligned(actual, desired)
    assert turned[:, 2] == pytest.approx(desired, abs=1e-12)
    assert turned.T @ turned == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(turned) == pytest.approx(1.0)


@given(seeds)
@settings(max_examples=30, deadline=None)
def test_printed_axis_doubles_the_angle(seed):
    rng = np.random.default_rng(seed)
    actual, desired = Rotation.random(rng=rng).as_matrix(), unit(rng)
    before = np.linalg.norm(tilt(desired, actual[:, 2]))
    after = np.linalg.norm(tilt(desired, aligned(actual, desired, printed=True)[:, 2]))
    assert after == pytest.approx(min(2 * before, 2 * np.pi - 2 * before), abs=1e-6)


def test_aligned_axes_leave_the_orientation_and_opposed_ones_turn_it_over():
    assert aligned(np.eye(3), np.array([0.0, 0.0, 1.0])) == pytest.approx(np.eye(3))
    turned = aligned(np.eye(3), np.array([0.0, 0.0, -1.0]))
    assert turned[:, 2] == pytest.approx([0, 0, -1], abs=1e-12)


@given(seeds)
@settings(max_examples=30, deadline=None)
def test_shortest_distance_agrees_with_herons_formula(seed):
    rng = np.random.default_rng(seed)
    wrist, tip = rng.standard_normal((2, 3))
    centre = wrist + rng.uniform(0.1, 0.9) * (tip - wrist) + 0.3 * rng.standard_normal(3)
    _, foot = closest_point(centre, [wrist, tip])
    inside = 0 < (foot - wrist) @ (tip - wrist) < (tip - wrist) @ (tip - wrist) - 1e-9
    if inside:
        a, b, c = (np.linalg.norm(x) for x in (centre - wrist, centre - tip, tip - wrist))
        s = (a + b + c) / 2
        area = np.sqrt(max(s * (s - a) * (s - b) * (s - c), 0.0))
        assert np.linalg.norm(centre - foot) == pytest.approx(2 * area / c, abs=1e-6)
        assert (centre - foot) @ (tip - wrist) == pytest.approx(0.0, abs=1e-12)


def test_force_pulls_the_arm_to_the_centre_and_the_printed_one_does_not():
    wrist, tip, centre = np.array([0.0, 0, 0]), np.array([0.0, 0, -0.4]), np.array([0.1, 0, -0.1])
    _, foot = closest_point(centre, [wrist, tip])
    assert centre_force(centre, foot, 300.0) == pytest.approx([30.0, 0.0, 0.0])
    printed = printed_centre_force(centre, tip, wrist, 300.0)
    assert printed[0] < 0  # away from the centre
    assert abs(printed[2]) > 1  # and not across the link


def test_tool_axis_passes_through_the_centre_once_it_can_be_told():
    centre, target = np.zeros(3), np.array([0.0, 0.3, -0.4])
    assert tool_axis(centre, centre, target, 0.08) == pytest.approx([0, 0.6, -0.8])
    aside = np.array([0.05, 0.15, -0.2])
    assert tool_axis(aside, centre, target, 0.08) == pytest.approx(aside / np.linalg.norm(aside))


@pytest.mark.parametrize("shift", [np.zeros(3), np.array([0.4, -0.2, 0.7])])
def test_nothing_depends_on_where_the_origin_is(shift):
    """The force as printed is K (to - link) (to . link) / (L^2): from the definition of R with e = P_E - P_EA."""
    wrist, tip, centre = np.array([0.0, 0, 0]), np.array([0.0, 0.1, -0.4]), np.array([0.1, 0, -0.1])
    to, link = tip - centre, tip - wrist
    expected = 300.0 * (to - link) * (to @ link) / (link @ link)
    assert printed_centre_force(centre + shift, tip + shift, wrist + shift, 300.0) == pytest.approx(expected)
    assert not printed_centre_force(tip + shift, tip + shift, wrist + shift, 300.0).any()
    target, aside = np.array([0.0, 0.3, -0.4]), np.array([0.05, 0.15, -0.2])
    axis = tool_axis(aside + shift, shift, target + shift, 0.08)
    assert axis == pytest.approx(aside / np.linalg.norm(aside))
    assert tool_axis(0.1 * aside + shift, shift, target + shift, 0.08) == pytest.approx([0, 0.6, -0.8])


def test_the_nearest_point_lies_on_one_of_the_segments_or_at_a_corner():
    corners = [np.array(corner) for corner in ([0.0, 0, 0], [1.0, 0, 0], [1.0, 1, 0])]
    for centre, segment, point in (
        ([0.3, 0.2, 0.1], 0, [0.3, 0, 0]),
        ([-0.5, 0.1, 0.0], 0, [0, 0, 0]),
        ([0.9, 0.4, 0.0], 1, [1, 0.4, 0]),
        ([1.2, 3.0, 0.0], 1, [1, 1, 0]),
    ):
        found, place = closest_point(np.array(centre, dtype=float), corners)
        assert found == segment
        assert place == pytest.approx(point)
