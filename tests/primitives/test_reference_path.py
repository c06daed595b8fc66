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
