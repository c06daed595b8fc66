"""Tab offers what there is, through a shell's own protocol and through Bash itself."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT


def offered(line: str, folder: Path) -> list[str]:
    """What argcomplete's protocol answers for a command line whose last word is to be completed."""
    answer = folder / "answer"
    env = {
        **os.environ, "PYTHONPATH": str(ROOT), "_ARGCOMPLETE": "1", "_ARGCOMPLETE_IFS": "\n", "COMP_LINE": line,
        "COMP_POINT": str(len(line)), "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
    }  # fmt: skip
    subprocess.run([sys.executable, "-m", "dexrepro"], env=env, cwd=folder, check=False, timeout=60)
    return [word.strip() for word in answer.read_text().splitlines()]


@pytest.mark.parametrize(
    ("line", "some", "none"),
    [
        ("dexrepro ", ["run", "check", "study", "completion"], []),
        ("dexrepro run ", ["chapter=", "claim=", "movement_estimation."], ["samples="]),
        ("dexrepro study ", ["chapter=", "claim=", "samples="], ["movement_estimation."]),
        ("dexrepro run chapter=", ["chapter=1", "chapter=8"], []),
        ("dexrepro run chapter=2 only=", ["only=movement_estimation"], ["only=dartboard"]),
        ("dexrepro run only=movement_estimation movement_estimation.st", ["movement_estimation.stiffness="], []),
        ("dexrepro study chapter=7 claim=C7.0", ["claim=C7.01"], ["claim=C1.01"]),
        ("dexrepro run chapter=2 figure=2.", ["figure=2.7"], ["figure=1.9"]),
        ("dexrepro render only=movement_estimation case=k", ["case=k35"], []),
    ],
)
def test_tab_offers_what_there_is(line: str, some: list[str], none: list[str], tmp_path: Path) -> None:
    words = offered(line, tmp_path)
    assert set(some) <= set(words)
    assert not set(none) & set(words)


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_each_shell_gets_a_script_that_it_can_read(shell: str, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "dexrepro", "completion", shell]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True, timeout=60)
    assert "dexrepro" in done.stdout
    if shutil.which(shell):
        subprocess.run([shell, "-n"], input=done.stdout, text=True, check=True, timeout=60)
