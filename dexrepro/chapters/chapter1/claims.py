"""What Chapter 1 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C1.17",
        "1.15d",
        "All thirteen persons felt fatigue with the general mapping and none with the proposed one.",
        None,
        not_testable="Fatigue and comfort are felt by people; only a load of the forearm's posture is computed here.",
        where="1.5.2.1",
    ),
)
