"""What the book says about ``style_separation``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, less


def represented(case: str, rank: int) -> Predicate:
    """Errors below the spread of repetitions, and no reaction touches its obstacle."""
    return every(less(f".{case}.mean{rank}", f".{case}.spread"), less(f".{case}.collisions{rank}", 0.5))


CLAIMS = (
    Claim(
        "C7.15",
        "7.A",
        "A common basis and a style parameter a style represent all reactions.",
        represented("per_coordinate", 1),
        control=represented("shared", 1),
        readings={
            "several style parameters, as the singular values ask for": represented("per_coordinate", 2),
            "the reactions to one obstacle, as in Fig. 7.8": represented("one_obstacle", 1),
        },
        searched="one or several style parameters, a factor a coordinate or a common one, all obstacles or one",
        where="(7.26), (7.27)",
        note="lambda_k reads as a number or a row of style parameters. One a coordinate errs by "
        "{.per_coordinate.mean1:.2g} cm (two {.per_coordinate.mean2:.2g}, one for a single obstacle "
        "{.one_obstacle.mean1:.2g}; repetitions spread by {.per_coordinate.spread:.2g} cm). That two are enough, and "
        "one for an obstacle, holds by construction: two moments of reaction, and the same hump in every direction.",
    ),
)
