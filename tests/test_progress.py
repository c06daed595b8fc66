"""What a run says while it goes and when it ends."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path

import pytest
from conftest import Command, Shell
from rich.console import Console

from dexrepro import progress
from dexrepro.progress import Bar, Lines
from dexrepro.result import CaseEntry
from dexrepro.timings import duration


class Clock:
    now = 0.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    monkeypatch.setattr(progress, "time", clock := Clock())
    times = {"cases": {"long.a": 60.0, "long.b": 60.0, "long.c": 30.0}}
    monkeypatch.setattr(progress, "timings", lambda: times)
    return clock


def entry(wall: float) -> CaseEntry:
    return CaseEntry("finished", 1, 0.0, wall, None)


@pytest.mark.parametrize("kind", [Lines, Bar])
def test_a_long_run_says_how_long_it_takes_and_corrects_itself(clock: Clock, kind: type[Lines]) -> None:
    text = io.StringIO()
    shown = kind(Console(file=text, width=60))
    shown.begin(["long.a", "long.b", "long.c", "long.new", "unknown.a"], 2)
    assert "5 cases on 2 processes take about 2 min, not counting 1 that were never timed" in text.getvalue().replace(
        "\n", " "
    )
    assert shown.left() == 100  # 60 + 60 + 30 + their mean of 50, on two processes
    shown.finished("long.a", entry(120.0))
    assert shown.left() == 140, "this machine is half as fast"


def test_a_short_run_says_nothing_of_its_length(clock: Clock) -> None:
    text = io.StringIO()
    Lines(Console(file=text)).begin(["unknown.a"], 2)
    assert text.getvalue() == ""


def test_where_it_is_piped_there_is_a_line_at_least_every_ten_seconds(clock: Clock) -> None:
    text = io.StringIO()
    shown = Lines(Console(file=text, width=60))
    shown.begin(["long.a", "long.b"], 1)
    shown.report(1, 0.0, 40.0)
    for _ in range(305):
        clock.now += 0.1
        shown.report(1, clock.now, 40.0)
        shown.tick()
    lines = [line for line in text.getvalue().splitlines() if line.startswith("0 of 2 cases")]
    assert len(lines) == 3
    assert "simulated 10/40 s (1x), about 2 min to go" in lines[0]


def test_times_are_said_as_one_says_them() -> None:
    assert [duration(seconds) for seconds in (3, 89, 720, 9000)] == ["3 s", "89 s", "12 min", "2.5 h"]


def test_a_run_ends_with_the_claims_that_fail_or_changed(toy: Path, toy_book: Path, command: Command) -> None:
    status, said = command("run workers=1")
    assert status == 0
    failing = next(line for line in said.splitlines() if line.startswith("C90."))
    assert "not reproduced, margin " in failing
    (toy_book / "chapter90/decay/baseline.json").write_text(
        json.dumps({"metrics": {}, "claims": {"C90.01": "not reproduced"}, "tables": {}})
    )
    said = command("run")[1]
    assert "C90.01  reproduced, margin +" in said
    assert "(stored: not reproduced): the fast one decays more" in said


def test_the_log_says_what_is_read_and_why_a_case_runs_again(toy: Path, toy_book: Path, command: Command) -> None:
    assert "decay.plain: runs, it is not in " in command("run workers=1 -v")[1]
    said = command("--log run")[1]
    assert f"decay: up to date in {Path('results/chapter90/decay')}" in said
    assert "runs" not in said.partition("experiment ")[0].replace("runs/", "")
    file = toy_book / "chapter90/decay/config.yaml"
    file.write_text(file.read_text().replace("start: 1.0", "start: 1.25"))
    said = command("run --log workers=1")[1]
    assert "composed chapter 90 from " in said
    assert "decay.plain: runs again: start=1.25 (was: 1.0)" in said
    file = toy_book / "chapter90/decay/experiment.py"
    file.write_text(file.read_text().replace("config.start +", "2 * config.start +"))
    assert (
        "decay.plain: runs again: code or a file that it uses, or the version of a package" in command("run --log")[1]
    )
    assert "runs again" not in command("run force=true quiet=true")[1]


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
def test_a_narrow_console_of_a_small_alphabet_is_enough(shell: Shell, toy: Path, encoding: str) -> None:
    for words in ("run workers=1", "list", "show decay", "show C90.01"):
        done = shell(f"COLUMNS=20 PYTHONIOENCODING={encoding} {sys.executable} -m dexrepro {words}", cwd=toy)
        assert done.returncode == 0, done.stderr
        assert "Traceback" not in done.stderr
