"""A tiny chapter of its own, so that the runner is tested without simulating the book."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import dexrepro
from dexrepro import chapters

ROOT = Path(dexrepro.__file__).parent.parent
TOY = Path(__file__).parent / "toy"


@pytest.fixture
def toy_book(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A book of one tiny chapter, 90, outside the package."""
    return Path(shutil.copytree(TOY, tmp_path_factory.mktemp("toy") / "book"))


@pytest.fixture
def toy(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, toy_book: Path) -> Path:
    """Make chapter 90 the only chapter, here and in commands started from here; work in an empty folder."""
    monkeypatch.setenv(chapters.ADDED, str(toy_book))
    monkeypatch.chdir(tmp_path)
    chapters.forget()
    yield tmp_path
    monkeypatch.undo()
    chapters.forget()


Shell = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def shell(tmp_path: Path) -> Shell:
    """Run a command line as a user would, in an empty folder."""

    def run(command: str, cwd: Path = tmp_path, timeout: float = 120) -> subprocess.CompletedProcess[str]:
        env = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}
        return subprocess.run(
            command, shell=True, cwd=cwd, env=env, capture_output=True, text=True, timeout=timeout, check=False
        )

    return run
