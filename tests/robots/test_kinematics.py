"""Kinematics and dynamics of every arm agree with Pinocchio, an independent implementation."""

import numpy as np
import pytest

from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.arm import Pose, Tool
from dexrepro.robots.baxter import baxter, extension, palm, posture
from dexrepro.robots.kinematics import forward, jacobian, point_jacobian
from dexrepro.robots.pen_arm import gripper, pen, pen_arm
from dexrepro.robots.planar import PlanarTip, planar
from dexrepro.robots.rotations import rotation_error

pin = pytest.importorskip("pinocchio")

BOOK = ([0.5, 0.3, 0.1], [1.5, 0.9, 0.2])
ARMS = {
    "planar, 2 links": planar([0.2, 0.2], [2.0, 2.0], [0.027, 0.027], base=(0.3, -0.2, 0.4)),
    "planar, 3 links": planar(*BOOK, base=(0.5, 0.0)),
    "planar, point masses": planar(*BOOK, inertias="points"),
    "planar, with a tool": planar(
        *BOOK, tool=Tool(tip=Pose((0.1, 0.05, 0.0)), mass=0.3, inertia=(1e-3, 0, 0, 1e-3, 0, 1e-3))
    ),
    "pen arm": pen_arm(),
    "pen arm with pen": pen_arm(tool=pen(), base=Pose((0.1, 0.2, 0.3), (0.1, 0.2, 0.3))),
    "pen arm with gripper": pen_arm(tool=gripper()),
    "baxter left": baxter("left"),
    "baxter right": baxter("right", base=Pose((0.1, 0.2, 0.3), (0.2, -0.1, 0.7))),
    "baxter with gripper": baxter("right", tool=extension()),
    "baxter with palm": baxter("left", tool=palm()),
}
GRAVITY = (1.0, -2.0, -9.81)


@pytest.mark.parametrize("name", ARMS)
def test_model_and_kinematics_agree_with_pinocchio(name):
    arm = ARMS[name]
    reference = pin.buildModelFromXML(arm.urdf())
    reference.gravity.linear = np.array(GRAVITY)
    last = (arm.bodies[-1][1] if arm.bodies else arm.links[-1]).name
    local = arm.tip
    for pose, _ in arm.bodies:
        local = np.linalg.inv(pose.matrix) @ local
    parent = reference.getFrameId(last)
    joint = reference.frames[parent].parentJoint
    tip = reference.addFrame(
        pin.Frame("tip", joint, reference.frames[parent].placement * pin.SE3(local[:3, :3], local[:3, 3]), pin.OP_FRAME)
    )
    data = reference.createData()
    model = RigidBodyModel(arm, gravity=GRAVITY)
    rng = np.random.default_rng(1)
    for q, dq in zip(rng.uniform(-1.5, 1.5, (100, arm.dof)), rng.uniform(-2, 2, (100, arm.dof))):
        state = q
        if reference.nq != arm.dof:  # unlimited joints are (cos, sin) in Pinocchio
            state = np.stack([np.cos(q), np.sin(q)], axis=-1).ravel()
        mass = pin.crba(reference, data, state)
        mass = np.triu(mass) + np.triu(mass, 1).T
        np.testing.assert_allclose(model.mass_matrix(q), mass, atol=1e-8)
        bias = pin.nonLinearEffects(reference, data, state, dq)
        np.testing.assert_allclose(model.bias(q, dq), bias, atol=1e-8)
        np.testing.assert_allclose(
            model.coriolis(q, dq), bias - pin.computeGeneralizedGravity(reference, data, state), atol=1e-8
        )
        wanted = pin.computeFrameJacobian(reference, data, state, tip, pin.LOCAL_WORLD_ALIGNED)
        np.testing.assert_allclose(model.jacobian(q), wanted, atol=1e-8)
        np.testing.assert_allclose(jacobian(arm, q), wanted, atol=1e-8)
        pin.framesForwardKinematics(reference, data, state)
        for position, rotation in (forward(arm, q), model.forward(q)):
            np.testing.assert_allclose(position, data.oMf[tip].translation, atol=1e-8)
            np.testing.assert_allclose(rotation, data.oMf[tip].rotation, atol=1e-8)


def test_batched_kinematics_equals_one_state_at_a_time():
    arm = baxter("left")
    q = np.random.default_rng(2).uniform(-1, 1, (4, 3, 7))
    position, rotation = forward(arm, q)
    assert position.shape == (4, 3, 3)
    assert rotation.shape == (4, 3, 3, 3)
    assert jacobian(arm, q).shape == (4, 3, 6, 7)
    np.testing.assert_allclose(position[2, 1], forward(arm, q[2, 1])[0], atol=1e-14)
    np.testing.assert_allclose(jacobian(arm, q)[2, 1], jacobian(arm, q[2, 1]), atol=1e-14)


def test_jacobian_is_the_derivative_of_the_pose():
    arm, q, step = baxter("right", tool=extension()), posture("right"), 1e-6
    position, rotation = forward(arm, q)
    moved, turned = forward(arm, q + step * np.eye(7))
    expected = np.concatenate([(moved - position) / step, rotation_error(turned, rotation) / step], axis=-1).T
    np.testing.assert_allclose(jacobian(arm, q), expected, atol=1e-5)


def test_point_on_an_inner_link_ignores_the_joints_behind_it():
    arm, q = baxter("right"), posture("right")
    inner = point_jacobian(arm, q, 3, (0.1, 0.0, 0.0))
    assert (inner[:, 4:] == 0).all()
    assert np.abs(inner[:, :4]).max() > 0.1


@pytest.mark.parametrize("name", [name for name in ARMS if name.startswith("planar")])
def test_closed_forms_of_planar_arms_equal_the_general_ones(name):
    arm = ARMS[name]
    chain = PlanarTip(arm)
    for q in np.random.default_rng(3).uniform(-3, 3, (10, arm.dof)):
        np.testing.assert_allclose(chain.tip(q.tolist()), forward(arm, q)[0][:2], atol=1e-12)
        np.testing.assert_allclose(chain.jacobian(q.tolist()), jacobian(arm, q)[:2], atol=1e-12)


def test_published_poses_of_the_book_are_met():
    follower = planar(*BOOK, base=(0.5, 0.0))
    np.testing.assert_allclose(forward(follower, np.pi / 3 * np.ones(3))[0], (0.5, 0.6928, 0), atol=1e-4)
    np.testing.assert_allclose(forward(follower, [0.9112, 1.4184, 0.8120])[0], (0.5, 0.6128, 0), atol=1e-4)
    np.testing.assert_allclose(forward(baxter("right"), posture("right"))[0], (0.5726, -0.1812, 0.2462), atol=1e-4)


def test_left_arm_mirrors_the_right_one():
    right, left = (forward(baxter(side), posture(side)) for side in ("right", "left"))
    np.testing.assert_allclose(left[0], right[0] * (1, -1, 1), atol=1e-5)
    np.testing.assert_allclose(left[1][:, 2], right[1][:, 2] * (1, -1, 1), atol=1e-5)


def test_nominal_model_with_a_mass_error_scales_mass_and_gravity():
    arm, q = baxter("right", tool=palm()), posture("right")
    exact, light = RigidBodyModel(arm), RigidBodyModel(arm, mass_error=-0.3)
    np.testing.assert_allclose(light.mass_matrix(q), 0.7 * exact.mass_matrix(q), rtol=1e-9)
    np.testing.assert_allclose(light.gravity(q), 0.7 * exact.gravity(q), atol=1e-9)
    np.testing.assert_allclose(light.jacobian(q), exact.jacobian(q), atol=1e-12)


def test_pen_arm_has_the_inertia_range_it_was_chosen_for():
    q = np.array([0.1, 0.6, -1.2])
    bare = np.linalg.eigvalsh(RigidBodyModel(pen_arm()).mass_matrix(q))
    loaded = np.linalg.eigvalsh(RigidBodyModel(pen_arm(tool=gripper())).mass_matrix(q))
    assert 3e-4 < bare[0] < bare[-1] < 3e-3
    assert (loaded > bare).all()
