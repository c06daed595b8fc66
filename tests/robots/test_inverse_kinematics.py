"""Closed-loop inverse kinematics reaches the workspace and stays within limits."""

from dataclasses import replace

import numpy as np
import pytest

from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.baxter import baxter, posture
from dexrepro.robots.inverse_kinematics import InverseKinematics, Unreachable, nearest, solve
from dexrepro.robots.kinematics import forward, jacobian
from dexrepro.robots.pen_arm import pen_arm
from dexrepro.robots.planar import planar
from dexrepro.robots.rotations import rotation_error

BOOK = planar([0.5, 0.3, 0.1], [1.5, 0.9, 0.2], base=(0.5, 0.0))
ARMS = {"planar 2": planar([0.2, 0.2], [2.0, 2.0]), "planar 3": BOOK, "pen arm": pen_arm(), "baxter": baxter("left")}


def reachable(arm, count, margin=0.05):
    rng = np.random.default_rng(4)
    lower, upper = np.maximum(arm.lower, -2.5) + margin, np.minimum(arm.upper, 2.5) - margin
    return forward(arm, rng.uniform(lower, upper, (count, arm.dof)))


@pytest.mark.parametrize(
    ("name", "task"),
    [("planar 2", "position"), ("planar 3", "position"), ("planar 3", "pose"), ("pen arm", "position")]
    + [("baxter", task) for task in ("position", "pose", "axis")],
)
def test_every_reachable_target_is_reached(name, task):
    arm = ARMS[name]
    for position, rotation in zip(*reachable(arm, 15)):
        q = solve(arm, position, rotation, task=task)
        assert (q >= arm.lower - 1e-9).all()
        assert (q <= arm.upper + 1e-9).all()
        place, turn = forward(arm, q)
        np.testing.assert_allclose(place, position, atol=2e-6)
        if task == "pose":
            np.testing.assert_allclose(rotation_error(rotation, turn), 0, atol=2e-6)
        if task == "axis":
            np.testing.assert_allclose(turn[:, 2], rotation[:, 2], atol=2e-6)


def test_target_out_of_reach_is_refused_with_the_best_error():
    with pytest.raises(Unreachable, match=r"comes no closer than 0\.1"):
        solve(ARMS["planar 2"], (0.5, 0.0, 0.0), restarts=1)


def test_error_decays_at_the_gain():
    follower = InverseKinematics(BOOK, gain=50.0, period=1e-3, damping=0.0)
    start = np.pi / 3 * np.ones(3)
    follower.reset(start)
    goal = forward(BOOK, start)[0] + (0.005, -0.005, 0)
    sizes = []
    for _ in range(100):
        follower(goal)
        sizes.append(np.linalg.norm(follower.error))
    assert sizes[-1] / sizes[0] == pytest.approx((1 - 0.05) ** 99, rel=0.05)


def test_reference_velocity_removes_the_lag():
    speed = np.array([0.05, 0.02, 0.0])
    errors = []
    for velocity in (None, speed):
        follower = InverseKinematics(BOOK, gain=20.0)
        start = np.pi / 3 * np.ones(3)
        follower.reset(start)
        origin = forward(BOOK, start)[0]
        for k in range(500):
            follower(origin + speed * k * 1e-3, velocity=velocity)
        errors.append(np.linalg.norm(follower.error))
    assert errors[0] == pytest.approx(np.linalg.norm(speed) / 20, rel=0.05)
    assert errors[1] < 1e-2 * errors[0]


def test_joint_and_speed_limits_are_never_exceeded_while_the_target_is_tracked():
    arm = baxter("right")
    follower = InverseKinematics(arm, "pose", gain=20.0, period=0.01, damping=0.02)
    follower.reset(posture("right"))
    position, rotation = forward(arm, posture("right"))
    for k in range(800):
        before = follower.position
        angle = 0.01 * k
        follower(position + 0.3 * np.array([np.sin(angle), 1 - np.cos(angle), 0.5 * np.sin(angle)]), rotation)
        assert (follower.position >= arm.lower - 1e-12).all()
        assert (follower.position <= arm.upper + 1e-12).all()
        assert (np.abs(follower.position - before) <= 0.01 * arm.speed + 1e-12).all()


def test_redundant_joints_drift_to_rest_without_moving_the_end_point():
    arm, start = baxter("left"), posture("left")
    follower = InverseKinematics(arm, "pose", 100.0, 1e-2, 1e-4, rest=np.zeros(7), rest_gain=0.5)
    follower.reset(start)
    position, rotation = forward(arm, start)
    for _ in range(300):
        follower(position, rotation)
    assert np.linalg.norm(follower.error) < 2e-3
    assert np.linalg.norm(follower.position) < np.linalg.norm(start) - 0.02


def test_rigid_body_model_may_stand_in_for_the_kinematics():
    arm, start = baxter("left"), posture("left")
    paths = []
    for kinematics in (None, RigidBodyModel(arm)):
        follower = InverseKinematics(arm, "pose", 50.0, 1e-2, 1e-2, kinematics=kinematics)
        follower.reset(start)
        position, rotation = forward(arm, start)
        for _ in range(20):
            follower(position + (0.02, 0.0, -0.03), rotation)
        paths.append(follower.position)
    np.testing.assert_allclose(*paths, atol=1e-8)


def test_unknown_task_is_refused():
    with pytest.raises(ValueError, match="none of position, pose, axis"):
        InverseKinematics(BOOK, "orientation")


def test_the_nearest_posture_leaves_no_pull_in_the_null_space():
    arm, home = baxter("right"), posture("right")
    place, turn = forward(arm, home + 0.1)
    q = nearest(arm, home, place, turn, settle=400)
    np.testing.assert_allclose(forward(arm, q)[0], place, atol=1e-8)
    free = np.linalg.svd(jacobian(arm, q))[2][-1]
    assert abs(free @ (home - q)) < 1e-6 < np.abs(home - q).max()


def slow(arm, speed):
    return replace(arm, joints=tuple(replace(joint, velocity=speed) for joint in arm.joints))


def test_the_other_joints_take_over_what_a_joint_at_its_limit_cannot_do():
    q, twist = np.array([0.7, 0.9, 0.8]), np.array([0.02, -0.3, 0.0])
    free = InverseKinematics(BOOK, damping=0.0)
    free.reset(q)
    free(forward(BOOK, q)[0], velocity=twist)
    fastest = np.abs(free.velocity).max()
    for speed in (0.9 * fastest, 2 * fastest):
        for redistribute in (True, False):
            held = InverseKinematics(slow(BOOK, speed), damping=0.0, redistribute=redistribute)
            held.reset(q)
            held(forward(BOOK, q)[0], velocity=twist)
            assert np.abs(held.velocity).max() <= speed + 1e-12
            if redistribute:
                np.testing.assert_allclose(jacobian(BOOK, q)[:2] @ held.velocity, twist[:2], atol=1e-9)
            else:
                np.testing.assert_allclose(held.velocity, np.clip(free.velocity, -speed, speed), atol=1e-12)


def test_a_stretched_arm_cannot_be_drawn_in_without_another_start():
    arm, goal = ARMS["planar 2"], (0.2, 0.0, 0.0)
    with pytest.raises(Unreachable):
        solve(arm, goal, start=(0.0, 0.0), restarts=0)
    np.testing.assert_allclose(forward(arm, solve(arm, goal, start=(0.0, 0.0)))[0], goal, atol=2e-6)
