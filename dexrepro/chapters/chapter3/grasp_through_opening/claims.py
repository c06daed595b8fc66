"""What the book says about ``grasp_through_opening``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater

PICKS = "grasp_through_opening"

CLAIMS = (
    Claim(
        "C3.23",
        "3.D",
        "Camera, classifier and motion together grasp and lift objects through the opening in most scenes, and in more "
        "of them than with random grasps.",
        every(greater(f"{PICKS}.chosen.success", 0.5), greater(f"{PICKS}.success_gain", 0.0)),
        by_construction="an object counts as held where the rule that made the classifier's training labels finds the "
        "grasp no bad one",
        where="3.5, 3.6",
        note="The 95 % interval of the former (Fig. 3.D) does not exclude half. The number "
        "of proposals was raised to 200 because 40 left scenes without a good one. The book shows single grasps and no "
        "rate of success. Closing is modelled as a rigid hold.",
    ),
)
