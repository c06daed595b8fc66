import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.control.null_space import consistent_damping, consistent_inverse, damped_inverse


@given(st.integers(0, 10_000), st.sampled_from([3, 5, 6]))
@settings(max_examples=20, deadline=None)
def test_null_space_torque_does_not_accelerate_the_task(seed, size):
    rng = np.random.default_rng(seed)
    root, jacobian = rng.standard_normal((7, 7)), rng.standard_normal((size, 7))
    mass = root @ root.T + np.eye(7)
    inverse, projector = consistent_inverse(mass, jacobian, damping=0.0)
    assert jacobian @ inverse == pytest.approx(np.eye(size), abs=1e-7)
    assert projector @ projector == pytest.approx(projector, abs=1e-6)
    assert jacobian @ np.linalg.solve(mass, projector @ rng.standard_normal(7)) == pytest.approx(0.0, abs=1e-6)


def test_consistent_damping_of_null_space_motion_does_not_accelerate_the_task_as_plain_damping_does():
    rng = np.random.default_rng(2)
    root, jacobian, damping = rng.standard_normal((7, 7)), rng.standard_normal((3, 7)), rng.uniform(1, 20, 7)
    mass = root @ root.T + np.eye(7)
    inverse, projector = consistent_inverse(mass, jacobian, damping=0.0)
    matrix = consistent_damping(damping, jacobian, inverse, projector)
    task, null = inverse @ rng.standard_normal(3), (np.eye(7) - inverse @ jacobian) @ rng.standard_normal(7)
    assert matrix @ task == pytest.approx(damping * task)
    assert jacobian @ np.linalg.solve(mass, matrix @ null) == pytest.approx(0.0, abs=1e-8)
    assert np.linalg.norm(jacobian @ np.linalg.solve(mass, damping * null)) > 0.1


def test_damped_inverse_tends_to_the_right_inverse():
    jacobian = np.random.default_rng(1).standard_normal((3, 7))
    assert jacobian @ damped_inverse(jacobian, 1e-12) == pytest.approx(np.eye(3))


def test_damped_inverse_weighs_the_miss_against_the_length_of_the_answer():
    """It gives the x of the least |J x - y|^2 + damping |x|^2."""
    rng = np.random.default_rng(3)
    jacobian, y = rng.standard_normal((3, 7)), rng.standard_normal(3)
    stacked, wanted = np.vstack([jacobian, np.sqrt(0.3) * np.eye(7)]), np.append(y, np.zeros(7))
    assert damped_inverse(jacobian, 0.3) @ y == pytest.approx(np.linalg.lstsq(stacked, wanted)[0])


def test_damping_bounds_the_torque_where_the_task_is_singular():
    """Without it a task of two equal rows has no inverse; with it both rows bear half of it, by the inertia each."""
    mass, row, damping = np.diag([2.0, 4.0]), np.array([1.0, 0.0]), 0.1
    inverse, projector = consistent_inverse(mass, np.array([row, row]), damping)
    compliance = row @ np.linalg.solve(mass, row)
    assert inverse == pytest.approx(np.outer(np.linalg.solve(mass, row), [1, 1]) / (2 * compliance + damping))
    assert projector == pytest.approx(np.eye(2) - np.outer(row, row) * 2 * compliance / (2 * compliance + damping))
