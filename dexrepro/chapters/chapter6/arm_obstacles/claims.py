"""What the book says about ``arm_obstacles``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, greater, less


def passes(case: str) -> Predicate:
    """The whole arm keeps clear of every box and arrives, to 1 cm: an arm that stops on the way has passed none."""
    clear = (greater(f".{case}.distance_{box}", 0.0) for box in ("first", "second", "new"))
    return every(*clear, less(f".{case}.goal_error", 0.01))


CLAIMS = (
    Claim(
        "C6.16",
        "6.4",
        "The arm on the original path hits the new box.",
        less(".original.distance_new", 0.0),
        where="6.4.1",
        by_construction="the box was placed across the path",
    ),
    Claim(
        "C6.17",
        "6.5",
        "The arm on the constrained path passes all boxes.",
        passes("unprojected_consistent"),
        control=passes("original"),
        readings={
            "with the recorded acceleration (6.12)": passes("unprojected"),
            "as printed in (6.15)": passes("unprojected_printed"),
        },
        credits="the constraints",
        searched="three readings of the acceleration, each without our projection",
        where="6.4.1",
        note="Without our projection, which the book does not have. Under the other two readings the law leaves its "
        "barrier on the way, from where on there is no path, and the arm ends {.unprojected.goal_error:.2f} m off the "
        "goal; projected, with the recorded acceleration, it passes the new box by {.constrained.distance_new:.3f} m "
        "and arrives. Fragile: inflating the box by the tool's tip instead of the wrist, or passing between box and "
        "torso, makes the arm touch (Table T6.Sc).",
    ),
)
