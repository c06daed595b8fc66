"""Recorded series as scripts: exact, thinned only where they are long, and with their units."""

from __future__ import annotations

import base64
import re
import zlib
from pathlib import Path

import numpy as np
import pytest

from dexrepro import chapters
from dexrepro.case import live
from dexrepro.cases import experiment_cases
from dexrepro.config import compose_chapter
from dexrepro.experiment import Recording
from dexrepro.recordings import save_recording
from dexrepro.report import explorer


def unpacked(script: str, columns: int) -> np.ndarray:
    """The inverse, as the page's script does it."""
    data = base64.b64decode(re.search(r'= "(.*)";', script)[1])
    planes = np.frombuffer(zlib.decompress(data), np.uint8).reshape(columns, 4, -1)
    changes = np.ascontiguousarray(planes.transpose(0, 2, 1)).view("<i4")[..., 0]
    return np.cumsum(changes, axis=1, dtype=np.int32).view(np.float32)


@pytest.mark.parametrize(("samples", "stride"), [(50, 1), (9000, 3)])
def test_a_script_holds_the_stored_samples(tmp_path: Path, samples: int, stride: int) -> None:
    rng = np.random.default_rng(0)
    series = {
        "time": np.arange(samples) * 0.01,
        "error": rng.standard_normal((samples, 2)),
        "x": np.full(samples, np.nan),
    }
    save_recording(Recording(series), tmp_path / "series", "plain", 100.0)
    (tmp_path / "files").mkdir()
    found = explorer.write(tmp_path, tmp_path / "files", ["plain", "absent"], None)
    case = found["cases"]["plain"]
    assert case["channels"] == ["time", "error[0]", "error[1]", "x"]
    assert case["stride"] == stride
    values = unpacked((tmp_path / "files/series-plain.js").read_text(), 4)
    np.testing.assert_allclose(values[1:3], series["error"][::stride].T, rtol=1e-6)
    assert np.isnan(values[3]).all()


def test_what_is_no_series_in_time_is_left_out(tmp_path: Path) -> None:
    save_recording(Recording({"time": np.arange(3.0), "x": np.zeros(3)}), tmp_path / "series", "plain", 100.0)
    assert explorer.write(tmp_path, tmp_path, ["plain"], None) is None


@pytest.mark.parametrize(
    ("channel", "unit"),
    [("leader.position", "rad"), ("box.pose", "m, m, m, 1, 1, 1, 1"), ("error", "mm"), ("push2.x", "N"),
     ("push.x", "N"), ("force_2", "kN"), ("groups5", "cm"), ("tip", ""), ("position", ""), ("hand.force", "lbf")],
)  # fmt: skip
def test_units_are_declared_or_those_of_the_world(channel: str, unit: str) -> None:
    declared = {"error": "mm", "push": "N", "force": "kN", "groups": "cm", "hand.force": "lbf"}
    assert explorer.unit(channel, declared) == unit


@pytest.mark.parametrize("name", ["skill_reuse", "barrier_and_switch"])
def test_the_planar_arm_of_chapter_4_has_a_scene_from_what_was_recorded(tmp_path: Path, name: str) -> None:
    experiment, cases = chapters.load("4").experiment(name), experiment_cases(compose_chapter("4"), name)
    config = live({**cases["none" if "none" in cases else "base"], "law": None, "perturbation": 0.0})
    angles = np.array([[0.0, 0.5], [1.0, 0.5]])
    with experiment.simulation.scene(config) as world:
        staged = experiment.simulation.stage(world, Recording({"time": np.arange(2.0), "position": angles}), config)
        _, poses = world.animate(staged, [0.0, 1.0])
    assert np.abs(poses[1] - poses[0]).max() > 0.5, "the links have moved"


def test_without_a_film_the_camera_sees_all_that_is_not_hidden() -> None:
    """An arm 1 m high at (2, 0), and a body that is put away far below."""
    arm, away = np.array([[2.0, 0.0, height] for height in np.linspace(0, 1, 9)]), np.array([[2.0, 0.0, -9.0]])
    camera = explorer._fitted(np.vstack([arm, away]))
    np.testing.assert_allclose(camera.target, (2.0, 0.0, 0.5))
    assert 2 * camera.distance * np.tan(np.deg2rad(camera.field_of_view / 2)) > 1.0, "the whole arm fits"
    assert camera.distance < 2.0, "and fills the picture"
    assert explorer._fitted(np.array([[0, 0, 0.1], [1, 1, 0.1]])).pitch == -89.0, "a plane is seen from above"
