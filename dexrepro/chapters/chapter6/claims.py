"""What Chapter 6 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C6.28",
        "6.D",
        "The calculation of the constrained primitive is more complex than that of [16] and [39].",
        None,
        where="6.5, point 3",
        not_testable="wall time is bound to the implementation; table T6.D counts operations instead (C6.45)",
    ),
    Claim(
        "C6.31",
        "6.13",
        "Which of the two ways to a reference is better depends on the task.",
        None,
        where="6.4.1",
        not_testable="a judgement on tasks that the book does not name",
    ),
)
