"""What the book says about ``planar_skill``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, about, every, greater, less, within


def crosses_old(case: str) -> Predicate:
    return every(
        greater(f".{case}.inside_share_extended_old_min", 0.0),
        *(less(f".{case}.clearance_extended_{i}_old_max", 0.0) for i in (1, 2)),
    )


fig_6_2a = about("6.2a", "6.4.1")
CLAIMS = (
    fig_6_2a(
        "C6.01",
        "The demonstrations are cut into the two sub-skills.",
        every(
            within(".book.pauses_fewest_min", 0.5, 1.5),
            within(".book.pauses_most_max", 0.5, 1.5),
            less(".book.pause_error_max", 0.3),
        ),
        by_construction="the demonstrations pause between the sub-skills, as we generate them",
        note="Pauses stand in for the book's BP-AR-HMM: where they lie and how many there are is found, in every "
        "demonstration one, within {.book.pause_error_max:.2f} s; in a sub-skill alone none. "
        "The skills are learned from the change point of a library, which is told that there is one and errs by up to "
        "{.book.segmentation_error_max:.2f} s; with a penalty in place of the number it cuts the curved "
        "strokes as well.",
    ),
    fig_6_2a(
        "C6.02",
        "The learned path collides with the new block but not with the old obstacles.",
        every(less(".book.clearance_new_max", 0.0), greater(".book.clearance_old_min", 0.0)),
        by_construction="the block was placed across the demonstrations",
    ),
    fig_6_2a(
        "C6.03",
        "The new block concerns the second sub-skill alone.",
        greater(".book.clearance_first_new_min", 1.0),
        by_construction="the block was placed across the demonstrations",
    ),
    Claim(
        "C6.04",
        "6.2b",
        "The interpolated reference clears all obstacles by more than the margin and keeps most of the learned path.",
        every(greater(".book.clearance_reference_min", 0.5), greater(".book.kept_share_min", 0.5)),
        where="6.4.1",
        by_construction="the operator's points pass the block, and the map the printed goal, by more than the margin",
        note="The reference by extended primitives clears them by {.book.clearance_extended_2_min:.2f} cm, and by "
        "{.local_intervals.clearance_extended_2_min:.2f} cm where the constraint cuts the intervals.",
    ),
    Claim(
        "C6.05",
        "6.2c",
        "The reference by extended primitives crosses the original obstacles.",
        crosses_old("book"),
        control=less(".book.clearance_reference_max", 0.0),
        readings={
            "intervals cut inside of sub-skill 2, where the constraint begins and ends": crosses_old("local_intervals")
        },
        credits="primitives that know no obstacles",
        where="6.4.1, 6.3.1",
        note="Of their points {.book.inside_share_extended_old_min:.1%} to {.book.inside_share_extended_old_max:.1%} "
        "lie inside the original obstacles alone. Step 2 of 6.3.1 divides by constraints and sub-skills; Fig. 6.2c "
        "seems to extend whole sub-skills. Cut at the constraint, extended primitives clear everything by "
        "{.local_intervals.clearance_extended_2_min:.2f} cm.",
    ),
    Claim(
        "C6.31",
        "6.2c",
        "Which of the two ways to a reference is better depends on the task: interpolation keeps clear of obstacles, "
        "an extended primitive follows a goal that moves.",
        every(
            greater(".book.clearance_reference_min", ".book.clearance_extended_2_max"),
            less(".book.moved_goal_extended_max", ".book.moved_goal_reference_min", 0.1),
        ),
        control=less(".book.acceleration_extended_max", ".book.acceleration_reference_min"),
        where="6.4.1",
        by_construction="the goal of a primitive is a parameter, fixed points know none",
        note="The book names no measure. The goal moves by {.book.moved_goal_reference_max:.1f} cm after the reference "
        "was made; the extended primitive ends {.book.moved_goal_extended_max:.3f} cm off it. By the largest "
        "acceleration, the control, extended primitives gain nothing: between whole sub-skills they need "
        "{.book.acceleration_extended_max:.0f} cm/s^2, cut at the constraint "
        "{.local_intervals.acceleration_extended_max:.0f}, the spline {.book.acceleration_reference_max:.0f}.",
    ),
)
