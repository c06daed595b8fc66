"""What the book says about ``constraint_cases``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, less

FOUR = ("asymmetric_inside", "symmetric_inside", "symmetric_outside", "asymmetric_outside")


def falls(*cases: str, measure: str = "rising_states") -> Predicate:
    return every(*(less(f".{case}.{measure}", 0.5) for case in cases))


CLAIMS = (
    Claim(
        "C6.08",
        "T6.2",
        "alpha_2, u and k_n make V^c never increase (consistent law, all four cases).",
        every(falls(*FOUR), falls(*FOUR, measure="rising_near_bound")),
        control=falls(*FOUR, measure="rising_without_share"),
        printed=falls(*FOUR[:-1], "asymmetric_outside_printed"),
        credits="k_n with its share of the barrier",
        where="(6.21), Table 6.2",
        note="dV/dt by differences at random states, {.states} for each case, and as many within a ten-thousandth of "
        "the bound. Without the barrier's share of k_n, the control, V rises at "
        "{.symmetric_inside.rising_without_share:.0f} states near the bound of the symmetric tube, two couplings taken "
        "together. Three cases hold as printed; the second asymmetric one needs the factor z_1 that (6.17) lacks.",
    ),
    Claim(
        "C6.13",
        "T6.2",
        "One expression of the extra term serves all constraint cases.",
        every(*(less(f".{case}.worst_rate", 0.0) for case in FOUR)),
        where="Remark 6.5",
        by_construction="one function computes it for all cases; only the pull and the share of the barrier differ",
    ),
)
