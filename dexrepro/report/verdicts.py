"""What the pages say of a claim: does it hold, would we have noticed if it did not, how often does it hold.

Everything here works on what a result's claims.json holds. A claim evaluated before controls were recorded has none:
it counts as not severely tested, never as tested.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from dexrepro.experiment import AFTER_CORRECTION, NOT_EVALUATED, NOT_REPRODUCED, NOT_TESTABLE, REPRODUCED

Claim = Mapping[str, Any]

NOT_ATTRIBUTED = "not attributed"
READING_DEPENDENT = "reading-dependent"
BY_CONSTRUCTION = "by construction"
HOLDS = (REPRODUCED, AFTER_CORRECTION)
ROBUST = 0.85  # the lower bound of the share of draws from which on a claim is robust


class Meaning(NamedTuple):
    """How a verdict is marked on the map, and what it says."""

    mark: str
    text: str


VERDICTS = {
    REPRODUCED: Meaning(
        "circle", "The statement holds, and no erratum touches it, or it holds with the printed form too."
    ),
    AFTER_CORRECTION: Meaning("diamond", "It holds only with the corrected form of an equation; as printed it fails."),
    NOT_ATTRIBUTED: Meaning(
        "triangle", "What is observed is there, but it is there as well without what is said to cause it."
    ),
    READING_DEPENDENT: Meaning("hexagon", "It holds under one reading of what is left open and fails under another."),
    NOT_REPRODUCED: Meaning("cross", "The statement fails."),
    BY_CONSTRUCTION: Meaning(
        "square", "The effect is built into a generator of ours: no evidence, so it counts apart."
    ),
    NOT_TESTABLE: Meaning("dash", "No simulation can measure it; the reason is given."),
    NOT_EVALUATED: Meaning("dash", "A number it needs is absent from this result."),
}


def category(claim: Claim) -> str:
    """The verdict under which a claim counts: one that holds by construction counts apart."""
    built_in = claim.get("by_construction") and claim["verdict"] in (*HOLDS, NOT_ATTRIBUTED)
    return BY_CONSTRUCTION if built_in else claim["verdict"]


def is_severe(claim: Claim) -> bool:
    """Whether the run without what the claim credits makes the statement fail."""
    margin = claim.get("control_margin")
    return margin is not None and not margin > 0


def robustness(claim: Claim, row: Mapping[str, Any] | None) -> str:
    """ "robust", "fragile" or "open": as evaluated, else from a study's interval; "" without a study."""
    if claim.get("robustness") is not None:
        return str(claim["robustness"])
    if not row:
        return ""
    return "robust" if row["low"] >= ROBUST else "fragile" if row["high"] < ROBUST else "open"


def strength(claim: Claim) -> str:
    """ "strong": severely tested and robust; "partial": one of the two; "weak": neither."""
    return ("weak", "partial", "strong")[is_severe(claim) + (claim["robustness"] == "robust")]


def is_headline(claim: Claim) -> bool:
    """Whether a reader can build on it: it holds, by no construction, was severely tested, and is robust."""
    return category(claim) in HOLDS and strength(claim) == "strong"


def noticed(claim: Claim) -> str:
    """Whether a failure would have been noticed, in a phrase."""
    if claim.get("control_margin") is not None:
        return "yes: the control fails" if is_severe(claim) else "no: the control holds as well"
    if claim.get("no_control"):
        return f"no control can exist: {claim['no_control']}"
    return "the control was not evaluated" if claim.get("control") else "not tested: no control on record"


def often(claim: Claim) -> str:
    """How often it holds over what is not printed, in a phrase."""
    row, word = claim.get("study"), claim["robustness"]
    if not row:
        return word or "no study"
    return f"{word}: {row['holds']} of {row['samples']} draws" if word else f"{row['holds']} of {row['samples']} draws"


def score(claims: Iterable[Claim]) -> dict[str, Any]:
    """Counts of the book's claims by category, of how well they are tested, and of our own tests."""
    claims = list(claims)
    book = [claim for claim in claims if claim["source"] == "book"]
    held = [claim for claim in book if category(claim) in HOLDS]
    own = [claim for claim in claims if claim["source"] != "book" and claim["verdict"] != NOT_EVALUATED]
    return {
        "controlled": sum(claim.get("control_margin") is not None for claim in book),
        "total": len(book),
        "counts": {verdict: sum(category(claim) == verdict for claim in book) for verdict in VERDICTS},
        "severe": sum(is_severe(claim) for claim in held),
        "robust": sum(claim["robustness"] == "robust" for claim in held),
        "headline": sum(map(is_headline, book)),
        "headline_corrected": sum(is_headline(claim) and claim["verdict"] == AFTER_CORRECTION for claim in book),
        "ours": (sum(claim["verdict"] in HOLDS for claim in own), len(own)),
    }


def answer(claims: Sequence[Claim]) -> str:
    """An experiment's result in one sentence."""
    book = [claim for claim in claims if claim["source"] == "book" and claim["verdict"] != NOT_EVALUATED]
    if not book:
        return "The book claims nothing about this; our own tests and figures stand for themselves."
    held = [claim for claim in book if claim["verdict"] in HOLDS]
    missed = "; ".join(f"{claim['id']} {claim['verdict']}" for claim in book if claim not in held)
    corrected = sum(claim["verdict"] == AFTER_CORRECTION for claim in held)
    if len(book) == 1:
        return f"The book's claim: {book[0]['verdict']}."
    how_many = "None" if not held else "All" if not missed else f"{len(held)}"
    after = (
        "" if not corrected else ", after correction" if corrected == len(held) else f", {corrected} after correction"
    )
    first = f"{how_many} of the book's {len(book)} claims {'holds' if len(held) == 1 else 'hold'}{after}."
    return f"{first} {missed}." if missed else first


def examples(claims: Iterable[Claim]) -> list[Claim]:
    """One worked example of each verdict that occurs: the best documented, then the one decided most clearly."""

    def merit(claim: Claim) -> tuple[bool, bool, bool, float]:
        documented = claim.get("control_margin") is not None
        return documented, bool(claim.get("study")), claim["source"] == "book", min(abs(claim["margin"] or 0.0), 0.9)

    found: dict[str, Claim] = {}
    for claim in claims:
        key = category(claim)
        if key not in found or merit(claim) > merit(found[key]):
            found[key] = claim
    return [found[verdict] for verdict in VERDICTS if verdict in found]
