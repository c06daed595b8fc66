"""What the book says about ``growth_cost``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, less

CLAIMS = (
    Claim(
        "C4.24",
        "4.A",
        "Fewer nodes make the control step cheaper.",
        every(
            less(".growing.multiplications_72", ".lattice.multiplications"),
            less(".growing.memory_kb_72", ".lattice.memory_kb"),
        ),
        where="4.6",
        by_construction="arithmetic and memory follow from the numbers of nodes",
        note="Times are in Table T4.D. Evaluated as a product the fixed network also fits into 1 ms.",
    ),
)
