"""MuJoCo's window shows a run and changes no number of it."""

from types import SimpleNamespace

import numpy as np
import pytest

from dexrepro.physics import engine
from dexrepro.physics.world import World
from dexrepro.robots.planar import planar

viewer = pytest.importorskip("mujoco.viewer")


@pytest.fixture(autouse=True)
def chosen():
    engine.use("mujoco")
    yield
    engine.use(engine.default())


def swing(duration: float) -> np.ndarray:
    world = World()
    arm = planar((0.5, 0.4), (2.0, 1.0))
    world.add_arm("arm", arm, np.full(arm.dof, 0.5), contacts=True)
    world.add_sphere("ball", 0.05, (0.3, 0.0, 0.5), mass=0.2)
    recording = world.run(duration, {})
    world.close()
    return np.c_[recording["arm.position"], recording["ball.pose"]]


def test_a_window_shows_the_scene_and_leaves_the_numbers_as_they_are(monkeypatch):
    alone, windows, shown = swing(0.2), [], []

    def launch(model, data, **_):
        windows.append(model.ntex)
        viewer.mujoco.mj_forward(model, data)  # as the true one does
        return SimpleNamespace(sync=lambda: shown.append(data.time), close=lambda: windows.append("closed"))

    monkeypatch.setattr(viewer, "launch_passive", launch)
    monkeypatch.setattr(World, "live", True)
    np.testing.assert_array_equal(swing(0.2), alone)
    assert windows == [1, "closed"]
    assert 3 <= len(shown) <= 15, "sixty pictures a second, in as long as is simulated"
