"""What the book says about ``sensitivity``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.chapters.chapter1.statements import CASES
from dexrepro.claims import Claim, Predicate, about, every, greater, less


def _mostly(law: str) -> Predicate:
    return every(*(greater(f".tracking.best_{law}{case}", 0.5) for case in CASES))


ours_1_10 = about("1.10", source="ours")
CLAIMS = (
    Claim(
        "C1.02",
        "1.10",
        "It has the smallest error of the three during most of the time.",
        _mostly(""),
        control=_mostly("proportional_"),
        printed=_mostly("printed_"),
        where="1.5.1",
        note="Counted on the holding line without arms. Without its weights the law has the smallest error as often: "
        "{.tracking.best_proportional_c1:.0%} of the time in case 1, with them "
        "{.tracking.best_c1:.0%}. With the printed definition of e_f (E1.10) contact is lost at once.",
    ),
    ours_1_10(
        "C1.26",
        "The autoregressive part improves the force after the transient.",
        every(*(less(f".tracking.proposed_late{k}", f".tracking.proportional_late{k}") for k in (1, 2, 3))),
        note="Against the same law without weights; over the whole run it does not help in cases 1 and 2.",
    ),
    ours_1_10(
        "C1.29",
        "The win over the force controller does not come from its smaller gain.",
        every(*(less(f".tracking.equal_c{k}", f".tracking.force_c{k}") for k in (1, 2, 3))),
        note="Both at 0.05 m/(s N): the whole-run error of cases 1 and 2 is then smaller with the force controller.",
    ),
)
