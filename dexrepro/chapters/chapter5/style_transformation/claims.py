"""What the book says about ``style_transformation``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.chapters.chapter5.statements import TARGETS
from dexrepro.claims import Claim, Predicate, every, greater, within

STYLES = "style_transformation.default"
PRINTED_STYLES = "style_transformation.printed_damping"


def leaves_base(case: str) -> Predicate:
    return every(*(greater(f"{case}.{letter}.leaves_base", 0.9) for letter in TARGETS))


def distinct(case: str) -> Predicate:
    return every(
        *(greater(f"{case}.{letter}.distinct", 0.99) for letter in TARGETS),
        *(greater(f"{case}.{letter}.margin", 5.0) for letter in TARGETS),
    )


def small_difference(case: str) -> Predicate:
    return every(*(within(f"{case}.{letter}.final", 0.004, 0.2) for letter in TARGETS))


CLAIMS = (
    Claim(
        "C5.11",
        "5.6",
        "The shapes move gradually from a to the target as features are added.",
        every(
            *(
                predicate
                for letter in TARGETS
                for predicate in (
                    greater(f"{STYLES}.{letter}.approaches", 0.9),
                    greater(f"{STYLES}.{letter}.first_step", 0.3),
                )
            )
        ),
        where="5.5.2",
        printed=every(*(greater(f"style_transformation.printed_start.{letter}.approaches", 0.9) for letter in TARGETS)),
        note="With the weights of the new features alone, as Algorithm 5.1 allows, and 25 kernels, chosen for a "
        "gradual change. (5.29) as a whole, its start corrected, jumps to the target with the first five features; as "
        "printed it leads away from it.",
    ),
    Claim(
        "C5.12",
        "5.6",
        "Shapes near the centre resemble a more.",
        leaves_base(STYLES),
        where="5.5.2",
        printed=leaves_base(PRINTED_STYLES),
        note="At every step in every draw with 25 kernels; with 15, 20 or 30 up to a third of the draws come nearer to "
        "a once (T5.D).",
    ),
    Claim(
        "C5.13",
        "5.6",
        "After 30 added features the letters are clearly distinguishable.",
        distinct(STYLES),
        where="5.5.2",
        printed=distinct(PRINTED_STYLES),
    ),
    Claim(
        "C5.15",
        "5.6",
        "Small differences to the demonstrations remain after 30 features.",
        small_difference(STYLES),
        where="5.5.2",
        printed=small_difference(PRINTED_STYLES),
        note="Between 0.1 and 5 % of the size with 25 kernels, up to 14 % with 40. The book's cause, a compromise "
        "between letters, is not the one here: each letter's weights are fitted on their own; the features are random "
        "and too few.",
    ),
    Claim(
        "C5.16",
        "5.B",
        "Interpolated weights pass smoothly from one style to the other.",
        greater(f"{STYLES}.mixed_pointwise", 0.5),
        where="Remark 5.3",
        by_construction="a primitive is linear in its weights",
        note="An identity: the path is the pointwise mixture of the two paths.",
    ),
    Claim(
        "C5.17",
        "5.6",
        "The old skill is preserved and can be recovered by taking the new terms away.",
        greater(f"{STYLES}.recovered", 0.5),
        where="5.1 (a), 5.3.1",
        by_construction="old and new weights are stored apart",
    ),
)
