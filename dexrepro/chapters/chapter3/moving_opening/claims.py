"""What the book says about ``moving_opening``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

MOVING = "moving_opening"

CLAIMS = (
    Claim(
        "C3.12",
        "3.16",
        "The arm follows the moving opening (Dis_R below 10 mm) and touches neither lid nor box.",
        every(less(f"{MOVING}.track.moving_distance_max", 0.01), less(f"{MOVING}.track.contact_time", 1e-3)),
        where="3.5.4",
        note="It rests on the gripper's length as C3.02 does: with most shorter ones it fails (study).",
    ),
    Claim(
        "C3.12b",
        "3.16",
        "With the tool axis left free it follows as well (Dis_R below 10 mm).",
        less(f"{MOVING}.pos.moving_distance_max", 0.01),
        source="ours",
        note="A spring of 1000 N/m drives the arm into a joint limit.",
    ),
    Claim(
        "C3.13",
        "3.16",
        "It is the null-space torque that makes it follow: without it the mean Dis_R is more than twice as large.",
        greater(f"{MOVING}.default_ratio", 2.0),
        source="ours",
        note="As with the fixed opening, the orientation rule alone does it.",
    ),
    Claim(
        "C3.13b",
        "3.16",
        "Where the tool axis is left free, the null-space torque more than halves the mean Dis_R.",
        greater(f"{MOVING}.position_ratio", 2.0),
        source="ours",
    ),
)
