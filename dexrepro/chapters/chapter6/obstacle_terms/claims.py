"""What the book says about ``obstacle_terms``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Predicate, about, every, greater, less

STEERING = ("centroid", "closest", "boundary")


def blocked(measure: str, *methods: str, widths: tuple[int, ...] = (20, 30)) -> Predicate:
    return every(*(less(f".{name}.bars_{measure}_{width}mm", 2.5) for name in methods for width in widths))


def dearer(than: str, operations: str = "operations") -> Predicate:
    return greater(f".constrained.{operations}", f".{than}")


fig_6_d = about("6.D", "6.5, point 1")
ours_6_d = about("6.D", "6.5, point 2", source="ours")
CLAIMS = (
    fig_6_d(
        "C6.25",
        "The steering term of [16] has a dead zone around a head-on approach.",
        less(".centroid.aligned_distance", 0.1),
        control=less(".potential.aligned_distance", 0.1),
        readings={"offsets of a millionth of a centimetre and more": less(".centroid.nearly_aligned_distance", 0.1)},
        note="For exact alignment with a point only: from an offset of a millionth of a centimetre on the path passes "
        "at {.centroid.nearly_aligned_distance:.2f} cm. The potential of [39], the control, keeps "
        "{.potential.aligned_distance:.2f} cm off even an aligned point.",
    ),
    fig_6_d(
        "C6.26",
        "The reaction of the steering term fades as the heading narrows towards the obstacle.",
        less(".steering_at_001", ".steering_peak", 0.25),
        by_construction="an identity: phi exp(-beta phi) vanishes with phi",
    ),
    fig_6_d(
        "C6.27",
        "The methods of [16] and [39] do not suit non-point obstacles (bars of a half-width of 2 cm or more).",
        blocked("passed", *STEERING, "potential"),
        control=blocked("passed", *STEERING, widths=(3,)),
        readings={"the best of 20 settings each": blocked("tuned", *STEERING, "potential", widths=(20,))},
        searched="three representations of the obstacle for [16], the closest point for [39], 20 settings each",
        where="6.5, point 2",
        note="A bar is passed by a path that arrives. Of five with a half-width of 2 cm [16] passes up to "
        "{.boundary.bars_passed_20mm:.0f} with its authors' parameters and {.boundary.bars_tuned_20mm:.0f} with the "
        "best of 20 settings (boundary points; the centroid {.centroid.bars_tuned_20mm:.0f}); [39] stops before them "
        "({.potential.bars_tuned_20mm:.0f}). The control has the narrowest bars.",
    ),
    fig_6_d(
        "C6.28",
        "The calculation of the constrained primitive is more complex than that of [16] and [39].",
        every(dearer("centroid.operations"), dearer("potential.operations")),
        control=every(
            dearer("centroid.operations", "operations_primitive"),
            dearer("potential.operations", "operations_primitive"),
        ),
        readings={
            "[16] and [39] about a single point": every(
                dearer("centroid.operations"), dearer("potential.operations_point")
            ),
            "[16] about 30 boundary points": dearer("boundary.operations"),
        },
        credits="the calculation in (6.14)",
        searched="one point, the closest point and 30 boundary points for [16], one point and the closest point for "
        "[39]",
        where="6.5, point 3",
        note="Operations a step, reference and nominal path included: {.constrained.operations:.0f}; "
        "[16] {.centroid.operations:.0f} about one point and {.boundary.operations:.0f} "
        "about 30; [39], whose gradient is taken by differences, {.potential.operations_point:.0f} "
        "about one point and {.potential.operations:.0f} about the closest one.",
    ),
    fig_6_d(
        "C6.29",
        "A bound of the measurement noise can be added to the margin.",
        every(less(".constrained.noise_excess", 0.0), greater(".constrained.noise_clearance", 0.0)),
        where="6.5, point 3",
        by_construction="the triangle inequality: the margin is kept about a reference that errs by the noise at most",
    ),
    ours_6_d(
        "C6.43",
        "Tuned over 20 settings, steering passes the triangle with every representation of it.",
        every(*(greater(f".{name}.tuned_clearance", 0.0) for name in ("centroid", "closest", "boundary"))),
    ),
    ours_6_d(
        "C6.44",
        "The dynamic potential of [39] with the closest point passes the triangle and stops before every bar.",
        every(
            greater(".potential.clearance", 0.0),
            less(".potential.goal_error", 0.2),
            *(less(f".potential.bars_passed_{w}mm", 0.5) for w in (3, 6, 10, 15, 20, 30)),
        ),
    ),
)
