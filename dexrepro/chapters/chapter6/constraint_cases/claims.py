"""What the book says about ``constraint_cases``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, less

CASES = "constraint_cases"
FOUR = ("asymmetric_inside", "symmetric_inside", "symmetric_outside", "asymmetric_outside")

CLAIMS = (
    Claim(
        "C6.08",
        "T6.2",
        "V^c never increases (consistent law, all four cases).",
        every(
            *(less(f"{CASES}.{case}.rising_states", 0.5) for case in FOUR),
            *(less(f"{CASES}.{case}.v_rises", 0.5) for case in FOUR),
        ),
        printed=less(f"{CASES}.asymmetric_outside_printed.rising_states", 0.5),
        where="(6.21), Table 6.2",
        note="Three cases hold as printed; the second asymmetric one needs the factor z_1 that (6.17) lacks.",
    ),
    Claim(
        "C6.13",
        "T6.2",
        "One expression of the extra term serves all constraint cases.",
        every(*(less(f"{CASES}.{case}.worst_rate", 0.0) for case in FOUR)),
        where="Remark 6.5",
        by_construction="one function computes it for all cases; only the pull and the share of the barrier differ",
    ),
)
