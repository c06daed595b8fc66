"""What the book says about ``lyapunov``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import about, every, less

fig_1_10 = about("1.10", "Eq. (1.44)")
CLAIMS = (
    fig_1_10(
        "C1.06a",
        "The Lyapunov function never rises, for the law that knows the contact position.",
        every(less(".ideal.rising", 1e-9), less(".ideal_compliant.rising", 1e-9)),
        control=less(".built.rising", 1e-9),
        printed=less(".printed.rising", 1e-9),
    ),
    fig_1_10(
        "C1.06b",
        "The Lyapunov function never rises, for the law as it can be built.",
        less(".built.rising", 1e-9),
        control=less(".printed.rising", 1e-9),
        printed=less(".printed.rising", 1e-9),
        searched="perfect tracking and tracking through (1.26), smaller steps",
        note="Eq. (1.31) puts the follower's own position in place of the contact position, which the proof may not: V "
        "rises in {.built.rising:.1%} of the steps, although it ends at {.built.end:.2g} of {.built.start:.0f}.",
    ),
    fig_1_10(
        "C1.34",
        "Any positive estimator gain L is stable.",
        every(*(less(f".growth_long.growth_{gain}", 1.0) for gain in ("0p12", "0p15", "0p18", "0p2", "0p3"))),
        control=less(".growth_long.growth_m0p05", 1.0),
        printed=less(".growth_printed.growth_0p12", 1.0),
        where="1.4",
        note="Largest force error at the end against that after a third of the run, for the smallest of five gains: "
        "{.growth.growth_0p12:.2f} over a short run, in which it only grows, {.growth_long.growth_0p12:.2g} over one "
        "six times as long (E1.14). Routh's condition for the law as built about z = 0 is N (1 - k beta) < L (L + k "
        "alpha), here L > {.growth.bound:.3f}: below it the error grows before it decays. The control has a negative "
        "L; with none at all the ratio is {.growth_long.growth_0:.2g}.",
    ),
)
