"""What a reader who implements Chapter 2 must know beyond the printed equations."""

from __future__ import annotations

from dexrepro.experiment import Erratum

ESTIMATION = "movement_estimation"

ERRATA = (
    Erratum(
        "E2.05",
        "Fig. 2.7, text",
        "reading",
        "Once the force is the desired one, the estimated rest position keeps the offset f_d (1/khat - 1/k_o), because "
        "nothing then excites the stiffness estimate; the text names the condition (a desired force close to 0), not "
        "the value used.",
        "The error converges to this offset; to zero only for khat = k_o or f_d -> 0.",
        evidence=tuple(
            f"{ESTIMATION}.{case}.{metric}"
            for case in ("sigma30", "light30")
            for metric in ("estimation_error", "predicted_offset")
        ),
    ),
)
