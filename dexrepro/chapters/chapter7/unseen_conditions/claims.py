"""What the book says about ``unseen_conditions``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, about, every, less

ours_7_c = about("7.C", source="ours")
CLAIMS = (
    ours_7_c(
        "C7.23",
        "Leaving one condition out, fuzzy rules are closer than the nearest demonstration, on average.",
        less(".main.left_out_fuzzy", ".main.left_out_nearest"),
        note="On the mean: they win {.main.left_out_wins:.0f} of twelve conditions.",
    ),
    ours_7_c(
        "C7.24",
        "In unseen conditions fuzzy rules are closer than the nearest demonstration and touch less.",
        every(less(".main.unseen_fuzzy", ".main.unseen_nearest"), less(".main.touches_fuzzy", ".main.touches_nearest")),
    ),
    ours_7_c(
        "C7.24b",
        "In unseen conditions fuzzy rules are closer than a plane a direction.",
        less(".main.unseen_fuzzy", ".main.unseen_plane"),
        note="The synthetic person reacts linearly to the height, which favours the plane; it touches the obstacle in "
        "{.main.touches_plane:.0%} of the conditions (fuzzy rules {.main.touches_fuzzy:.0%}) and errs by "
        "{.main.left_out_plane:.2f} cm when a condition is left out ({.main.left_out_fuzzy:.2f}).",
    ),
    Claim(
        "C7.25",
        "7.C",
        "The fuzzy system can represent the reactions of its own rules (to 1 mm, for some width).",
        less(".narrow.rule_worst", 0.1),
        where="Remark 7.3",
        by_construction="with sets narrow enough one rule alone speaks at its centre",
        note="At the rules' own conditions only; what it does between them, C7.24 and C7.24b tell.",
    ),
    ours_7_c(
        "C7.25b",
        "It does so with the widths used here.",
        less(".main.rule_worst", 0.1),
        note="Our widths interpolate best and leak between forward and right; no width is printed.",
    ),
)
