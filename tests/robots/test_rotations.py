import numpy as np
from scipy.spatial.transform import Rotation

from dexrepro.robots.rotations import (
    cross,
    perpendicular,
    quaternion_from_euler,
    quaternion_from_rotation,
    rotated,
    rotation_error,
    rotation_from_quaternion,
    rotation_matrix,
    tilt,
)


def test_rotation_error_is_the_rotation_vector():
    vectors = np.random.default_rng(0).uniform(-1, 1, (20, 3))
    base = Rotation.random(20, random_state=1).as_matrix()
    for vector, actual in zip(vectors, base):
        desired = Rotation.from_rotvec(vector).as_matrix() @ actual
        np.testing.assert_allclose(rotation_error(desired, actual), vector, atol=1e-12)
    assert not rotation_error(np.eye(3), np.eye(3)).any()


def test_one_orientation_and_many_have_the_same_rotation_error():
    desired, actual = Rotation.random(50, random_state=2).as_matrix(), Rotation.random(50, random_state=3).as_matrix()
    single = [rotation_error(wanted, has) for wanted, has in zip(desired, actual)]
    np.testing.assert_allclose(rotation_error(desired, actual), single, atol=1e-12)


def test_tilt_is_the_least_rotation_between_two_axes():
    axes = np.random.default_rng(0).normal(size=(20, 2, 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    for first, second in axes:
        vector = tilt(first, second)
        np.testing.assert_allclose(rotation_matrix(vector) @ first, second, atol=1e-12)
        assert abs(vector @ first) < 1e-12, "no spin about the axis itself"
    up = np.array([0.0, 0.0, 1.0])
    np.testing.assert_array_equal(tilt(up, up), np.zeros(3))
    np.testing.assert_allclose(rotation_matrix(tilt(up, -up)) @ up, -up, atol=1e-12)


def test_vectors_and_quaternions_turn_as_in_scipy():
    rng = np.random.default_rng(1)
    for vector, other in rng.normal(size=(20, 2, 3)):
        turn = Rotation.from_rotvec(vector)
        np.testing.assert_allclose(rotation_matrix(vector), turn.as_matrix(), atol=1e-12)
        np.testing.assert_allclose(rotated(turn.as_quat(), other), turn.apply(other), atol=1e-12)
        np.testing.assert_allclose(cross(vector, other), np.cross(vector, other), atol=1e-12)
        unit = vector / np.linalg.norm(vector)
        assert abs(perpendicular(unit) @ unit) < 1e-12


def test_quaternions_are_those_of_scipy_and_every_formula_of_a_matrix_gives_them_back():
    turns = Rotation.concatenate([Rotation.random(40, random_state=4), Rotation.from_rotvec(np.pi * np.eye(3))])
    matrices, scalar_last = turns.as_matrix(), turns.as_quat()
    quaternions = np.roll(scalar_last, 1, axis=1)
    np.testing.assert_allclose(rotation_from_quaternion(quaternions), matrices, atol=1e-12)
    np.testing.assert_allclose(rotation_from_quaternion(quaternions[0]), matrices[0], atol=1e-12)
    back = quaternion_from_rotation(matrices)
    np.testing.assert_allclose(np.abs(np.sum(back * quaternions, axis=1)), 1, atol=1e-12)
    np.testing.assert_allclose(rotation_from_quaternion(back), matrices, atol=1e-12)
    angles = np.random.default_rng(5).uniform(-1.5, 1.5, (20, 3))
    expected = Rotation.from_euler("xyz", angles).as_matrix()
    np.testing.assert_allclose(rotation_from_quaternion(quaternion_from_euler(angles)), expected, atol=1e-12)
