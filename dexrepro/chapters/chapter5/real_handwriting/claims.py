"""What people's own letters show of the claims that the book makes of one: tests of ours."""

from __future__ import annotations

from dexrepro.claims import Claim, greater, less

REAL = "real_handwriting.default"

CLAIMS = (
    Claim(
        "C5.39",
        "5.H",
        "IDMP before DMP+ before DMP, with 5 kernels: so on most shapes that people wrote.",
        greater(f"{REAL}.holds.C5.07", 0.8),
        source="ours",
        control=greater(f"{REAL}.control.C5.07", 0.8),
        note="In more than 90 % of the draws, as C5.07 asks, on {real_handwriting.default.holds.C5.07:.0%} of the "
        "shapes, and in {real_handwriting.default.n5.ordered.least:.0%} on the worst. The control is its control: as "
        "many weights each.",
    ),
    Claim(
        "C5.40",
        "5.H",
        "IDMP before DMP+ before DMP, with 20 kernels: so on most shapes that people wrote.",
        greater(f"{REAL}.holds.C5.30", 0.8),
        source="ours",
        control=greater(f"{REAL}.control.C5.30", 0.8),
        note="In more than 90 % of the draws, as C5.30 asks, on {real_handwriting.default.holds.C5.30:.0%} of the "
        "shapes, and in {real_handwriting.default.n20.ordered.least:.0%} on the worst.",
    ),
    Claim(
        "C5.41",
        "5.H",
        "With 20 kernels the IDMP's error is less than half of the DMP+'s on fewer than half of the shapes.",
        less(f"{REAL}.holds.C5.06", 0.5),
        source="ours",
        control=less(f"{REAL}.holds.C5.07", 0.5),
        note="C5.06 does not carry over to people's own letters: it holds on "
        "{real_handwriting.default.holds.C5.06:.0%} of the shapes; the median over the shapes is "
        "{real_handwriting.default.n20.idmp60.ratio.median:.2f} of the DMP+'s error, the best "
        "{real_handwriting.default.n20.idmp60.ratio.least:.2f}. The synthetic hand flatters. The control asks the same "
        "of C5.07.",
    ),
    Claim(
        "C5.42",
        "5.H",
        "Styles of people's own shapes are mixed pointwise, where start and goal are mixed as the weights are.",
        greater(f"{REAL}.mixed.pointwise", 0.5),
        source="ours",
        control=greater(f"{REAL}.weights_alone.pointwise", 0.5),
        note="The control mixes the weights alone, as (5.30) prints it, between the start and goal of the first.",
    ),
)
