"""The runner keeps its promises: whole results, nothing repeated, nothing lost, the same numbers from any pool."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest

import dexrepro
from dexrepro import cli
from dexrepro.cache_key import own_digest
from dexrepro.case import generator
from dexrepro.errors import InputError
from dexrepro.plan import plan_chapter
from dexrepro.result import Result
from dexrepro.runner import KEPT, complete, run_plans
from dexrepro.storage import read_json


def run(*overrides: str, workers: int = 1, force: bool = False):
    plans, _ = plan_chapter("90", overrides)
    return run_plans(plans, workers=workers, force=force)


def test_a_run_writes_metrics_claims_series_tables_figures_and_provenance(toy: Path) -> None:
    run()
    folder = toy / "results/chapter90/decay"
    result = Result(folder)
    assert result.metrics["decay.plain.final"] == pytest.approx(0.5 * np.exp(-2 * 1.99))
    assert result.metrics["decay.ratio"] == pytest.approx(np.exp(2 * 1.99))
    assert result.metrics["decay.plain.none"] is None
    assert {claim["id"]: claim["verdict"] for claim in result.claims} == {
        "C90.01": "reproduced",
        "C90.02": "not reproduced",
        "C90.03": "reproduced",
    }
    assert result.recording("halved")["pair"].shape == (200, 2)
    assert (folder / "figures/fig_90_10.png").exists()
    assert (folder / "figures/fig_90_10.svg").exists()
    assert list(result.tables["T90.1"].case) == ["plain", "fast", "halved", "gain1", "gain2"]
    assert {"seed", "version", "revision", "packages", "wall", "steps", "real_time_factor"} <= set(result.run)


def test_a_table_of_nothing_is_not_kept(toy: Path, toy_book: Path) -> None:
    drawn = toy_book / "chapter90/decay/figures.py"
    drawn.write_text(drawn.read_text("utf-8") + "\n\ntabulate = lambda *_: {'T90.1': pd.DataFrame()}\n", "utf-8")
    outcome = run("case=plain")
    assert not list(outcome.folders["decay"].rglob("T90.1*"))
    assert cli.main(["report"]) == 0


def test_what_is_there_is_not_run_again_unless_forced(toy: Path) -> None:
    run()
    stamp = (toy / "results/chapter90/decay/run.json").stat().st_mtime_ns
    run()
    assert (toy / "results/chapter90/decay/run.json").stat().st_mtime_ns == stamp
    run(force=True)
    assert (toy / "results/chapter90/decay/run.json").stat().st_mtime_ns > stamp


@pytest.mark.parametrize("name", ["metrics.json", "claims.json"])
def test_a_damaged_result_is_made_anew(toy: Path, name: str) -> None:
    run()
    whole = (toy / "results/chapter90/decay" / name).read_bytes()
    (toy / "results/chapter90/decay" / name).write_text('{"a": ')
    run()
    assert (toy / "results/chapter90/decay" / name).read_bytes() == whole


def test_a_changed_file_of_the_user_changes_the_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    for name in ("path1.csv", "letter", "users_law.py", "users_helper.py"):
        Path(name).write_text("1")
    config = {
        "demonstrations": ["path?.csv", "letter"],
        "law": {"_target_": "users_law.Law"},
        "kind": "dmp",
        "other": "no.such.Law",
    }
    keys = [own_digest(config)]
    for name in ("path1.csv", "path2.csv", "letter", "users_law.py", "users_helper.py"):
        Path(name).write_text("2")
        keys.append(own_digest(config))
    assert len(set(keys)) == 6
    Path("unrelated.csv").write_text("3")
    assert own_digest(config) == keys[-1]


def test_a_film_stays_while_its_recording_stays(toy: Path) -> None:
    folder = run().folders["decay"]
    (folder / "animation").mkdir()
    (folder / "animation/plain.gif").touch()
    (folder / "run.json").write_text("{}")  # as after a change of the drawing code
    run()
    assert (folder / "animation/plain.gif").exists()
    run(force=True)
    assert not (folder / "animation").exists()


def test_what_somebody_puts_into_a_result_stays(toy: Path) -> None:
    folder = run().folders["decay"]
    (folder / "notes.md").write_text("mine")
    (folder / "photos").mkdir()
    (folder / "photos/rig.jpg").write_text("mine")
    run(force=True)
    assert (folder / "notes.md").read_text() == (folder / "photos/rig.jpg").read_text() == "mine"


def test_a_file_where_a_result_is_to_be_stays_and_is_named(toy: Path) -> None:
    (toy / "results/chapter90").mkdir(parents=True)
    (toy / "results/chapter90/decay").write_text("mine")
    assert "it is no folder: 'results/chapter90/decay'" in run().failures["decay"]
    assert (toy / "results/chapter90/decay").read_text() == "mine"


def test_an_override_leaves_the_results_of_the_book_alone(toy: Path) -> None:
    run()
    before = (toy / "results/chapter90/decay/metrics.json").read_bytes()
    outcome = run("decay.start=2.0")
    assert (toy / "results/chapter90/decay/metrics.json").read_bytes() == before
    assert outcome.folders["decay"].parent == Path("results/runs")
    assert outcome.differs["decay"] == ["start=2.0 (book: 1.0)"]


def test_a_shared_value_reaches_the_experiments_that_refer_to_it(toy: Path) -> None:
    outcome = run("shared.rate=1.0")
    assert outcome.differs["decay"] == ["rate=1.0 (book: 2.0)"]
    assert Result(outcome.folders["decay"]).metrics["decay.plain.final"] == pytest.approx(0.5 * np.exp(-1.99))


def test_a_list_makes_one_case_for_each_element_and_absent_ones_are_not_evaluated(toy: Path) -> None:
    result = Result(run("decay.gains=[1,7]").folders["decay"])
    assert {"gain1", "gain7"} <= set(result.run["cases"])
    assert next(claim for claim in result.claims if claim["id"] == "C90.03")["verdict"] == "not evaluated"


def test_one_and_two_workers_write_the_same_bytes(toy: Path) -> None:
    noisy = "decay.noise=0.1"
    first = run(noisy, f"results='{toy}/one'", workers=1).folders["decay"]
    second = run(noisy, f"results='{toy}/two'", workers=2).folders["decay"]
    for path in [*sorted((first / "series").iterdir()), first / "metrics.json"]:
        assert path.read_bytes() == (second / path.relative_to(first)).read_bytes(), path.name


def test_compared_cases_share_the_noise_of_a_purpose() -> None:
    draws = [generator(0, "decay", "noise").standard_normal(5) for _ in range(2)]
    assert np.array_equal(*draws)
    assert not np.array_equal(draws[0], generator(0, "decay", "operator").standard_normal(5))
    assert not np.array_equal(draws[0], generator(1, "decay", "noise").standard_normal(5))


def test_a_failing_case_stops_no_other_and_loses_nothing(toy: Path) -> None:
    run()
    before = (toy / "results/chapter90/decay/metrics.json").read_bytes()
    outcome = run("+decay.cases.fast.fail=true")
    assert outcome.failures.keys() == outcome.tracebacks.keys() == {"decay.fast"}
    line = r"ValueError: told to fail \(\S+/decay/experiment.py, line \d+\)"
    assert re.fullmatch(line, outcome.failures["decay.fast"])
    assert "in simulate" in outcome.tracebacks["decay.fast"].read_text()
    assert (toy / "results/chapter90/decay/metrics.json").read_bytes() == before
    cached = {path.parent.name.split("-")[0] for path in (toy / "results/.cache/decay").glob("*/case.json")}
    assert {"plain", "halved", "gain1", "gain2"} <= cached


def test_a_case_that_ends_before_its_first_sample_is_measured_and_the_others_are_drawn(toy: Path) -> None:
    outcome = run("+decay.cases.fast.fail='at once'")
    folder = outcome.folders["decay"]
    assert not outcome.failures
    assert read_json(folder / "metrics.json")["decay.fast.final"] is None
    assert read_json(folder / "run.json")["cases"]["fast"]["status"] == "undefined from 0 s"
    assert (folder / "figures/fig_90_10.png").exists()
    assert "fast" not in (folder / "tables/T90.1.csv").read_text()
    assert cli.main(["draw", str(folder)]) == 0


def test_a_killed_worker_is_named_and_the_next_run_completes_what_is_missing(toy: Path) -> None:
    outcome = run("decay.fail=kill", "+decay.cases.plain.fail=false", "+decay.cases.fast.fail=false", workers=1)
    assert "killed" in outcome.failures["decay.halved"]
    assert not list((toy / "results").glob("runs/*"))
    assert not list((toy / "results/.cache/decay").glob(".halved*"))
    assert len(run().folders) == 1


def test_old_cached_cases_are_dropped_but_none_that_a_sweep_may_still_need(toy: Path) -> None:
    cache = toy / "results/.cache/decay"
    others = [cache / f"plain-{number:016d}" for number in range(8)]
    for path in others:
        path.mkdir(parents=True)
    run()
    assert len(list(cache.glob("plain-*"))) == 9
    for path in others:
        os.utime(path, (0, 0))
    run(force=True)
    assert len(list(cache.glob("plain-*"))) == KEPT


def test_a_case_that_another_process_has_finished_is_not_run_again(toy: Path) -> None:
    plans, _ = plan_chapter("90")
    job = plans[0].jobs[0]
    entry = complete(job)
    assert complete(job) == entry, "the very same wall time"


def test_skipped_experiments_say_what_they_need(toy: Path) -> None:
    _, skipped = plan_chapter("90")
    assert "no_such_package" in skipped["needs_more"]


@pytest.mark.parametrize(
    ("override", "parts"),
    [
        ("decay.rat=1", ["decay.rat", "did you mean 'decay.rate'"]),
        ("only=deccay", ["deccay", "did you mean 'decay'"]),
        ("figure=90.11", ["90.11", "90.10"]),
        ("decay.mass=-1", ["decay.mass", "-1", "greater than 0"]),
        ("decay.step=0", ["decay.step", "0", "greater than 0"]),
        ("decay.duration=0.001", ["decay.duration", "0.001", "at least one step of 0.01 s"]),
        ("decay.noise=-0.1", ["decay.noise", "-0.1", "0 or greater"]),
        ("decay.rate=fast", ["decay.rate", "fast", "must be a number"]),
        ("decay.rate=nan", ["decay.rate", "finite"]),
        ("decay.rate", ["key=value"]),
        ("seed=x", ["seed", "x", "whole number"]),
        ("results=/proc/nowhere", ["results", "/proc/nowhere", "cannot write"]),
    ],
)
def test_bad_input_gets_one_sentence_that_names_key_value_and_range(toy: Path, override: str, parts: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        plan_chapter("90", [override])
    assert "\n" not in str(caught.value)
    for part in parts:
        assert part in str(caught.value)


def test_the_python_door_gives_metrics_claims_and_frames(toy: Path) -> None:
    results = dexrepro.run(90, ["decay.start=3.0"], only="decay", workers=1)
    assert results["decay"].metrics["decay.plain.largest"] == pytest.approx(1.5)
    assert dexrepro.load(results["decay"].folder).recording("plain").time[-1] == pytest.approx(1.99)
    with pytest.raises(FileNotFoundError, match="no result"):
        dexrepro.load(toy)


def test_the_configuration_on_disk_is_resolved(toy: Path) -> None:
    run()
    text = (toy / "results/chapter90/decay/config.yaml").read_text()
    assert "${" not in text
    assert json.loads((toy / "results/chapter90/decay/run.json").read_text())["differs"] == []


def test_a_window_without_a_display_is_refused_before_anything_runs(toy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DISPLAY", ":7777")
    with pytest.raises(InputError, match=r"gui = true .* needs a display, and there is none \(DISPLAY = :7777"):
        run("gui=true")
    assert not list(toy.rglob("*.json"))
