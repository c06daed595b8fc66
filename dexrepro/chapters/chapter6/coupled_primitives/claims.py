"""What the book says about ``coupled_primitives``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import about, every, less

ours_table_6_1 = about("T6.1", "Table 6.1", source="ours")
CLAIMS = (
    ours_table_6_1(
        "C6.46",
        "Velocity coupling [20] holds the distance of two agents the better the stronger it is; [19] improves on it.",
        every(
            less(".distance_10.size", ".distance_off.size"),
            less(".distance_50.size", ".distance_10.size"),
            less(".force_10.size", ".distance_10.size"),
            less(".force_30.size", ".force_20.size"),
        ),
        note="The error at the end is {.force_30.end_error:.2g} cm with [19], "
        "{.distance_50.end_error:.1g} cm with [20].",
    ),
    ours_table_6_1(
        "C6.47",
        "The force coupling of [17] brings the force on a surface nearer to its set value.",
        less(".surface_pi.size", ".surface_off.size", 0.5),
    ),
)
