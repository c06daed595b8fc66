"""What the book says about ``barrier_anatomy``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater

CLAIMS = (
    Claim(
        "C6.10",
        "6.B",
        "A larger k_2 gives a larger tracking error.",
        every(*(greater(f".{law}.k2_slope", 0.0) for law in ("printed", "feedforward"))),
        readings={
            "explicit steps on the printed 100 points, with the recorded acceleration": greater(
                ".feedforward.coarse_decades", 0.0
            ),
            "the same with the law as printed in (6.15)": greater(".printed.coarse_decades", 0.0),
        },
        no_control="it names no cause; where k_2 does not act there is nothing to compare",
        searched=(
            "three readings of the acceleration, tau of 1 s and of the segment's duration, k_2 over a decade and "
            "more, implicit steps and explicit steps on 100 points"
        ),
        where="Remark 6.6",
        note="The authors call it not conclusive. With k_n taken implicitly the error falls with k_2 (slope "
        "{.feedforward.k2_slope:.2f} in logarithms, tracking gains alone; with the barrier the tube is kept from k_2 = "
        "{.feedforward.k2_kept_from:g} on). Explicit steps on 100 points are unstable from some k_2 on: between the "
        "printed one and the largest the error grows by {.feedforward.coarse_decades:.0f} orders of magnitude.",
    ),
)
