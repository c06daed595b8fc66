import numpy as np
import pytest

from dexrepro.humans.segmentation import change_point, slowest_point
from dexrepro.humans.waypoints import average, draw, stroke

DOWN = [(0, 10), (0.5, 5), (0, 0)]
ACROSS = [(0, 0), (5, 0.5), (10, 0)]


def test_stroke_passes_its_way_points():
    path = stroke(DOWN, np.linspace(0, 1, 2001))
    for point in DOWN:
        assert np.linalg.norm(path - point, axis=1).min() < 0.01


def test_drawing_joins_its_strokes_and_pauses_between_them():
    drawing = draw([DOWN, ACROSS], [2.0, 3.0], np.random.default_rng(0), 0.2, 0.0)
    assert drawing.time[-1] == pytest.approx(5.2)
    np.testing.assert_allclose(drawing.position[[0, -1]], [(0, 10), (10, 0)], atol=1e-12)
    pausing = np.abs(drawing.time - drawing.pauses[0]) < 0.09
    assert np.ptp(drawing.position[pausing], axis=0).max() < 1e-3


def test_three_strokes_follow_one_another_with_a_pause_between_each():
    back = [(10, 0), (5, 5), (0, 10)]
    drawing = draw([DOWN, ACROSS, back], [2.0, 3.0, 4.0], np.random.default_rng(0), 0.3, 0.0, pause=0.5)
    assert drawing.time[-1] == pytest.approx(2 + 0.5 + 3 + 0.5 + 4)
    assert drawing.pauses == pytest.approx([2.25, 5.75])
    np.testing.assert_allclose(drawing.position[[0, -1]], [(0, 10), (0, 10)], atol=1e-12)
    assert np.abs(np.diff(drawing.position, axis=0)).max() < 0.2, "no jump where strokes meet"
    meeting = drawing.position[np.searchsorted(drawing.time, drawing.pauses)]
    missed = np.abs(meeting - [(0, 0), (10, 0)])
    assert np.all((missed > 1e-3) & (missed < 1.2)), "where strokes meet is missed, too"


def test_way_points_are_missed_by_the_spread_and_samples_by_the_tremor():
    crossings = []
    for seed in range(200):
        position = draw([DOWN], [2.0], np.random.default_rng(seed), 0.3, 0.0).position
        crossings.append(position[np.argmin(np.abs(position[:, 1] - 5)), 0])
    assert np.mean(crossings) == pytest.approx(0.5, abs=0.08)
    assert np.std(crossings) == pytest.approx(0.3, rel=0.15)
    still, shaken = (draw([DOWN], [20.0], np.random.default_rng(0), 0.3, size).position for size in (0.0, 0.05))
    assert (shaken - still).mean() == pytest.approx(0, abs=0.005)
    assert (shaken - still).std() == pytest.approx(0.05, rel=0.05)


def test_a_movement_that_begins_later_has_the_same_average():
    u = np.linspace(0, 1, 201)
    path = stroke(ACROSS, u)
    time, mean = average([(7 + 4 * u, path), (3 + 6 * u, path)], samples=201)
    assert time[[0, -1]] == pytest.approx([0, 5])
    np.testing.assert_allclose(mean, path, atol=1e-12)


@pytest.mark.parametrize("method", [change_point, slowest_point])
def test_segmentation_finds_the_pause(method):
    for seed in range(3):
        drawing = draw([DOWN, ACROSS], [4.5, 5.0], np.random.default_rng(seed), 0.1, 0.01)
        assert method(drawing.time, drawing.position) == pytest.approx(drawing.pauses[0], abs=0.3)


def test_average_of_one_movement_at_two_speeds_is_that_movement():
    u = np.linspace(0, 1, 201)
    path = stroke(ACROSS, u)
    time, mean = average([(4 * u, path), (6 * u, path)], samples=201)
    assert time[-1] == pytest.approx(5)
    np.testing.assert_allclose(mean, path, atol=1e-12)
