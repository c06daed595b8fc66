"""What Chapter 7 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C7.08",
        "7.7",
        "Stiffness does not have much correspondence with the direction.",
        None,
        not_testable="the synthetic muscle has no such dependence; only recordings of people can show it",
        where="7.4.1",
    ),
    Claim(
        "C7.19b",
        "7.9",
        "They pass it where the printed coordinates, read in cm, put it.",
        None,
        source="ours",
        not_testable="the units of the coordinates are not printed; with this reading the ordinary path already clears "
        "the obstacle, and left turns into it (T7.9)",
    ),
    Claim(
        "C7.34",
        "",
        "The method realises life-long learning and copes with more complex tasks.",
        None,
        not_testable="no experiment of the chapter touches it",
        where="7.5",
    ),
)
