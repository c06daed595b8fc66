"""What the book says about ``style_separation``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, less

STYLES = "style_separation"


def represented(case: str, rank: int) -> Predicate:
    """Errors below the spread of repetitions, and no reaction touches its obstacle."""
    return every(
        less(f"{STYLES}.{case}.mean{rank}", f"{STYLES}.{case}.spread"),
        less(f"{STYLES}.{case}.collisions{rank}", 0.5),
    )


CLAIMS = (
    Claim(
        "C7.15",
        "7.A",
        "One style parameter a style represents all reactions (scalar reading of (7.26)).",
        represented("per_coordinate", 1),
        where="(7.26)",
        note="Reactions at two places on the path are not multiples of one curve, whoever demonstrates them.",
    ),
    Claim(
        "C7.15a",
        "7.A",
        "A common basis and style parameters from the singular values represent all reactions.",
        represented("per_coordinate", 2),
        printed=represented("printed_sign", 2),
        by_construction="two moments of reaction make two components a coordinate; expect 3 to 4 for people",
        where="(7.26), (7.27)",
        note="Vector reading of lambda_k.",
    ),
    Claim(
        "C7.15b",
        "7.A",
        "For one obstacle a single style parameter of each coordinate is enough.",
        represented("one_obstacle", 1),
        source="ours",
        by_construction="every direction reacts with the same hump",
    ),
)
