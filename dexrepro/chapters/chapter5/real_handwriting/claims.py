"""What people's own letters show of the claims that the book makes of one: tests of ours."""

from __future__ import annotations

from dexrepro.claims import about, greater, less

REAL, ROUGH = ".default", ".rough"

ours_5_h = about("5.H", source="ours")
CLAIMS = (
    ours_5_h(
        "C5.39",
        "IDMP before DMP+ before DMP, with 5 kernels: so on most shapes that people wrote.",
        greater(f"{REAL}.holds.C5.07", 0.8),
        control=greater(f"{REAL}.control.C5.07", 0.8),
        readings={"recordings smoothed less": greater(f"{ROUGH}.holds.C5.07", 0.8)},
        note="In more than 90 % of the draws, as C5.07 asks, on {.default.holds.C5.07:.0%} of the shapes, and in "
        "{.default.n5.ordered.least:.0%} on the worst. The control is its control: as many weights each. Smoothed at "
        "{.cases.rough.hand.cutoff:g} Hz instead of {.hand.cutoff:g} it holds on {.rough.holds.C5.07:.0%}.",
    ),
    ours_5_h(
        "C5.40",
        "IDMP before DMP+ before DMP, with 20 kernels: so on most shapes that people wrote.",
        greater(f"{REAL}.holds.C5.30", 0.8),
        control=greater(f"{REAL}.control.C5.30", 0.8),
        readings={"recordings smoothed less": greater(f"{ROUGH}.holds.C5.30", 0.8)},
        note="In more than 90 % of the draws, as C5.30 asks, on {.default.holds.C5.30:.0%} of the shapes, and in "
        "{.default.n20.ordered.least:.0%} on the worst. Smoothed at {.cases.rough.hand.cutoff:g} Hz instead of "
        "{.hand.cutoff:g} it holds on {.rough.holds.C5.30:.0%}.",
        turns="a share of shapes equals its bound, which is not more; a count is exact",
    ),
    ours_5_h(
        "C5.41",
        "With many kernels the IDMP's error is less than half of the DMP+'s on fewer than half of the shapes.",
        less(f"{REAL}.holds.C5.06", 0.5),
        control=less(f"{REAL}.holds.C5.07", 0.5),
        readings={"recordings smoothed less": less(f"{ROUGH}.holds.C5.06", 0.5)},
        note="C5.06 does not carry over to people's own letters: it holds on {.default.holds.C5.06:.0%} of the shapes; "
        "the median over the shapes is {.default.n20.idmp60.ratio.median:.2f} of the DMP+'s error, the best "
        "{.default.n20.idmp60.ratio.least:.2f}. The synthetic hand flatters. Smoothed at {.cases.rough.hand.cutoff:g} "
        "Hz instead of {.hand.cutoff:g} it holds on {.rough.holds.C5.06:.0%}. The control asks the same of C5.07.",
    ),
    ours_5_h(
        "C5.42",
        "Styles of people's own shapes are mixed pointwise, where start and goal are mixed as the weights are.",
        greater(f"{REAL}.mixed.pointwise", 0.5),
        control=greater(f"{REAL}.weights_alone.pointwise", 0.5),
        note="The control mixes the weights alone, as (5.30) prints it, between the start and goal of the first.",
    ),
)
