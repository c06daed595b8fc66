"""CPU time of a step under each engine, in turn in the same run: alone, controlled, and in contact.

Run by ``make bench``. Every time is the shortest of several; what is printed is microseconds a step, and how many times
as long PyBullet takes.
"""

from __future__ import annotations

import time

import numpy as np
import pytest

from dexrepro.physics import engine
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.baxter import baxter, palm, posture

STEPS, REPEATS = 1000, 5
ARM, START = baxter("right", tool=palm()), posture("right")


def raw() -> World:
    """Steps of the engine alone, the arm falling."""
    world = World()
    world.add_arm("arm", ARM, START)
    for _ in range(STEPS):
        world.scene.advance()
    return world


def controlled() -> World:
    """An operational-space law at 1 kHz: state, Jacobian, mass matrix, bias, implicit damping."""
    world, model = World(), RigidBodyModel(ARM)
    world.add_arm("arm", ARM, START)
    goal, _ = model.forward(START)

    def law(sense):
        q = sense.position
        jacobian, mass = model.jacobian(q)[:3], model.mass_matrix(q)
        pull = np.linalg.solve(jacobian @ np.linalg.solve(mass, jacobian.T), 100.0 * (goal - sense.tip))
        return model.bias(q, sense.velocity) + jacobian.T @ pull, np.full(7, 2.0)

    world.run(1e-3 * STEPS, {"arm": law}, record_every=10)
    return world


def contact() -> World:
    """Two arms that touch, and a box at rest on a table."""
    world, models = World(), {}
    for side in ("left", "right"):
        arm = baxter(side, tool=palm())
        models[side] = RigidBodyModel(arm)
        world.add_arm(side, arm, posture(side), contacts=True)
    world.add_box("table", (0.5, 0.5, 0.1), (1.2, 0.0, -0.05))
    world.add_box("box", (0.2, 0.2, 0.2), (1.2, 0.0, 0.1), mass=0.6)
    laws = {side: lambda sense, side=side: models[side].gravity(sense.position) for side in models}
    world.run(1e-3 * STEPS, laws, record_every=10)
    return world


@pytest.mark.parametrize("scene", [raw, controlled, contact])
def test_time_of_a_step(scene, capsys: pytest.CaptureFixture[str]) -> None:
    best = dict.fromkeys(filter(engine.is_installed, engine.ENGINES), np.inf)
    for _ in range(REPEATS):
        for word in best:
            engine.use(word)
            begin = time.process_time()
            scene().close()
            best[word] = min(best[word], (time.process_time() - begin) / STEPS)
    engine.use(engine.default())
    first, *_, last = best.values()
    spent = "   ".join(f"{engine.ENGINES[word]} {1e6 * value:6.1f} us" for word, value in best.items())
    with capsys.disabled():
        print(f"\n{scene.__name__:11s} {spent}   {first / last:.2f} times as fast")
    assert all(np.isfinite(value) for value in best.values())
