import numpy as np
import pytest

from dexrepro.physics.soft_object import Cushion, SoftObject, _across
from dexrepro.physics.world import World
from dexrepro.robots.arm import Pose
from dexrepro.robots.planar import planar

SOFT = dict(fast=1.0, slow=0.2, fast_time=0.05, slow_time=4.0)


def test_cushion_relaxes_to_its_elastic_force_and_never_pulls():
    cushion = Cushion(100.0, 1e-3, **SOFT)
    forces = [cushion.force(0.05) for _ in range(40_000)]
    assert forces[-1] == pytest.approx(2 * 100.0 * 0.05, rel=1e-3)
    assert forces[0] == pytest.approx(2 * 100.0 * 0.05 * 2.2, rel=0.02)
    for seconds in (0.1, 1.0, 6.0):
        held = 2 * 100.0 * 0.05 * (1 + np.exp(-seconds / 0.05) + 0.2 * np.exp(-seconds / 4.0))
        assert forces[round(seconds / 1e-3)] == pytest.approx(held, rel=5e-3)
    assert cushion.force(-0.01) == 0.0
    assert cushion.force(0.001) == 0.0  # the slow branch has not come back yet


def test_cushion_that_was_apart_does_not_push_at_first_touch():
    cushion = Cushion(100.0, 1e-3, **SOFT)
    forces = [cushion.force(-0.15 + 1e-4 * k) for k in range(1504)]
    assert max(forces[:1501]) == 0.0
    assert forces[1503] == pytest.approx(2 * 100.0 * 3e-4 * 2.2, rel=0.03)


def test_cushion_works_on_batches():
    members = [Cushion(100.0, 1e-3, **SOFT) for _ in range(2)]
    batch = Cushion(100.0, 1e-3, **SOFT)
    for x in (0.002, 0.01, 0.02, -0.01):
        np.testing.assert_allclose(
            batch.force(np.array([x, 0.5 * x])), [m.force(share * x) for m, share in zip(members, (1.0, 0.5))]
        )


def held_body(friction, duration=1.0, squeeze=0.1, gravity=9.81, off=0.0, kick=None, rise=0.0):
    """Two arms that cannot move, the right one higher by ``rise`` [m], hold a 0.3 kg body, ``off`` the middle between
    them [m]; at 0.1 s it gets a kick."""
    with World(gravity=(0, 0, -gravity)) as world:
        for name, x, z in (("left", 0.7, 0.0), ("right", 1.1, rise)):
            arm = planar((0.1,), (1e6,), base=Pose((x - 0.1, 0.0, z)), effort=1e9)
            world.add_arm(name, arm, np.zeros(1))
        ball = world.add_sphere("ball", 0.05, (0.9 + off, 0.0, rise / 2), mass=0.3, collides=False, inertia=[0.01] * 3)
        cushions = (Cushion(100.0, 1e-3, **SOFT), Cushion(100.0, 1e-3, **SOFT))
        world.add(
            SoftObject("grip", "ball", ("left", "right"), cushions, length=np.hypot(0.4, rise) + squeeze,
                       friction=friction, shear=500.0, shear_damping=10.0, scale=lambda t: 1.0)
        )  # fmt: skip
        return world.run(duration, events=[(0.1, lambda: kick(ball))] if kick else ())


def test_friction_carries_the_weight_with_the_shear_it_needs():
    run = held_body(friction=0.6)
    sag = -run["ball.pose"][-1, 2]
    assert sag == pytest.approx(0.3 * 9.81 / (2 * 500.0), rel=0.02)
    assert run["grip.slip"][-1] == 0.0
    np.testing.assert_allclose(run["grip.force_left"], run["grip.force_right"], rtol=1e-6)


def test_without_enough_friction_the_body_slips_and_falls():
    run = held_body(friction=0.1)
    assert run["ball.pose"][-1, 2] < -0.1
    assert run["grip.slip"][-1] > 0.1
    fallen = -run["ball.pose"][:, 2]
    limit = 0.1 * run["grip.force_left"]
    late = slice(300, None)
    np.testing.assert_allclose(  # what is fallen but for the elastic give, on both sides
        np.diff(run["grip.slip"][late]), np.diff(2 * (fallen - limit / 500.0)[late]), rtol=0.05
    )


def test_a_body_off_the_middle_is_pushed_back_and_the_arms_apart():
    run = held_body(friction=0.6, gravity=0.0, off=0.02)
    assert run["ball.pose"][100, 0] < 0.92
    assert abs(run["ball.pose"][-300:, 0].mean() - 0.9) < 2e-3
    assert (run["left.force"][1:, 0] < 0).all()
    assert (run["right.force"][1:, 0] > 0).all()
    assert run["grip.force_right"][0] > run["grip.force_left"][0], "it is closer to the right arm"


def test_a_slanted_object_presses_along_its_line():
    run = held_body(friction=0.6, gravity=0.0, rise=0.3)
    np.testing.assert_allclose(run["ball.pose"][:, :3] - (0.9, 0.0, 0.15), 0, atol=1e-6)
    line = np.array((0.4, 0.0, 0.3)) / 0.5
    np.testing.assert_allclose(run["right.force"][10:], run["grip.force_right"][10:, None] * line, atol=1e-3)
    np.testing.assert_allclose(run["left.force"][10:], -run["right.force"][10:], atol=1e-3)


@pytest.mark.parametrize("across", [1, 2])
def test_contacts_that_stick_turn_a_kicked_body_back(across):
    def kick(ball):
        for side in (-1, 1):
            force = np.zeros(3)
            force[across] = side * 40.0
            ball.push_at(tuple(force), (ball.x + side * 0.2, ball.y, ball.z))

    run = held_body(friction=5.0, gravity=0.0, duration=1.5, kick=kick)
    turned = np.abs(run["ball.pose"][:, 3:6]).max(axis=1)
    assert 1e-3 < turned.max() < 0.5
    assert turned[-1] < 0.1 * turned.max()


def test_a_part_across_a_line_has_none_along_it():
    line = (0.48, 0.6, 0.64)
    across = np.array(_across((1.0, -2.0, 3.0), line))
    assert across @ line == pytest.approx(0)
    np.testing.assert_allclose(np.cross(across, line), np.cross((1.0, -2.0, 3.0), line))
