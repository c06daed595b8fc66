"""What the book says about ``hand_over``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

CLAIMS = (
    Claim(
        "C1.35",
        "1.16e",
        "A latch hands over from the field to the force law once, where a bare comparison chatters.",
        every(less(".latched.switches", 1.5), greater(".bare.switches", 10.0)),
        source="ours",
    ),
)
