"""From a law to an arm: what the adapters add to the law's command, and what they leave alone."""

import math

import numpy as np
import pytest

from dexrepro.control.contract import Command, Measured, Undefined
from dexrepro.control.motion import Motion
from dexrepro.physics.drive import EndPointDrive, HoldingDrive, JointDrive, Limited, Posture, clip
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.kinematics import forward
from dexrepro.robots.planar import planar

ARM = planar([0.5, 0.3, 0.1], [1.5, 0.9, 0.2])
START = np.array([0.6, 0.9, -0.4])


class Constant:
    """A law that notes what it is told and gives one command."""

    def __init__(self, kind, command):
        self.kind, self.command, self.told, self.resets = kind, command, [], 0

    def reset(self, measured):
        self.resets += 1

    def __call__(self, measured, *desired):
        self.told.append((measured, *desired))
        return self.command


def at_rest(position):
    position = np.asarray(position, float)
    return lambda time: Motion(position, 0 * position, 0 * position)


@pytest.mark.parametrize("as_force", [True, False])
def test_what_holds_the_posture_does_not_move_the_task(as_force):
    model = RigidBodyModel(ARM)
    q, dq = START + (0.1, -0.2, 0.3), np.array([0.4, -0.3, 0.2])
    jacobian, force = model.jacobian(q)[:2], np.array([1.0, -2.0])
    command = Command(force=force) if as_force else Command(jacobian.T @ force)
    torque = Posture(model, START, 4.0)(q, dq, jacobian, command).torque
    mass = model.mass_matrix(q)
    added = np.linalg.solve(mass, torque - jacobian.T @ force)
    np.testing.assert_allclose(jacobian @ added, 0, atol=1e-10)
    free = np.linalg.svd(jacobian)[2][-1]
    wanted = 4.0 * (START - q) - 2 * math.sqrt(4.0) * dq
    assert free @ mass @ added == pytest.approx(free @ mass @ wanted), "and all of what the task leaves free is done"


def test_an_end_point_law_is_told_the_sensed_end_point_and_its_force_becomes_torque():
    law, model = Constant("end_point", Command(force=np.array([2.0, -1.0]))), RigidBodyModel(ARM)
    path = lambda time: Motion(np.array((0.3 + time, 0.4)), np.array((1.0, 0.0)), np.zeros(2))  # noqa: E731
    drive = EndPointDrive(law, path, model)
    assert drive.error.tolist() == [0, 0], "before the first call"
    with World(gravity=(0, 0, 0)) as world:
        world.add_arm("arm", ARM, START)
        run = world.run(2e-3, {"arm": drive})
    np.testing.assert_allclose(run["arm.torque"][0], model.jacobian(START)[:2].T @ (2, -1), atol=1e-12)
    np.testing.assert_allclose(law.told[0][0].position, forward(ARM, START)[0][:2], atol=1e-12)
    np.testing.assert_allclose(drive.path.position, (0.301, 0.4))
    np.testing.assert_allclose(drive.error, law.told[-1][0].position - (0.301, 0.4))
    assert law.resets == 1


def test_a_joint_law_is_reset_once_and_told_where_its_path_is():
    law = Constant("joint", Command(np.zeros(3)))
    drive = JointDrive(law, at_rest(START), contact=lambda sense: np.arange(3.0))
    with World(gravity=(0, 0, 0)) as world:
        world.add_arm("arm", ARM, START)
        world.run(3e-3, {"arm": drive})
    assert law.resets == 1
    measured, desired = law.told[1]
    assert measured.time == pytest.approx(1e-3)
    np.testing.assert_array_equal(measured.force, [0, 1, 2])
    np.testing.assert_array_equal(desired.position, START)


def test_a_limited_torque_includes_what_holds_the_arm_and_stays_within_its_limit():
    model = RigidBodyModel(ARM, gravity=(0, -9.81, 0))
    law = lambda sense: Command(np.array([1.0, -100.0, 100.0]), np.ones(3))  # noqa: E731

    class Still:
        position = START

    torque, damping, _ = Limited(law, 50.0, model)(Still())
    np.testing.assert_allclose(torque, np.clip(model.gravity(START) + (1, -100, 100), -50, 50))
    np.testing.assert_array_equal(damping, np.ones(3))
    with pytest.raises(Undefined, match="finite"):
        Limited(lambda sense: Command(np.array([np.nan])))(Still())


class Wish:
    """A holding law that wants one place."""

    kind = "holding"

    def __init__(self, place):
        self.place, self.told = place, []

    def reset(self, measured):
        self.begun = measured

    def __call__(self, measured):
        self.told.append(measured)
        return self.place


class Follows:
    """A plain holding law: it moves from where it was reset by a thousandth of the force."""

    def reset(self, position):
        self.place = position

    def __call__(self, position, force):
        self.place += 1e-3 * force
        return self.place


def test_a_plain_holding_law_is_driven_as_any_other():
    drive = HoldingDrive(Follows(), limit=2e-3)
    drive.reset(1.0, 0.01, 3.0)
    assert [drive(1.0 + 0.1 * k, 0.0, 1.5) for k in (1, 2)] == pytest.approx([0.0115, 0.013])
    assert drive(1.3, 0.0, 90.0) == pytest.approx(0.015), "its reference moves at most by the limit"


def test_a_holding_law_is_told_the_rate_and_its_reference_moves_at_most_by_the_limit():
    free, held = HoldingDrive(Wish(0.05)), HoldingDrive(Wish(0.05), limit=0.02)
    for drive in (free, held):
        drive.reset(1.0, 0.01, 3.0)
        assert drive.law.begun == Measured(1.0, 0.01, 0.0, 3.0)
    assert [free(1.1, 0.013, 4.0), free(1.2, 0.011, 4.0)] == [0.05, 0.05]
    assert [held(1.0 + 0.1 * k, 0.0, 4.0) for k in (1, 2, 3)] == pytest.approx([0.03, 0.05, 0.05])
    assert [measured.velocity for measured in free.law.told] == pytest.approx([0.03, -0.02])
    assert free.reference == 0.05
    assert [clip(x, 2.0) for x in (-3.0, 1.0, 3.0)] == [-2.0, 1.0, 2.0]
