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
