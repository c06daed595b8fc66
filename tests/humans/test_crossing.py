import numpy as np
import pytest

from dexrepro.humans.crossing import clearance, obstacle_boxes, via_points


def test_three_cubes_carry_the_lip():
    stack, lip = obstacle_boxes(3)
    np.testing.assert_allclose(stack, [(-1, -1, 0), (1, 1, 6)])
    np.testing.assert_allclose(lip, [(-1, -4, 6), (1, 4, 6.2)])


@pytest.mark.parametrize(
    ("point", "distance"),
    [
        ((0, 0, 9.2), 3), ((4, 0, 10.2), 5), ((0, 5, 6.1), 1), ((0, -6, 6.1), 2),  # above, beyond a corner, beside
        ((-2, 0, 3), 1), ((0, 3, 3), 2), ((0, -2.5, 3), 1.5),  # beside the stack
        ((0, 0, 3), -1), ((0.4, 0, 3), -0.6), ((0, 0, 0), -1), ((2, 0, -1), 1),  # inside; the stack goes on below
    ],
)  # fmt: skip
def test_clearance_is_the_distance_from_the_nearer_box(point, distance):
    assert clearance(np.full((2, 4, 3), point, float), 3) == pytest.approx(np.full((2, 4), distance))


def test_the_movement_is_symmetric_and_level_above_the_lip():
    path = via_points(3, 1.0, 2.0)
    np.testing.assert_allclose(path[::-1] * [-1, 1, 1], path, atol=1e-12)
    np.testing.assert_allclose(path[[0, -1]], [(-6, 0, 0), (6, 0, 0)])
    assert np.all(np.diff(path[:, 0]) > 0)
    assert np.all(np.diff(path[:5, 2]) > 0)
    assert path[[3, 5], 2] == pytest.approx(6.2 + 1.0)
    assert np.ptp(path[3:6, 2]) < 0.3
    level = path[[2, 6], 0]
    assert np.diff(via_points(3, 1.0, 3.0)[[2, 6], 0]) == pytest.approx(np.diff(level) + 2), "plateau is half a length"
