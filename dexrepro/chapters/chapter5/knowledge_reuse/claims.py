"""What the book says about ``knowledge_reuse``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.chapters.chapter5.statements import TARGETS
from dexrepro.claims import Claim, Predicate, every, less

REUSE = "knowledge_reuse"


def begins_better(case: str) -> Predicate:
    return every(*(less(f"{REUSE}.{case}.{letter}.early", f"{REUSE}.anew.{letter}.early") for letter in TARGETS))


CLAIMS = (
    Claim(
        "C5.20",
        "5.E",
        "Learned weights can be accumulated and reused: later letters begin with smaller errors.",
        begins_better("kept"),
        where="5.4.2, 5.5.4",
        printed=begins_better("printed_sign"),
        note="One order of letters, and an adaptation gain chosen slow enough for the start of a letter to show it: a "
        "fifth of the gain used elsewhere.",
    ),
)
