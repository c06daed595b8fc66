"""What Chapter 3 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C3.21",
        "3.7",
        "The method runs in real time.",
        None,
        not_testable="Wall time depends on the machine; a control step takes about 0.2 ms here, see `make bench`.",
        where="3.1",
    ),
    Claim(
        "C3.22",
        "-",
        "The method improves on limits in joint space and on peg-in-hole methods.",
        None,
        not_testable="The chapter compares with neither.",
        where="3.1",
    ),
)
