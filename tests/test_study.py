"""A study varies what the book does not print, counts, resumes, and names what matters."""

from __future__ import annotations

import copy
import gzip
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

from dexrepro import chapters, cli
from dexrepro.claims import LOOKS, Claim, less, robustness, within
from dexrepro.config import baseline_dir
from dexrepro.errors import InputError
from dexrepro.pool import Pool
from dexrepro.storage import read_json, write_json
from dexrepro.study import draws, samples, sampling, summaries
from dexrepro.study.confirm import confirm

RESULTS = Path("results")


@pytest.fixture
def folder(toy: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(samples, "baseline_dir", lambda: toy / "shipped")
    return toy


def test_only_parameters_with_a_declared_range_are_varied(folder: Path) -> None:
    assert set(draws.parameters("90", "decay")) == {"decay.start"}
    values, block = draws.draw("90", "decay", 3)
    assert 0.5 <= values["decay.start"] <= 2
    assert all(case["start"] == values["decay.start"] for case in block["cases"].values())
    assert draws.draw("90", "decay", 3) == (values, block)


def test_shared_parameters_are_found_through_whole_blocks_and_chains() -> None:
    composed = {"shared": {"arm": {"mass": 1.0, "length": "${shared.size}"}, "size": 2.0, "unused": 3.0}}
    assert draws._references(composed, {"arm": "${shared.arm}"}) == {"shared.arm", "shared.size"}


def test_only_the_cases_of_claims_are_run(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    claims = chapters.load("90").claims_of("decay")
    cases = draws.draw("90", "decay", 0)[1]["cases"]
    assert samples.needed_cases(claims, cases) == ["plain", "fast", "gain1", "gain2"]
    over_all = Claim("C90.09", "90.10", "a number over several cases", less("decay.ratio", 9))
    assert samples.needed_cases([*claims, over_all], cases) == list(cases)


def test_some_cases_are_studied_for_the_claims_about_no_other(folder: Path) -> None:
    cases = sampling.cases_of("90", "decay", "gain*")
    assert cases == ("gain1", "gain2")
    path = sampling.run("90", "decay", 2, RESULTS, workers=1, only=cases)
    assert path.parent.name == "cases"
    assert not samples.summary_file("decay", RESULTS).exists(), "it stands for no whole study"
    about = [c.id for c in chapters.load("90").claims_of("decay") if all(".gain" in n for n in c.metrics)]
    assert sorted(read_json(path)["claims"]) == sorted(about) != []
    whole = read_json(sampling.run("90", "decay", 2, RESULTS, workers=1))
    assert set(whole["claims"]) > set(about)
    assert whole["samples"] == 2
    with pytest.raises(InputError, match="unknown case 'gone'"):
        sampling.cases_of("90", "decay", "gone")
    with pytest.raises(InputError, match="no claim of decay is about these cases alone"):
        sampling.cases_of("90", "decay", "halved")


def test_a_case_that_fails_leaves_the_claims_of_the_others(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    values, block = draws.draw("90", "decay", 0)
    block["cases"]["gain2"]["fail"] = True
    monkeypatch.setattr(samples, "draw", lambda *_: (values, block))
    sample = samples.evaluate("90", "decay", 0, {})
    assert sample["cases"]["gain2"]["error"] == "ValueError: told to fail"
    found = summaries.summary("90", "decay", [sample])
    assert found["failed"] == 1
    assert set(found["claims"]) == {"C90.01", "C90.02"}


def test_points_cover_the_ranges_evenly_and_lists_are_drawn_element_by_element(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    origin = draws.parameters("90", "decay")["decay.start"]
    starts = np.sort([draws.draw("90", "decay", index)[0]["decay.start"] for index in range(16)])
    share = (starts - origin.low) / (origin.high - origin.low)
    assert np.all(np.floor(16 * share) == np.arange(16)), "one in every sixteenth"
    origins = {"decay.start": origin, "decay.gains": replace(origin, low=1.0, high=9.0)}
    monkeypatch.setattr(draws, "provenance", lambda chapter: origins)
    draws.ranged.cache_clear()
    assert set(draws.parameters("90", "decay")) == {"decay.start", "decay.gains.0", "decay.gains.1"}
    values, block = draws.draw("90", "decay", 5)
    assert block["gains"] == [values["decay.gains.0"], values["decay.gains.1"]]
    draws.ranged.cache_clear()


def test_a_whole_number_is_drawn_whole_only_where_its_range_has_whole_ends(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    origin, composed = draws.parameters("90", "decay")["decay.start"], draws.compose_chapter("90")
    composed["decay"]["start"] = 1
    monkeypatch.setattr(draws, "compose_chapter", lambda chapter: copy.deepcopy(composed))
    for low, whole in ((1.0, True), (0.2, False)):
        origins = {"decay.start": replace(origin, low=low, high=5.0)}
        monkeypatch.setattr(draws, "provenance", lambda chapter, origins=origins: origins)
        draws.ranged.cache_clear()
        drawn = [draws.draw("90", "decay", index)[0]["decay.start"] for index in range(8)]
        assert all(isinstance(value, int) for value in drawn) is whole
        assert min(drawn) >= low
    draws.ranged.cache_clear()


def test_the_best_of_a_search_is_not_drawn_and_what_is_drawn_beside_it_stays(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = draws.parameters("90", "decay")["decay.start"]
    drawn = []
    for kind in ("chosen", "derived"):
        origins = {"decay.gains": replace(start, low=1.0, high=9.0, kind=kind), "decay.start": start}
        monkeypatch.setattr(draws, "provenance", lambda chapter, origins=origins: origins)
        draws.ranged.cache_clear()
        drawn.append(draws.draw("90", "decay", 5)[0])
    draws.ranged.cache_clear()
    assert drawn[0].keys() - drawn[1].keys() == {"decay.gains.0", "decay.gains.1"}
    assert drawn[0].items() >= drawn[1].items()


def test_words_are_drawn_evenly_and_leave_the_numbers_alone(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    start = draws.parameters("90", "decay")["decay.start"]
    before = [draws.draw("90", "decay", index)[0] for index in range(16)]
    words = draws.Provenance("-", "chosen", "either", words=("exact", "euler"), drawn=True)
    composed = draws.compose_chapter("90")
    composed["decay"]["integrator"] = "exact"
    monkeypatch.setattr(draws, "compose_chapter", lambda chapter: copy.deepcopy(composed))
    monkeypatch.setattr(draws, "provenance", lambda chapter: {"decay.start": start, "decay.integrator": words})
    draws.ranged.cache_clear()
    drawn = [draws.draw("90", "decay", index) for index in range(16)]
    assert [block["integrator"] for _, block in drawn] == [values["decay.integrator"] for values, _ in drawn]
    assert sorted(values.pop("decay.integrator") for values, _ in drawn) == ["euler"] * 8 + ["exact"] * 8
    assert [values for values, _ in drawn] == before
    draws.ranged.cache_clear()


def test_a_reworded_claim_costs_no_simulation(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = sampling.run("90", "decay", 4, RESULTS, workers=1)
    other = Claim(
        "C90.01", "90.10", "the fast one decays much more", less("decay.fast.final", "decay.plain.final", 0.5)
    )
    chapter = chapters.load("90")
    changed = replace(chapter, claims=(other, *chapter.claims[1:]))
    monkeypatch.setattr(chapters, "load", lambda number: changed)
    monkeypatch.setattr(samples, "measured", lambda *_: pytest.fail("it was simulated again"))
    monkeypatch.setattr(sampling, "Pool", lambda workers: Pool(here=True))
    again = read_json(sampling.run("90", "decay", 4, RESULTS))
    assert again["claims"]["C90.01"]["predicate"] == "decay.fast.final < 0.5 decay.plain.final"
    assert again["claims"]["C90.01"]["samples"] == 4
    assert path.exists()


def test_a_study_says_nothing_of_a_claim_that_has_changed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sampling.run("90", "decay", 16, RESULTS, workers=1)
    assert summaries.robustness_of("90", RESULTS)["C90.01"] == "open"
    chapter = chapters.load("90")
    other = replace(chapter.claims[0], predicate=less("decay.fast.final", 9))
    monkeypatch.setattr(chapters, "load", lambda _: replace(chapter, claims=(other, *chapter.claims[1:])))
    assert "C90.01" not in summaries.robustness_of("90", RESULTS)


def test_a_study_ends_when_every_claim_is_decided(folder: Path) -> None:
    """The toy's claims that always hold need 26 samples, the one that holds in a third is fragile before."""
    result = read_json(sampling.run("90", "decay", None, RESULTS, workers=1))
    assert result["samples"] == 26
    assert {key: row["word"] for key, row in result["claims"].items()} == {
        "C90.01": "robust",
        "C90.02": "fragile",
        "C90.03": "robust",
    }


def test_what_is_decided_is_drawn_no_more(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    chapter = chapters.load("90")
    seldom = Claim("C90.02", "90.10", "it stays small", less("decay.gain2.largest", 0.5))
    always = replace(chapter.claims[0], control=less("decay.gain1.final", "decay.plain.final"))
    monkeypatch.setattr(chapters, "load", lambda _: replace(chapter, claims=(always, seldom)))
    monkeypatch.setattr(sampling, "Pool", lambda workers: Pool(here=True))
    path = sampling.run("90", "decay", None, RESULTS)
    rows = {key: (row["word"], row["samples"]) for key, row in read_json(path)["claims"].items()}
    assert rows == {"C90.01": ("robust", 26), "C90.02": ("fragile", 16)}
    assert read_json(path)["claims"]["C90.01"]["control_samples"] == 8, "it has been seen, and decides nothing"
    cases = [set(entry["cases"]) for entry in samples.read_samples(samples.samples_file(path))]
    deciding = {"plain", "fast"}
    assert cases == [deciding | {"gain1", "gain2"}] * 8 + [deciding | {"gain2"}] * 8 + [deciding] * 10
    monkeypatch.setattr(chapters, "load", lambda _: chapter)
    assert read_json(sampling.run("90", "decay", 28, RESULTS))["claims"]["C90.03"]["samples"] == 28, "the rest is added"
    entries = [entry for entry in sampling.kept_samples("90", "decay", RESULTS).values() if len(entry["cases"]) == 4]
    assert len(entries) == 28


def test_a_number_over_several_cases_needs_those_that_it_is_made_of(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    chapter = chapters.load("90")
    over = Claim("C90.09", "90.10", "the fast one decays more", within("decay.ratio", 1, 1e6))
    monkeypatch.setattr(chapters, "load", lambda _: replace(chapter, claims=(over,)))
    monkeypatch.setattr(sampling, "Pool", lambda workers: Pool(here=True))
    path = sampling.run("90", "decay", None, RESULTS)
    row = read_json(path)["claims"]["C90.09"]
    assert (row["word"], row["holds"], row["samples"]) == ("robust", 26, 26)
    cases = [set(entry["cases"]) for entry in samples.read_samples(samples.samples_file(path))]
    assert cases == [{"plain", "fast", "halved", "gain1", "gain2"}] * 8 + [{"plain", "fast"}] * 18
    asked = samples._Asked({"plain": {}}, ["plain", "fast"])
    assert "fast" not in asked
    assert asked.cases == {"fast"}
    assert [*asked.items()] == [("plain", {})]
    assert asked.cases == {"plain", "fast"}, "who goes through all asks for all"


def test_no_parameter_is_named_by_luck() -> None:
    rng = np.random.default_rng(1)
    named = 0
    for _ in range(60):
        values = [dict(zip("abcdefghij", row)) for row in rng.random((16, 10))]
        named += summaries._most_influential(rng.random(16), values)[0] is not None
    assert named <= 8, "about one in twenty of 60, whatever the number of parameters"
    values = [dict(zip("abcdefghij", row)) for row in rng.random((16, 10))]
    assert summaries._most_influential(np.array([-row["c"] for row in values]), values) == ("c", pytest.approx(-1))


def test_a_study_counts_how_often_each_claim_holds_and_what_it_follows(folder: Path) -> None:
    result = read_json(sampling.run("90", "decay", 16, RESULTS, workers=1))
    always, sometimes = result["claims"]["C90.01"], result["claims"]["C90.02"]
    assert (always["holds"], always["samples"]) == (16, 16)
    assert always["low"] == pytest.approx(16 / (16 + 1.959964**2), rel=1e-4), "Wilson's interval"
    starts = [draws.draw("90", "decay", index)[0]["decay.start"] for index in range(16)]
    assert sometimes["holds"] == sum(start < 1 for start in starts)
    assert sometimes["parameter"] == "decay.start"
    assert result["failed"] == 0


def test_a_study_resumes_and_survives_a_line_cut_short(folder: Path) -> None:
    sampling.run("90", "decay", 4, RESULTS, workers=1)
    lines = RESULTS / "studies/decay.jsonl"
    kept = lines.read_text().splitlines(keepends=True)
    lines.write_text("".join(kept[:3]) + kept[3][:20])
    sampling.run("90", "decay", 6, RESULTS, workers=1)
    assert lines.read_text().startswith("".join(kept[:3]))
    assert [entry["index"] for entry in samples.read_samples(lines)] == list(range(6))


def test_a_study_asked_for_less_forgets_nothing(folder: Path) -> None:
    sampling.run("90", "decay", 5, RESULTS, workers=1)
    assert read_json(sampling.run("90", "decay", 2, RESULTS, workers=1))["samples"] == 5


def test_shipped_samples_count_and_those_of_another_configuration_do_not(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sampling.run("90", "decay", 3, RESULTS, workers=1)
    (folder / "shipped").mkdir()
    (RESULTS / "studies").rename(folder / "shipped/study")
    evaluated: list[int] = []
    evaluate = samples.evaluate
    monkeypatch.setattr(sampling, "Pool", lambda workers: Pool(here=True))
    monkeypatch.setattr(samples, "evaluate", lambda *which: evaluated.append(which[2]) or evaluate(*which))
    lines = folder / "shipped/study/decay.jsonl"
    lines.with_suffix(".jsonl.gz").write_bytes(gzip.compress(lines.read_bytes()))
    lines.unlink()
    sampling.run("90", "decay", 5, RESULTS)
    assert evaluated == [3, 4]
    narrower = {key: replace(origin, high=1.0) for key, origin in draws.parameters("90", "decay").items()}
    monkeypatch.setattr(draws, "ranged", lambda *_: narrower)
    assert read_json(sampling.run("90", "decay", 2, Path("other")))["samples"] == 2
    assert evaluated[2:] == [0, 1]


def test_only_the_cases_that_changed_run_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sampling.run("90", "decay", 2, RESULTS, workers=1)
    keys = samples.content_of
    monkeypatch.setattr(sampling, "Pool", lambda workers: Pool(here=True))
    monkeypatch.setattr(
        samples, "content_of", lambda who, values: keys(who, values) + "new" * (values["case"] == "fast")
    )
    ran: list[str] = []
    measured = samples.measured
    monkeypatch.setattr(samples, "measured", lambda who, values: ran.append(values["case"]) or measured(who, values))
    assert read_json(sampling.run("90", "decay", 2, RESULTS))["samples"] == 2
    assert ran == ["fast", "fast"]


def test_samples_are_carried_over_a_change_of_code_that_changes_no_number(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = sampling.run("90", "decay", 4, RESULTS, workers=1)
    keys, measured = samples.content_of, samples.measured
    monkeypatch.setattr(sampling, "Pool", lambda workers: Pool(here=True))
    monkeypatch.setattr(samples, "content_of", lambda who, values: keys(who, values) + "of other code")

    def other(who: Any, values: Any) -> Any:
        metrics = measured(who, values)
        return {**metrics, "final": metrics["final"] * (1.01 if values["case"] == "fast" else 1)}

    monkeypatch.setattr(samples, "measured", other)
    assert confirm("90", "decay", RESULTS) == (3 * 4, ["fast"])
    monkeypatch.setattr(samples, "measured", measured)
    assert confirm("90", "decay", RESULTS) == (4, [])
    monkeypatch.setattr(samples, "measured", lambda *_: pytest.fail("it was simulated again"))
    assert read_json(sampling.run("90", "decay", 4, RESULTS)) == read_json(path)


def test_a_case_that_failed_twice_is_carried_over_only_where_it_failed_alike(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(sentence: str) -> None:
        def other(who: Any, values: Any) -> Any:
            if values["case"] == "fast":
                raise ValueError(sentence)
            return measured(who, values)

        monkeypatch.setattr(samples, "measured", other)

    keys, measured = samples.content_of, samples.measured
    monkeypatch.setattr(sampling, "Pool", lambda workers: Pool(here=True))
    failing("the error grew to 1.25e3 m")
    sampling.run("90", "decay", 2, RESULTS, workers=1)
    monkeypatch.setattr(samples, "content_of", lambda who, values: keys(who, values) + "of other code")
    failing("the matrix is singular")
    assert confirm("90", "decay", RESULTS)[1] == ["fast"]
    failing("the error grew to 1.26e3 m")
    assert confirm("90", "decay", RESULTS) == (2, [])


def test_a_study_never_becomes_smaller(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = sampling.run("90", "decay", 3, RESULTS, workers=1)
    lines, narrower = (RESULTS / "studies/decay.jsonl").read_text(), draws.parameters("90", "decay")
    narrower = {key: replace(origin, high=1.0) for key, origin in narrower.items()}
    monkeypatch.setattr(sampling, "Pool", lambda workers: Pool(here=True))  # other processes do not know of this:
    monkeypatch.setattr(draws, "ranged", lambda *_: narrower)
    with pytest.raises(InputError, match=r"samples = 2 is not allowed: .* holds 3 samples of another configuration"):
        sampling.run("90", "decay", 2, RESULTS, workers=1)
    assert sampling.run("90", "decay", 3, RESULTS, workers=1, hours=1e-9) == path  # no time for any
    assert cli.main(["study", "chapter=90", "only=decay", "samples=3", "hours=1e-9", "workers=1"]) == 0
    assert "holds 3 samples, 0 of them of today's values and code: it stays as it was" in capsys.readouterr().err
    assert read_json(path)["samples"] == 3
    assert read_json(path)["varied"]["decay.start"] == [0.5, 2]
    assert (RESULTS / "studies/decay.jsonl").read_text() == lines
    assert read_json(sampling.run("90", "decay", 3, RESULTS, workers=1))["varied"]["decay.start"] == [0.5, 1]


def test_only_an_update_writes_what_is_shipped(folder: Path) -> None:
    sampling.run("90", "decay", 2, RESULTS, workers=1)
    assert not (folder / "shipped").exists()
    path = sampling.run("90", "decay", 3, RESULTS, workers=1, update=True)
    assert path == folder / "shipped/study/decay.json"
    assert read_json(path)["samples"] == 3
    assert len(list(samples.read_samples(path.with_suffix(".jsonl.gz")))) == 3


def test_of_two_studies_the_larger_is_shown_and_ours_where_equal(folder: Path) -> None:
    path = sampling.run("90", "decay", 4, RESULTS, workers=1)
    assert path == RESULTS / "studies/decay.json"
    (folder / "shipped/study").mkdir(parents=True)
    varied = read_json(path)["varied"]
    for size, shown in ((3, 4), (4, 4), (9, 9)):
        for name in ("decay", "other"):
            summary = {"chapter": "90", "experiment": name, "samples": size, "varied": varied, "claims": {}}
            write_json(folder / f"shipped/study/{name}.json", summary)
        decay, other = summaries.stored(RESULTS)
        assert decay["samples"] == shown
        assert bool(decay["claims"]) == (size < 9)
        assert other["samples"] == size
    other = summary | {"experiment": "decay", "varied": {"decay.start": [0, 9]}}
    write_json(folder / "shipped/study/decay.json", other)
    assert summaries.stored(RESULTS)[0]["samples"] == 4, "of other ranges than today's"


def test_an_unknown_claim_is_refused(folder: Path) -> None:
    with pytest.raises(InputError, match=r"did you mean 'C90.01'"):
        sampling.experiments_of("90", [], "C90.1")


def test_a_claim_that_is_not_testable_is_refused_with_the_reason() -> None:
    with pytest.raises(InputError, match=r"claim = C1.17 is not allowed: it is not testable: Fatigue"):
        sampling.experiments_of("1", [], "C1.17")
    assert sampling.experiments_of("2", ["growth_cost", "movement_estimation"], None) == ["movement_estimation"]


@pytest.mark.slow
def test_a_study_in_a_checkout_changes_no_tracked_file(tmp_path: Path) -> None:
    git = ["git", "-C", str(tmp_path), "-c", "user.name=test", "-c", "user.email=test"]
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], capture_output=True, text=True, check=False)
    if listed.returncode:
        pytest.skip("not a checkout")
    for name in filter(None, listed.stdout.split("\0")):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, tmp_path / name)
    for arguments in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "as it is"]):
        subprocess.run([*git, *arguments], check=True)
    command = [sys.executable, "-m", "dexrepro", "study", "chapter=1", "only=two_nuts", "samples=2", "workers=1"]
    env = {**os.environ, "PYTHONPATH": str(tmp_path)}
    done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    assert list(tmp_path.glob("results/studies/*.json"))
    assert subprocess.run([*git, "status", "--porcelain"], capture_output=True, text=True, check=True).stdout == ""


@pytest.mark.parametrize(
    ("share", "wrong"), [(0.8499, "robust"), (0.85, "fragile"), (0.80, "robust"), (0.90, "fragile")]
)
def test_a_word_of_a_study_is_wrong_in_at_most_one_of_twenty(share: float, wrong: str) -> None:
    """Exact: the chance of every count of draws that held, looked at after every draw, a claim holding in ``share``."""
    alive, words = np.ones(1), dict.fromkeys(("robust", "fragile", "open"), 0.0)
    for look in range(1, LOOKS[-1] + 1):
        alive = np.convolve(alive, [1 - share, share])
        for holds, chance in enumerate(alive):
            word = robustness(holds, look)
            if word != "open" or look == LOOKS[-1]:
                words[word] += chance
                alive[holds] = 0.0
    assert sum(words.values()) == pytest.approx(1)
    assert words[wrong] < 0.05, words


STUDIES = sorted((baseline_dir() / "study").glob("*.json"))


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_a_shipped_study_has_its_samples_and_is_of_what_would_be_drawn_and_run_today(path: Path) -> None:
    found = read_json(path)
    chapter, experiment = found["chapter"], found["experiment"]
    rows = list(samples.read_samples(samples.samples_file(path)))
    assert len(rows) == found["samples"]
    assert found["varied"] == draws.varied(chapter, experiment)
    today = samples.contents(chapter, experiment, rows[0])
    other = [case for case, row in rows[0]["cases"].items() if row["content"] != today.get(case, row["content"])]
    assert not other, "run again, or where no number changed: dexrepro study --confirm --update"
