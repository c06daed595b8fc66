"""What the pages say of a claim, from what its evaluation holds."""

from __future__ import annotations

from typing import Any

import pytest

from dexrepro import chapters
from dexrepro.claims import Claim, Erratum, less
from dexrepro.config import compose_chapter
from dexrepro.report import relations, verdicts


def claim(**values: Any) -> dict[str, Any]:
    fields = {
        "id": "C1.01",
        "source": "book",
        "verdict": "reproduced",
        "margin": 0.5,
        "by_construction": "",
        "robustness": "",
    }
    return {**fields, "study": None, **values}


SEVERE = {"control": "b < a", "control_margin": -0.5}


@pytest.mark.parametrize(
    ("values", "strength", "counts"),
    [
        ({}, "weak", (0, 0)),
        (SEVERE, "partial", (0, 0)),
        ({"robustness": "robust"}, "partial", (0, 0)),
        ({**SEVERE, "robustness": "robust"}, "strong", (1, 1)),
        ({**SEVERE, "robustness": "robust", "verdict": "after correction"}, "strong", (1, 0)),
        ({**SEVERE, "robustness": "robust", "verdict": "not reproduced"}, "strong", (0, 0)),
        ({**SEVERE, "robustness": "robust", "verdict": "by construction"}, "strong", (0, 0)),
        ({"control": "b < a", "control_margin": 0.2, "robustness": "robust"}, "partial", (0, 0)),
        ({"control": "b < a", "control_margin": None, "robustness": "robust"}, "partial", (0, 0)),
    ],
)
def test_only_what_is_reproduced_was_tested_and_is_robust_makes_the_headline(values, strength, counts) -> None:
    assert verdicts.strength(claim(**values)) == strength
    score = verdicts.score([claim(**values)])
    assert (score["strong"], score["headline"]) == counts


def test_each_verdict_counts_apart_and_ours_beside_them() -> None:
    score = verdicts.score([claim(verdict="by construction"), claim(robustness="robust"), claim(source="ours")])
    assert (score["counts"]["by construction"], score["counts"]["reproduced"]) == (1, 1)
    assert (score["total"], score["robust"], score["ours"]) == (2, 1, (1, 1))


def test_a_control_that_holds_is_said_to_hold() -> None:
    assert verdicts.noticed(claim(**SEVERE)) == "yes: the control fails"
    assert verdicts.noticed(claim(control="b < a", control_margin=0.1)).startswith("no")
    drawn = {"holds": 30, "samples": 40, "control_fails": 13, "control_samples": 16}
    assert verdicts.noticed(claim(**SEVERE, study=drawn)) == "yes: the control fails (it fails in 13 of 16 draws)"
    assert "identity" in verdicts.noticed(claim(no_control="an identity"))


def test_a_statement_has_been_seen_to_fail_only_in_a_run_of_its_own() -> None:
    assert not verdicts.seen_to_fail(claim())
    assert not verdicts.seen_to_fail(claim(control_margin=0.1, study={"holds": 40, "samples": 40}))
    assert all(
        verdicts.seen_to_fail(claim(**values))
        for values in (SEVERE, {"printed_margin": -1.0}, {"readings": {"whole run": -0.1}}, {"margin": -0.2})
    )
    assert verdicts.seen_to_fail(claim(study={"holds": 15, "samples": 16}))
    never = [claim(), claim(no_control="an identity"), claim(verdict="not attributed"), claim(**SEVERE)]
    assert [reason for _, reason in verdicts.never_failed(never)] == ["", "an identity", "its control holds as well"]


def test_the_answer_names_what_fails() -> None:
    claims = [claim(), claim(id="C1.02", verdict="not attributed"), claim(id="C1.03", source="ours")]
    assert verdicts.answer(claims) == "1 of the book's 2 claims holds. C1.02 not attributed."
    assert verdicts.answer(claims[:1] * 2) == "All of the book's 2 claims hold."


def test_each_verdict_has_the_best_documented_example() -> None:
    chosen = verdicts.examples(
        [claim(margin=0.9), claim(id="C1.02", **SEVERE), claim(id="C1.03", verdict="not reproduced")]
    )
    assert [item["id"] for item in chosen] == ["C1.02", "C1.03"]


def test_an_erratum_touches_a_claim_by_name_by_evidence_or_by_the_case_it_switches() -> None:
    statement = Claim("C1.01", "1.1", "It holds (E1.01).", less("e.a.x", 1), printed=less("e.printed.x", 1))
    errata = [
        Erratum("E1.01", "", "slip", ""),
        Erratum("E1.02", "", "slip", "", evidence=("e.printed.y",)),
        Erratum("E1.03", "", "slip", "", switch="e.law.sign=printed"),
        Erratum("E1.04", "", "slip", "", evidence=("e.a.y",)),
        Erratum("E1.05", "", "slip", "", switch="e.law.sign=other"),
    ]
    composed = {"e": {"cases": {"printed": {"law": {"sign": "printed"}}}}}
    assert [item.id for item in relations.errata_of(statement, errata, composed)] == ["E1.01", "E1.02", "E1.03"]


@pytest.mark.parametrize("number", chapters.numbers())
def test_every_claim_with_a_printed_form_names_the_erratum(number: str) -> None:
    loaded, composed = chapters.load(number), compose_chapter(number)
    claims = [item for item in loaded.claims if item.printed]
    assert not [item.id for item in claims if not relations.errata_of(item, loaded.errata, composed)]
