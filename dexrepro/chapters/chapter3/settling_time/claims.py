"""What the book says about ``settling_time``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, less

SETTLING = "settling_time"

CLAIMS = (
    Claim(
        "C3.14",
        "3.A",
        "The settling time is bounded by T_max whatever the first error, from 0.01 rad to 10 rad.",
        less(f"{SETTLING}.printed.settling_max", f"{SETTLING}.printed.bound"),
        printed=less(f"{SETTLING}.printed.settling_max", f"{SETTLING}.printed.bound_printed"),
        where="3.3.3",
        note="The bound is loose by more than a factor of ten, corrected or printed.",
    ),
    Claim(
        "C3.15",
        "3.A",
        "The fractional and superlinear terms shorten the settling (from 0.1 rad and from 1 rad).",
        every(
            less(f"{SETTLING}.printed.settling_0p1", f"{SETTLING}.linear.settling_0p1"),
            less(f"{SETTLING}.printed.settling_1", f"{SETTLING}.linear.settling_1"),
        ),
        where="3.2.3",
        note="By about a third with the printed gains, in which the linear terms dominate.",
    ),
    Claim(
        "C3.15b",
        "3.A",
        "With K11 and K21 tuned for both laws (25 pairs each, same torque allowed) the law with the terms in SIG still "
        "settles sooner from 1 rad.",
        less(f"{SETTLING}.tuned.settling_1", f"{SETTLING}.tuned_linear.settling_1"),
        source="ours",
    ),
    Claim(
        "C3.18",
        "3.A",
        "The Lyapunov function does not grow along the error dynamics.",
        less(f"{SETTLING}.printed.growth", 1e-6),
        where="3.3.3",
    ),
)
