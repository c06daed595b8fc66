"""Arms from their makers' files, in a scene of the user's own and as chapter 2's follower arm."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import case, rng

from dexrepro.chapters.chapter2.balloon_static import experiment as balloon
from dexrepro.chapters.own.scene import experiment as scene
from dexrepro.errors import InputError

DATA = Path(pytest.importorskip("pybullet_data").getDataPath())
AIRO = importlib.util.find_spec("airo_models")
UR5E = Path(str(AIRO.origin)).parent / "arms/ur5e/ur5e.urdf" if AIRO else None
ARMS = [
    pytest.param(DATA / "kuka_iiwa/model.urdf", "lbr_iiwa_link_7", id="iiwa"),
    pytest.param(DATA / "franka_panda/panda.urdf", "panda_grasptarget", id="panda"),
    pytest.param(UR5E, "tool0", id="ur5e", marks=pytest.mark.skipif(UR5E is None, reason="needs airo-models")),
]


@pytest.mark.parametrize(("file", "end"), ARMS)
def test_an_arm_of_a_makers_file_follows_a_leader(file: Path, end: str) -> None:
    config = case(
        "own", "scene", "default",
        f"scene.arm={{_target_: dexrepro.robots.urdf.from_urdf, path: '{file}', end: {end}}}",
        "scene.leader={line: {start: [0.45, 0.1, 0.4], end: [0.5, 0.15, 0.4], period: 2}}", "scene.duration=0.5",
        'scene.law={_target_: dexrepro.control.computed_torque.ComputedTorque, model: "${scene.model}", frequency: 30}',
    )  # fmt: skip
    recording = scene.simulate(config, rng("scene"))
    assert recording.status == "finished"
    assert scene.measure(recording, config)["rmse"] < 1e-3


@pytest.mark.parametrize(("file", "end"), ARMS)
def test_it_holds_the_balloon_in_chapter_2(file: Path, end: str) -> None:
    def run(base: str) -> Any:
        arm = f"{{_target_: dexrepro.robots.urdf.from_urdf, path: '{file}', end: {end}, base: {base}}}"
        words = (f"shared.balloon.follower_arm={arm}", "balloon_static.duration=1")
        config = case("2", "balloon_static", "off_80", *words)
        return balloon.simulate(config, rng("balloon_static"))

    recording = run("[0.35, 0.8, 0.0]")
    assert recording.status == "finished"
    assert np.linalg.norm(recording["follower.force"][-1]) > 0.5, "it has found the balloon"
    with pytest.raises(InputError, match=r"follower_arm does not reach \(0.73, 0.33, 0.33\) m from where its base="):
        run("[0.35, 5.8, 0.0]")
