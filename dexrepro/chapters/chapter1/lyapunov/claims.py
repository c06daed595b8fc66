"""What the book says about ``lyapunov``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, less

CLAIMS = (
    Claim(
        "C1.06a",
        "1.10",
        "The Lyapunov function never rises, for the law that knows the contact position.",
        every(less("lyapunov.ideal.rising", 1e-9), less("lyapunov.ideal_compliant.rising", 1e-9)),
        printed=less("lyapunov.printed.rising", 1e-9),
        where="Eq. (1.44)",
    ),
    Claim(
        "C1.06b",
        "1.10",
        "The Lyapunov function never rises, for the law as it can be built.",
        less("lyapunov.built.rising", 1e-9),
        where="Eq. (1.44)",
        note="Eq. (1.31) puts the follower's own position in place of the contact position, which the proof may not.",
    ),
    Claim(
        "C1.34",
        "1.10",
        "Any positive estimator gain L is stable.",
        less("lyapunov.growth.growth_0p12", 1.0),
        where="1.4",
        note="Routh's condition for the law as built is N (1 - k beta) < L (L + k alpha), here L > 0.175.",
    ),
)
