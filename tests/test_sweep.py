"""Sweeps and studies through Hydra launchers: the same results from each, nothing lost, nothing repeated."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import Shell

RUN = f"PYTHONPATH=. {sys.executable} -m dexrepro run"
submitit = pytest.mark.skipif(
    importlib.util.find_spec("submitit") is None, reason="needs hydra-submitit-launcher (pip install dexrepro[slurm])"
)
ray = pytest.mark.skipif(
    importlib.util.find_spec("ray") is None, reason="needs hydra-ray-launcher (pip install dexrepro[ray])"
)
LAUNCHERS = [
    pytest.param("submitit_local", marks=submitit),
    pytest.param("ray +hydra.launcher.ray.init.num_cpus=2", marks=ray),
]


@pytest.mark.parametrize("launcher", LAUNCHERS)
def test_every_launcher_gives_the_results_of_plain_runs(shell: Shell, toy: Path, launcher: str) -> None:
    sweep = shell(f"{RUN} -m 'seed=range(3)' decay.noise=0.1 hydra/launcher={launcher}")
    assert sweep.returncode == 0, sweep.stderr
    assert len(list((toy / "results/runs").glob("decay-*"))) == 3
    assert shell(f"{RUN} seed=2 decay.noise=0.1 results=plain").returncode == 0
    plain = next((toy / "plain/runs").glob("decay-*"))
    swept = toy / "results/runs" / plain.name
    for path in [*(plain / "series").iterdir(), plain / "metrics.json"]:
        assert path.read_bytes() == (swept / path.relative_to(plain)).read_bytes()


@submitit
def test_a_job_that_fails_gives_status_1_and_a_sentence(shell: Shell, toy: Path) -> None:
    done = shell(f"{RUN} -m +decay.cases.fast.fail=true hydra/launcher=submitit_local")
    assert done.returncode == 1
    assert "a job of the sweep failed: decay.fast failed: ValueError: told to fail" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_launcher_that_is_absent_says_what_brings_it(shell: Shell, toy: Path) -> None:
    hide = "import sys; sys.modules['hydra_plugins.hydra_ray_launcher'] = None; sys.argv[0] = 'dexrepro';"
    script = f"{hide} from dexrepro.cli import main; sys.exit(main())"
    done = shell(f'PYTHONPATH=. {sys.executable} -c "{script}" run -m seed=1,2 hydra/launcher=ray')
    assert done.returncode == 2
    assert "hydra/launcher=ray needs: pip install 'dexrepro[ray]'" in done.stderr


def test_a_sweep_works_where_it_was_started_even_if_its_launcher_does_not(
    toy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from hydra.core.hydra_config import HydraConfig
    from omegaconf import OmegaConf

    from dexrepro.sweep import enter_launch_folder

    here = OmegaConf.create({"runtime": {"cwd": str(toy)}})
    monkeypatch.setattr(HydraConfig, "get", staticmethod(lambda: here))
    monkeypatch.setattr(sys, "path", [entry for entry in sys.path if entry])
    monkeypatch.chdir("/")
    enter_launch_folder()
    assert Path.cwd() == toy
    assert sys.path[-1] == "", "the user's own classes are in reach"


def kill_worker(sweep: int) -> None:
    """Kill one process of a sweep's launcher."""
    for path in Path("/proc").glob("[0-9]*"):
        status, command = (path / "stat").read_text(), (path / "cmdline").read_text()
        if int(status.rpartition(")")[2].split()[1]) == sweep and "popen_loky" in command:
            return os.kill(int(path.name), signal.SIGKILL)
    raise AssertionError("the sweep has no worker")


def kill_all(sweep: int) -> None:
    os.killpg(sweep, signal.SIGKILL)


def finished(folder: Path) -> dict[Path, int]:
    """Cases and results that are there, with the instant each was written [ns]."""
    paths = [*folder.glob("results/.cache/*/[!.]*/case.json"), *folder.glob("results/runs/[!.]*/run.json")]
    return {path: path.stat().st_mtime_ns for path in paths}


@pytest.mark.parametrize("kill", [kill_worker, kill_all])
def test_whatever_is_killed_the_same_sweep_completes_what_is_missing(toy: Path, kill) -> None:
    command = [
        sys.executable, "-m", "dexrepro", "run", "-m", "seed=range(3)", "decay.pause=0.3", "hydra.launcher.n_jobs=2",
    ]  # fmt: skip
    env = {**os.environ, "PYTHONPATH": "."}
    sweep = subprocess.Popen(
        command,
        cwd=toy,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    deadline = time.monotonic() + 60
    while len(finished(toy)) < 8 and time.monotonic() < deadline:
        time.sleep(0.02)
    kill(sweep.pid)
    _, stderr = sweep.communicate(timeout=60)
    assert sweep.returncode != 0
    if kill is kill_worker:
        assert "the same command completes what is missing" in stderr
    before = finished(toy)
    assert len(before) < 18, "killed too late to prove anything"

    again = subprocess.run(command, cwd=toy, env=env, capture_output=True, text=True, check=False, timeout=60)
    assert again.returncode == 0, again.stderr
    after = finished(toy)
    assert len(after) == 3 * 5 + 3
    assert {path: after[path] for path in before} == before, "something was run again"
    assert not list((toy / "results").rglob(".*@*")), "half a folder is left"


@submitit
def test_jobs_of_a_study_share_its_samples(shell: Shell, toy: Path) -> None:
    study = f"PYTHONPATH=. {sys.executable} -m dexrepro study chapter=90 samples=6"
    done = shell(f"{study} jobs=2 hydra/launcher=submitit_local")
    assert done.returncode == 0, done.stderr
    assert "C90.01: holds in 6 of 6" in done.stdout
    lines = (toy / "results/studies/decay.jsonl").read_text().splitlines()
    assert sorted(json.loads(line)["index"] for line in lines) == list(range(6))
    assert "jobs = x is not allowed" in shell(f"{study} jobs=x").stderr


def test_the_summary_of_a_study_by_jobs_is_said_once(shell: Shell, toy: Path) -> None:
    done = shell(f"PYTHONPATH=. {sys.executable} -m dexrepro study chapter=90 'case=gain*' samples=2 jobs=2")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("decay: results/studies/cases/decay-") == 1
