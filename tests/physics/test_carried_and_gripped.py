import numpy as np
import pytest

from dexrepro.physics.elements import Carried
from dexrepro.physics.world import World
from dexrepro.robots.planar import planar


def test_a_carried_body_is_where_its_path_says():
    with World() as world:
        world.add_box("lid", (0.1, 0.1, 0.01), (0.0, 0.0, 0.5))
        world.add(Carried("lid", lambda time: (0.1 * time, 0.0, 0.5)))
        recording = world.run(0.1)
        assert world.end("lid").x == pytest.approx(0.1 * 0.099)
    assert recording["lid.x"] == pytest.approx(0.1 * recording.time)


def test_only_static_bodies_are_carried():
    with World() as world:
        world.add_box("cube", (0.1, 0.1, 0.1), (0.0, 0.0, 0.5), mass=1.0)
        world.add(Carried("cube", lambda time: (0.0, 0.0, 0.5)))
        with pytest.raises(ValueError, match="not a static body"):
            world.run(0.01)


def test_a_gripped_body_moves_with_the_end_point():
    arm = planar((0.5, 0.3, 0.1), (1.5, 0.9, 0.2))
    with World(gravity=(0, 0, 0)) as world:
        plant = world.add_arm("arm", arm, (0.3, 0.4, 0.2))
        world.run(0.001)
        world.add_box("cube", (0.02, 0.02, 0.02), (plant.x, plant.y, plant.z), mass=0.05, collides=False)
        world.grip("arm", "cube")
        recording = world.run(0.3, {"arm": lambda sense: np.array((0.5, 0.3, 0.05))})
    gap = np.linalg.norm(recording["cube.pose"][:, :3] - recording["arm.tip"], axis=1)
    assert np.linalg.norm(recording["arm.tip"][-1] - recording["arm.tip"][0]) > 0.05
    assert gap.max() < 2e-3
