"""Every claim of the book is severely tested: it has been seen to fail, or says why it cannot."""

from __future__ import annotations

import itertools
import re

import pytest

from dexrepro import baselines, chapters
from dexrepro.cases import settings
from dexrepro.claims import NOT_EVALUATED, Predicate, filled
from dexrepro.config import baseline_dir, compose_chapter
from dexrepro.report import verdicts
from dexrepro.study import summaries


@pytest.mark.parametrize("number", chapters.numbers())
def test_every_claim_of_the_book_has_a_control_or_the_reason_why_none_can_exist(number: str) -> None:
    claims = [claim for claim in chapters.load(number).claims if claim.source == "book" and claim.predicate]
    assert not [claim.id for claim in claims if not (claim.control or claim.no_control or claim.by_construction)]


@pytest.mark.parametrize("number", chapters.numbers())
def test_every_statement_has_been_seen_to_fail_or_says_why_it_cannot(number: str) -> None:
    """In its own run, the control's, a printed form's, a reading's or a draw of a study; another case is none of these.

    Those that never failed are listed on the page "How a verdict is made". Where the control holds as well as what is
    credited, the verdict "not attributed" rests on just that.
    """
    studied = {key: row for item in summaries.stored(baseline_dir()) for key, row in item["claims"].items()}
    metrics = baselines.stored_values(number)
    evaluated = [claim.evaluate(metrics).as_dict() for claim in chapters.load(number).claims if claim.predicate]
    never = verdicts.never_failed([{**item, "study": studied.get(item["id"])} for item in evaluated])
    assert not [item["id"] for item, reason in never if not reason]


@pytest.mark.parametrize("number", chapters.numbers())
def test_stored_verdicts_follow_from_stored_metrics(number: str) -> None:
    stored = {key: verdict for item in baselines.stored(number).values() for key, verdict in item.claims.items()}
    metrics = baselines.stored_values(number)
    found = {claim.id: claim.evaluate(metrics).verdict for claim in chapters.load(number).claims if claim.predicate}
    assert {key: verdict for key, verdict in found.items() if verdict != NOT_EVALUATED and key in stored} == {
        key: verdict for key, verdict in stored.items() if found.get(key, NOT_EVALUATED) != NOT_EVALUATED
    }


def outcomes(predicate: Predicate, entries: dict[str, dict[str, float]]) -> set[bool]:
    """Whether it holds where its numbers are, moved by their tolerances in pairs, and all moved where it gains most.

    A part of a predicate compares two numbers at most, so that pairs find whatever makes one fail. A tolerance of the
    smallest size about 0 is no change that was seen.
    """
    ends = {}
    for name in dict.fromkeys(predicate.metrics):
        value, size = entries[name]["value"], entries[name]["atol"]
        size = 0.0 if value is None else entries[name]["rtol"] * abs(value) + size * (size > baselines.ATOL)
        ends[name] = (value - size, value, value + size) if size else (value,)
    best = {name: entries[name]["value"] for name in ends}
    found = {predicate.margin(best) > 0}
    moved = [name for name in ends if len(ends[name]) > 1]
    pairs = [*itertools.combinations(moved, 2)] or [(name, name) for name in moved]
    for one, two in pairs:
        places = [best | {one: a, two: b} for a, b in itertools.product(ends[one], ends[two])]
        found |= {predicate.margin(place) > 0 for place in places}
    if found == {False}:
        for one, two in pairs * 2:
            places = [best | {one: a, two: b} for a, b in itertools.product(ends[one], ends[two])]
            best = max(places, key=predicate.margin)
        found.add(predicate.margin(best) > 0)
    return found


@pytest.mark.parametrize("number", chapters.numbers())
def test_a_claim_says_why_where_its_verdict_turns_within_the_tolerance_of_its_numbers(number: str) -> None:
    stored = baselines.stored(number).values()
    entries = {name: entry for baseline in stored for name, entry in baseline.metrics.items()}
    claims = chapters.load(number).claims
    turning = {claim.id for claim in claims if any(len(outcomes(one, entries)) > 1 for one in claim.predicates)}
    assert turning == {claim.id for claim in claims if claim.turns}


@pytest.mark.parametrize("number", chapters.numbers())
def test_every_number_that_a_text_takes_from_a_run_is_stored(number: str) -> None:
    """In notes of claims, errata and their evidence, captions and alternative texts, which may name parameters, too."""
    chapter, metrics = chapters.load(number), baselines.stored_values(number)
    composed = compose_chapter(number)
    for experiment in chapter.experiments:
        metrics |= settings(composed, experiment.name)
    texts = [text for item in chapter.errata for text in (item.summary, item.correction)]
    texts += [text for item in chapter.experiments for f in item.figures.values() for text in (f.caption, f.alt)]
    texts += [item.film.caption for item in chapter.experiments if item.film]
    texts += [claim.note for claim in chapter.claims]
    named = {name for text in texts for name in re.findall(r"\{(\w+(?:\.\w+)+)(?::[^{}]*)?\}", text)}
    assert not {name for name in named if metrics.get(name) is None}
    assert {name for item in chapter.errata for name in item.evidence} <= metrics.keys()
    assert not [text for text in texts if re.search(r"\{\w+\.", filled(text, metrics))]
