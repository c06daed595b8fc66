"""What is kept between commands follows its files, and lets the common commands begin without the large libraries."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import ROOT

from dexrepro import chapters, closure, disk_cache
from dexrepro.config import compose_chapter


@pytest.fixture
def calls(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return []


def lengths(folder: Path, calls: list[int]) -> object:
    def make() -> tuple[list[int], list[Path]]:
        calls.append(1)
        files = sorted(folder.glob("*.txt"))
        return [len(path.read_text()) for path in files], [folder, *files]

    return disk_cache.cached("lengths", make)


def settle(*paths: Path, ago: float = 60) -> None:
    for path in paths:
        os.utime(path, (time.time() - ago,) * 2)


def test_it_is_found_out_once_until_a_file_changes_appears_or_goes(tmp_path: Path, calls: list[int]) -> None:
    folder = tmp_path / "data"
    folder.mkdir()
    one, two = folder / "one.txt", folder / "two.txt"
    one.write_text("1234")
    settle(one, folder)
    assert [lengths(folder, calls) for _ in range(3)] == [[4]] * 3
    assert len(calls) == 1
    one.write_text("12345")
    settle(one, folder, ago=30)
    assert [lengths(folder, calls) for _ in range(2)] == [[5]] * 2
    two.write_text("1")
    settle(two, folder, ago=20)
    assert lengths(folder, calls) == [5, 1]
    two.unlink()
    settle(folder, ago=10)
    assert lengths(folder, calls) == [5]
    assert len(calls) == 4


def test_what_was_written_a_moment_ago_is_not_kept(tmp_path: Path, calls: list[int]) -> None:
    (tmp_path / "one.txt").write_text("1234")
    assert [lengths(tmp_path, calls) for _ in range(2)] == [[4]] * 2
    assert len(calls) == 2


def test_a_folder_that_cannot_be_written_and_a_damaged_file_cost_time_alone(
    tmp_path: Path, calls: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "data"
    folder.mkdir()
    settle(folder)
    assert lengths(folder, calls) == []
    next((tmp_path / "cache/dexrepro").iterdir()).write_text("{")
    assert lengths(folder, calls) == []
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert lengths(folder, calls) == []
    assert len(calls) == 3


def test_kept_is_what_would_be_found_out_now() -> None:
    roots = [("dexrepro.chapters.chapter2.holding_line.experiment", "simulate")]
    assert closure.digest(roots) == closure._digest(roots, ())[0]
    assert compose_chapter("2", ["seed=3", "quiet=true", "figure='2.7'"]) == {
        **compose_chapter("2"), "seed": 3, "quiet": True, "figure": "2.7",
    }  # fmt: skip


LARGE = ("scipy", "matplotlib", "hydra", "omegaconf", "pybullet", "pandas")


@pytest.mark.parametrize("words", ["--help", "list", "list --json", "run workers=1", "completion bash"])
def test_the_common_commands_begin_without_the_large_libraries(toy: Path, toy_result: Path, words: str) -> None:
    """Once what they need is kept; a run that has nothing to do is such a command too."""
    for path in [toy, *Path(os.environ[chapters.ADDED]).rglob("*")]:
        settle(path)
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    for _ in range(2):
        code = "import atexit, sys; atexit.register(lambda: print(*sys.modules)); from dexrepro.cli import main"
        code += f"; main({words.split()!r})"
        done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True, check=False)
    modules = done.stdout.splitlines()[-1].split()
    assert "dexrepro.cli" in modules, done.stderr
    assert [name for name in LARGE if name in modules] == []
