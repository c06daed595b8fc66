"""What the book says about ``incremental_update``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, about, every, greater, less

ours_5_g = about("5.G", "Lemma 5.1", source="ours")
CLAIMS = (
    Claim(
        "C5.28",
        "5.G",
        "IDMP needs less computation than methods based on reinforcement learning, for a smaller error.",
        every(less(".search.operations_idmp", ".search.operations"), less(".search.error_idmp", ".search.error")),
        control=less(".search.operations_idmp", ".search.operations_trial"),
        where="5.1",
        note="The book prints no cost and no such method. Here a cross-entropy search over the weights of a plain DMP, "
        "helped by the size of the best weights: after {.search.rollouts:.0f} rollouts its error is "
        "{.search.error:.2g} cm^2, the IDMP's {.search.error_idmp:.2g} cm^2 by {.search.operations_idmp:.1e} "
        "multiplications and no rollout. One rollout alone, the control, takes {.search.operations_trial:.1e}.",
    ),
    ours_5_g(
        "C5.36",
        "The incremental update gives the pseudo-inverse of the extended matrix whatever the rank.",
        every(*(less(f".lemma.{kind}.completed.error", 1e-8) for kind in ("independent", "dependent", "mixed"))),
    ),
    ours_5_g(
        "C5.37",
        "Updating costs less than solving anew.",
        every(greater(".cost.saving_first", 1.0), greater(".cost.saving_last", 10.0)),
        where="5.3.1",
        note="Multiplications. On nearly dependent features, those of few kernels, repeated updates drift away "
        "from the solution anew (Fig. 5.G).",
    ),
)
