"""What the pages say of a claim: does it hold, would we have noticed if it did not, how often does it hold.

Everything here works on what a result's claims.json holds. A claim evaluated before controls were recorded has none:
it counts as not severely tested, never as tested.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from dexrepro import claims
from dexrepro.claims import AFTER_CORRECTION, NOT_ATTRIBUTED, NOT_EVALUATED, REPRODUCED, ROBUST
from dexrepro.report import words

Claim = Mapping[str, Any]

HOLDS = (REPRODUCED, AFTER_CORRECTION)
VERDICTS = {**claims.VERDICTS, NOT_EVALUATED: "needs a number that this result does not have"}
MARKS = {
    REPRODUCED: "circle", AFTER_CORRECTION: "diamond", NOT_ATTRIBUTED: "triangle",
    claims.READING_DEPENDENT: "hexagon", claims.BY_CONSTRUCTION: "square", claims.NOT_REPRODUCED: "cross",
    claims.NOT_TESTABLE: "dash", NOT_EVALUATED: "dash",
}  # fmt: skip
"""How a verdict is marked: a shape, so that its colour is not needed."""


def is_severe(claim: Claim) -> bool:
    """Whether the run without what the claim credits makes the statement fail."""
    margin = claim.get("control_margin")
    return margin is not None and not margin > 0


def seen_to_fail(claim: Claim) -> bool:
    """Whether the statement fails in a run on record: its own, its control's, a printed form's, a reading's, a draw."""
    row = claim.get("study") or {"holds": 0, "samples": 0}
    margins = [claim.get(key) for key in ("margin", "control_margin", "printed_margin")]
    margins += (claim.get("readings") or {}).values()
    return row["holds"] < row["samples"] or any(margin is not None and not margin > 0 for margin in margins)


def never_failed(evaluated: Iterable[Claim]) -> list[tuple[Claim, str]]:
    """The book's claims whose statement has failed in no run on record, those by construction apart, and why."""
    return [
        (claim, claim.get("no_control") or ("its control holds as well" if claim["verdict"] == NOT_ATTRIBUTED else ""))
        for claim in evaluated
        if claim["source"] == "book" and claim["margin"] is not None and not claim["by_construction"]
        and not seen_to_fail(claim)
    ]  # fmt: skip


def robustness(row: Mapping[str, Any] | None) -> str:
    """ "robust", "fragile" or "open": what a study shows a claim to be; "" without one."""
    return claims.robustness(row["holds"], row["samples"]) if row else ""


def strength(claim: Claim) -> str:
    """ "strong": severely tested and robust; "partial": one of the two; "weak": neither."""
    return ("weak", "partial", "strong")[is_severe(claim) + (claim["robustness"] == ROBUST)]


def noticed(claim: Claim) -> str:
    """Whether a failure would have been noticed, in a phrase, with how often the control fails where it was drawn."""
    if claim.get("control_margin") is not None:
        row = claim.get("study") or {}
        fails = row.get("control_fails")
        count = row.get("control_samples", row.get("samples"))
        draws = "" if fails is None else f" (it fails in {fails} of {count} draws)"
        return f"{'yes: the control fails' if is_severe(claim) else 'no: the control holds as well'}{draws}"
    if claim.get("no_control"):
        return f"no control can exist: {claim['no_control']}"
    return "the control was not evaluated" if claim.get("control") else "not tested: no control on record"


def often(claim: Claim) -> str:
    """How often it holds over what is not printed, in a phrase."""
    row, word = claim.get("study"), claim["robustness"]
    if not row:
        return word or "no study"
    return f"{word}: {row['holds']} of {row['samples']} draws" if word else f"{row['holds']} of {row['samples']} draws"


def score(evaluated: Iterable[Claim]) -> dict[str, Any]:
    """Counts of the book's claims by verdict, of how well they are tested, and of our own tests.

    strong: those that hold, were severely tested and are robust; headline: the reproduced among them.
    """
    evaluated = list(evaluated)
    book = [claim for claim in evaluated if claim["source"] == "book"]
    held = [claim for claim in book if claim["verdict"] in HOLDS]
    strong = [claim for claim in held if strength(claim) == "strong"]
    own = [claim for claim in evaluated if claim["source"] != "book" and claim["verdict"] != NOT_EVALUATED]
    return {
        "controlled": sum(claim.get("control_margin") is not None for claim in book),
        "total": len(book),
        "counts": {verdict: sum(claim["verdict"] == verdict for claim in book) for verdict in VERDICTS},
        "severe": sum(is_severe(claim) for claim in held),
        "robust": sum(claim["robustness"] == ROBUST for claim in held),
        "strong": len(strong),
        "headline": sum(claim["verdict"] == REPRODUCED for claim in strong),
        "ours": (sum(claim["verdict"] in HOLDS for claim in own), len(own)),
    }


def answer(evaluated: Sequence[Claim]) -> str:
    """An experiment's result in one sentence."""
    book = [claim for claim in evaluated if claim["source"] == "book" and claim["verdict"] != NOT_EVALUATED]
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


def to_name(evaluated: Iterable[Claim], stored: Mapping[str, str]) -> list[str]:
    """A line for each claim that does not hold, or ends otherwise than is stored, with its margin."""
    lines = []
    for claim in evaluated:
        verdict, was = claim["verdict"], stored.get(claim["id"])
        changed = was not in (None, verdict)
        if verdict != NOT_EVALUATED and (changed or verdict == claims.NOT_REPRODUCED):
            margin = "" if claim["margin"] is None else f", margin {claim['margin']:+.2g}"
            said = textwrap.shorten(claim["statement"], 90, placeholder=" ...")
            lines.append(f"{claim['id']}  {verdict}{margin}{f' (stored: {was})' if changed else ''}: {said}")
    return lines


def examples(evaluated: Iterable[Claim]) -> list[Claim]:
    """One worked example of each verdict that occurs: the best documented, then the one decided most clearly."""

    def merit(claim: Claim) -> tuple[bool, bool, bool, float]:
        documented = claim.get("control_margin") is not None
        return documented, bool(claim.get("study")), claim["source"] == "book", min(abs(claim["margin"] or 0.0), 0.9)

    found: dict[str, Claim] = {}
    for claim in evaluated:
        key = claim["verdict"]
        if key not in found or merit(claim) > merit(found[key]):
            found[key] = claim
    return [found[verdict] for verdict in VERDICTS if verdict in found]


def changes(old: Iterable[Claim], new: Iterable[Claim]) -> list[tuple[Any, Any]]:
    """Pairs of a claim in two runs that differ in verdict or in two digits of the margin, changed verdicts first."""
    before = {claim["id"]: claim for claim in old}
    pairs = [(before[claim["id"]], claim) for claim in new if claim["id"] in before]
    changed = [pair for pair in pairs if len({(c["verdict"], words.short_number(c["margin"])) for c in pair}) > 1]
    return sorted(changed, key=lambda pair: pair[0]["verdict"] == pair[1]["verdict"])
