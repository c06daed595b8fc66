"""Films: made from a recording, beside the watched quantity, and made again only when something has changed."""

from __future__ import annotations

import base64
import json
import os
import sys
import types
import zlib
from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image

from dexrepro import chapters
from dexrepro.errors import InputError
from dexrepro.experiment import Experiment, Film, Recording
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.recordings import save_recording
from dexrepro.report import animation, explorer
from dexrepro.robots.planar import planar
from dexrepro.storage import read_json, write_json

CAMERA = Camera((0.4, 0.0, 0.0), 1.5, 0.0, -89.9)


def scene(config):
    world = World(gravity=(0, 0, 0))
    world.add_arm("arm", planar([0.5, 0.3], [1.5, 0.9]), [0.0, 0.0])
    return world


def stage(world, recording, config):
    return Recording({**recording.series, "arm.position": recording["angles"]})


@pytest.fixture
def swing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Experiment]:
    """A result folder whose arm turns by a right angle in two seconds."""
    home = tmp_path / "chapter/swing"
    home.mkdir(parents=True)
    for name in ("swing", "swing.experiment", "swing.figures"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
        (home / f"{name.rpartition('.')[2]}.py").touch()
    simulation, pictures = sys.modules["swing.experiment"], sys.modules["swing.figures"]
    simulation.scene, simulation.stage = scene, stage
    pictures.FILM = Film("turn", "The arm turns.", CAMERA, "tip", "Distance [mm]", 1e3, "wanted", (0.5, 2.0))
    experiment = Experiment("swing", home)
    monkeypatch.setattr(chapters, "numbers", lambda: ("90",))
    monkeypatch.setattr(chapters, "load", lambda number: types.SimpleNamespace(experiments=(experiment,)))
    monkeypatch.setattr(animation, "compose_chapter", lambda number: {})
    folder = tmp_path / "results"
    time = np.linspace(0, 2, 41)
    angles = np.column_stack([time * np.pi / 4, 0 * time])
    series = {"time": time, "angles": angles, "tip": np.column_stack([np.cos(time), np.sin(time)])}
    for case in ("still", "turn"):
        save_recording(Recording(series), folder / "series", case, 20.0)
    entry = {"status": "finished", "steps": 40, "simulated": 2.0, "wall": 0.1}
    run = {"chapter": "90", "experiment": "swing", "differs": [], "packages": {}, "wall": 0.2}
    write_json(folder / "run.json", run | {"cases": {"still": entry, "turn": entry}})
    cases = {case: {"wanted": 900.0} for case in ("still", "turn")}
    (folder / "config.yaml").write_text(yaml.safe_dump({"cases": cases}))
    return folder, experiment


def test_a_film_shows_the_declared_case_and_span_beside_the_quantity(swing: tuple[Path, Experiment]) -> None:
    path = animation.render(swing[0])
    assert path == swing[0] / "animation/turn.gif"
    with Image.open(path) as film, Image.open(path.with_suffix(".png")) as still:
        assert film.size == still.size == (2 * animation.SIZE[0], animation.SIZE[1])
        assert film.n_frames == 31, "one frame a sample from 0.5 to 2 s"
        first = np.asarray(film.convert("RGB")).astype(int)
        film.seek(film.n_frames - 1)
        last = np.asarray(film.convert("RGB")).astype(int)
    width = animation.SIZE[0]
    assert np.abs(first - last)[:, :width].max() > 100, "the arm moves"
    blue = [np.sum((picture[..., 2] > 130) & (picture[..., 0] < 60)) for picture in (first[:, width:], last[:, width:])]
    assert blue[1] > blue[0] + 100, "the curve is coloured up to the instant"


def test_a_film_is_up_to_date_until_its_recording_or_its_code_changes(swing: tuple[Path, Experiment]) -> None:
    folder, experiment = swing
    film = animation.film_of(folder, experiment)
    assert film is not None
    assert not animation.up_to_date(film, experiment)
    animation.render(folder)
    assert animation.up_to_date(film, experiment)
    later = film.stat().st_mtime + 10
    for changed in (folder / "series/turn.csv.gz", experiment.folder / "experiment.py"):
        before = changed.stat().st_mtime
        os.utime(changed, (later, later))
        assert not animation.up_to_date(film, experiment)
        os.utime(changed, (before, before))


def test_another_case_is_shown_in_the_same_way(swing: tuple[Path, Experiment]) -> None:
    with Image.open(animation.render(swing[0], "still")) as film:
        assert film.size[0] == 2 * animation.SIZE[0]


def test_a_run_that_ended_before_the_span_of_the_film_is_shown_as_a_whole(swing: tuple[Path, Experiment]) -> None:
    time = np.linspace(0, 0.3, 7)
    series = {"time": time, "angles": np.zeros((7, 2)), "tip": np.zeros((7, 2))}
    save_recording(Recording(series), swing[0] / "series", "turn", 20.0)
    with Image.open(animation.render(swing[0])) as film:
        assert film.n_frames == 7


def test_a_case_that_ended_before_its_first_sample_spoils_no_film_of_the_others(swing: tuple[Path, Experiment]) -> None:
    folder, run = swing[0], read_json(swing[0] / "run.json")
    at_once = {"status": "undefined from 0.50 s", "steps": 0, "simulated": 0.0, "wall": 0.1}
    run["cases"] = {"undefined": at_once} | run["cases"]
    write_json(folder / "run.json", run)
    assert animation.render(folder).name == "turn.gif"
    with pytest.raises(InputError, match=r"no arm is recorded in .* by 'undefined' \(undefined from 0.50 s\)"):
        animation.render(folder, "undefined")
    write_json(folder / "run.json", run | {"cases": run["cases"] | {"undefined": at_once | {"status": "finished"}}})
    with pytest.raises(InputError, match="no series of the case 'undefined'"):
        animation.render(folder)


def test_a_result_that_names_foreign_code_is_not_rendered(swing: tuple[Path, Experiment], tmp_path: Path) -> None:
    trap = tmp_path / "trap"
    foreign = ["pathlib.Path.touch", "dexrepro.storage.shutil.rmtree", "dexrepro.result.redraw", "os.system"]
    imports = ["dexrepro.chapters.add", "dexrepro.chapters._package", "dexrepro.chapters.chapter7.skills.import_module"]
    for target in foreign + imports:
        node = {"_target_": target, "self": str(trap)}
        config = {"cases": {"turn": {"law": None, "arm": node}, "still": {}}}
        (swing[0] / "config.yaml").write_text(yaml.safe_dump(config))
        with pytest.raises(InputError, match=rf"config.yaml names {target} under cases.turn.arm._target_"):
            animation.render(swing[0])
    assert not trap.exists()
    config["cases"]["turn"]["arm"] = {"_target_": "dexrepro.robots.planar.planar", "lengths": [1.0], "masses": [1.0]}
    config["cases"]["turn"]["mine"] = {"_target_": "fractions.Fraction"}
    (swing[0] / "config.yaml").write_text(yaml.safe_dump(config))
    assert animation.render(swing[0], allow=["fractions"]).exists()


def test_a_scene_is_exported_as_the_engine_poses_it(swing: tuple[Path, Experiment], tmp_path: Path) -> None:
    folder, experiment = swing
    shown = explorer.scene(folder, tmp_path, experiment)
    assert shown["case"] == "turn"
    entry = json.loads((tmp_path / "scene.js").read_text().partition(" = ")[2].rstrip(";\n"))
    planes = np.frombuffer(zlib.decompress(base64.b64decode(entry["poses"])), np.uint8)
    changes = np.ascontiguousarray(planes.reshape(-1, 4, entry["samples"]).transpose(0, 2, 1)).view("<i4")[..., 0]
    columns = np.cumsum(changes, axis=1, dtype=np.int32).view(np.float32)
    times, poses = columns[0], columns[1:].reshape(-1, 7, entry["samples"])
    assert times[0] >= 0.5, "the span of the film"
    assert len(entry["solids"]) == len(poses)
    angles = times * np.pi / 4
    middle = 0.25 * np.array([np.cos(angles), np.sin(angles), 0 * angles])
    np.testing.assert_allclose(poses[0, :3], middle, atol=1e-5)


def test_a_result_that_the_present_code_cannot_stage_has_no_scene(
    swing: tuple[Path, Experiment], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(swing[1].simulation, "scene", lambda config: config.another_key)
    assert explorer.scene(swing[0], tmp_path, swing[1]) is None
    assert not (tmp_path / "scene.js").exists()
