"""What the book says about ``planar_skill``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less, within

SKILL = "planar_skill"

CLAIMS = (
    Claim(
        "C6.01",
        "6.2a",
        "The demonstrations are cut into the two sub-skills.",
        less(f"{SKILL}.book.segmentation_error_max", 0.3),
        where="6.4.1",
        note="A change point of a library replaces the book's BP-AR-HMM; cut at the smallest speed it holds too.",
    ),
    Claim(
        "C6.02",
        "6.2a",
        "The learned path collides with the new block but not with the old obstacles.",
        every(less(f"{SKILL}.book.clearance_new_max", 0.0), greater(f"{SKILL}.book.clearance_old_min", 0.0)),
        where="6.4.1",
        by_construction="the block was placed across the demonstrations",
    ),
    Claim(
        "C6.03",
        "6.2a",
        "The new block concerns the second sub-skill alone.",
        greater(f"{SKILL}.book.clearance_first_new_min", 1.0),
        where="6.4.1",
        by_construction="the block was placed across the demonstrations",
    ),
    Claim(
        "C6.04",
        "6.2b",
        "The interpolated reference clears all obstacles by more than the margin and keeps most of the learned path.",
        every(greater(f"{SKILL}.book.clearance_reference_min", 0.5), greater(f"{SKILL}.book.kept_share_min", 0.5)),
        where="6.4.1",
    ),
    Claim(
        "C6.05",
        "6.2c",
        "The reference by extended primitives crosses the original obstacles.",
        every(
            greater(f"{SKILL}.book.inside_share_extended_min", 0.0),
            less(f"{SKILL}.book.clearance_extended_1_max", 0.0),
            less(f"{SKILL}.book.clearance_extended_2_max", 0.0),
        ),
        where="6.4.1",
        note="It depends on the intervals: cut inside of sub-skill 2, extended primitives clear everything (C6.32).",
    ),
    Claim(
        "C6.11",
        "6.2a",
        "alpha_z and beta_z = alpha_z / 4 make (6.1) critically damped.",
        within(f"{SKILL}.book.damping_ratio", 1 - 1e-9, 1 + 1e-9),
        where="Remark 6.6",
        by_construction="arithmetic on the printed values",
    ),
    Claim(
        "C6.32",
        "6.2c",
        "With intervals cut inside of sub-skill 2, extended primitives clear all obstacles.",
        every(
            greater(f"{SKILL}.local_intervals.clearance_extended_1_min", 0.0),
            greater(f"{SKILL}.local_intervals.clearance_extended_2_min", 0.0),
        ),
        source="ours",
        where="6.3.1",
    ),
)
