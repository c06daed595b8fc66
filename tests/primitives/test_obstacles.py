import numpy as np
import pytest

from dexrepro.primitives.obstacles import Disk, Polygon, clearance

SQUARE = Polygon.rectangle((0, 2), (0, 2))


def test_distance_is_negative_inside_and_euclidean_outside():
    points = [(1, 1), (0.25, 1), (3, 1), (3, 3), (1, -2)]
    assert SQUARE.distance(points) == pytest.approx([-1, -0.25, 1, np.sqrt(2), 2])


def test_closest_point_lies_on_the_boundary_at_the_distance():
    points = np.random.default_rng(0).uniform(-3, 5, (200, 2))
    triangle = Polygon(np.array([(9.0, 10.5), (13.0, 10.5), (11.0, 13.0)]) - [10, 10])
    feet = triangle.closest(points)
    np.testing.assert_allclose(np.abs(triangle.distance(feet)), 0, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(feet - points, axis=1), np.abs(triangle.distance(points)))


def test_boundary_points_are_evenly_spaced_and_the_centroid_is_the_centre():
    boundary = SQUARE.boundary(16)
    np.testing.assert_allclose(np.linalg.norm(np.diff(boundary, axis=0), axis=1), 0.5)
    np.testing.assert_allclose(SQUARE.centroid, [1, 1])


def test_clearance_is_the_worst_over_obstacles_also_moving_ones():
    path = np.stack([np.linspace(-1, 3, 5), np.full(5, 3.0)], axis=1)
    assert clearance(path, [SQUARE]) == pytest.approx(1)
    follower = Disk(path + [0, 0.5], 0.4)
    assert clearance(path, [SQUARE, follower]) == pytest.approx(0.1)


L_SHAPE = Polygon(np.array([[0.0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]]) + [5.0, -2.0])


def test_a_polygon_with_a_notch_has_the_inside_and_the_centroid_of_its_two_rectangles():
    """4 x 1 with its centre at (2, 0.5), and 1 x 2 at (0.5, 2), from the corner (5, -2)."""
    points = np.random.default_rng(1).uniform(-1, 5, (400, 2))
    x, y = points.T
    inside = ((x > 0) & (x < 4) & (y > 0) & (y < 1)) | ((x > 0) & (x < 1) & (y > 0) & (y < 3))
    assert 20 < inside.sum() < 200
    assert np.array_equal(L_SHAPE.contains(points + [5.0, -2.0]), inside)
    assert np.array_equal(L_SHAPE.distance(points + [5.0, -2.0]) < 0, inside)
    assert L_SHAPE.centroid == pytest.approx(np.array([5 + (4 * 2 + 2 * 0.5) / 6, -2 + (4 * 0.5 + 2 * 2) / 6]))


def test_the_boundary_begins_at_the_first_corner_and_goes_once_around():
    around = L_SHAPE.boundary(14)  # 14 long
    expected = [(0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (4, 1), (3, 1), (2, 1), (1, 1), (1, 2), (1, 3), (0, 3), (0, 2)]
    assert around[:13] == pytest.approx(np.array(expected) + [5.0, -2.0])


def test_a_polygon_a_run_is_each_run_s_own():
    both = Polygon(np.stack([SQUARE.vertices, SQUARE.vertices + [10.0, 0.0]]))
    points = np.array([[1.0, 1.5], [1.0, 1.5]])
    assert both.distance(points) == pytest.approx([-0.5, 9.0])
    assert both.closest(points) == pytest.approx(np.array([[1, 2], [10, 1.5]]))


def test_inside_is_told_behind_any_number_of_edges_and_of_any_slope():
    tops = [[5, 2], [4, 2], [4, 1], [3, 1], [3, 2], [2, 2], [2, 1], [1, 1], [1, 2], [0, 2]]
    comb = Polygon(np.array([[0.0, 0.0], [5.0, 0.0], *tops]))
    points = [(x + 0.5, 1.5) for x in range(-1, 6)]
    assert comb.contains(points).tolist() == [False, True, False, True, False, True, False]
    corners = np.array([[1.0, -2.0], [6.0, 0.5], [2.5, 4.0]])
    where = np.random.default_rng(2).uniform(-3, 7, (300, 2))
    sides = [np.linalg.det(np.stack([np.broadcast_to(b - a, where.shape), where - a], axis=-1))
             for a, b in zip(corners, np.roll(corners, -1, axis=0))]  # fmt: skip
    assert np.array_equal(Polygon(corners).contains(where), np.all(np.array(sides) > 0, axis=0))
