"""What the book says about ``incremental_update``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

UPDATE = "incremental_update"

CLAIMS = (
    Claim(
        "C5.36",
        "5.G",
        "The incremental update gives the pseudo-inverse of the extended matrix whatever the rank.",
        every(
            *(less(f"{UPDATE}.lemma.{kind}.completed.error", 1e-8) for kind in ("independent", "dependent", "mixed"))
        ),
        source="ours",
        where="Lemma 5.1",
    ),
    Claim(
        "C5.37",
        "5.G",
        "Updating costs less than solving anew.",
        every(greater(f"{UPDATE}.cost.saving_first", 1.0), greater(f"{UPDATE}.cost.saving_last", 10.0)),
        source="ours",
        where="5.3.1",
        note="Multiplications. On nearly dependent features repeated updates drift: with 5 kernels after about 20.",
    ),
)
