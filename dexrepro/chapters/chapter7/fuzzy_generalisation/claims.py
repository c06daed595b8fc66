"""What the book says about ``fuzzy_generalisation``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, greater, less, ordered

PERSON = "the synthetic person reacts this way"
FUZZY = "fuzzy_generalisation"


def usable(case: str) -> Predicate:
    return every(greater(f"{FUZZY}.{case}.lateral_steps", 0), greater(f"{FUZZY}.{case}.clearance_chosen", 0))


CLAIMS = (
    Claim(
        "C7.16",
        "7.9",
        "The ordinary skill carries over to a new start and end (to 0.5 mm).",
        less(f"{FUZZY}.main.end_error", 0.05),
        printed=less(f"{FUZZY}.printed_kinematics.end_error", 0.05),
        where="7.4.2",
        note="The printed form is (7.33), T X' = V'; (7.3) and (7.12) print it without the dot.",
    ),
    Claim(
        "C7.17",
        "7.9",
        "For the medium obstacle forward and right overlap at a medium level.",
        ordered(*(f"{FUZZY}.main.separation_{h}" for h in (8, 4, 2))),
        printed=ordered(*(f"{FUZZY}.printed_sign.separation_{h}" for h in (8, 4, 2))),
        where="7.4.2",
        by_construction=f"{PERSON}, and a weighted mean lies between what it averages",
    ),
    Claim(
        "C7.18",
        "7.9",
        "The reaction to the medium obstacle lies between those to the low and the tall one.",
        greater(f"{FUZZY}.main.between_heights", 0),
        printed=greater(f"{FUZZY}.printed_sign.between_heights", 0),
        where="7.4.2",
        by_construction="a weighted mean lies between what it averages",
    ),
    Claim(
        "C7.19",
        "7.9",
        "The generalised reactions in three directions pass the obstacle.",
        greater(f"{FUZZY}.main.clearance_three", 0),
        printed=greater(f"{FUZZY}.printed_sign.clearance_three", 0),
        where="7.4.2",
        note="Obstacle on the path, by our choice; a person who lifts 1 cm less would make right touch it (T7.S).",
    ),
    Claim(
        "C7.20",
        "7.9",
        "Fuzzy sets must change along with the task.",
        greater(f"{FUZZY}.main.clearance_three", f"{FUZZY}.same_sets.clearance_three"),
        where="7.3.2",
        note="7.4.2 itself keeps the sets, because the board is the same; here this makes right touch the obstacle.",
    ),
    Claim(
        "C7.21",
        "7.9",
        "Directions in between are generated, and the chosen left-forward one is usable.",
        usable("main"),
        printed=usable("printed_sign"),
        where="7.4.2",
        note="Fragile: other widths of the direction sets make it touch the obstacle (T7.S).",
    ),
    Claim(
        "C7.21b",
        "7.9",
        "Every direction in between is usable.",
        greater(f"{FUZZY}.main.clearance_between", 0),
        source="ours",
        note="Averaging around and over gives neither; wider humps or sets avoid it (T7.S).",
    ),
    Claim(
        "C7.22",
        "7.9",
        "The generalised stiffness lies between those of the low and the tall obstacle.",
        greater(f"{FUZZY}.main.stiffness_between", 0.999),
        printed=greater(f"{FUZZY}.printed_sign.stiffness_between", 0.999),
        where="7.4.2",
        by_construction="a weighted mean lies between what it averages",
    ),
)
