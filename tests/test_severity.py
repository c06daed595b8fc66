"""Every claim of the book is severely tested: it has been seen to fail, or says why it cannot."""

from __future__ import annotations

import re

import pytest

from dexrepro import baselines, chapters, study
from dexrepro.claims import BY_CONSTRUCTION, NOT_EVALUATED, Claim, Predicate, filled, less, robustness


def stored_metrics(number: str) -> dict[str, float | None]:
    stored = baselines.stored(number).values()
    return {name: entry["value"] for baseline in stored for name, entry in baseline.metrics.items()}


@pytest.mark.parametrize("number", chapters.numbers())
def test_every_claim_of_the_book_has_a_control_or_the_reason_why_none_can_exist(number: str) -> None:
    claims = [claim for claim in chapters.load(number).claims if claim.source == "book" and claim.predicate]
    assert not [claim.id for claim in claims if not (claim.control or claim.no_control or claim.by_construction)]


@pytest.mark.parametrize("number", chapters.numbers())
def test_every_predicate_has_been_seen_to_fail(number: str) -> None:
    """In a stored control, printed form, reading, other case or study sample; those that never did say why."""
    metrics = stored_metrics(number)
    sampled = {
        key: entry["quantiles"][0]
        for item in study.stored(baselines.baseline_dir())
        for key, entry in item["claims"].items()
    }
    never = []
    for claim in chapters.load(number).claims:
        if claim.predicate is None or claim.source != "book" or claim.by_construction:
            continue
        found = claim.evaluate(metrics)
        margins = [found.margin, found.control_margin, found.printed_margin, *found.readings.values()]
        margins += of_other_cases(claim.predicate, metrics)
        if not any(margin is not None and margin <= 0 for margin in [*margins, sampled.get(claim.id)]):
            never.append(claim)
    assert not [claim.id for claim in never if not claim.no_control]


def of_other_cases(predicate: Predicate, metrics: dict[str, float | None]) -> list[float | None]:
    """Margins of the statement where one of its cases is another stored case of the experiment."""
    experiment = predicate.metrics[0].split(".")[0]
    cases = {name.split(".")[1] for name in metrics if name.startswith(f"{experiment}.") and name.count(".") == 2}
    margins = []
    for case in {name.split(".")[1] for name in predicate.metrics if name.count(".") == 2}:
        for other in cases:
            moved = {name: name.replace(f".{case}.", f".{other}.") for name in predicate.metrics}
            margins.append(predicate.margin({name: metrics[key] for name, key in moved.items() if key in metrics}))
    return margins


@pytest.mark.parametrize("number", chapters.numbers())
def test_stored_verdicts_follow_from_stored_metrics(number: str) -> None:
    stored = {key: verdict for item in baselines.stored(number).values() for key, verdict in item.claims.items()}
    metrics = stored_metrics(number)
    found = {claim.id: claim.evaluate(metrics).verdict for claim in chapters.load(number).claims if claim.predicate}
    assert {key: verdict for key, verdict in found.items() if verdict != NOT_EVALUATED and key in stored} == {
        key: verdict for key, verdict in stored.items() if found.get(key, NOT_EVALUATED) != NOT_EVALUATED
    }


def test_verdicts_of_every_kind() -> None:
    def verdict(**values: object) -> str:
        claim = Claim("C", "1", "a falls", less("e.a.x", 1.0), **values)
        return claim.evaluate({"e.a.x": 0.5, "e.b.x": 2.0, "e.c.x": 0.7, "e.d.x": None}).verdict

    holds, fails, undefined = less("e.c.x", 1.0), less("e.b.x", 1.0), less("e.d.x", 1.0)
    assert verdict() == verdict(control=fails) == verdict(control=holds) == verdict(printed=holds) == "reproduced"
    assert verdict(printed=fails) == verdict(printed=undefined) == "after correction"
    assert verdict(control=holds, credits="the term") == "not attributed"
    assert verdict(control=fails, credits="the term") == "reproduced"
    assert verdict(readings={"another window": fails}) == "reading-dependent"
    assert verdict(by_construction="the generator does it") == BY_CONSTRUCTION
    assert Claim("C", "1", "a falls", fails).evaluate({"e.b.x": 2.0}).verdict == "not reproduced"
    assert Claim("C", "1", "a falls", fails).evaluate({"e.b.x": None}).verdict == "not reproduced"
    assert Claim("C", "1", "a falls", fails).evaluate({}).verdict == NOT_EVALUATED


def test_the_numbers_of_a_note_come_from_the_run() -> None:
    claim = Claim("C", "1", "a falls", less("e.a.x", 1.0), note="It is {e.a.x:.1f} mm, not {e.a.gone}.")
    assert claim.evaluate({"e.a.x": 0.52}).note == "It is 0.5 mm, not ?."


@pytest.mark.parametrize("number", chapters.numbers())
def test_every_number_that_a_text_takes_from_a_run_is_stored(number: str) -> None:
    """In notes of claims, errata, captions and alternative texts."""
    chapter, metrics = chapters.load(number), stored_metrics(number)
    texts = [text for item in chapter.errata for text in (item.summary, item.correction)]
    texts += [text for item in chapter.experiments for f in item.figures.values() for text in (f.caption, f.alt)]
    texts += [claim.note for claim in chapter.claims]
    named = {name for text in texts for name in re.findall(r"\{(\w+(?:\.\w+)+)(?::[^{}]*)?\}", text)}
    assert not {name for name in named if metrics.get(name) is None}
    assert not [text for text in texts if re.search(r"\{\w+\.", filled(text, metrics))]


def test_what_a_study_shows() -> None:
    assert robustness(40, 40) == "robust"
    assert robustness(16, 16) == "open"
    assert robustness(8, 16) == "fragile"
    assert robustness(90, 100) == "open"
    assert robustness(0, 0) == ""
