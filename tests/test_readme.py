"""The examples of the README and of the manual run as they stand."""

from __future__ import annotations

import importlib.util
import json
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Shell
from test_cli import SHORT

from dexrepro import chapters, scoreboard, timings
from dexrepro.cases import experiment_cases
from dexrepro.config import compose_chapter
from dexrepro.control.contract import Measured, check

README = (ROOT / "README.md").read_text()
PAGES = [README, *(path.read_text() for path in sorted((ROOT / "docs").glob("*.md")))]
PAGES += [path.read_text() for path in sorted((ROOT / "docs/how-to").glob("*.md"))]


def blocks(language: str) -> list[str]:
    return [text for page in PAGES for text in re.findall(rf"```{language}\n(.*?)```", page, re.DOTALL)]


def block(language: str, containing: str) -> str:
    return next(text for text in blocks(language) if containing in text)


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def test_examples_are_short() -> None:
    assert all(len(text.splitlines()) <= 40 for text in blocks("python") + blocks("yaml") + blocks("xml"))


def test_the_python_example(shell: Shell, tmp_path: Path) -> None:
    (tmp_path / "example.py").write_text(block("python", "dexrepro.run("))
    done = shell("python example.py")
    assert done.returncode == 0, done.stderr


def test_the_own_control_law_joins_the_comparison(shell: Shell, tmp_path: Path) -> None:
    (tmp_path / "my_law.py").write_text(block("python", "class IntegralForce"))
    command = block("sh", "+holding_comparison.cases.mine").strip()
    done = shell(f"{command} holding_comparison.duration=0.05", timeout=300)
    assert done.returncode == 0, done.stderr
    metrics = next(tmp_path.glob("results/runs/holding_comparison-*/metrics.json")).read_text()
    assert "holding_comparison.mine.rmse" in metrics


def test_the_plain_law_is_one() -> None:
    names: dict[str, type] = {}
    exec(block("python", "class PlainIntegralForce"), names)
    law = check(names["PlainIntegralForce"](0.5, 1.0, 0.1), "holding")
    law.reset(Measured(0.0, 0.2, 0.0, 0.0))
    assert law(Measured(0.0, 0.2, 0.0, 3.0)) == pytest.approx(0.3)


def test_a_folder_of_the_users_own_joins_the_comparison(shell: Shell, tmp_path: Path) -> None:
    write(tmp_path / "mine/my_law.py", block("python", "class IntegralForce"))
    write(tmp_path / "mine/own/compare.yaml", block("yaml", "my_law.IntegralForce"))
    single, sweep = block("sh", "+own=compare").splitlines()
    done = shell(f"{single} holding_comparison.duration=0.05", timeout=300)
    assert done.returncode == 0, done.stderr
    folder = next(tmp_path.glob("results/runs/holding_comparison-*"))
    assert "holding_comparison.mine.rmse" in (folder / "metrics.json").read_text()
    assert "\nmine,mine," in (folder / "tables/T2.1.csv").read_text()
    assert ">mine</text>" in (folder / "figures/fig_2_08.svg").read_text(), "the legend names the law"
    done = shell(f"{sweep.replace(' -m', '')} --cfg job".replace("'seed=range(2)'", ""))
    assert "my_law.IntegralForce" in done.stdout, done.stderr


def test_the_own_scene_runs_and_is_compared_and_rendered(shell: Shell, tmp_path: Path) -> None:
    write(tmp_path / "mine/scene/squeeze.yaml", block("yaml", "name: squeeze"))
    write(tmp_path / "tiny.urdf", block("xml", "<robot"))
    for command in block("sh", "+scene=squeeze").splitlines():
        done = shell(f"{command} scene.duration=0.3")
        assert done.returncode == 0, done.stderr
        assert "book" not in done.stdout
    first, second = sorted(tmp_path.glob("results/runs/squeeze-*"))
    assert {"scene.force.force_rmse", "scene.tracking.rmse"} <= set(json.loads((first / "metrics.json").read_text()))
    assert (first / "figures/fig_own_A.png").exists()
    assert "scene.force.force_rmse" in shell(f"dexrepro diff {first} {second}").stdout
    assert shell(f"dexrepro render {first} case=force").returncode == 0
    assert (first / "animation/force.gif").exists()


QUICK = {
    "letter_accuracy": "kernels.draws=2 ~{0}.cases '+{0}.cases={{default: {{equal_size: true}}}}'",
    "style_transformation": "features.draws=1 ~{0}.cases +{0}.cases.default={{}}",
    "obstacle_crossing": "features.draws=1 ~{0}.cases +{0}.cases.default={{}}",
    "reaching_demonstrations": "separation_repetitions=10 ~{0}.cases.printed_sign",
    "reactive_learning": "draws=2 ~{0}.cases.printed_sign",
    "planar_skill": "demonstrations.count=3 ~{0}.cases.tau_1s",
}


@pytest.mark.parametrize("command", block("sh", "my_letter.csv").splitlines())
def test_own_demonstrations_take_the_place_of_the_synthetic(shell: Shell, tmp_path: Path, command: str) -> None:
    share = np.linspace(0, 1, 100)
    progress, bump = share**3 * (10 - 15 * share + 6 * share**2), np.sin(np.pi * share)
    down, across = np.r_[progress, np.ones(115)], np.r_[np.zeros(115), progress]  # a pause between
    for name, columns in {
        "my_letter": (2 + np.sin(2 * np.pi * progress), 4 * progress),
        "over_one": (12 * progress - 6, 0 * share, 5 * bump),
        "reach1": (2.3 + 17.7 * progress, 9 * progress, bump**2),
        "reach2": (2.3 + 17.7 * progress, 9 * progress, 2 * bump**2),
        "left1": (2.3 + 17.7 * progress, 9 * progress + 6 * bump**3, 2 * bump**3),
        "drawing": (30 - 24 * across, 20 - 12 * down + 0.5 * np.sin(np.pi * across)),
    }.items():
        rows = np.column_stack([np.linspace(0, 3, len(columns[0])), *columns])
        np.savetxt(tmp_path / f"{name}.csv", rows, delimiter=",")
    (tmp_path / "block.csv").write_text("16,6.5\n19,6.5\n19,9\n16,9\n")
    experiment = re.search(r"only=(\w+)", command)[1]
    command = f"{command} {experiment}.{QUICK[experiment].format(experiment)}"
    done = shell(command, timeout=300)
    if refused := re.search(r"; set (planar_skill\.[^;\n]*)", done.stderr):
        done = shell(f"{command} {refused[1]}", timeout=300)
    assert done.returncode == 0, done.stderr
    folder = next(tmp_path.glob(f"results/runs/{experiment}-*"))
    assert all(
        value is None or np.isfinite(value) for value in json.loads((folder / "metrics.json").read_text()).values()
    )
    assert list((folder / "figures").glob("*.png"))


def own_experiment(home: Path) -> None:
    """The experiment of the manual, in the folder that it names."""
    (home / "lab/push").mkdir(parents=True)
    for language, name in (
        ("python", "experiment.py"),
        ("python", "figures.py"),
        ("python", "claims.py"),
        ("yaml", "config.yaml"),
    ):
        (home / "lab/push" / name).write_text(block(language, f"# lab/push/{name}"))


def test_the_own_experiment_is_run_checked_studied_drawn_and_reported(shell: Shell, tmp_path: Path) -> None:
    own_experiment(tmp_path)
    for command in block("sh", "--experiments lab").splitlines():
        done = shell(command)
        assert done.returncode == 0, done.stderr
    (claim,) = json.loads((tmp_path / "results/chapterlab/push/claims.json").read_text())
    assert (claim["verdict"], claim["severe"]) == ("reproduced", True)
    assert list((tmp_path / "results/chapterlab/push/figures").glob("fig_lab_*.png"))
    assert "lab.01" in json.loads((tmp_path / "lab/push/baseline.json").read_text())["claims"]
    assert "push" in (tmp_path / "results/report/chapterlab.html").read_text()
    listed = json.loads(shell("dexrepro list --json --experiments lab").stdout)["chapters"]
    assert [chapter["chapter"] for chapter in listed] == [*chapters.numbers(), "lab"]


def test_another_book_is_another_folder(shell: Shell, tmp_path: Path) -> None:
    own_experiment(tmp_path / "other")
    (tmp_path / "other/lab").rename(tmp_path / "other/chapter9")
    (tmp_path / "other/book.yaml").write_text("title: Pushing Arms\nauthors: A. Reader\n")
    (tmp_path / "other/chapter9/__init__.py").write_text('TITLE = "Pushes"\n')
    listed = json.loads(shell("dexrepro list --json --experiments other").stdout)["chapters"]
    assert [(chapter["chapter"], chapter["title"]) for chapter in listed] == [("9", "Pushes")]
    done = shell("dexrepro run --experiments other && dexrepro report --experiments other")
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "results/report/index.html").read_text()
    assert "Pushing Arms" in page
    assert "Teleoperation" not in page


LISTS = [text for text in blocks("sh") if "dexrepro list" in text or text.startswith("dexrepro run figure=")]
COMMANDS = [line.partition(" #")[0].strip() for text in LISTS for line in text.splitlines() if "…" not in line]


@pytest.mark.parametrize("command", [command for command in COMMANDS if " study " not in command])
def test_every_command_is_understood(shell: Shell, command: str) -> None:
    """Every command of the list; those that simulate in full elsewhere only show their configuration here."""
    needs_results = {"dexrepro check": 2, "dexrepro draw": 2, "dexrepro render": 2}
    if command.startswith("dexrepro run") and "--cfg" not in command:
        command = command.replace(" -m", "").replace("'seed=range(3)'", "") + " --cfg job"
    done = shell(command)
    expected = next((status for start, status in needs_results.items() if command.startswith(start)), 0)
    assert done.returncode == expected, done.stderr
    assert "Traceback" not in done.stderr


def test_parameters_of_an_example_are_those_that_its_figure_shows() -> None:
    def shown(*words: str) -> dict[str, object]:
        composed = compose_chapter("2", words)
        cases = experiment_cases(composed, "movement_estimation")
        periods = np.atleast_1d(composed["movement_estimation"]["period"])
        in_figure = {n: v for n, v in cases.items() if v["period"] in periods and n.startswith(("sigma", "k"))}
        assert all(name.startswith("sigma") for name in in_figure), "the figure draws whatever has one of the periods"
        return in_figure

    begins = "dexrepro run figure=2.7 "
    words = [c.removeprefix(begins).replace("'", "") for c in COMMANDS if c.startswith(f"{begins}'") or "2.7 mov" in c]
    assert len(words) >= 3
    for word in words:
        assert shown(word) != shown(), f"{word} leaves Fig. 2.7 as it is"


SCALING = [line.partition(" #")[0].strip() for line in block("sh", "submitit_slurm").splitlines()]
HAS_SLURM = shutil.which("sinfo") is not None and subprocess.run(["sinfo"], capture_output=True).returncode == 0


@pytest.mark.parametrize("command", [command for command in SCALING if command.startswith("dexrepro run")])
def test_every_launcher_runs_a_sweep(shell: Shell, tmp_path: Path, command: str) -> None:
    if "launcher=ray" in command and importlib.util.find_spec("ray") is None:
        pytest.skip("needs Ray (pip install dexrepro[ray])")
    if "submitit_slurm" in command and not HAS_SLURM:
        pytest.skip("needs a Slurm that runs (tests/slurm/single_node.sh brings one up)")
    done = shell(command.replace("range(20)", "range(2)") + f" {SHORT}")
    assert done.returncode == 0, done.stderr
    assert len(list((tmp_path / "results/runs").glob("movement_estimation-*/metrics.json"))) == 2


STUDIES = [command for command in COMMANDS + SCALING if " study " in command]


@pytest.mark.parametrize("command", STUDIES)
def test_every_study_counts(shell: Shell, tmp_path: Path, command: str) -> None:
    few = re.sub(r"samples=\d+", "samples=2", command).replace("jobs=20", "jobs=2")
    if "submitit_slurm" in command and not HAS_SLURM:
        few = few.replace("submitit_slurm", "joblib")
    done = shell(few)
    assert done.returncode == 0, done.stderr
    assert "C7.01: holds in" in done.stdout
    assert (
        json.loads(next(tmp_path.glob("results/studies/*.json")).read_text())["samples"] >= 2
    )  # those shipped count too


def test_the_script_for_slurm_runs_a_sweep_like_that_of_the_readme() -> None:
    script = (ROOT / SCALING[-1]).read_text()
    assert "dexrepro run -m" in script
    assert "hydra/launcher=submitit_slurm" in script
    assert subprocess.run(["bash", "-n", str(ROOT / SCALING[-1])], check=False).returncode == 0


def test_the_table_counts_the_stored_verdicts() -> None:
    assert scoreboard.markdown() in README, "dexrepro list --markdown prints the table as it must stand"


def test_what_the_commands_take_is_what_was_measured() -> None:
    """``make measure`` writes both; the estimate at the start of a run has a time for the cases that were measured."""
    assert f"<!-- measured -->\n{timings.markdown()}\n<!-- end -->" in README
    known = timings.timings()["cases"]
    experiments = {name for number in chapters.numbers() for name in chapters.names(number)}
    assert {name.partition(".")[0] for name in known} <= experiments
    assert all(seconds >= 0 for seconds in known.values())


def test_a_measurement_counts_time_memory_and_disk(tmp_path: Path) -> None:
    measure = runpy.run_path(str(ROOT / ".ci/measure"))["measure"]
    write = "from pathlib import Path; Path('it').write_bytes(bytes(30_000_000)); x = bytearray(200_000_000); "
    found = measure([sys.executable, "-c", f"{write} import time; time.sleep(1.5)"], tmp_path)
    assert found["seconds"] >= 1.5
    assert 0.2 <= found["memory"] < 0.4
    assert found["disk"] == 0.03
