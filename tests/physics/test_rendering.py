"""The geometry of the overhead camera, and what stands in a scene."""

import numpy as np
import pytest

from dexrepro.physics.rendering import Overhead
from dexrepro.physics.world import World
from dexrepro.robots.arm import Pose, Shape
from dexrepro.robots.pen_arm import pen_arm

CAMERA = Overhead((0.3, -0.2, 1.4), size=(120, 80), field_of_view=40.0)


def test_the_field_of_view_ends_at_the_upper_and_lower_edge():
    below = 0.9  # m
    half = below * np.tan(np.radians(20.0))
    x, y, z = CAMERA.position
    ends = CAMERA.project(np.array([[x, y, z - below], [x, y + half, z - below], [x, y - half, z - below]]))
    np.testing.assert_allclose(ends, [(59.5, 39.5), (59.5, -0.5), (59.5, 79.5)], atol=1e-9)


def test_a_ray_through_a_pixel_meets_the_point_that_is_seen_there():
    rng = np.random.default_rng(0)
    for point in rng.uniform((-0.2, -0.7, 0.0), (0.8, 0.3, 0.5), (20, 3)):
        column, row = CAMERA.project(point)
        assert CAMERA.place(column, row, point[2]) == pytest.approx(point[:2], abs=1e-12)
    assert CAMERA.project(np.array([0.4, -0.2, 0.5]))[0] > 59.5, "right is +x"


def test_solids_of_a_scene_are_where_their_bodies_stand():
    with World(gravity=(0, 0, 0)) as world:
        world.add_arm("arm", pen_arm(base=Pose((0.5, 0.0, 0.2))), np.array([0.3, 0.2, -0.7]))
        parts = [Shape("box", (0.1, 0.1, 0.1), Pose((0.0, 0.0, 0.0))), Shape("sphere", (0.05,), Pose((0.2, 0.0, 0.0)))]
        world.add_body("pair", parts, (0.1, 0.2, 0.3), rpy=(0.0, 0.0, np.pi / 2), mass=0.4)
        recording = world.run(5e-3)
        seen, poses = world.animate(recording, recording.time[-1:])
        number = world.bodies["pair"].body
    found = {item.kind: pose[:3] for item, pose in zip(seen, poses[0]) if item.body == number}
    np.testing.assert_allclose(found["box"], (0.1, 0.2, 0.3), atol=1e-6)
    np.testing.assert_allclose(found["sphere"], (0.1, 0.4, 0.3), atol=1e-6)


def test_a_free_body_keeps_its_velocity_and_closing_twice_harms_no_other_world():
    with World(gravity=(0, 0, 0)) as world:
        body = world.add_sphere("ball", 0.05, (0.0, 0.0, 0.0), mass=0.5)
        other = World()
        other.close()
        other.close()
        run = world.run(1.0, events=[(0.0, lambda: body.push(5.0, 0.0, 0.0))])
        assert world.time == pytest.approx(1.0)
        again = world.run(0.5)
        assert world.time == pytest.approx(1.5)
    travelled = run["ball.pose"][:, 0]
    speed = 5.0 * 1e-3 / 0.5
    np.testing.assert_allclose(np.diff(travelled)[5:] / 1e-3, speed, rtol=1e-5)
    assert (run.simulated, again.simulated, again.steps) == (pytest.approx(1.0), pytest.approx(0.5), 500)
    assert again.time[0] == pytest.approx(1.0)
