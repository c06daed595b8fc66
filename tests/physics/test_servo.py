"""Arms go where their servo is told."""

import numpy as np
import pytest

from dexrepro.physics.elements import TipForce
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.servo import JointServo, PlanarServo, PoseServo
from dexrepro.physics.world import World
from dexrepro.robots.baxter import baxter, posture
from dexrepro.robots.inverse_kinematics import nearest
from dexrepro.robots.planar import PlanarChain, planar

FACING = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]])  # the gripper of the left arm points along -y


def test_an_arm_follows_a_pose_and_carries_a_known_force():
    arm = baxter("left")
    place, rotation = np.array([0.62, 0.25, 0.3]), FACING
    start = nearest(arm, posture("left"), place, rotation)
    with World(step=2e-3) as world:
        world.add_arm("arm", arm, start)
        follower = PoseServo(arm, start, dt=0.01, gain=20.0, singular=0.02, posture=0.2, bandwidth=40.0, mass_error=0.0)
        follower.reset(start)
        world.add(TipForce("load", "arm", lambda t, x, v: (3.0, 5.0, -8.0)))
        target = lambda t: place + [0.05 * np.sin(2 * t), 0.0, 0.03 * np.sin(3 * t)]  # noqa: E731
        run = world.run(
            2.0, {"arm": lambda sense: follower.go(sense, target(sense.time), rotation)}, control_period=0.01
        )
    wanted = np.array([target(t) for t in run.time])
    assert np.linalg.norm(run["arm.tip"] - wanted, axis=1)[250:].max() < 2e-3


def test_a_joint_servo_goes_along_a_reference_of_constant_rate():
    arm = planar([0.5, 0.3], [1.5, 0.9])
    servo, start, rate = JointServo(RigidBodyModel(arm), 40.0), np.array([0.3, 0.8]), np.array([0.5, -0.4])
    servo.reset(start)
    servo.refer(0.0, start, rate)
    with World(gravity=(0, 0, 0)) as world:
        world.add_arm("arm", arm, start)
        run = world.run(0.5, {"arm": servo})
    np.testing.assert_allclose(run["arm.position"][-1], start + run.time[-1] * rate, atol=1e-3)
    servo.refer(0.5, start, rate, np.array([1.0, 2.0]))
    np.testing.assert_array_equal(servo.compensation, [1, 2])


@pytest.mark.parametrize(("gain", "arrives"), [(20.0, True), (-20.0, False)])
def test_a_planar_arm_comes_back_to_its_path_but_for_the_printed_sign(gain, arrives):
    lengths, masses, start = [0.5, 0.3, 0.1], [1.5, 0.9, 0.2], np.array([0.9, 1.4, 0.8])
    chain, arm = PlanarChain(lengths, masses), planar(lengths, masses)
    servo = PlanarServo(chain, RigidBodyModel(arm), dt=1e-3, gain=gain, bandwidth=60.0)
    servo.reset(start)
    x, y = servo.last
    servo.reset(start + 0.02)  # the reference starts off its path, the error has to decay
    servo.last = x, y
    with World(step=1e-3, gravity=(0, 0, 0)) as world:
        world.add_arm("arm", arm, start)
        run = world.run(0.3, {"arm": lambda sense: servo(sense, x, y)}, on_divergence="stop")
    off = np.linalg.norm(run["arm.tip"][:, :2] - (x, y), axis=1)
    assert (off[-1] < 1e-3) == arrives
