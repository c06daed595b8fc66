"""What the book says about ``obstacle_crossing``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, greater, less

CROSSING = "obstacle_crossing.default"
PRINTED_CROSSING = "obstacle_crossing.printed_damping"


def one_block_only(case: str) -> Predicate:
    return every(
        greater(f"{case}.skill1.over1", 0.0), less(f"{case}.skill1.over2", 0.0), less(f"{case}.skill1.over3", 0.0)
    )


def settles(case: str) -> Predicate:
    return every(*(less(f"{case}.skill{b}.last_change", 0.1) for b in (2, 3)))


def crosses(case: str) -> Predicate:
    return every(
        *(greater(f"{case}.skill{b}.clearance", 0.0) for b in (2, 3)),
        *(less(f"{case}.skill{b}.rms", 0.05) for b in (2, 3)),
    )


def reaches_goals(case: str) -> Predicate:
    return every(
        *(greater(f"{case}.goals{b}.clearance", 0.0) for b in (2, 3)),
        *(less(f"{case}.goals{b}.end_error", 0.05) for b in (2, 3)),
    )


CLAIMS = (
    Claim(
        "C5.21",
        "5.8",
        "A DMP learns to cross one block; that skill does not cross two or three.",
        one_block_only(CROSSING),
        where="5.5.3",
        printed=one_block_only(PRINTED_CROSSING),
    ),
    Claim(
        "C5.22",
        "5.8",
        "The curves change less and less until the final one.",
        settles(CROSSING),
        where="5.5.3",
        printed=settles(PRINTED_CROSSING),
        note="From the first step to the last; not at every step in every draw.",
    ),
    Claim(
        "C5.23",
        "5.8",
        "The final skills cross two and three blocks.",
        crosses(CROSSING),
        where="5.5.3",
        printed=crosses(PRINTED_CROSSING),
    ),
    Claim(
        "C5.24",
        "5.8",
        "The generalised paths reach all nine goals without touching the obstacle.",
        reaches_goals(CROSSING),
        where="5.5.3",
        printed=reaches_goals(PRINTED_CROSSING),
        note="With a constant amplitude where start and goal agree, a known limit of the goal-scaled form; and with "
        "demonstrations that pass well clear, by our choice: narrow_plateau in T5.F collides, as its demonstrations "
        "nearly do. Most samples of the study fail, with a fast phase above all.",
    ),
    Claim(
        "C5.25",
        "5.8",
        "The same holds with the forcing scaled by g - x0 on every axis, as printed.",
        every(*(greater(f"obstacle_crossing.printed_amplitude.goals{b}.clearance", 0.0) for b in (2, 3))),
        where="(5.1), 5.5.3",
        note="Start and goals lie at the same height: the scale is zero there.",
    ),
)
