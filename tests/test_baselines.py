"""Baselines guard numbers and verdicts, with tolerances that say how sensitive each number is."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dexrepro import baselines, chapters, cli
from dexrepro.errors import InputError
from dexrepro.pool import BLAS_THREADS
from dexrepro.storage import read_json, write_json

RESULTS = Path("results")
ARITHMETICS = baselines.arithmetics


@pytest.fixture(autouse=True)
def here_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other arithmetic takes processes that most tests need not wait for."""
    monkeypatch.setattr(baselines, "arithmetics", tuple)


@pytest.fixture
def stored(toy: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The baseline of the toy chapter beside its results; made once, for all tests."""
    kept, path = tmp_path_factory.getbasetemp() / "stored-of-the-toy", baselines.baseline_file("90", "decay")
    if kept.exists():
        shutil.copytree(kept / RESULTS, RESULTS)
        shutil.copy2(kept / path.name, path)
    else:
        baselines.update_chapter("90", RESULTS, accept=[], workers=1)
        shutil.copytree(RESULTS, kept / RESULTS)
        shutil.copy2(path, kept)
    return path


def edit(path: Path, change) -> None:
    data = read_json(path)
    change(data)
    write_json(path, data)


def test_a_fresh_update_agrees_with_its_own_results(stored: Path) -> None:
    report = baselines.check_chapter("90", RESULTS)
    assert report.ok
    assert report.compared == len(read_json(stored)["metrics"]) > 10


def test_counts_are_exact_and_numbers_have_a_tolerance_that_follows_their_sensitivity(stored: Path) -> None:
    entries = read_json(stored)["metrics"]
    assert entries["decay.plain.samples"] == {"value": 200, "rtol": 0.0, "atol": 0.0}
    assert entries["decay.plain.final"]["rtol"] == 1e-3


def test_a_tolerance_covers_what_the_arithmetic_of_another_machine_changes(
    toy: Path, toy_book: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    code = toy_book / "chapter90/decay/experiment.py"
    code.write_text(code.read_text().replace('"none": np.nan', '"none": 1.0 + 0.02 * ("BITS" in os.environ)'))
    chapters.forget()
    monkeypatch.setattr(baselines, "arithmetics", lambda: ({"BITS": "1"},))
    baselines.update_chapter("90", RESULTS, accept=[], workers=1)
    entries = read_json(baselines.baseline_file("90", "decay"))["metrics"]
    expected = {"value": 1.0, "rtol": 0.06, "atol": 1e-9, "reason": "the same code gave 1.02 with BITS=1"}
    assert entries["decay.plain.none"] == expected
    assert entries["decay.plain.final"].keys() == {"value", "rtol", "atol"}
    assert entries["decay.plain.final"]["rtol"] == 1e-3
    assert cli.main(["check"]) == 0


def test_a_measured_reason_is_renewed_and_one_set_by_hand_stays() -> None:
    measured = baselines._entry(2.0, [2.0], {"A=1": 2.2, "B=1": 2.0}, None)
    assert measured == {"value": 2.0, "rtol": 0.3, "atol": 1e-9, "reason": "the same code gave 2.2 with A=1"}
    again = baselines._entry(2.0, [2.0], {}, measured)
    assert again == measured, "a sensitivity once seen remains"
    assert "reason" not in baselines._entry(5.0, [5.0], {}, measured)
    by_hand = {**measured, "rtol": 0.1, "reason": "a count of draws"}
    assert baselines._entry(3.0, [3.0], {"A=1": 9.0}, by_hand) == {**by_hand, "value": 3.0}


def test_the_arithmetic_of_another_machine_can_be_had_here() -> None:
    """Otherwise a tolerance would cover nothing but what stands beside it."""
    old, threads = ARITHMETICS()
    line = [sys.executable, "-c", "import numpy, threadpoolctl as t; print(t.threadpool_info()[0]['architecture'])"]
    here, there = (
        subprocess.run(line, env=os.environ | environment, capture_output=True, text=True, check=True)
        for environment in ({"OPENBLAS_CORETYPE": "Haswell"}, old)
    )
    assert not there.stderr
    if platform.machine() == "x86_64" and "openblas" in str(np.show_config(mode="dicts")):
        assert here.stdout != there.stdout
    assert threads[BLAS_THREADS] == "2"


def test_drift_missing_new_and_changed_verdicts_are_told_apart(stored: Path) -> None:
    def change(data) -> None:
        metrics = data["metrics"]
        metrics["decay.plain.final"]["value"] *= 1.01
        metrics["decay.gone"] = {"value": 1.0, "rtol": 1e-3, "atol": 0.0}
        del metrics["decay.fast.final"]
        data["claims"]["C90.01"] = "not reproduced"

    edit(stored, change)
    report = baselines.check_chapter("90", RESULTS)
    assert [entry.name for entry in report.drifted] == ["decay.plain.final"]
    assert report.missing == ["decay.gone"]
    assert report.new == ["decay.fast.final"]
    assert report.verdict_changed == ["C90.01"]
    assert not report.ok


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data["metrics"]["decay.plain.final"].update(value=7.0),
        lambda data: data["metrics"].update({"decay.gone": {"value": 1.0, "rtol": 1e-3, "atol": 0.0}}),
        lambda data: data["metrics"].pop("decay.fast.final"),
        lambda data: data["claims"].update({"C90.01": "not reproduced"}),
        lambda data: data["claims"].update({"C90.99": "reproduced"}),
        lambda data: data["claims"].pop("C90.02"),
        lambda data: data["tables"].pop("T90.1"),
        lambda data: data["tables"].update({"T90.2": {"case": ["plain"]}}),
        lambda data: data["tables"]["T90.1"]["final"].__setitem__(0, 1e3 * data["tables"]["T90.1"]["final"][0]),
        lambda data: data["tables"]["T90.1"]["case"].__setitem__(0, "plane"),
        lambda data: [column.pop() for column in data["tables"]["T90.1"].values()],
        lambda data: data["tables"].update({"T90.1": dict(reversed(data["tables"]["T90.1"].items()))}),
    ],
)
def test_each_difference_alone_is_one_too_many(stored: Path, change: Callable[[dict[str, Any]], object]) -> None:
    edit(stored, change)
    assert not baselines.check_chapter("90", RESULTS).ok
    assert cli.main(["check"]) == 1


def test_a_table_may_move_as_far_as_the_metric_it_shows() -> None:
    metrics = {
        "e.c.loose": {"value": 0.0123, "rtol": 0.5, "atol": 0.0},
        "e.c.n": {"value": 20, "rtol": 0.0, "atol": 10},
    }
    same = baselines._same_cell
    assert same(15.0, 12.3, 12.3, metrics), "of the loose metric, in another unit"
    assert not same(19.0, 12.3, 12.3, metrics)
    assert same(26, 20, 20.0, metrics)
    assert not same(31, 20, 20.0, metrics)
    assert same(1.02, 1.0, 1.0, {})
    assert not same(1.2, 1.0, 1.0, {})
    assert not same("2", 2, 2.0, {})
    assert same(None, None, 0.0, {})
    assert not same(None, 1.0, 1.0, {})
    assert not same(0.5, 0.0, 1.0, {})


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda data: data["metrics"]["decay.plain.final"].update(rtol=1.5), "rtol = 1.5 is not allowed"),
        (lambda data: data["metrics"]["decay.plain.final"].update(atol=-1), "atol = -1 is not allowed"),
        (lambda data: data["metrics"]["decay.plain.final"].update(rtol=None), "rtol = None is not allowed"),
        (lambda data: data["metrics"]["decay.plain.final"].update(value="1"), "value = '1' must be a number"),
        (lambda data: data["metrics"].update({"decay.x": 3}), "no baseline"),
        (lambda data: data["metrics"]["decay.plain.final"].pop("atol"), "'atol'"),
        (lambda data: data.pop("metrics") and data.update(numbers={}), "numbers"),
    ],
)
def test_a_baseline_that_guards_nothing_is_refused(
    stored: Path, change: Callable[[dict[str, Any]], object], sentence: str
) -> None:
    edit(stored, change)
    with pytest.raises(InputError) as caught:
        baselines.check_chapter("90", RESULTS)
    assert sentence in str(caught.value)
    assert str(stored) in str(caught.value)


def test_a_metric_near_zero_for_its_sensitivity_gets_an_absolute_tolerance() -> None:
    entry = baselines._fresh_entry(1e-5, [0.02])
    assert entry["rtol"] <= 1
    assert entry["atol"] == pytest.approx(0.2, rel=0.01)


def test_check_writes_nothing_and_reads_what_it_may_not_write(stored: Path, toy: Path) -> None:
    before = sorted(toy.rglob("*"))
    for folder in [RESULTS, *RESULTS.rglob("*")]:
        folder.chmod(0o555 if folder.is_dir() else 0o444)
    assert cli.main(["check"]) == 0
    assert cli.main(["check", "results=results"]) == 0
    assert sorted(toy.rglob("*")) == before
    for folder in [RESULTS, *RESULTS.rglob("*")]:
        folder.chmod(0o755 if folder.is_dir() else 0o644)


def test_a_claim_is_checked_by_its_cases(stored: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(stored, lambda data: data["claims"].update({"C90.01": "not reproduced", "C90.03": "not reproduced"}))
    capsys.readouterr()
    assert cli.main(["check", "claim=C90.01"]) == 1
    text = capsys.readouterr().out
    assert "2 claims, 1 verdicts changed" in text, "C90.02 is about one of the cases"
    assert "C90.01: reproduced, stored: not reproduced" in text
    assert cli.main(["check", "chapter=90", "only=decay", "case=plain,gain*"]) == 1, "C90.01 is about others, too"
    assert "C90.03: reproduced, stored: not reproduced" in capsys.readouterr().out


def test_check_says_what_was_made_by_another_configuration_or_code(
    stored: Path, toy_book: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert not baselines.check_chapter("90", RESULTS).outdated
    config = toy_book / "chapter90/decay/config.yaml"
    config.write_text(config.read_text().replace("start: 1.0", "start: 1.5"))
    assert cli.main(["check"]) == 0, "the numbers are those stored"
    assert "out of date: decay: plain and 4 more cases of another configuration" in capsys.readouterr().out


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


def test_a_column_that_is_free_may_differ_and_stays_free(stored: Path) -> None:
    edit(stored, lambda data: data["tables"]["T90.1"]["final"].__setitem__(0, 7.0))
    assert baselines.check_chapter("90", RESULTS).tables_changed
    edit(stored, lambda data: data.update(free={"T90.1/final": "the wall time of a machine"}))
    assert baselines.check_chapter("90", RESULTS).ok
    baselines.update_chapter("90", RESULTS, accept=[], workers=1)
    assert read_json(stored)["free"] == {"T90.1/final": "the wall time of a machine"}
