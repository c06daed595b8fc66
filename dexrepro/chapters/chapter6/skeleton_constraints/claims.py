"""What the book says about ``skeleton_constraints``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Reference, every, greater, less

HANDS = "skeleton_constraints"
PROJECTION = "our projection puts a step beyond the barrier back; only the consistent law needs none"

CLAIMS = (
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
        "C6.40",
        "6.10",
        "Without projection the law with the recorded acceleration keeps the links as well.",
        less(f"{HANDS}.unprojected.undefined", 0.5),
        where="6.4.2",
        note="It leaves its barrier after about 2 s, where a hidden elbow is far from where it should be.",
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
)
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
