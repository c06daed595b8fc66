"""What the book says about ``obstacle_tracking``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

CLAIMS = (
    Claim(
        "C5.26",
        "5.9",
        "The arm follows the generalised skills with limited errors and without conflict with the obstacle.",
        every(
            less("obstacle_tracking.largest_bound_use", 1.0),
            greater("obstacle_tracking.least_clearance", 0.0),
        ),
        printed=less("obstacle_tracking.printed.bound_use", 1.0),
        where="5.5.3",
    ),
)
