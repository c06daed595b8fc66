"""What the book says about ``incremental_update``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, about, every, greater, less


def cheaper(case: str, method: str) -> Predicate:
    """A fit takes fewer multiplications than the search, and its error is smaller."""
    return every(*(less(f".{case}.{part}_{method}", f".{case}.{part}") for part in ("operations", "error")))


ours_5_g = about("5.G", "Lemma 5.1", source="ours")
CLAIMS = (
    Claim(
        "C5.28",
        "5.G",
        "DMP+ requires less computation than methods based on reinforcement learning (for a smaller error, we add).",
        cheaper("search", "dmp_plus"),
        control=cheaper("search", "dmp"),
        credits="truncated kernels and local biases",
        printed=cheaper("search_printed", "dmp_plus"),
        where="5.1",
        note="The book prints no cost and no such method. Here a cross-entropy search over the weights of a plain DMP, "
        "helped by the size of the best weights: after {.search.rollouts:.0f} rollouts, {.search.operations:.1e} "
        "multiplications, its error is {.search.error:.2g} cm^2, that of DMP+ {.search.error_dmp_plus:.2g} cm^2 by "
        "{.search.operations_dmp_plus:.1e}. A plain DMP on the same {.kernels.count} kernels, the control, is cheaper "
        "still and errs by {.search.error_dmp:.2g} cm^2.",
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
