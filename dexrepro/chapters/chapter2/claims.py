"""What Chapter 2 claims, as predicates over measured numbers."""

from __future__ import annotations

from dexrepro.experiment import Claim, Reference, every, less

ESTIMATION = "movement_estimation"

CLAIMS = (
    Claim(
        "C2.07",
        "2.6",
        "The contact force converges to the desired force for stiffnesses of 25, 35 and 45 N/m from an estimate of 30.",
        every(*(less(f"{ESTIMATION}.k{k}.settling_time", 2.0) for k in (25, 35, 45))),
        where="2.4.1.2 Case 1",
    ),
    Claim(
        "C2.10",
        "2.7",
        "Convergence takes longer where the partner moves fast (sigma = 10 s).",
        every(
            *(less(f"{ESTIMATION}.sigma{s}.early_residual", f"{ESTIMATION}.sigma10.early_residual") for s in (30, 40))
        ),
        printed=every(
            *(
                less(f"{ESTIMATION}.printed{s}.convergence_time", f"{ESTIMATION}.printed10.convergence_time")
                for s in (30, 40)
            )
        ),
        where="2.4.1.2 Case 2",
        note="Clear with time counted from the start (10.3, 2.1 and 0.1 s to within 1 mm), weak with a window.",
    ),
)

REFERENCES: tuple[Reference, ...] = ()
