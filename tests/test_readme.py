"""The README's examples run as they stand."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from conftest import ROOT, Shell

README = (ROOT / "README.md").read_text()


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


def block(language: str, containing: str) -> str:
    return next(text for text in blocks(language) if containing in text)


def test_examples_are_short() -> None:
    assert all(len(text.splitlines()) <= 40 for text in blocks("python") + blocks("yaml"))


def test_the_python_example(shell: Shell, tmp_path: Path) -> None:
    (tmp_path / "example.py").write_text(block("python", "dexrepro.run("))
    done = shell("python example.py")
    assert done.returncode == 0, done.stderr


def test_the_own_control_law_joins_the_comparison(shell: Shell, tmp_path: Path) -> None:
    (tmp_path / "my_law.py").write_text(block("python", "class IntegralForce"))
    command = block("sh", "my_law.IntegralForce").strip()
    done = shell(f"{command} holding_comparison.duration=0.05", timeout=300)
    assert done.returncode == 0, done.stderr
    metrics = next(tmp_path.glob("results/runs/holding_comparison-*/metrics.json")).read_text()
    assert "holding_comparison.mine.rmse" in metrics


def test_the_own_experiment_runs(shell: Shell, tmp_path: Path) -> None:
    for folder in ("dexrepro", "conf"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    chapter = tmp_path / "dexrepro/chapters/chapter2"
    (chapter / "push.py").write_text(block("python", '"2.Z"'))
    with open(chapter / "__init__.py", "a") as file:
        file.write("\nfrom dexrepro.chapters.chapter2 import push\n\nEXPERIMENTS += (Experiment.of(push),)\n")
    with open(tmp_path / "conf/chapter/2.yaml", "a") as file:
        file.write(block("yaml", "push:"))
    done = shell("PYTHONPATH=. python -m dexrepro run figure=2.Z")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "results/chapter2/push/figures/fig_2_Z.png").exists()


@pytest.mark.parametrize("command", [line for line in block("sh", "dexrepro list").splitlines() if "…" not in line])
def test_every_command_is_understood(shell: Shell, command: str) -> None:
    """Every command of the list, cut short where it would simulate: the chapter runs elsewhere in full."""
    command = command.partition("#")[0].strip()
    if command.startswith("dexrepro run") and "--cfg" not in command:
        command += " --cfg job" if " -m " not in command else ""
        command = command.replace("-m ", "--cfg job ").replace("'seed=range(3)'", "")
    done = shell(command)
    assert done.returncode == (2 if command == "dexrepro check" else 0), done.stderr
    assert "Traceback" not in done.stderr
