"""What the book says about ``obstacle_tracking``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, greater, less


def follows(*cases: str) -> Predicate:
    return every(
        *(less(f".{case}.bound_use", 1.0) for case in cases), *(greater(f".{case}.clearance", 0.0) for case in cases)
    )


CLAIMS = (
    Claim(
        "C5.26",
        "5.9",
        "Under the adaptive controller the arm follows the generalised skills with limited errors and without conflict "
        "with the obstacle.",
        every(less(".largest_bound_use", 1.0), greater(".least_clearance", 0.0)),
        control=follows(*(f"pd_{blocks}_{goal}" for blocks in ("two", "three") for goal in range(9))),
        printed=follows("printed"),
        credits="the adaptive neural law and its barrier",
        where="5.5.3",
        note="The control is PD control with gravity compensation as tuned for the letters, along the same "
        "crossings. To the farthest goal it uses {.pd_three_8.bound_use:.0%} of the bound, the law "
        "{.three_8.bound_use:.0%}, which is the initial error; the pen errs by {.pd_three_8.tip_rms:.2f} against "
        "{.three_8.tip_rms:.2f} mm.",
    ),
)
