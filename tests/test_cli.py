"""The commands of the README and the manual, typed in a shell."""

from __future__ import annotations

import json
import multiprocessing
import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from conftest import ROOT, Shell

from dexrepro import cli
from dexrepro.commands import run
from dexrepro.config import compose_chapter

ONLY_K = [
    f"~movement_estimation.cases.{case}" for case in compose_chapter("2")["movement_estimation"]["cases"] if case != "k"
]
SHORT = " ".join(["movement_estimation.duration=0.05", *map(repr, ONLY_K)])


Typed = Callable[[str], tuple[int, str]]


@pytest.fixture
def typed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Typed:
    """Run a command line in this process, in an empty folder: its status, and what it says on stderr."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])

    def run(line: str) -> tuple[int, str]:
        try:
            status = cli.main(shlex.split(line)[1:])
        except SystemExit as left:  # what argparse does
            status = int(left.code or 0)
        return status, capfd.readouterr().err

    return run


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ("dexrepro --version", "dexrepro 0."),
        ("dexrepro run --help", "dexrepro run chapter=N --cfg job"),
        ("dexrepro run chapter=2 --cfg job", "movement_estimation:"),
        ("dexrepro list", "movement_estimation: 2.6, 2.7"),
        (f"dexrepro run chapter=2 only=movement_estimation {SHORT}", "differs from the book in: duration=0.05"),
        (f"dexrepro run figure=2.7 {SHORT}", "results/runs/movement_estimation"),
        (
            f"dexrepro run chapter=2 only=movement_estimation 'movement_estimation.stiffness=[25,60]' {SHORT}",
            "stiffness=[25, 60]",
        ),
        (
            f"dexrepro run -m chapter=2 only=movement_estimation 'seed=range(2)' {SHORT} hydra/launcher=joblib",
            "seed=1 (book: 0)",
        ),
        ("dexrepro report", "results/report/index.html"),
    ],
)
def test_a_command_of_the_manual_works(shell: Shell, command: str, expected: str) -> None:
    done = shell(command)
    assert done.returncode == 0, done.stderr
    assert expected in done.stdout
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("command", "status", "sentence"),
    [
        ("dexrepro run chapter=99", 2, "unknown chapter '99'"),
        ("dexrepro run -m chapter=2,99", 2, "unknown chapter '99'"),
        ("dexrepro run figure=2.77", 2, "unknown figure '2.77'"),
        ("dexrepro run chapter=2 only=movement_estimaton", 2, "did you mean 'movement_estimation'?"),
        ("dexrepro run -m chapter=2 sed=1,2", 2, "unknown key 'sed': did you mean 'seed'?"),
        ("dexrepro run chapter=2 workers=0", 2, "workers = 0 is not allowed"),
        ("dexrepro check chapter=2 workers=all", 2, "workers = all is not allowed"),
        ("dexrepro check chapter=2", 2, "run: dexrepro run chapter=2"),
        ("dexrepro check chapter=2 --json only=nosuch", 2, "unknown experiment 'nosuch'"),
        ("dexrepro check chapter=2 --jsn only=holding_line", 2, "unrecognized arguments"),
        ("dexrepro diff here there", 2, "here holds no result"),
        ("dexrepro draw case=s1", 2, "case = s1: of which experiment"),
    ],
)
def test_a_mistake_gets_one_sentence(typed: Typed, command: str, status: int, sentence: str) -> None:
    found, said = typed(command)
    assert found == status
    assert sentence in said
    assert "Traceback" not in said


def test_list_is_json_that_scripts_can_rely_on(shell: Shell) -> None:
    data = json.loads(shell("dexrepro list --json").stdout)
    chapter = next(chapter for chapter in data["chapters"] if chapter["chapter"] == "2")
    assert {"chapter", "title", "experiments", "claims", "errata"} <= set(chapter)
    assert {"name", "cases", "figures", "tables"} <= set(chapter["experiments"][0])
    assert {"id", "figure", "statement", "predicate"} <= set(chapter["claims"][0])
    assert {"id", "equation", "summary", "switch"} <= set(chapter["errata"][0])


def test_a_case_that_fails_gives_status_1_and_its_reason(shell: Shell) -> None:
    done = shell(f"dexrepro run figure=2.7 {SHORT} movement_estimation.law._target_=nosuch.Law")
    assert done.returncode == 1
    assert "2 more failed: cannot build the objects of the configuration" in done.stderr


OWN_LAW = """
from dexrepro.control.holding_reference import ImpedanceReference

class Further(ImpedanceReference):
    def __call__(self, measured):
        return super().__call__(measured) + 1e-3
"""
OWN_CASE = """# @package _global_
only: movement_estimation
movement_estimation:
  cases:
    mine: {law._target_: my_law.Further, stiffness: 35, period: 20}
"""


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A user's folder with a law and a configuration that adds it to a comparison."""
    folder = tmp_path / "mine"
    (folder / "own").mkdir(parents=True)
    (folder / "my_law.py").write_text(OWN_LAW)
    (folder / "own/compare.yaml").write_text(OWN_CASE)
    return folder


def test_a_folder_of_the_user_brings_law_and_configuration(shell: Shell, tmp_path: Path, mine: Path) -> None:
    command = f"dexrepro run --config-dir mine +own=compare {SHORT}"
    done = shell(command)
    assert done.returncode == 0, done.stderr
    assert "movement_estimation.mine:" in done.stdout
    metrics = next(tmp_path.glob("results/runs/movement_estimation-*/metrics.json")).read_text()
    assert "movement_estimation.mine." in metrics
    (mine / "my_law.py").write_text(OWN_LAW.replace("1e-3", "2e-3"))
    again = shell(command).stdout
    assert "movement_estimation.mine:" in again, "the law has changed, so its case must run again"
    assert "movement_estimation.k25:" not in again


def test_a_folder_of_the_user_takes_part_in_a_sweep(shell: Shell, tmp_path: Path, mine: Path) -> None:
    done = shell(f"dexrepro run -m --config-dir mine +own=compare 'seed=range(2)' {SHORT} hydra/launcher=joblib")
    assert done.returncode == 0, done.stderr
    runs = list(tmp_path.glob("results/runs/movement_estimation-*/metrics.json"))
    assert len(runs) == 2
    assert all("movement_estimation.mine." in path.read_text() for path in runs)


def test_a_folder_of_the_user_is_importable_in_spawned_processes(mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [*sys.path])
    assert run._config_dir_option(["--config-dir", str(mine), "a=1"]) == (str(mine), ["a=1"])
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(eval, ("__import__('my_law').Further.__name__",)) == "Further"


def test_a_folder_of_the_user_that_cannot_be_used_gets_one_sentence(typed: Typed, mine: Path) -> None:
    (mine / "own/compare.yaml").write_text(OWN_CASE.partition("\n")[2])
    (mine / "own/misspelt.yaml").write_text(OWN_CASE + "  duratio: 1\n")
    for command, sentence in {
        "--config-dir nowhere +own=compare": "--config-dir = nowhere is not allowed: there is no such folder",
        "--config-dir mine +own=compar": "Could not find 'own/compar'",
        "--config-dir mine +own=misspelt": "unknown key 'movement_estimation.duratio': did you mean 'duration'?",
        "--config-dir mine chapter=2 +own=compare": "begin it with '# @package _global_'",
    }.items():
        status, said = typed(f"dexrepro run {command}")
        assert status == 2, command
        assert sentence in said
        assert "Traceback" not in said


def test_ctrl_c_leaves_no_half_result_and_the_next_run_completes_it(tmp_path: Path, shell: Shell) -> None:
    command = [
        sys.executable, "-m", "dexrepro", "run", "figure=2.7", "movement_estimation.duration=3.0", "workers=1", *ONLY_K,
    ]  # fmt: skip
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    heeding = partial(signal.signal, signal.SIGINT, signal.default_int_handler)  # ignored where tests run in background
    process = subprocess.Popen(
        command, cwd=tmp_path, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=heeding
    )
    cache = tmp_path / "results/.cache/movement_estimation"
    deadline = time.monotonic() + 60
    while not (finished := list(cache.glob("*/case.json"))) and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, stderr = process.communicate(timeout=60)
    assert process.returncode == 130, stderr
    assert not list((tmp_path / "results").glob("runs/movement*"))
    done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    first = finished[0].parent.name.partition("-")[0]
    assert f"movement_estimation.{first}:" not in done.stdout, "the finished case was run again"
    assert len(list((tmp_path / "results/runs").glob("movement*/metrics.json"))) == 1


def test_diff_names_what_differs(shell: Shell, tmp_path: Path) -> None:
    for rest_length in (0.55, 0.5):
        done = shell(f"dexrepro run figure=2.7 {SHORT} movement_estimation.rest_length={rest_length}")
        assert done.returncode == 0, done.stderr
    a, b = sorted(path.relative_to(tmp_path) for path in (tmp_path / "results/runs").glob("movement*"))
    done = shell(f"dexrepro diff {a} {b}")
    assert done.returncode == 0, done.stderr
    assert "rest_length" in done.stdout
    assert "metric   movement_estimation.k25." in done.stdout
    assert list((tmp_path / "results/runs").glob("diff-*.png"))


def test_a_recorded_run_is_animated_without_simulating(shell: Shell, tmp_path: Path) -> None:
    assert shell(f"dexrepro run figure=2.7 {SHORT}").returncode == 0
    folder = next((tmp_path / "results/runs").glob("movement*"))
    done = shell(f"dexrepro render {folder} case=k35")
    assert done.returncode == 0, done.stderr
    assert (folder / "animation/k35.gif").read_bytes()[:4] == b"GIF8"
    assert "did you mean 'k35'" in shell(f"dexrepro render {folder} case=k36").stderr


@pytest.mark.parametrize("kind", ["joint", "end_point", "holding"])
def test_a_new_controller_comes_with_a_test_that_passes(shell: Shell, kind: str) -> None:
    done = shell(f"dexrepro new controller MyLaw --kind {kind}")
    assert done.returncode == 0, done.stderr
    assert "my_law.MyLaw" in done.stdout
    assert shell(f"{sys.executable} -m pytest -q -p no:cacheprovider test_my_law.py").returncode == 0
    command = done.stdout.splitlines()[-1].strip()
    assert shell(f"{command} --cfg job").returncode == 0
    assert "exists already" in shell("dexrepro new controller MyLaw").stderr
    assert "must be a class name" in shell("dexrepro new controller my-law").stderr
