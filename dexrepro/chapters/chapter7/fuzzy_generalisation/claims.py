"""What the book says about ``fuzzy_generalisation``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, about, every, greater, less, ordered

PERSON = "the synthetic person reacts this way"


def passes(*cases: str) -> Predicate:
    return every(*(greater(f".{case}.clearance_three", 0) for case in cases))


def rescaled(case: str, kept: str) -> Predicate:
    """Sets that change with the task pass the obstacle, and by more than those that are kept."""
    return every(passes(case), greater(f".{case}.clearance_three", f".{kept}.clearance_three"))


def usable(*cases: str) -> Predicate:
    return every(*(greater(f".{case}.{part}", 0) for case in cases for part in ("lateral_steps", "clearance_chosen")))


ORDINARY = greater(".main.ordinary_clearance", 0)
AS_READ = "obstacle at the printed (10, 5), read in cm"


fig_7_9 = about("7.9", "7.4.2")
CLAIMS = (
    fig_7_9(
        "C7.16",
        "The ordinary skill carries over to a new start and end (to 0.5 mm).",
        less(".main.end_error", 0.05),
        printed=less(".printed_kinematics.end_error", 0.05),
        no_control="the attractor ends at its goal whatever is learned: only an equation that is wrong can miss it",
        note="The printed form is (7.33), T X' = V'; (7.3) and (7.12) print it without the dot.",
    ),
    fig_7_9(
        "C7.17",
        "For the medium obstacle forward and right overlap at a medium level.",
        ordered(*(f".main.separation_{h}" for h in (8, 4, 2))),
        printed=ordered(*(f".printed_sign.separation_{h}" for h in (8, 4, 2))),
        by_construction=f"{PERSON}, and a weighted mean lies between what it averages",
    ),
    fig_7_9(
        "C7.18",
        "The reaction to the medium obstacle lies between those to the low and the tall one.",
        greater(".main.between_heights", 0),
        printed=greater(".printed_sign.between_heights", 0),
        by_construction="a weighted mean lies between what it averages",
    ),
    fig_7_9(
        "C7.19",
        "The generalised reactions in three directions pass the obstacle.",
        passes("main"),
        control=ORDINARY,
        printed=passes("printed_sign", "printed_kinematics"),
        readings={"the fuzzy sets kept, as 7.4.2 says": passes("same_sets"), AS_READ: passes("as_read")},
        note="Smallest clearance {.main.clearance_three:.2f} cm with the obstacle on the path, "
        "our choice, and the sets rescaled, as 7.3.2 says; {.same_sets.clearance_three:.2f} cm "
        "with the sets kept. Where the printed coordinates, read in cm, put it the ordinary path clears it already "
        "(by {.as_read.ordinary_clearance:.2f} cm) and left turns into it. With a person who "
        "lifts 1 cm less the clearance is {.lower_lift.clearance_three:.2f} cm (T7.S).",
    ),
    fig_7_9(
        "C7.20",
        "Fuzzy sets must change along with the task.",
        rescaled("main", "same_sets"),
        control=passes("same_sets"),
        printed=passes("printed_sign", "printed_kinematics"),
        readings={AS_READ: rescaled("as_read", "as_read_same_sets")},
        where="7.3.2",
        note="7.4.2 itself keeps the sets, because the board is the same; here this lowers the clearance from "
        "{.main.clearance_three:.2f} to {.same_sets.clearance_three:.2f} cm. Where the printed coordinates, read in "
        "cm, put the obstacle, it raises it from {.as_read.clearance_three:.2f} to "
        "{.as_read_same_sets.clearance_three:.2f} cm.",
    ),
    fig_7_9(
        "C7.21",
        "Directions in between are generated, and the chosen left-forward one is usable.",
        usable("main"),
        control=ORDINARY,
        printed=usable("printed_sign", "printed_kinematics"),
        readings={"the fuzzy sets kept, as 7.4.2 says": usable("same_sets"), AS_READ: usable("as_read")},
        note="Other widths of the direction sets may make it touch the obstacle (T7.S).",
    ),
    Claim(
        "C7.21b",
        "7.9",
        "Every direction in between is usable.",
        greater(".main.clearance_between", 0),
        source="ours",
        note="{.main.clearance_between:.2f} cm at worst: averaging around and over gives neither. Wider humps or sets "
        "leave {.wide_reaction.clearance_between:.2f} and {.wide_sets.clearance_between:.2f} cm.",
    ),
    fig_7_9(
        "C7.22",
        "The generalised stiffness lies between those of the low and the tall obstacle.",
        greater(".main.stiffness_between", 0.99),
        printed=greater(".printed_sign.stiffness_between", 0.99),
        by_construction="a weighted mean lies between what it averages",
    ),
)
