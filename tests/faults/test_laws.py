"""A law that gives no number ends its case with a sentence that names law, time and value, and nothing else."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dexrepro import chapters, cli, runner
from dexrepro.case import generator, live
from dexrepro.cases import experiment_cases
from dexrepro.config import compose_chapter
from dexrepro.control.contract import Command
from dexrepro.errors import InputError
from dexrepro.experiment import Config, Recording
from dexrepro.physics.loop import LawFailed
from dexrepro.physics.world import World
from dexrepro.plan import plan_chapter
from dexrepro.storage import read_json, write_json

pytestmark = pytest.mark.usefixtures("bounded")
LOST = """class Lost:
    kind = "holding"

    def reset(self, measured): ...

    def __call__(self, measured):
        return 0.0 if measured.time < 0.05 else float("nan")
"""


def test_a_law_of_ones_own_that_gives_no_number_is_a_failure_and_its_run_is_there_up_to_then(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    Path("lost.py").write_text(LOST)
    line = ["run", "only=holding_line", "case=mine", "workers=1", "+holding_line.cases.mine.law._target_=lost.Lost"]
    for _ in range(2):  # also where the result is there already
        assert cli.main(line) == 1
        said = " ".join(capfd.readouterr().err.split())
        assert "holding_line.mine failed: the law Lost of arm 'follower' failed at 0.05 s: it gave nan, and a" in said
    (result,) = Path("results/runs").glob("holding_line-*")
    assert read_json(result / "run.json")["cases"]["mine"]["simulated"] == pytest.approx(0.051)


def test_that_a_law_of_the_book_ends_so_is_a_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    given = ("only=holding_line", "case=mine")
    for law, ended in (("fractions.Fraction", ["holding_line.mine"]), ("dexrepro.control.holding.FixedDistance", [])):
        (plan,), _ = plan_chapter("2", (*given, f"+holding_line.cases.mine.law._target_={law}"), write=False)
        plan.folder.mkdir(parents=True)
        write_json(plan.folder / "run.json", {"cases": {"mine": {"status": "the law X failed at 1 s: it gave nan"}}})
        assert list(runner._unusable([plan], {"holding_line": plan.folder})) == ended


@pytest.mark.parametrize(("status", "told"), [("the law X gave nan", InputError), ("finished", ValueError)])
def test_a_run_that_ended_early_and_cannot_be_measured_says_why(
    status: str, told: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    experiment = chapters.load("2").experiment("holding_line")
    early = Recording({"time": np.zeros(1)}, status=status)
    monkeypatch.setattr(experiment.simulation, "simulate", lambda *_: early)
    monkeypatch.setattr(experiment.simulation, "measure", lambda recording, _: recording.time[1:].max())
    with pytest.raises(told, match="zero-size" if status == "finished" else f"{status}; what was recorded"):
        runner._run(experiment, Config(), 0)


class Fails:
    """Gives what it is told to from its third call on."""

    kind = "joint"
    gives: Any = None

    def reset(self, measured: Any) -> None:
        self.calls = 0

    def __call__(self, measured: Any, desired: Any) -> Any:
        self.calls += 1
        still = np.zeros_like(measured.position)
        return Command(still) if self.calls < 3 else Fails.gives(still)


@pytest.fixture
def brief(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every run of a world ends after a few steps."""
    run = World.run
    monkeypatch.setattr(World, "run", lambda world, duration, *given, **more: run(world, 0.02, *given, **more))


@pytest.mark.parametrize(("number", "name"), [("5", "knowledge_reuse"), ("3", "grasp_through_opening")])
@pytest.mark.parametrize(
    ("gives", "sentence"),
    [
        (lambda still: Command(still * np.nan), "it gave [nan, nan"),
        (lambda still: Command(still + np.inf), "it gave [inf, inf"),
        (lambda still: Command(still + 1j), "j"),
        (lambda still: Command(np.zeros(99)), "failed at"),
        (lambda still: None, "failed at"),
        (lambda still: Command("x"), "failed at"),
    ],
    ids=["nan", "inf", "complex", "shape", "none", "text"],
)
@pytest.mark.usefixtures("brief")
def test_a_comparison_of_many_runs_says_that_one_was_ended(number: str, name: str, gives: Any, sentence: str) -> None:
    Fails.gives = gives
    case = f"+{name}.cases.mine={{law: {{_target_: test_laws.Fails}}}}"
    extra = [f"{name}.choice=random"] if name == "grasp_through_opening" else []
    values = experiment_cases(compose_chapter(number, (case, *extra)), name)["mine"]
    config = live({**values, "perturbation": 0.0, "seed": 1, "case": "mine"})
    try:
        said = chapters.load(number).experiment(name).simulation.simulate(
            config, lambda purpose: generator(1, name, purpose)
        ).status  # fmt: skip
    except LawFailed as error:
        said = str(error)
    assert said.startswith("the law Fails of arm")
    assert sentence in said
