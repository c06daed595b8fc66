"""A search finds what is best within a budget, repeats nothing, says where a range ends it; laws of a folder join."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from dexrepro import chapters, comparison, tune
from dexrepro.cache_key import content_of
from dexrepro.checks import value_at
from dexrepro.errors import InputError
from dexrepro.provenance import provenance
from dexrepro.scaffold import new_controller

RESULTS = Path("results")
Command = Callable[[str], tuple[int, str]]


class Bowl(tune.Search):
    """Least at start = 1.3, which no run need simulate."""

    def metrics(self, chosen):
        return {"final": (chosen.get("start", 1.0) - 1.3) ** 2}


class Told(Bowl):
    """The same, and where."""

    def metrics(self, chosen):
        return super().metrics(chosen) | {"start": chosen.get("start", 1.0)}


def bowl(budget, **changed):
    found = tune.search_of("decay.plain", "final", 1, ["start"])
    return tune.run(Bowl(**{**vars(found), **changed}), budget, RESULTS, workers=1)


def test_the_search_closes_in_on_the_best(toy):
    found, path = bowl(24)
    assert found.chosen["start"] == pytest.approx(1.3, abs=0.03)
    assert (found.start, found.runs, found.edges) == (pytest.approx(0.09), 24, [])
    assert len(json.loads(path.read_text())["runs"]) == 24


def test_a_best_at_the_edge_of_its_range_is_said(toy):
    found, _ = bowl(24, ranges={"start": (0.5, 1.2)})
    assert "upper edge of 0.5..1.2" in found.edges[0]


def test_where_nothing_is_better_that_is_said_and_whether_what_was_searched_matters(toy):
    found, _ = bowl(8, ranges={"start": (2.0, 3.0)})
    assert (found.chosen, found.edges) == ({}, [tune.NO_BETTER])
    found, _ = bowl(8, ranges={"gain": (2.0, 3.0)})
    assert (found.chosen, found.edges) == ({}, [tune.ALIKE])


def test_a_guessed_range_is_left_where_the_best_lies_beyond_it(toy):
    given, _ = bowl(24, ranges={"start": (0.25, 1.1)})
    found, path = bowl(24, ranges={"start": (0.25, 1.1)}, guessed=True)
    assert given.chosen["start"] == pytest.approx(1.1, abs=0.03)
    assert 1.2 < found.chosen["start"] < 1.4
    assert "lies beyond or at the upper end of the guess 0.25..1.1: widen it" in found.edges[0]
    assert json.loads(path.read_text())["edges"] == found.edges


def test_a_run_whose_other_metric_is_above_its_limit_is_not_the_best(toy):
    found = tune.search_of("decay.plain", "final+start", 1, ["start"], limits={"start": 1.1})
    found, path = tune.run(Told(**vars(found)), 24, RESULTS, workers=1)
    assert found.failed
    assert found.chosen["start"] < 1.1
    assert "is more than 1.1" in path.read_text()
    row = json.loads(path.read_text())["runs"][0]
    assert row["value"] == pytest.approx((1.0 - 1.3) ** 2 + 1.0)


def test_a_search_that_was_made_repeats_no_run(toy, monkeypatch):
    before, _ = bowl(8)
    monkeypatch.setattr(tune.Pool, "add", lambda *_: pytest.fail("it ran again"))
    assert bowl(8)[0] == before


def test_what_fails_is_counted_and_what_does_not_exist_refused(toy):
    search = tune.search_of("decay.plain", "none", 1, ["start"])
    found, _ = tune.run(search, 3, RESULTS, workers=1)
    assert (found.best, found.failed) == (None, 3)
    for words, said in {
        ("decay.plane", "final", "start"): "did you mean 'plain'",
        ("decay.plain", "final", "begin"): "unknown parameter 'begin'",
        ("decay.plain", "final", "start=2..1"): "low before high",
        ("decay.plain", "finish", "start"): "unknown metric 'finish'",
    }.items():
        case, metric, parameter = words
        with pytest.raises(InputError, match=said):
            tune.run(tune.search_of(case, metric, 1, [parameter]), 2, RESULTS, workers=1)


def test_the_line_that_is_printed_reproduces_the_best(toy, command):
    code, text = command("tune case=decay.plain minimise=final budget=4 workers=1 start gain=1..3 decay.duration=1.0")
    assert code == 0
    code, _ = command(text.strip().splitlines()[-1].partition("dexrepro ")[2].replace("'", "") + " workers=1")
    assert code == 0
    (stored,) = RESULTS.glob("tuning/decay.plain-*.json")
    (metrics,) = RESULTS.glob("runs/decay-*/metrics.json")
    assert json.loads(metrics.read_text())["decay.plain.final"] == pytest.approx(json.loads(stored.read_text())["best"])


def test_a_case_made_from_a_list_is_overridden_with_all_of_its_experiment(toy):
    assert tune.search_of("decay.gain2", "final", 1, ["start"]).override({"start": 0.5}) == "'decay.start=0.5'"
    assert tune.search_of("decay.fast", "final", 1).override({"start": 0.5}) == "'++decay.cases.fast.start=0.5'"


def test_words_that_are_missing_or_wrong_are_one_sentence(toy, command):
    for words, said in {
        "tune minimise=final": "case= is missing",
        "tune case=decay.plain": "give minimise=METRIC or maximise=METRIC",
        "tune case=decay.plain minimise=final budget=1": "budget = 1 is not allowed",
        "tune case=decay.plain minimise=final": "declares a range; name some, as KEY=LOW..HIGH: start, ",
        "compare case=decay.plain minimise=final laws=. other.gain=2": "'other.gain=2' has no meaning here",
        "compare case=decay.plain minimise=final laws=nowhere": "there is no such folder",
    }.items():
        code, text = command(words)
        assert (code, said in text) == (2, True), text


LAW = """
class Mine:
    kind = "holding"
    ranges = {"gain": (0.1, 1.0)}
    def __init__(self, gain, desired_force, dt, limit=3.0): ...
    def reset(self, measured): ...
    def __call__(self, measured): return 0.0

class Joint(Mine):
    kind = "joint"
"""


def test_laws_of_a_folder_stand_beside_the_books_where_their_kind_fits(tmp_path, monkeypatch):
    (tmp_path / "laws_of_a_folder.py").write_text(LAW)
    monkeypatch.syspath_prepend(tmp_path)
    laws = comparison.laws_in(tmp_path)
    searches = []

    def tuned(search):
        searches.append(search)
        return tune.Found(2.0, 1.0 if search.case == "Mine" else 1.5, {}, 8, 0, [])

    rows = comparison.leaderboard(["holding_comparison.s4", "holding_comparison.s8"], laws, ["rmse"], 1, tuned)
    assert [(row["law"], row["whose"]) for row in rows] == [
        ("Mine", "yours"), ("s4", "the book's"), ("s8", "the book's"),
    ]  # fmt: skip
    passive, proposed, mine = searches
    assert set(passive.ranges) == {f"laws.passive_impedance.{name}" for name in ("mass", "damping")}
    assert all(key.startswith("laws.impedance.") for key in proposed.ranges)
    assert mine.ranges == {"law.gain": (0.1, 1.0)}
    with pytest.raises(
        InputError, match=r"laws_of_a_folder\.Mine is of kind 'holding'; skill_reuse\.none take 'end_point'"
    ):
        comparison.leaderboard(["skill_reuse.none"], laws, ["rmse_mm"], 1, tuned)
    law = mine.values["law"]
    assert law["_target_"] == "laws_of_a_folder.Mine"
    assert (law["desired_force"], law["dt"]) == (1.0, mine.values["step"])
    assert "limit" not in law


def test_a_metric_that_no_case_has_is_refused(tmp_path, monkeypatch):
    (tmp_path / "laws_of_no_metric.py").write_text(LAW)
    monkeypatch.syspath_prepend(tmp_path)

    def tuned(search):
        raise InputError(f"unknown metric 'rms' of {search.name}")

    with pytest.raises(InputError, match="unknown metric 'rms' of holding_comparison"):
        comparison.leaderboard(["holding_comparison.s4"], comparison.laws_in(tmp_path), ["rms"], 1, tuned)


def test_what_is_overridden_holds_for_the_laws_of_both_sides(tmp_path, monkeypatch):
    (tmp_path / "laws_of_another_folder.py").write_text(LAW)
    monkeypatch.syspath_prepend(tmp_path)
    searches = []

    def tuned(search):
        searches.append(search)
        return tune.Found(2.0, 1.0, {}, 8, 0, [])

    words = ["holding_comparison.step=0.002", "force_tracking.step=0.004"]
    cases = ["holding_comparison.s4", "force_tracking.c1_force"]
    comparison.leaderboard(cases, comparison.laws_in(tmp_path), ["rmse"], 1, tuned, words)
    steps = {(search.experiment, search.case): search.values["step"] for search in searches}
    assert steps == {
        ("holding_comparison", "s4"): 0.002, ("holding_comparison", "Mine"): 0.002,
        ("force_tracking", "c1_force"): 0.004, ("force_tracking", "Mine"): 0.004,
    }  # fmt: skip


PLAIN = """
class {name}:
    ranges = {{"gain": (0.1, 1.0)}}
    def __init__(self, gain, dt): ...
    def reset(self, position): ...
    def __call__(self, position, force): return 0.0
"""


def test_a_plain_law_alone_in_its_file_is_found_and_of_several_one_must_say_which(tmp_path, monkeypatch):
    alone, several, helpers = tmp_path / "plain_alone.py", tmp_path / "plain_several.py", tmp_path / "_plain_helper.py"
    alone.write_text("from _plain_helper import Filter\n" + PLAIN.format(name="Mine"))
    helpers.write_text(PLAIN.format(name="Filter"))
    several.write_text(PLAIN.format(name="Low") + PLAIN.format(name="High"))
    monkeypatch.setattr(sys, "path", [*sys.path])
    told = []
    assert list(comparison.laws_in(tmp_path, told.append)) == ["plain_alone.Mine"]
    assert told == [f"{several}: High, Low could be plain holding laws or helpers; declare kind = 'holding' in a law"]
    laws = comparison.laws_in(alone)
    assert list(laws) == ["plain_alone.Mine"], "a file is named as well as a folder"
    with pytest.raises(InputError, match=r"laws = .*several.py is not allowed: no class in it declares kind = 'joint'"):
        comparison.laws_in(several)
    search = comparison.joined(
        tune.search_of("holding_comparison.s4", "rmse", 1), "plain_alone.Mine", laws["plain_alone.Mine"]
    )
    assert search.ranges == {"law.gain": (0.1, 1.0)}
    assert search.values["law"]["dt"] == search.values["step"]
    given = "+holding_comparison.cases.mine={law: {_target_: plain_alone.Mine, gain: 0.2, dt: 0.001}}"
    assert tune.search_of("holding_comparison.mine", "rmse", 1, (), [given]).ranges["law.gain"] == (0.05, 0.8)


def test_a_law_in_a_file_of_another_modules_name_is_one_sentence(tmp_path, monkeypatch):
    (tmp_path / "signal.py").write_text(PLAIN.format(name="Mine"))
    monkeypatch.setattr(sys, "path", [*sys.path])
    with pytest.raises(InputError, match=r"'signal' is a module already \(.+\); rename .*signal.py"):
        comparison.laws_in(tmp_path)


def test_a_law_of_which_nothing_says_how_it_is_built_is_one_sentence(tmp_path, monkeypatch):
    (tmp_path / "a_law_unbuilt.py").write_text(
        "class Mine:\n    kind = 'holding'\n    def __init__(self, gizmo): ...\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match=r"nothing says what 'gizmo' is; .* ranges = "):
        comparison.leaderboard(["holding_comparison.s4"], comparison.laws_in(tmp_path), ["rmse"], 1, lambda _: None)


# ----------------------------------------------------------------------------------------- searches that are shipped


def test_a_shipped_search_is_replaced_by_a_whole_one_alone(toy, tmp_path, monkeypatch):
    target = tmp_path / "shipped.json"
    monkeypatch.setattr(tune, "shipped", lambda case: target)
    search = Bowl(**vars(tune.search_of("decay.plain", "final", 1, ["start"])))
    tune.run(search, 8, RESULTS, workers=1, update=True)
    whole = target.read_bytes()

    def interrupted(text):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tune.run(search, 16, RESULTS, workers=1, tell=interrupted, update=True)
    assert target.read_bytes() == whole
    tune.run(search, 16, RESULTS, workers=1, update=True)
    assert len(json.loads(target.read_text())["runs"]) == 16


@pytest.mark.parametrize("word", ["minimise=x", "budget=3", "law.gain=1..2"])
def test_a_shipped_search_is_made_again_as_it_was(command, word):
    status, text = command(f"tune --update case={tune.searched()[0]} {word}")
    assert status == 2
    assert f"{word}: the search for" in text


def of_the_book(case):
    stored = json.loads(tune.shipped(case).read_text())
    spans = [f"{key}={low!r}..{high!r}" for key, (low, high) in stored["ranges"].items()]
    return stored, tune.search_of(case, stored["metric"], stored["sign"], spans, (), stored.get("limits"))


@pytest.mark.parametrize("case", tune.searched())
def test_a_tuned_case_of_the_book_has_the_best_values_of_its_search_and_none_at_an_edge(case):
    stored, search = of_the_book(case)
    definition = chapters.load(search.chapter).experiment(search.experiment)
    present = content_of(definition, search.config({}))
    assert stored["runs"][0]["content"] == present, f"of other values or code: dexrepro tune --update case={case}"
    start, *others = (stored["sign"] * row["value"] for row in stored["runs"] if row["value"] is not None)
    assert start <= min(others) + 0.01 * abs(min(others))
    for key, (low, high) in search.ranges.items():
        share = math.log(value_at(search.values, key) / low) / math.log(high / low)
        assert tune.EDGE < share < 1 - tune.EDGE, key


def test_what_is_called_the_best_of_a_search_has_one_and_rivals_have_as_many_runs():
    called, budgets = set(), {}
    for number in chapters.numbers():
        for key, origin in provenance(number).items():
            if ".cases." in key and origin.text.startswith("best of a search"):
                called.add(key.replace(".cases.", "."))
    assert called == {*tune.searched()}
    for case in called:
        stored, search = of_the_book(case)
        about = search.experiment, search.metric, len(search.ranges) > 1
        budgets.setdefault(about, set()).add(len(stored["runs"]))
    assert all(len(found) == 1 for found in budgets.values()), budgets


@pytest.mark.parametrize(
    ("kind", "case"),
    [("joint", "bounded_tracking.tuned"), ("end_point", "skill_reuse.none"), ("holding", "holding_comparison.s1")],
)
def test_a_new_controller_can_be_compared_as_it_is(
    kind: str, case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", [*sys.path])
    new_controller(f"Fresh{kind.title().replace('_', '')}", kind, tmp_path)
    ((target, law),) = comparison.laws_in(tmp_path).items()
    joined = comparison.joined(tune.search_of(case, "rmse", 1), target, law)
    assert joined is not None
    assert joined.values["law"].get("dt", 1e-3) == 1e-3
    given = {*joined.values["law"]} - {"_target_", "dt", "desired_force"}
    assert {key.removeprefix("law.") for key in joined.ranges} == given


def test_a_case_is_named_with_its_experiment() -> None:
    with pytest.raises(InputError, match=r"case = none is not allowed: it must be EXPERIMENT\.CASE"):
        tune.search_of("none", "rmse_mm", 1)


def test_the_control_period_is_no_gain_of_a_law() -> None:
    ranges = tune.search_of("skill_reuse.none", "rmse_mm", 1).ranges
    assert "law.floor" in ranges
    assert "law.step" not in ranges
