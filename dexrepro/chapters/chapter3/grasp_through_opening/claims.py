"""What the book says about ``grasp_through_opening``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater

CLAIMS = (
    Claim(
        "C3.23",
        "3.D",
        "Camera, classifier and motion together grasp and lift objects through the opening in most scenes, and in more "
        "of them than with random grasps.",
        every(greater(".chosen.success", 0.5), greater(".success_gain", 0.0)),
        control=greater(".random.success", 0.5),
        where="3.5, 3.6",
        note="{.chosen.lifted} of {.chosen.trials} scenes, with random grasps (control) {.random.lifted}; the 95 % "
        "interval of the former begins at {.chosen.success_low:.0%}. What an object's rise between two closing fingers "
        "shows, by contact and friction, counts as held; it is then carried out as if fixed to the hand. The number of "
        "proposals was raised because a fifth as many left scenes without a good one. The book shows single grasps and "
        "no rate of success.",
    ),
)
