"""What Chapter 5 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C5.28",
        "5.8",
        "IDMP needs less computation than methods based on reinforcement learning.",
        None,
        where="5.1",
        not_testable="The book compares with no such method and prints no cost.",
    ),
)
