"""What the book says about ``obstacle_crossing``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Predicate, about, every, greater, less

CROSSING = ".default"
PRINTED_CROSSING = ".printed_damping"


def one_block_only(case: str, skill: int = 1) -> Predicate:
    own = less(f"{case}.skill{skill}.rms", 0.1)
    over = greater(f"{case}.skill{skill}.over1", 0.0)
    return every(own, over, *(less(f"{case}.skill{skill}.over{b}", 0.0) for b in (2, 3)))


def shrinks(case: str) -> Predicate:
    return every(*(greater(f"{case}.skill{b}.shrinks_always", 0.9) for b in (2, 3)))


def crosses(case: str) -> Predicate:
    return every(
        *(greater(f"{case}.skill{b}.clearance", 0.0) for b in (2, 3)),
        *(less(f"{case}.skill{b}.rms", 0.05) for b in (2, 3)),
    )


def reaches_goals(case: str, within: float = 0.05) -> Predicate:
    return every(
        *(greater(f"{case}.goals{b}.clearance", 0.0) for b in (2, 3)),
        *(less(f"{case}.goals{b}.end_error", within) for b in (2, 3)),
    )


UNCHANGED = "A path whose goal is not changed ends where it ended before, which cannot be at nine goals at once."

fig_5_8 = about("5.8", "5.5.3")
CLAIMS = (
    fig_5_8(
        "C5.21",
        "A DMP learns to cross one block; that skill does not cross two or three.",
        one_block_only(CROSSING),
        control=one_block_only(CROSSING, skill=3),
        printed=one_block_only(PRINTED_CROSSING),
        note="The control is the skill that was grown for three blocks. With the printed sign of D v the path is "
        "{.printed_damping.skill1.rms:.1f} cm from the demonstrated one.",
    ),
    fig_5_8(
        "C5.22",
        "The curves change less and less until the final one.",
        shrinks(CROSSING),
        control=shrinks(".relearn"),
        printed=shrinks(PRINTED_CROSSING),
        readings={
            "at every step of the median of the draws": every(
                *(less(f"{CROSSING}.skill{b}.largest_step", 1.0) for b in (2, 3))
            )
        },
        note="The path changes less at every step in {.default.skill2.shrinks_always:.0%} of the "
        "draws with two blocks and {.default.skill3.shrinks_always:.0%} with three.",
    ),
    fig_5_8(
        "C5.23",
        "The final skills cross two and three blocks.",
        crosses(CROSSING),
        control=every(*(greater(f"{CROSSING}.skill1.over{b}", 0.0) for b in (2, 3))),
        printed=crosses(PRINTED_CROSSING),
        note="The control is the skill they were grown from.",
    ),
    fig_5_8(
        "C5.24",
        "The generalised paths reach all nine goals without touching the obstacle.",
        reaches_goals(CROSSING),
        no_control=UNCHANGED,
        printed=reaches_goals(PRINTED_CROSSING),
        note="With a constant amplitude where start and goal agree, a known limit of the goal-scaled form; and with "
        "demonstrations that pass well clear, by our choice: with a narrow plateau the clearance is "
        "{.narrow_plateau.goals3.clearance:.2f} cm (T5.F).",
    ),
    fig_5_8(
        "C5.25",
        "The same holds with the forcing scaled by g - x0 on every axis, as printed.",
        reaches_goals(".printed_amplitude"),
        no_control=UNCHANGED,
        readings={
            "to half a centimetre, a quarter of the distance of the goals": reaches_goals(
                ".printed_amplitude", within=0.5
            )
        },
        searched="goals at the height where the demonstration ends and at that of its start, a little lower, where the "
        "amplitude vanishes; how near to the goal is there",
        where="(5.1), 5.5.3",
        note="The forcing of an axis is scaled by the difference of two heights that agree but for the hand's noise. "
        "With goals where the demonstration ends the paths clear the obstacle by "
        "{.printed_amplitude.goals3.clearance:.2f} cm and end {.printed_amplitude.goals3.end_error:.2f} cm off; "
        "sideways, where the goals differ by far more than the demonstrated start and end, they swing widely.",
    ),
)
