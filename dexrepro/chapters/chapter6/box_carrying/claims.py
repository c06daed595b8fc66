"""What the book says about ``box_carrying``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, greater, less


def carried(case: str) -> Predicate:
    return every(less(f".{case}.box_error_max", 2.0), greater(f".{case}.min_palm_force", 0.0))


CLAIMS = (
    Claim(
        "C6.22",
        "6.12",
        "The constrained primitives ensure that two arms carry the box stably.",
        carried("unprojected_consistent"),
        control=carried("geometry"),
        readings={
            "with the recorded acceleration (6.12)": carried("unprojected"),
            "as printed in (6.15)": carried("unprojected_printed"),
        },
        credits="the constrained primitives",
        searched="three readings of the acceleration, each without our projection",
        where="6.4.2",
        note="As C6.20, without our projection, which the book does not have: under the other two readings the law "
        "leaves its barrier and there is no path; projected, with the recorded acceleration, the box strays "
        "{.constrained.box_error_max:.2f} cm at most. The same squeeze for all paths. The control restores lengths and "
        "distance by geometry alone: {.geometry.box_error_max:.2f} cm, under the constrained primitives "
        "{.unprojected_consistent.box_error_max:.2f} cm. Along the original paths it is lost with the occlusion "
        "that we chose, and carried without ({.original_no_occlusion.box_error_max:.1f} cm); with "
        "stiff joints ({.cases.stiff.law.frequency:g} rad/s) it strays "
        "{.stiff.box_error_max:.0f} cm along the constrained paths, too.",
    ),
)
