"""What the book says about ``dartboard``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.chapters.chapter1.statements import OPERATOR
from dexrepro.claims import Claim, Predicate, Reference, about, every, greater, less, ordered


def _nobody_lower(case: str) -> Predicate:
    return every(greater(f".{case}.wins_median", 6.5), less(f".{case}.losses_median", 0.5))


fig_1_14 = about("1.14", "1.5.2.1")
CLAIMS = (
    fig_1_14(
        "C1.13",
        "A smaller scale makes the tool more precise.",
        ordered(*(f".{case}.general_radius" for case in ("scale1", "scale2", "scale3", "book", "scale6"))),
        by_construction=OPERATOR,
        note="Median distance of the hits from the centre for constant scales of 1, 2, 3, "
        "{.mappings.general.factor:g} and 6.",
    ),
    fig_1_14(
        "C1.14",
        "A larger scale gives more reach: the hand moves less for the same task.",
        ordered(*(f".{case}.general_excursion" for case in ("scale6", "book", "scale3", "scale2", "scale1"))),
        by_construction=OPERATOR,
    ),
    Claim(
        "C1.15b",
        "1.15b",
        "Near a board the operator slows down and the scale falls, between boards both rise.",
        every(less(".book.speed_near", ".book.speed_far"), less(".book.scale_near", ".book.scale_far")),
        where="1.5.2.1",
        by_construction="Minimum-jerk movements are faster where they are longer.",
    ),
    Claim(
        "C1.16",
        "1.15",
        "Of thirteen persons most score higher with the proposed mapping, and nobody lower (12 higher, 1 equal).",
        _nobody_lower("smooth"),
        control=_nobody_lower("smooth3"),
        readings={"the scale set by the unfiltered speed of the hand": _nobody_lower("book")},
        searched="a low-pass of the hand's speed, half the tremor, other seeds, other rings",
        where="1.5.2.1",
        note="The hand's speed sets the scale through a low-pass of 2 Hz: {.smooth.wins} higher, {.smooth.ties} equal, "
        "{.smooth.losses} lower of the first thirteen; judged is the median of ten panels of thirteen, "
        "{.smooth.wins_median:g} higher and {.smooth.losses_median:g} lower. Unfiltered, {.book.wins}, {.book.ties} "
        "and {.book.losses}, in the median {.book.losses_median:g} lower: the tremor alone then raises the scale while "
        "some aim. The control has the same low-pass and a general mapping with a constant scale of 3: "
        "{.smooth3.wins_median:g} higher and {.smooth3.losses_median:g} lower. The claim turns round for a smaller "
        "constant scale (T1.D), which does not match the whole workspace.",
    ),
    Claim(
        "C1.36",
        "1.15c",
        "Compared with the general mapping the adaptive scale makes teleoperation flexible: the hand moves less.",
        less(".book.proposed_excursion", ".book.general_excursion"),
        control=less(".scale2.general_excursion", ".book.general_excursion"),
        credits="the adaptive scale (1.45)",
        readings={
            "less than with a constant scale that is as precise": less(
                ".book.proposed_excursion", ".scale3.general_excursion"
            )
        },
        searched="constant scales of 1 to 6, with and without a low-pass of the hand's speed",
        where="1.5.2.1",
        note="Largest displacement of the hand: {.book.proposed_excursion:.3f} m, and {.book.general_excursion:.3f} m "
        "with the general mapping, whose scale of {.mappings.general.factor:g} is above the adaptive one's mean "
        "between boards, {.book.scale_far:.2g}; {.scale3.general_excursion:.3f} and {.scale2.general_excursion:.3f} m "
        "with constant scales of 3 and 2, between which its precision lies.",
    ),
)

REFERENCES = (
    Reference(".book.wins", 12, "1.5.2.1", "persons"),
    Reference(".book.ties", 1, "1.5.2.1", "persons"),
    Reference(".book.losses", 0, "1.5.2.1", "persons"),
)
