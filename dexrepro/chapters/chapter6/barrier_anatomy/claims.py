"""What the book says about ``barrier_anatomy``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater

ANATOMY = "barrier_anatomy"

CLAIMS = (
    Claim(
        "C6.10",
        "6.B",
        "A larger k_2 gives a larger tracking error.",
        every(*(greater(f"{ANATOMY}.{law}.k2_slope", 0.0) for law in ("printed", "feedforward"))),
        where="Remark 6.6",
        note="The authors call it not conclusive; here the error falls with k_2 under every law and time constant.",
    ),
)
