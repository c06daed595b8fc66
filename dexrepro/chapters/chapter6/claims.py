"""What Chapter 6 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C6.31",
        "6.13",
        "Which of the two ways to a reference is better depends on the task.",
        None,
        where="6.4.1",
        not_testable="a judgement on tasks that the book does not name",
    ),
)
