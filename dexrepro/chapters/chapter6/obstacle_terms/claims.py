"""What the book says about ``obstacle_terms``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

TERMS = "obstacle_terms"

CLAIMS = (
    Claim(
        "C6.25",
        "6.D",
        "The steering term of [16] has a dead zone for a head-on approach.",
        less(f"{TERMS}.centroid.aligned_distance", 0.1),
        where="6.5, point 1",
        note="For exact alignment with a point only: an offset of 1e-6 cm is enough to pass at 0.99 cm (C6.42).",
    ),
    Claim(
        "C6.26",
        "6.D",
        "The reaction of the steering term fades as the heading narrows towards the obstacle.",
        less(f"{TERMS}.steering_at_001", f"{TERMS}.steering_peak", 0.25),
        where="6.5, point 1",
    ),
    Claim(
        "C6.27",
        "6.D",
        "Steering does not suit non-point obstacles (standard parameters, bars of a half-width of 2 cm or more).",
        every(
            *(less(f"{TERMS}.{name}.bars_passed_20mm", 2.5) for name in ("centroid", "closest", "boundary")),
            *(less(f"{TERMS}.{name}.bars_passed_30mm", 2.5) for name in ("centroid", "closest", "boundary")),
        ),
        where="6.5, point 2",
    ),
    Claim(
        "C6.29",
        "6.D",
        "A bound of the measurement noise can be added to the margin.",
        every(less(f"{TERMS}.constrained.noise_excess", 0.0), greater(f"{TERMS}.constrained.noise_clearance", 0.0)),
        where="6.5, point 3",
    ),
    Claim(
        "C6.42",
        "6.D",
        "An offset of a millionth of a centimetre ends the dead zone.",
        greater(f"{TERMS}.centroid.nearly_aligned_distance", 0.5),
        source="ours",
        where="6.5, point 1",
    ),
    Claim(
        "C6.43",
        "6.D",
        "Tuned over 20 settings, steering passes the triangle with every representation of it.",
        every(*(greater(f"{TERMS}.{name}.tuned_clearance", 0.0) for name in ("centroid", "closest", "boundary"))),
        source="ours",
        where="6.5, point 2",
    ),
    Claim(
        "C6.44",
        "6.D",
        "The dynamic potential of [39] with the closest point passes triangle and all bars with usual parameters.",
        every(
            greater(f"{TERMS}.potential.clearance", 0.0),
            *(greater(f"{TERMS}.potential.bars_passed_{w}mm", 4.5) for w in (3, 6, 10, 15, 20, 30)),
        ),
        source="ours",
        where="6.5, point 2",
        note="The book says of [39] too that it does not suit non-point obstacles.",
    ),
    Claim(
        "C6.45",
        "6.D",
        "A step of the constrained primitive takes more operations than one of steering about a single point.",
        greater(f"{TERMS}.constrained.operations", f"{TERMS}.centroid.operations"),
        source="ours",
        where="6.5, point 3",
        note="About boundary points or with the potential the order is the opposite.",
    ),
)
