"""A tiny chapter of its own, so that the runner is tested without simulating the book."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import dexrepro
from dexrepro import chapters, config, plan

ROOT = Path(dexrepro.__file__).parent.parent
TOY = Path(__file__).parent / "toy"


@contextlib.contextmanager
def toy_chapter(folder: Path) -> Iterator[Path]:
    """Make chapter 90 the only chapter, and work in a folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(config, "config_dir", lambda: TOY / "conf")
        patch.setattr(chapters, "__path__", [str(TOY)])
        patch.chdir(folder)
        for function in (chapters.numbers, chapters.load, plan.source_digest):
            function.cache_clear()
        yield folder
    for function in (chapters.numbers, chapters.load, plan.source_digest):
        function.cache_clear()
    for name in [name for name in sys.modules if name.startswith("dexrepro.chapters.chapter90")]:
        del sys.modules[name]


@pytest.fixture
def toy(tmp_path: Path) -> Iterator[Path]:
    """Make chapter 90 the only chapter, work in an empty folder, and return that folder."""
    with toy_chapter(tmp_path) as folder:
        yield folder


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A report of chapter 90, with a film, built once for the tests of a module."""
    from PIL import Image

    from dexrepro.report import page
    from dexrepro.runner import run_plans

    with toy_chapter(tmp_path_factory.mktemp("toy")) as folder:
        plans, _ = plan.plan_chapter("90")
        run_plans(plans, workers=1, force=False)
        films = folder / "results/chapter90/decay/animation"
        films.mkdir()
        for name in ("plain.gif", "plain.png"):
            Image.new("RGB", (80, 33), "white").save(films / name)
        yield page.build(Path("results")).parent.resolve()


@pytest.fixture
def toy_tree(tmp_path: Path) -> Path:
    """A folder with a checkout whose only chapter is 90, for commands of a shell and the processes they start."""
    package = tmp_path / "dexrepro"
    (package / "chapters").mkdir(parents=True)
    for path in (ROOT / "dexrepro").iterdir():
        if path.name not in ("chapters", "__pycache__"):
            (package / path.name).symlink_to(path)
    (package / "chapters/__init__.py").symlink_to(ROOT / "dexrepro/chapters/__init__.py")
    (package / "chapters/chapter90").symlink_to(TOY / "chapter90")
    (tmp_path / "conf").symlink_to(TOY / "conf")
    return tmp_path


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
