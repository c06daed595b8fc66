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
