"""What the book says about ``dartboard``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.chapters.chapter1.statements import OPERATOR
from dexrepro.claims import Claim, Reference, every, greater, less, ordered

CLAIMS = (
    Claim(
        "C1.13",
        "1.14",
        "A smaller scale makes the tool more precise.",
        ordered(*(f"dartboard.{case}.general_radius" for case in ("scale1", "scale2", "scale3", "book", "scale6"))),
        where="1.5.2.1",
        by_construction=OPERATOR,
        note="Median distance of the hits from the centre for constant scales of 1, 2, 3, 4.5 and 6.",
    ),
    Claim(
        "C1.14",
        "1.14",
        "A larger scale gives more reach: the hand moves less for the same task.",
        ordered(*(f"dartboard.{case}.general_excursion" for case in ("scale6", "book", "scale3", "scale2", "scale1"))),
        where="1.5.2.1",
        by_construction=OPERATOR,
    ),
    Claim(
        "C1.15b",
        "1.15b",
        "Near a board the operator slows down and the scale falls, between boards both rise.",
        every(
            less("dartboard.book.speed_near", "dartboard.book.speed_far"),
            less("dartboard.book.scale_near", "dartboard.book.scale_far"),
        ),
        where="1.5.2.1",
        by_construction="Minimum-jerk movements are faster where they are longer.",
    ),
    Claim(
        "C1.16a",
        "1.15",
        "Most of thirteen persons score higher with the proposed mapping.",
        greater("dartboard.book.wins_median", 6.5),
        where="1.5.2.1",
        note="Median over ten panels of new synthetic operators; depends on the ring width and on the constant scale "
        "of the general mapping, and turns round for a scale of 3 or less (T1.D).",
    ),
    Claim(
        "C1.16b",
        "1.15",
        "Nobody scores lower with the proposed mapping (12 higher, 1 equal).",
        less("dartboard.book.losses", 0.5),
        where="1.5.2.1",
        note="Two of the thirteen shown, 16 of the 130 of all panels. Eight of the nine whose tremor alone is faster "
        "than v_min are among them: it raises the scale while they aim.",
    ),
)

REFERENCES = (
    Reference("dartboard.book.wins", 12, "1.5.2.1", "persons"),
    Reference("dartboard.book.ties", 1, "1.5.2.1", "persons"),
    Reference("dartboard.book.losses", 0, "1.5.2.1", "persons"),
)
