"""A tiny chapter of its own, so that the runner is tested without simulating the book."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings

import dexrepro
from dexrepro import chapters, cli

ROOT = Path(dexrepro.__file__).parent.parent
TOY = Path(__file__).parent / "toy"

settings.register_profile("busy", settings(), deadline=None)  # the clock of a busy machine is no test of a law
settings.load_profile("busy")


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
    """A report of chapter 90, with a film, a study and a run with other parameters; built once a module."""
    from PIL import Image

    from dexrepro.plan import plan_chapter
    from dexrepro.report import page
    from dexrepro.runner import run_plans
    from dexrepro.study import sampling

    with toy_chapter(tmp_path_factory.mktemp("work"), tmp_path_factory.mktemp("toy") / "book") as folder:
        for overrides in ((), ("decay.start=0.5",)):
            run_plans(plan_chapter("90", overrides)[0], workers=1, force=False)
        sampling.run("90", "decay", 8, Path("results"), workers=1)
        films = folder / "results/chapter90/decay/animation"
        films.mkdir()
        for name in ("plain.gif", "plain.png"):
            Image.new("RGB", (80, 33), "white").save(films / name)
        yield page.build(Path("results")).parent.resolve()


Shell = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def shell(tmp_path: Path) -> Shell:
    """Run a command line as a user would, in an empty folder."""

    def run(
        command: str, cwd: Path = tmp_path, timeout: float = 120, **environment: str
    ) -> subprocess.CompletedProcess[str]:
        path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
        env = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT), **environment}
        return subprocess.run(
            command, shell=True, cwd=cwd, env=env, capture_output=True, text=True, timeout=timeout, check=False,
            errors="replace",
        )  # fmt: skip

    return run


Command = Callable[[str], tuple[int, str]]


@pytest.fixture
def bounded() -> Iterator[None]:
    """A command that hangs fails its test."""

    def late(*_: object) -> None:
        raise TimeoutError("the command hangs")

    signal.signal(signal.SIGALRM, late)
    signal.alarm(180)  # a process that is spawned imports all anew
    yield
    signal.alarm(0)


@pytest.fixture
def command(toy: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Command:
    """Run a command as typed; its exit status and all it says. No fault may give a traceback."""
    monkeypatch.setattr(sys, "path", [*sys.path])

    def run(text: str) -> tuple[int, str]:
        capfd.readouterr()
        status = cli.main(text.split())
        said = "".join(capfd.readouterr())
        assert "Traceback" not in said
        return status, said

    return run


@pytest.fixture
def toy_result(toy: Path, command: Command, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The toy chapter has been run in this folder (once, for all tests)."""
    kept = tmp_path_factory.getbasetemp() / "results-of-the-toy"
    if not kept.exists():
        assert command("run workers=1")[0] == 0
        shutil.copytree("results", kept)
    elif not Path("results").exists():
        shutil.copytree(kept, "results")
    return toy / "results/chapter90/decay"


def whole(folder: Path) -> dict[str, bytes]:
    """Every file of a result, none of which may be lost."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
