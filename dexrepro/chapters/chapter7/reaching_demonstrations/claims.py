"""What the book says about ``reaching_demonstrations``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import about, every, greater, less

PERSON = "the synthetic person reacts this way"
MUSCLE = "the synthetic muscle stiffens this way"
DEMONSTRATIONS = ".corrected"
PRINTED_SIGN = ".printed_sign"

fig_7_6 = about("7.6", "7.4.1")
fig_7_7 = about("7.7", "7.4.1")
CLAIMS = (
    fig_7_6(
        "C7.01",
        "The primitive extracts the ordinary motion from the demonstrations (to 1 mm).",
        every(less(f"{DEMONSTRATIONS}.ordinary_rmse", 0.1), less(f"{DEMONSTRATIONS}.ordinary_end_error", 0.05)),
        printed=every(less(f"{PRINTED_SIGN}.ordinary_rmse", 0.1), less(f"{PRINTED_SIGN}.ordinary_end_error", 0.05)),
        no_control="least squares on a smooth curve: only a fit of another equation, the printed one, fails",
    ),
    fig_7_6(
        "C7.02",
        "The primitive extracts the ordinary stiffness (to 5 %).",
        less(f"{DEMONSTRATIONS}.stiffness_rmse", 0.05),
        printed=less(f"{PRINTED_SIGN}.stiffness_rmse", 0.05),
        no_control="least squares on a smooth curve: only a fit of another equation, the printed one, fails",
    ),
    fig_7_6(
        "C7.03",
        "For the low obstacle the trajectories are easy to distinguish by direction.",
        every(greater(f"{DEMONSTRATIONS}.separation_far_low", 4), greater(f"{DEMONSTRATIONS}.separation_close_low", 4)),
        by_construction=PERSON,
    ),
    fig_7_6(
        "C7.04",
        "For the tall obstacle forward and right override each other.",
        every(
            *(
                less(f"{DEMONSTRATIONS}.separation_{d}_tall", bound)
                for d in ("far", "close")
                for bound in (4, f"{DEMONSTRATIONS}.separation_{d}_low")
            )
        ),
        by_construction=PERSON,
    ),
    fig_7_7(
        "C7.05",
        "Stiffness increases with the height of the obstacle.",
        greater(f"{DEMONSTRATIONS}.final_ratio", 1.5),
        by_construction=MUSCLE,
    ),
    fig_7_7(
        "C7.06",
        "With a closer obstacle stiffness rises earlier.",
        every(
            *(
                less(f"{DEMONSTRATIONS}.half_rise_close_{h}", f"{DEMONSTRATIONS}.half_rise_far_{h}")
                for h in ("low", "tall")
            )
        ),
        by_construction=MUSCLE,
    ),
    fig_7_7(
        "C7.07",
        "The final stiffness is similar for both distances (within 10 %).",
        less(f"{DEMONSTRATIONS}.final_difference", 0.1),
        by_construction=MUSCLE,
    ),
    fig_7_7(
        "C7.08",
        "Stiffness does not have much correspondence with the direction (within 10 %).",
        less(f"{DEMONSTRATIONS}.direction_spread", 0.1),
        by_construction="the synthetic muscle has no such dependence; only recordings of people can show it",
    ),
    fig_7_7(
        "C7.09",
        "The distance changes the speed of the rise only a little (within 25 %).",
        less(f"{DEMONSTRATIONS}.slope_difference", 0.25),
        by_construction=MUSCLE,
    ),
)
