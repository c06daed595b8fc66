"""What Chapter 8 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C8.18b",
        "8.13",
        "They remain stable at 14, 35 and 38.",
        None,
        where="8.5",
        not_testable="The inputs of the networks, m and beta_1 are not printed; equal thresholds for D and G give "
        "equal counts unless their inputs differ.",
    ),
    Claim(
        "C8.20",
        "",
        "The network adapts its structure to new motions without retuning.",
        None,
        where="8.1",
        not_testable="The chapter has a single task and no number for another one.",
    ),
)
