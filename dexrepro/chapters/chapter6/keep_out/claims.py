"""What the book says about ``keep_out``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Predicate, about, every, greater, less


def passes(*cases: str) -> Predicate:
    return every(
        *(greater(f".{case}.distance_share", 1.0) for case in cases),
        *(less(f".{case}.goal_error_worst", 0.05) for case in cases),
    )


fig_6_c = about("6.C", "6.5, point 2")
CLAIMS = (
    fig_6_c(
        "C6.30",
        "Moving obstacles are passed with a forecast, a detour as reference and a tube about it.",
        passes(*(f"moving_detour_{law}" for law in ("consistent", "printed", "feedforward"))),
        by_construction="the detour clears the forecast obstacle by the margin",
    ),
    fig_6_c(
        "C6.35",
        "With the outside constraints of Table 6.2 about an obstacle, the path converges to the goal (Remark 6.2).",
        every(
            *(
                less(f".still_{law}.goal_error", 0.2)
                for law in ("consistent", "printed", "feedforward", "printed_h2", "feedforward_h2")
            )
        ),
        no_control="it fails itself, and a primitive without constraint arrives",
        searched="three readings of the acceleration, the barrier's weight 1 and H^2, three places of the obstacle",
        where="Remark 6.2, 6.3.3",
        note="Its Lyapunov function has its infimum at infinity: the error grows like sqrt(t). Weighted by 1 the "
        "barrier is stepped over, in {.still_feedforward.stepped_over:.0f} of three runs "
        "{.still_feedforward.last_distance:.1f} cm or more before the goal, and the law is undefined from "
        "there; weighted by H^2 it is kept, and the nearest path ends {.still_feedforward_h2.goal_error:.1f} "
        "cm from the goal. The safety filter arrives. A limit of Remark 6.2, which assumes that the reference goes "
        "to the goal: an obstacle does not.",
    ),
    fig_6_c(
        "C6.50",
        "Several convex obstacles on the way are passed about one continuous reference.",
        passes("several_detour"),
        control=passes("several_alone"),
        by_construction="the detour clears every obstacle by the margin",
    ),
)
