"""What the book says about ``two_nuts``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.chapters.chapter1.statements import OPERATOR
from dexrepro.claims import Claim, every, greater, less

CLAIMS = (
    Claim(
        "C1.12",
        "1.14",
        "With re-fixing a nut is turned with a comfortable hand, without it is not.",
        every(less(".proposed.outside", 0.1), greater(".general.outside", 0.9)),
        where="1.5.2.1",
        by_construction=OPERATOR,
    ),
    Claim(
        "C1.17b",
        "1.15d",
        "The load of the forearm's posture is lower with the proposed mapping for every operator.",
        less(".proposed.most_load", ".general.least_load"),
        source="ours",
        by_construction="The general mapping asks for a pronated hand in the working pose.",
    ),
)
