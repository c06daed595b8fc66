import math

import numpy as np
import pytest

from dexrepro.measures import angle_between, binomial_interval, last_outside, rms, rms_distance, rms_length


def test_root_mean_squares_of_numbers_and_of_distances():
    assert rms([1.0, -7.0]) == 5.0  # the mean of the magnitudes is 4
    assert rms_distance([[1.0, 0.0], [0.0, -7.0]]) == 5.0
    paths = np.zeros((2, 5, 3)) + np.array([3.0, 0.0, 4.0])
    assert rms_distance(paths) == pytest.approx([5.0, 5.0])
    assert rms_distance(paths[0], paths[1]) == 0.0


def test_a_run_too_short_to_tell_gives_no_number():
    assert math.isnan(rms([]))
    assert math.isnan(rms_length(np.zeros((0, 3))))


def test_the_last_instant_outside_a_bound():
    time = np.arange(5.0)
    assert last_outside(time, np.array([3.0, -2.0, 0.5, 2.0, 0.1]), 1.0) == 3.0
    assert last_outside(time, np.zeros(5), 1.0) == 0.0


def test_angles_do_not_depend_on_lengths():
    first, second = np.array([[2.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), np.array([[1.0, 1.0, 0.0], [0.0, 0.0, -7.0]])
    assert angle_between(first, second) == pytest.approx([math.pi / 4, math.pi])


def test_score_interval_contains_the_share_and_the_exact_one_is_wider():
    low, high = binomial_interval(9, 9)
    assert low == pytest.approx(9 / (9 + 1.959964**2), rel=1e-4), "Wilson: n / (n + z^2) where all succeed"
    assert high == pytest.approx(1.0)
    exact = binomial_interval(5, 10, "exact")
    score = binomial_interval(5, 10)
    assert exact[0] < score[0] < 0.5 < score[1] < exact[1]
