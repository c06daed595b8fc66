"""Paths over time, and the minimum-jerk movement they share."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from dexrepro.control.motion import Sampled, circle, held, line, minimum_jerk, quintic, rest, via_points

SPLINE = CubicSpline([1.0, 1.5, 2.5, 3.0], np.random.default_rng(0).normal(size=(4, 2)))


def test_minimum_jerk_starts_and_ends_at_rest():
    u = np.linspace(0, 1, 1001)
    speed = np.gradient(minimum_jerk(u), u)
    assert minimum_jerk([-1.0, 0.0, 0.5, 1.0, 2.0]) == pytest.approx([0, 0, 0.5, 1, 1])
    assert speed[[0, -1]] == pytest.approx(0, abs=1e-4)
    assert speed.max() == pytest.approx(1.875, rel=1e-4)


def test_plain_floats_give_the_same_movement_and_its_rate():
    u = np.linspace(-0.5, 1.5, 201)
    shares, rates = zip(*(quintic(2.0 * x, 2.0) for x in u))
    assert shares == pytest.approx(minimum_jerk(u), abs=1e-14)
    assert np.gradient(shares, 2.0 * u)[1:-1] == pytest.approx(rates[1:-1], abs=2e-3)


def test_segments_between_points_are_minimum_jerk():
    path = via_points([[0.0, 0.0], [1.0, -2.0]], [2.0], 0.01)
    assert path.position[:, 1] == pytest.approx(-2.0 * minimum_jerk(np.arange(200) / 200))
    assert path.duration == pytest.approx(2.0)


def test_segments_follow_each_other_and_rest_at_every_point():
    path = via_points([[0.0], [1.0], [-1.0]], [1.0, 0.5], 0.01)
    assert len(path) == 150
    assert path.position[[0, 100]] == pytest.approx(np.array([[0.0], [1.0]]))
    assert path.velocity[[0, 100]] == pytest.approx(0.0)
    assert path.acceleration[[0, 100]] == pytest.approx(0.0)
    assert path.position[125] == pytest.approx(0.0), "half the way"
    assert path.velocity[125] == pytest.approx(1.875 * -2.0 / 0.5)
    for part in (slice(0, 100), slice(100, 150)):  # the acceleration is continuous, its rate is not
        slope = np.gradient(path.velocity[part, 0], 0.01)
        assert slope[1:-1] == pytest.approx(path.acceleration[part, 0][1:-1], abs=0.7)


@pytest.mark.parametrize(
    "path",
    [
        line([0.1, 0.2], [0.5, -0.4], 3.0),
        circle([0.1, 0.2, 0.3], 0.25, 4.0),
        held(SPLINE, 1.0, 3.0),
        rest([1.0, 2.0]),
    ],
)
@pytest.mark.parametrize("time", [0.4, 1.3, 2.2, 2.9, 5.0])
def test_a_path_gives_its_own_derivatives(path, time):
    h = 1e-4
    before, here, after = (path(time + shift) for shift in (-h, 0.0, h))
    assert here.velocity == pytest.approx((after.position - before.position) / (2 * h), rel=1e-5, abs=1e-6)
    assert here.acceleration == pytest.approx((after.velocity - before.velocity) / (2 * h), rel=1e-5, abs=1e-6)


def test_a_line_goes_from_end_to_end_in_half_a_period():
    path = line([0.1, 0.2], [0.5, -0.4], 3.0)
    assert path(0.0).position == pytest.approx([0.1, 0.2])
    assert path(0.0).velocity == pytest.approx([0.0, 0.0])
    assert path(0.75).position == pytest.approx([0.3, -0.1])
    assert path(1.5).position == pytest.approx([0.5, -0.4])
    assert path(3.0).position == pytest.approx([0.1, 0.2])


def test_a_circle_keeps_its_radius_and_turns_once_a_period_after_a_start_from_rest():
    path, centre = circle([0.1, 0.2, 0.3], 0.25, 4.0), np.array([0.1, 0.2, 0.3])
    for time in np.linspace(0.0, 9.0, 31):
        position, velocity, _ = path(time)
        assert np.linalg.norm(position[:2] - centre[:2]) == pytest.approx(0.25)
        assert (position - centre) @ velocity == pytest.approx(0.0, abs=1e-12)
        assert (position[2], velocity[2]) == (0.3, 0.0)
        assert np.linalg.norm(velocity) == pytest.approx(0.25 * np.pi / 2 * (1 - np.exp(-time / 0.4)))
    assert path(0.0).position == pytest.approx([0.35, 0.2, 0.3])
    assert path(9.4).position == pytest.approx(path(5.4).position, abs=1e-6)
    assert path(1.4).position[1] == pytest.approx(0.45, abs=5e-3), "a quarter later, less the 0.4 s of the start"


def test_a_held_curve_rests_at_its_ends_before_and_after():
    path = held(SPLINE, 1.0, 3.0)
    for time, end in ((0.2, 1.0), (7.0, 3.0)):
        assert path(time).position == pytest.approx(SPLINE(end))
        assert not np.any([path(time).velocity, path(time).acceleration])
    for time in (1.0, 2.0, 3.0):
        assert path(time).acceleration == pytest.approx(SPLINE(time, 2))


def test_the_nearest_sample_counts_and_the_last_one_for_ever_after():
    path = Sampled(0.5, np.arange(4.0), 10 + np.arange(4.0), 20 + np.arange(4.0))
    assert [path(time).position for time in (0.0, 0.2, 0.3, 0.74, 1.5, 9.0)] == [0, 0, 1, 1, 3, 3]
    assert path(0.9) == (2.0, 12.0, 22.0)
    assert (len(path), path.duration) == (4, 2.0)


def test_rest_stays_with_no_velocity_and_no_acceleration():
    for part, value in zip(rest([1, 2])(3.0), ([1.0, 2.0], [0.0, 0.0], [0.0, 0.0])):
        assert part.tolist() == value
