"""What the book says about ``arm_obstacles``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, greater, less


def passes(case: str) -> Predicate:
    return every(*(greater(f".{case}.distance_{box}", 0.0) for box in ("first", "second", "new")))


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
        passes("constrained"),
        control=passes("original"),
        credits="the constraints",
        where="6.4.1",
        note="Fragile: inflating the box by the tool's tip instead of the wrist, or passing between box and torso, "
        "makes the arm touch (Table T6.Sc).",
    ),
)
