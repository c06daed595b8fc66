"""Baselines guard numbers and verdicts, with tolerances that say how sensitive each number is."""

from __future__ import annotations

from pathlib import Path

import pytest

from dexrepro import baselines
from dexrepro.config import InputError
from dexrepro.storage import read_json, write_json

RESULTS = Path("results")


@pytest.fixture
def stored(toy: Path) -> Path:
    baselines.update_chapter("90", RESULTS, accept=[], workers=1)
    return baselines.baseline_file("90", "decay")


def edit(path: Path, change) -> None:
    data = read_json(path)
    change(data)
    write_json(path, data)


def test_a_fresh_update_agrees_with_its_own_results(stored: Path) -> None:
    report = baselines.check_chapter("90", RESULTS)
    assert baselines.is_ok(report)
    assert report["compared"] == len(read_json(stored)["metrics"]) > 10


def test_counts_are_exact_and_numbers_have_a_tolerance_that_follows_their_sensitivity(stored: Path) -> None:
    entries = read_json(stored)["metrics"]
    assert entries["decay.plain.samples"] == {"value": 200, "rtol": 0.0, "atol": 0.0}
    assert entries["decay.plain.final"]["rtol"] == 1e-3


def test_drift_missing_new_and_changed_verdicts_are_told_apart(stored: Path) -> None:
    def change(data) -> None:
        metrics = data["metrics"]
        metrics["decay.plain.final"]["value"] *= 1.01
        metrics["decay.gone"] = {"value": 1.0, "rtol": 1e-3, "atol": 0.0}
        del metrics["decay.fast.final"]
        data["claims"]["C90.01"] = "not reproduced"

    edit(stored, change)
    report = baselines.check_chapter("90", RESULTS)
    assert [entry["name"] for entry in report["drifted"]] == ["decay.plain.final"]
    assert report["missing"] == ["decay.gone"]
    assert report["new"] == ["decay.fast.final"]
    assert report["verdict_changed"] == ["C90.01"]
    assert not baselines.is_ok(report)


def test_an_update_refuses_a_changed_verdict_unless_it_is_accepted(stored: Path) -> None:
    edit(stored, lambda data: data["claims"].update({"C90.02": "reproduced"}))
    with pytest.raises(InputError, match=r"C90.02 \(reproduced -> not reproduced\)"):
        baselines.update_chapter("90", RESULTS, accept=[], workers=1)
    baselines.update_chapter("90", RESULTS, accept=["C90.02"], workers=1)
    assert read_json(stored)["claims"]["C90.02"] == "not reproduced"


def test_a_tolerance_set_by_hand_survives_an_update(stored: Path) -> None:
    by_hand = {"rtol": 0.5, "reason": "depends on the optimiser's version"}
    edit(stored, lambda data: data["metrics"]["decay.plain.final"].update(by_hand))
    baselines.update_chapter("90", RESULTS, accept=[], workers=1)
    entry = read_json(stored)["metrics"]["decay.plain.final"]
    assert entry["rtol"] == 0.5
    assert entry["reason"] == by_hand["reason"]


def test_a_sensitivity_once_seen_remains_while_the_number_is_the_same(stored: Path) -> None:
    def widen(data) -> None:
        for name, value in (("decay.plain.final", 1.0), ("decay.fast.final", 2.0)):
            entry = data["metrics"][name]
            entry.update(value=value * entry["value"], rtol=0.3)

    edit(stored, widen)
    baselines.update_chapter("90", RESULTS, accept=[], workers=1)
    entries = read_json(stored)["metrics"]
    assert entries["decay.plain.final"]["rtol"] == 0.3
    assert entries["decay.fast.final"]["rtol"] == 1e-3, "another number than before"


def test_without_results_the_command_to_run_is_named(toy: Path) -> None:
    with pytest.raises(baselines.ResultsMissing, match="dexrepro run chapter=90 only=decay"):
        baselines.check_chapter("90", RESULTS)


def test_null_agrees_with_null_alone() -> None:
    entry = {"value": None, "rtol": 0.0, "atol": 0.0}
    assert baselines.agrees(None, entry)
    assert not baselines.agrees(0.0, entry)
    assert not baselines.agrees(None, {"value": 0.0, "rtol": 1.0, "atol": 1.0})
