"""A tiny chapter of its own, so that the runner is tested without simulating the book."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import dexrepro
from dexrepro import chapters

ROOT = Path(dexrepro.__file__).parent.parent
TOY = Path(__file__).parent / "toy"


@contextlib.contextmanager
def toy_chapter(folder: Path, book: Path) -> Iterator[Path]:
    """Make chapter 90 the only chapter, here and in commands started from here; work in a folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(chapters.ADDED, str(shutil.copytree(TOY, book)))
        patch.chdir(folder)
        chapters.forget()
        yield folder
    chapters.forget()


@pytest.fixture
def toy_book(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A book of one tiny chapter, 90, outside the package."""
    return tmp_path_factory.mktemp("toy") / "book"


@pytest.fixture
def toy(tmp_path: Path, toy_book: Path) -> Iterator[Path]:
    """Chapter 90 is the only one; the folder in which one works is empty."""
    with toy_chapter(tmp_path, toy_book) as folder:
        yield folder


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A report of chapter 90, with a film, built once for the tests of a module."""
    from PIL import Image

    from dexrepro.plan import plan_chapter
    from dexrepro.report import page
    from dexrepro.runner import run_plans

    with toy_chapter(tmp_path_factory.mktemp("work"), tmp_path_factory.mktemp("toy") / "book") as folder:
        plans, _ = plan_chapter("90")
        run_plans(plans, workers=1, force=False)
        films = folder / "results/chapter90/decay/animation"
        films.mkdir()
        for name in ("plain.gif", "plain.png"):
            Image.new("RGB", (80, 33), "white").save(films / name)
        yield page.build(Path("results")).parent.resolve()


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
