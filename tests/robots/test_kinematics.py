"""Kinematics and dynamics of every arm agree with Pinocchio, an independent implementation."""

import numpy as np
import pytest

from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.arm import Pose, Tool
from dexrepro.robots.baxter import baxter, extension, palm
from dexrepro.robots.kinematics import forward, jacobian
from dexrepro.robots.planar import planar

pin = pytest.importorskip("pinocchio")

BOOK = ([0.5, 0.3, 0.1], [1.5, 0.9, 0.2])
ARMS = {
    "planar, 2 links": planar([0.2, 0.2], [2.0, 2.0], [0.027, 0.027], base=(0.3, -0.2, 0.4)),
    "planar, 3 links": planar(*BOOK, base=(0.5, 0.0)),
    "planar, point masses": planar(*BOOK, inertias="points"),
    "planar, with a tool": planar(
        *BOOK, tool=Tool(tip=Pose((0.1, 0.05, 0.0)), mass=0.3, inertia=(1e-3, 0, 0, 1e-3, 0, 1e-3))
    ),
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
