"""What Chapter 4 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C4.27",
        "4.12",
        "The measured error curves of the real robot.",
        None,
        where="4.6",
        not_testable="they belong to one physical robot and its payload; axes without readable numbers",
    ),
)
