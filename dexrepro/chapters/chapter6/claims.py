"""What Chapter 6 claims, as predicates over measured numbers."""

from __future__ import annotations

from dexrepro.chapters.chapter6.claims_plane import PLANE, THEORY
from dexrepro.experiment import Claim, Reference, every, greater, less

OUT, TERMS, ARM, HANDS, BOX = "keep_out", "obstacle_terms", "arm_obstacles", "skeleton_constraints", "box_carrying"
COUPLED = "coupled_primitives"
PROJECTION = "our projection puts a step beyond the barrier back; only the consistent law needs none"

ROBOTS = (
    Claim(
        "C6.16",
        "6.4",
        "The arm on the original path hits the new box.",
        less(f"{ARM}.original.distance_new", 0.0),
        where="6.4.1",
        by_construction="the box was placed across the path",
    ),
    Claim(
        "C6.17",
        "6.5",
        "The arm on the constrained path passes all boxes.",
        every(*(greater(f"{ARM}.constrained.distance_{box}", 0.0) for box in ("first", "second", "new"))),
        where="6.4.1",
        note="Fragile: inflating the box by the tool's tip instead of the wrist, or passing between box and torso, "
        "makes the arm touch (Table T6.Sc).",
    ),
    Claim(
        "C6.18",
        "6.7",
        "The wrists spread about twice as far as the shoulders.",
        every(
            greater(f"{HANDS}.feedforward.spread_ratio_low", 1.7), less(f"{HANDS}.feedforward.spread_ratio_high", 2.6)
        ),
        where="6.4.2",
        by_construction="the measurement noise has these sizes",
    ),
    Claim(
        "C6.19",
        "6.10",
        "Link lengths of the original primitives vary widely.",
        every(
            greater(f"{HANDS}.feedforward.se_left_width_original", 15.0),
            greater(f"{HANDS}.feedforward.ew_left_width_original", 5.0),
        ),
        where="6.4.2",
        by_construction="the common occlusion bias was chosen after the printed ranges; without it they stay narrow",
    ),
    Claim(
        "C6.20",
        "6.10",
        "Link lengths of the constrained primitives stay within 1 cm of 22 and 28 cm.",
        every(
            *(less(f"{HANDS}.{law}.length_error_constrained", 1.0) for law in ("consistent", "printed", "feedforward"))
        ),
        where="6.4.2, (6.25)",
        by_construction=PROJECTION,
        note="The projection acts in some steps; without it the barrier is stepped over (C6.40).",
    ),
    Claim(
        "C6.40",
        "6.10",
        "Without projection the law with the recorded acceleration keeps the links as well.",
        less(f"{HANDS}.unprojected.undefined", 0.5),
        where="6.4.2",
        note="It leaves its barrier after about 2 s, where a hidden elbow is far from where it should be.",
    ),
    Claim(
        "C6.21",
        "6.11",
        "The range of the hand distance shrinks to within 1 cm of the box's length.",
        every(
            greater(f"{HANDS}.feedforward.hands_width_original", 10.0),
            *(less(f"{HANDS}.{law}.hands_error_constrained", 1.0) for law in ("consistent", "printed", "feedforward")),
        ),
        where="6.4.2, (6.24)",
        by_construction=PROJECTION,
        note="Both hands are held about their common centre, each within half the printed margin, so that the distance "
        "keeps 1 cm; with 1 cm each it leaves the band. Held about the other hand, 1 cm would do (E6.13).",
    ),
    Claim(
        "C6.23",
        "6.8",
        "Loop 1 is needed before the relative step: without it the shoulders are wrong.",
        less(
            f"{HANDS}.feedforward.rmse_shoulder_left_constrained",
            f"{HANDS}.no_loop1.rmse_shoulder_left_constrained",
            0.3,
        ),
        where="6.4.2",
    ),
    Claim(
        "C6.24",
        "6.9",
        "Noise and errors of wrists and left elbow are filtered and amended.",
        every(
            *(
                less(f"{HANDS}.feedforward.rmse_ratio_{joint}", 0.8)
                for joint in ("wrist_left", "wrist_right", "elbow_left")
            )
        ),
        where="6.5",
    ),
    Claim(
        "C6.41",
        "6.9",
        "Noise and errors of shoulders and right elbow are filtered and amended.",
        every(
            *(
                less(f"{HANDS}.feedforward.rmse_ratio_{joint}", 0.8)
                for joint in ("shoulder_left", "shoulder_right", "elbow_right")
            )
        ),
        where="6.5",
        note="The right elbow gains little, and the shoulders, the best measured joints, get slightly worse.",
    ),
    Claim(
        "C6.22",
        "6.12",
        "Two arms carry the box stably along the constrained paths, and lose it along the original ones.",
        every(
            less(f"{BOX}.constrained.box_error_max", 2.0),
            greater(f"{BOX}.constrained.min_palm_force", 0.0),
            less(f"{BOX}.original.carried", 0.5),
        ),
        where="6.4.2",
        note="The same squeeze for both; with stiff joints (45 rad/s) the constrained paths lose it as well.",
    ),
)

DISCUSSION = (
    Claim(
        "C6.25",
        "6.D",
        "The steering term of [16] has a dead zone for a head-on approach.",
        less(f"{TERMS}.centroid.aligned_distance", 0.1),
        where="6.5, point 1",
        note="For exact alignment with a point only: an offset of 1e-6 cm is enough to pass at 0.99 cm (C6.42).",
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
        "C6.28",
        "6.D",
        "The calculation of the constrained primitive is more complex than that of [16] and [39].",
        None,
        where="6.5, point 3",
        not_testable="wall time is bound to the implementation; table T6.D counts operations instead (C6.45)",
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
    Claim(
        "C6.29",
        "6.D",
        "A bound of the measurement noise can be added to the margin.",
        every(less(f"{TERMS}.constrained.noise_excess", 0.0), greater(f"{TERMS}.constrained.noise_clearance", 0.0)),
        where="6.5, point 3",
    ),
    Claim(
        "C6.30",
        "6.C",
        "Moving obstacles are passed with a forecast, a detour as reference and a tube about it.",
        every(
            *(
                greater(f"{OUT}.moving_detour_{law}.distance_share", 1.0)
                for law in ("consistent", "printed", "feedforward")
            ),
            *(
                less(f"{OUT}.moving_detour_{law}.goal_error_worst", 0.05)
                for law in ("consistent", "printed", "feedforward")
            ),
        ),
        where="6.5, point 2",
        by_construction="the detour clears the forecast obstacle by the margin",
    ),
    Claim(
        "C6.31",
        "6.13",
        "Which of the two ways to a reference is better depends on the task.",
        None,
        where="6.4.1",
        not_testable="a judgement on tasks that the book does not name",
    ),
    Claim(
        "C6.46",
        "T6.1",
        "Velocity coupling [20] holds the distance of two agents the better the stronger it is; [19] improves on it.",
        every(
            less(f"{COUPLED}.distance_10.size", f"{COUPLED}.distance_off.size"),
            less(f"{COUPLED}.distance_50.size", f"{COUPLED}.distance_10.size"),
            less(f"{COUPLED}.force_10.size", f"{COUPLED}.distance_10.size"),
            less(f"{COUPLED}.force_30.size", f"{COUPLED}.force_20.size"),
        ),
        source="ours",
        where="Table 6.1",
        note="At the price of a larger error at the end: 0.05 cm with [19], none with [20].",
    ),
    Claim(
        "C6.47",
        "T6.1",
        "The force coupling of [17] brings the force on a surface nearer to its set value.",
        less(f"{COUPLED}.surface_pi.size", f"{COUPLED}.surface_off.size", 0.5),
        source="ours",
        where="Table 6.1",
    ),
)

CLAIMS = PLANE + THEORY + ROBOTS + DISCUSSION

REFERENCES = (
    Reference(f"{HANDS}.feedforward.se_left_original_low", 12, "6.4.2", "cm"),
    Reference(f"{HANDS}.feedforward.se_left_original_high", 52, "6.4.2", "cm"),
    Reference(f"{HANDS}.feedforward.ew_left_original_low", 25, "6.4.2", "cm"),
    Reference(f"{HANDS}.feedforward.ew_left_original_high", 39, "6.4.2", "cm"),
    Reference(f"{HANDS}.feedforward.hands_original_low", 34, "6.4.2", "cm"),
    Reference(f"{HANDS}.feedforward.hands_original_high", 57, "6.4.2", "cm"),
    Reference(f"{HANDS}.feedforward.hands_constrained_low", 24, "6.4.2", "cm"),
    Reference(f"{HANDS}.feedforward.hands_constrained_high", 25, "6.4.2", "cm"),
)
