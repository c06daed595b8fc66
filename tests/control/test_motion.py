"""Paths over time, and the minimum-jerk movement they share."""

import numpy as np
import pytest

from dexrepro.control.motion import minimum_jerk, quintic, via_points


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
