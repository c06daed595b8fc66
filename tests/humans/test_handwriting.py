"""Letters and crossings as a hand makes them."""

import numpy as np
import pytest

from dexrepro.humans.crossing import clearance, via_points
from dexrepro.humans.handwriting import LETTERS, smoothed, tremor, via_path, write

TIME = np.linspace(0, 3, 1001)


@pytest.mark.parametrize("letter", LETTERS)
def test_letters_pass_their_via_points_and_start_and_end_at_rest(letter):
    points = 4 * np.array(LETTERS[letter])
    path = via_path(points, TIME)
    nearest = np.linalg.norm(path[:, None] - points[None], axis=2).min(axis=0)
    assert nearest.max() < 0.05
    np.testing.assert_allclose(path[[0, -1]], points[[0, -1]], atol=1e-12)
    assert np.abs(np.diff(path, axis=0)[[0, -1]]).max() < 1e-4


def test_small_letters_share_start_and_end():
    ends = {(LETTERS[name][0], LETTERS[name][-1]) for name in "azlkw"}
    assert len(ends) == 1


def test_tremor_has_its_size_and_frequencies_and_spares_the_ends():
    shake = tremor(TIME, 2, 0.02, np.random.default_rng(0))
    assert np.sqrt(np.mean(shake[100:-100] ** 2)) == pytest.approx(0.02, rel=0.25)
    np.testing.assert_allclose(shake[[0, -1]], 0, atol=1e-3)
    spectrum = np.abs(np.fft.rfft(shake[:, 0])) ** 2
    frequency = np.fft.rfftfreq(len(TIME), TIME[1])
    assert spectrum[(frequency > 7) & (frequency < 13)].sum() > 0.9 * spectrum.sum()


def test_smoothing_keeps_the_ends_and_removes_most_of_the_tremor():
    smooth = via_path(4 * np.array(LETTERS["w"]), TIME)
    shaken = smooth + tremor(TIME, 2, 0.02, np.random.default_rng(0))
    found = smoothed(TIME, shaken, 6.0)
    np.testing.assert_allclose(found[[0, -1]], shaken[[0, -1]], atol=1e-12)
    assert np.std(np.diff(found - smooth, axis=0)) < 0.5 * np.std(np.diff(shaken - smooth, axis=0))


def test_repetitions_differ_between_the_ends_alone():
    rng = np.random.default_rng(0)
    first, second = (write("a", TIME, 4.0, 0.05, 0.0, 6.0, rng) for _ in range(2))
    np.testing.assert_allclose(first[[0, -1]], second[[0, -1]], atol=1e-12)
    assert 0.01 < np.abs(first - second).max() < 0.5


@pytest.mark.parametrize("blocks", [1, 2, 3])
def test_crossings_pass_above_the_lip_by_their_clearance(blocks):
    path = via_path(via_points(blocks, 1.3, 2.6), TIME)
    assert 1.0 < clearance(path, blocks).min() < 1.6


def test_clearance_is_negative_inside_the_stack_and_the_distance_outside():
    points = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [4.0, 0.0, 1.0], [0.0, 0.0, 4.2]])
    np.testing.assert_allclose(clearance(points, 1), [-1.0, -1.0, 3.0, 2.0])
