"""Contacts, distances and pictures of a scene."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.robots.arm import Pose
from dexrepro.robots.baxter import baxter, extension, palm, posture
from dexrepro.robots.planar import planar


def test_resting_box_presses_with_its_weight():
    with World() as world:
        world.add_box("table", (1, 1, 0.1), (0, 0, -0.05))
        world.add_box("box", (0.2, 0.2, 0.2), (0, 0, 0.1), mass=0.6)
        world.run(1.0)
        assert world.contact_force("box", "table") == pytest.approx(0.6 * 9.81, rel=0.02)
        assert world.distance("box", "table") == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize(("friction", "slides"), [(0.3, True), (0.9, False)])
def test_box_slides_on_a_slope_if_friction_is_too_small(friction, slides):
    slope = 0.5  # rad, tangent 0.546
    with World() as world:
        world.add_box("slope", (2, 2, 0.1), (0, 0, 0), rpy=(0, slope, 0), friction=1.0)
        up = 0.05 + 0.05
        place = (up * np.sin(slope), 0, up * np.cos(slope))
        world.add_box("box", (0.1, 0.1, 0.1), place, mass=0.3, rpy=(0, slope, 0), friction=friction)
        run = world.run(0.5)
        force, reaction = (np.sum([touch.force for touch in world.contacts(name)], axis=0) for name in ("box", "slope"))
    np.testing.assert_allclose(reaction, -force, atol=1e-12)
    if not slides:
        np.testing.assert_allclose(force, (0, 0, 0.3 * 9.81), atol=0.05)
    moved = np.linalg.norm(run["box.pose"][-1, :3] - run["box.pose"][0, :3])
    expected = 0.5 * 0.5**2 * 9.81 * (np.sin(slope) - friction * np.cos(slope))
    assert moved == pytest.approx(expected, rel=0.05) if slides else moved < 2e-3


def test_arm_feels_the_contact_that_holds_it_up():
    """A palm that presses on a table: the sensed force points up and balances the torque given for it."""
    arm = baxter("right", tool=palm())
    start = posture("right")
    model = RigidBodyModel(arm)
    position, rotation = model.forward(start)
    with World() as world:
        world.add_arm("arm", arm, start, contacts=True)
        place = position + rotation @ (0, 0, 0.0505)
        rpy = Rotation.from_matrix(rotation).as_euler("xyz")
        world.add_box("wall", (0.4, 0.4, 0.1), place, rpy=rpy, friction=0.8)
        press = 10.0 * rotation[:, 2]

        def law(sense):
            torque = model.gravity(sense.position) + model.jacobian(sense.position)[:3].T @ press
            return torque, np.full(7, 5.0)

        run = world.run(1.0, {"arm": law})
        assert {touch.link for touch in world.contacts("arm")} == {world.arm("arm").links.index("palm")}
        assert world.contact_force("arm", "wall") == pytest.approx(10.0, rel=0.05)
    np.testing.assert_allclose(run["arm.force"][-200:].mean(axis=0), -press, atol=0.5)


def test_a_wrist_does_not_feel_what_an_upper_link_rests_on():
    arm = planar([0.4, 0.3], [1.0, 0.5], base=Pose(rpy=(np.pi / 2, 0.0, 0.0)))
    with World(gravity=(0, 0, -9.81)) as world:
        world.add_arm("arm", arm, [0.0, 1.2], contacts=True)
        world.add_box("post", (0.06, 0.2, 0.2), (0.25, 0.0, -0.121))
        run = world.run(0.5, {"arm": lambda s: (np.array([0.0, 0.5 * 9.81 * 0.15 * np.cos(1.2)]), np.ones(2))})
        assert world.contact_force("arm", "post") > 5.0
    np.testing.assert_allclose(run["arm.force"][-1], 0, atol=1e-9)


def test_distance_is_measured_though_contacts_are_off():
    with World() as world:
        arm = planar([0.5], [1.0])
        world.add_arm("arm", arm, [0.0])
        world.add_sphere("ball", 0.05, (0.25, 0.2, 0.0))
        assert world.distance("arm", "ball") == pytest.approx(0.2 - 0.05 - 0.02, abs=1e-3)
        assert world.distance("arm", "ball", limit=0.05) == 0.05


def test_tool_takes_the_place_of_hand_and_wrist_shapes():
    position, rotation = RigidBodyModel(baxter("right")).forward(posture("right"))
    distances = []
    for tool in (None, palm()):
        with World() as world:
            world.add_arm("arm", baxter("right", tool=tool), posture("right"))
            world.add_sphere("probe", 0.005, position + rotation @ (0.035, 0.0, -0.08))
            distances.append(world.distance("arm", "probe"))
    assert distances[0] < 0 < distances[1]


def test_picture_shows_the_arm_and_leaves_the_simulation_alone():
    with World() as world:
        world.add_arm("arm", baxter("right", tool=extension()), posture("right"))
        before = world.arms["arm"].q
        camera = Camera((0.4, -0.2, 0.2), 1.6, 60.0, -20.0)
        first = world.render({"arm": posture("right")}, camera=camera, size=(160, 120))
        other = world.render({"arm": np.zeros(7)}, camera=camera, size=(160, 120))
        world.arms["arm"].read()
        assert world.arms["arm"].q == before
    assert first.shape == (120, 160, 3)
    assert first.dtype == np.uint8
    assert np.abs(first.astype(int) - other).max() > 50


def test_any_recorded_instant_can_be_pictured_later():
    def scene():
        world = World(gravity=(0, 0, -9.81))
        world.add_arm("arm", planar([0.5], [1.0]), [0.0])
        world.add_sphere("ball", 0.1, (0.3, 0.3, 0.3), mass=0.2)
        return world

    camera = Camera((0.2, 0.2, 0.0), 1.5, 20.0, -40.0)
    with scene() as world:
        recording = world.run(0.3, {"arm": lambda s: [0.5]})
        direct = world.render(camera=camera, size=(80, 60))
    with scene() as later:
        first, last = (later.snapshot(recording, time, camera, (80, 60)).astype(int) for time in (0.0, 0.3))
    assert np.abs(first - last).max() > 50
    assert np.abs(last - direct).mean() < 1.0
