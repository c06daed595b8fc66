"""What the book says about ``box_carrying``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

BOX = "box_carrying"

CLAIMS = (
    Claim(
        "C6.22",
        "6.12",
        "Two arms carry the box stably along the constrained paths, and lose it along the original ones.",
        every(
            less(f"{BOX}.constrained.box_error_max", 2.0),
            greater(f"{BOX}.constrained.min_palm_force", 0.0),
            less(f"{BOX}.original.carried", 0.5),
        ),
        where="6.4.2",
        note="The same squeeze for both; with stiff joints (45 rad/s) the constrained paths lose it as well.",
    ),
)
