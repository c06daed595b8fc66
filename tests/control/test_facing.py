import numpy as np
from scipy.spatial.transform import Rotation

from dexrepro.control.facing import facing, quaternion_from_rotation_printed
from dexrepro.robots.rotations import quaternion_from_euler, quaternion_from_rotation, rotation_from_quaternion

quaternions = np.random.default_rng(3).normal(size=(2000, 4))
quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)


def test_the_facing_tool_keeps_x_and_opposes_y_and_z():
    partner, own = rotation_from_quaternion(quaternions), rotation_from_quaternion(facing(quaternions))
    np.testing.assert_allclose(own, partner @ np.diag([1.0, -1.0, -1.0]), atol=1e-14)


def test_facing_is_a_right_angle_in_quaternion_space_and_its_square_is_minus_one():
    np.testing.assert_allclose(np.sum(quaternions * facing(quaternions), axis=1), 0.0, atol=1e-15)
    np.testing.assert_allclose(facing(facing(quaternions)), -quaternions)


def test_half_a_turn_about_fixed_x_is_the_facing_rule():
    angles = np.random.default_rng(4).uniform(-np.pi, np.pi, (500, 3))
    turned = quaternion_from_euler(angles + [np.pi, 0.0, 0.0])
    np.testing.assert_allclose(turned, facing(quaternion_from_euler(angles)), atol=1e-14)
    expected = Rotation.from_euler("xyz", angles).as_matrix()
    np.testing.assert_allclose(rotation_from_quaternion(quaternion_from_euler(angles)), expected, atol=1e-14)


def test_quaternion_survives_the_rotation_matrix_also_at_half_turns():
    half_turns = np.c_[np.zeros(500), quaternions[:500, 1:] / np.linalg.norm(quaternions[:500, 1:], axis=1)[:, None]]
    for q in (quaternions, half_turns):
        back = quaternion_from_rotation(rotation_from_quaternion(q))
        np.testing.assert_allclose(np.abs(np.sum(back * q, axis=1)), 1.0, atol=1e-14)


def test_the_printed_formula_fails_at_half_turns_alone():
    axes = quaternions[:500, 1:] / np.linalg.norm(quaternions[:500, 1:], axis=1, keepdims=True)
    worst = {}
    for angle in (np.pi - 0.1, np.pi):
        rotations = Rotation.from_rotvec(angle * axes).as_matrix()
        q = quaternion_from_rotation_printed(rotations)
        back = rotation_from_quaternion(q / np.linalg.norm(q, axis=1, keepdims=True))
        worst[angle] = np.abs(back - rotations).max()
    assert worst[np.pi - 0.1] < 1e-12
    assert worst[np.pi] > 0.1


def test_one_orientation_or_any_batch_of_them_is_faced_alike():
    batch = quaternions.reshape(20, 100, 4)
    assert np.array_equal(facing(batch), facing(quaternions).reshape(batch.shape))
    assert np.array_equal(facing(batch[3, 7]), facing(batch)[3, 7])
    rotations = rotation_from_quaternion(batch)
    np.testing.assert_array_equal(quaternion_from_rotation_printed(rotations[3, 7]),
                                  quaternion_from_rotation_printed(rotations)[3, 7])  # fmt: skip
