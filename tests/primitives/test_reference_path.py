import numpy as np
import pytest

from dexrepro.primitives.reference_path import arc, chord_length, detour, differentiable, lagrange


def straight() -> tuple[np.ndarray, np.ndarray]:
    time = np.linspace(0, 4, 401)
    u = time / 4
    return time, np.stack([10 * u**3 * (10 - 15 * u + 6 * u * u), np.zeros_like(u)], axis=1)


def test_reference_is_twice_differentiable_and_ends_at_rest():
    time, path = straight()
    reference = differentiable(time[::10], path[::10], time)
    np.testing.assert_allclose(reference.position, path, atol=1e-3)
    np.testing.assert_allclose(reference.velocity[[0, -1]], 0, atol=1e-12)
    np.testing.assert_allclose(np.gradient(reference.velocity[:, 0], time), reference.acceleration[:, 0], atol=0.05)


def test_detour_passes_the_new_points_and_keeps_the_rest():
    time, path = straight()
    leave, resume = np.searchsorted(path[:, 0], [2.5, 7.5])
    bump = arc((5, 0), 1.0, np.pi, 0)
    at, points = detour(time, path, bump, int(leave), int(resume), samples=2001)
    assert at[[0, -1]] == pytest.approx([0, 4])
    np.testing.assert_allclose(points[[0, -1]], path[[0, -1]], atol=1e-6)
    for target in bump[::6]:
        assert np.linalg.norm(points - target, axis=1).min() < 0.02
    before = at < time[leave] - 0.1
    kept = np.stack([np.interp(at[before], time, path[:, axis]) for axis in (0, 1)], axis=1)
    np.testing.assert_allclose(points[before], kept, atol=0.05)
    assert (np.diff(chord_length(points)) >= 0).all()


def test_global_polynomial_oscillates_on_a_detour():
    """Runge's phenomenon: the book names Lagrange interpolation as an example."""
    at = np.linspace(-1, 1, 400)
    errors = []
    for count in (6, 22):
        nodes = np.linspace(-1, 1, count)
        value = lagrange(nodes, (1 / (1 + 25 * nodes**2))[:, None], at)
        errors.append(np.abs(value[:, 0] - 1 / (1 + 25 * at**2)).max())
    assert errors[1] > 5 * errors[0]
    line = lagrange(nodes, np.stack([nodes, 2 * nodes], 1), at)
    np.testing.assert_allclose(line, np.stack([at, 2 * at], 1), atol=1e-10)


def test_arcs_and_lengths():
    points = arc((5, 1), 2.0, np.pi, np.pi / 2, count=401)
    assert points[[0, -1]] == pytest.approx(np.array([[3, 1], [5, 3]]))
    assert np.linalg.norm(points - [5, 1], axis=1) == pytest.approx(2.0)
    assert chord_length(points)[[0, -1]] == pytest.approx([0, np.pi], rel=1e-5)


def test_a_detour_keeps_the_old_pace_before_it_leaves_and_stretches_the_rest():
    """The share of the remaining length that has been done at an instant is that of the old path."""
    time, path = straight()
    leave, resume = (int(k) for k in np.searchsorted(path[:, 0], [2.5, 7.5]))
    at, points = detour(time, path, arc((5, 0), 1.0, np.pi, 0), leave, resume, samples=401)
    done, old = chord_length(points), chord_length(path)
    left = done[leave]
    assert done[:leave:20] == pytest.approx(old[:leave:20], abs=0.06)
    share = (done[leave::20] - left) / (done[-1] - left)
    assert share == pytest.approx((old[leave::20] - old[leave]) / (old[-1] - old[leave]), abs=0.02)
    assert done[-1] > old[-1] + 0.8
    assert at == pytest.approx(time)


def test_the_polynomial_passes_every_node():
    nodes = np.array([[0.0, 1.0], [2.0, -1.0], [3.0, 0.5], [1.0, 1.0]])
    parameter = np.array([0.0, 1.0, 1.5, 3.0])
    assert lagrange(parameter, nodes, parameter) == pytest.approx(nodes)
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 0.3])
    at = np.linspace(-1, 4, 9)
    assert lagrange(parameter, cubic(parameter)[:, None], at)[:, 0] == pytest.approx(cubic(at))
