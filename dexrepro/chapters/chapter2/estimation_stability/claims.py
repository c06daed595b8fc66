"""What the book says about ``estimation_stability``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, less, within

CLAIMS = (
    Claim(
        "C2.27",
        "2.B",
        "dV <= 0 under (2.16): V decreases as long as there is a prediction error.",
        every(less(".lyapunov.largest_rise", 1e-12), within(".lyapunov.decrement_ratio", 0.99, 1.01)),
        no_control="An identity of (2.16); beyond the step limit of an explicit step the runs of E2.02 diverge.",
        where="2.3.2",
        note="For constant parameters and a bounded regressor; an explicit step adds the limit dt sum(g_j Y_j^2) < 2 "
        "(E2.02).",
    ),
    Claim(
        "C2.28",
        "2.B",
        "The reference (2.31) makes the steady-state force error vanish.",
        less(".reference.largest_error", 1e-6),
        where="2.3.3",
        by_construction="(2.31) is what (2.30) = 0 gives; an exact arm of impedance (2.25) confirms it",
    ),
)
