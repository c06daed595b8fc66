"""What the book says about ``planar_constraint``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

LAW = "planar_constraint"

CLAIMS = (
    Claim(
        "C6.06",
        "6.2d",
        "The path stays within 0.5 of the reference.",
        every(*(less(f"{LAW}.{law}.e_share", 1.0) for law in ("consistent", "printed", "feedforward"))),
        where="6.4.1, (6.23)",
        note="With tau = the segment's duration; with tau = 1 s only the consistent law or a projection keeps it.",
    ),
    Claim(
        "C6.07",
        "6.2d",
        "The distance to the reference is largest at the arc and vanishes quickly after it.",
        every(
            *(greater(f"{LAW}.{law}.peak_in_arc", 0.99) for law in ("printed", "feedforward")),
            *(less(f"{LAW}.{law}.settle_after_arc", 0.6) for law in ("printed", "feedforward")),
        ),
        where="6.4.1",
        note="Void for the consistent law, which never leaves the reference.",
    ),
    Claim(
        "C6.09",
        "6.2d",
        "The constraint (6.7) is never violated (consistent law).",
        every(
            *(less(f"{LAW}.{case}.violated_groups", 0.5) for case in ("consistent", "tau1_consistent")),
        ),
        where="6.3.3",
    ),
    Claim(
        "C6.12",
        "6.2d",
        "The constrained path converges to the goal.",
        every(*(less(f"{LAW}.{law}.goal_error", 0.02) for law in ("consistent", "printed", "feedforward"))),
        where="6.3.3",
        note="For constraints that keep inside of a tube; the outside cases do not arrive, see C6.35.",
    ),
    Claim(
        "C6.14",
        "6.2d",
        "The extra term does not influence the learned skill: the weights stay as they are.",
        every(*(less(f"{LAW}.{law}.weights_changed", 1e-12) for law in ("consistent", "printed", "feedforward"))),
        where="6.5",
        by_construction="the extra term acts on the movement, nothing is learned anew",
        note="What the skill still contributes to the movement is another matter, see C6.36.",
    ),
    Claim(
        "C6.15",
        "6.2d",
        "The constrained path clears all obstacles.",
        every(*(greater(f"{LAW}.{law}.clearance", 0.0) for law in ("consistent", "printed", "feedforward"))),
        where="6.4.1",
    ),
    Claim(
        "C6.33",
        "6.2d",
        "The constraint (6.7) is never violated (law as printed in (6.15), and with the recorded acceleration).",
        every(
            *(
                less(f"{LAW}.{case}.violated_groups", 0.5)
                for case in (
                    "printed",
                    "feedforward",
                    "narrow_printed",
                    "narrow_feedforward",
                    "tau1_printed",
                    "tau1_feedforward",
                )
            ),
        ),
        where="6.3.3",
        note="Kept at h = 0.5 with tau = duration, stepped over at half the margin and with tau = 1 s.",
    ),
    Claim(
        "C6.34",
        "6.2d",
        "With the discrete projection the constraint is kept by every reading, margin and time constant tried.",
        every(
            *(
                less(f"{LAW}.{case}.violated_groups", 0.5)
                for case in (
                    "narrow_printed_projected",
                    "narrow_feedforward_projected",
                    "tau1_printed_projected",
                    "tau1_feedforward_projected",
                )
            ),
        ),
        source="ours",
        where="6.3.3",
        by_construction="the projection puts a step beyond the barrier back",
    ),
    Claim(
        "C6.36",
        "6.2d",
        "The constrained movement still depends on the learned weights under every reading of the law.",
        every(*(greater(f"{LAW}.{law}.weight_effect", 0.01) for law in ("consistent", "printed", "feedforward"))),
        source="ours",
        where="6.5",
        note="Not under the consistent law, the one that the proof holds for: it cancels the primitive altogether.",
    ),
    Claim(
        "C6.37",
        "6.2d",
        "The barrier makes no difference to the largest distance on the map (weight 1, tau = duration).",
        less(f"{LAW}.barrier_effect", 1e-3),
        source="ours",
        where="(6.9)",
        note="0.3028 cm with and without: the tracking gains do the work.",
    ),
    Claim(
        "C6.38",
        "6.2d",
        "With tau = 1 s the tracking gains alone leave the tube; a barrier weighted by H^2 keeps it (law with the "
        "recorded acceleration).",
        every(
            greater(f"{LAW}.tau1_no_barrier.e_share", 1.0),
            less(f"{LAW}.tau1_feedforward_h2.e_share", 1.0),
            less(f"{LAW}.tau1_feedforward_h2.violated_groups", 0.5),
        ),
        source="ours",
        where="(6.9)",
        note="The path rides the barrier, at 99.99 % of the tube; the literal law (6.15) with that weight leaves it.",
    ),
    Claim(
        "C6.39",
        "6.2d",
        "V^c never increases (law as printed in (6.15), and with the recorded acceleration).",
        every(*(less(f"{LAW}.{law}.v_rises", 0.5) for law in ("printed", "feedforward"))),
        where="(6.21)",
        note="Neither of these two readings fulfils the assumption of the proof.",
    ),
)
