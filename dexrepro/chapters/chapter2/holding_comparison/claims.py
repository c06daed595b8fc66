"""What the book says about ``holding_comparison``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.chapters.chapter2.statements import ordered_pairs
from dexrepro.claims import Claim, every, greater, less, ordered

COMPARISON = "holding_comparison"

_GROUP_1 = ("s3", "s4", "s5", "s6", "s7", "s8")
_REGULATED = [(f"s{n + 1}", f"s{n}") for n in range(3, 19, 2)]
_LEAD = [("s7", "s5"), ("s8", "s6"), ("s13", "s11"), ("s14", "s12"), ("s17", "s15"), ("s18", "s16")]

_TUNED = ("impedance", "no_impedance", "passive_impedance", "force_integral", "force")

CLAIMS = (
    Claim(
        "C2.12",
        "2.8",
        "The force controller is the worst.",
        every(
            *(
                greater(f"{COMPARISON}.{force}.rmse", f"{COMPARISON}.{n}.rmse", 10)
                for force in ("s1", "s2")
                for n in _GROUP_1
            )
        ),
        where="2.4.1.3",
        note="True of the printed static law; an integral force law with a tuned gain is on a par with PIm.",
    ),
    Claim(
        "C2.13",
        "2.8",
        "Passive impedance is worse than both estimating laws on Traj. 1.",
        ordered_pairs(("s5", "s3"), ("s7", "s3"), ("s6", "s4"), ("s8", "s4")),
        where="2.4.1.3",
    ),
    Claim(
        "C2.14",
        "2.8",
        "Passive impedance is worse than both estimating laws on Traj. 2 (whole run, as the figure shows it).",
        ordered_pairs(("s11", "s9"), ("s13", "s9"), ("s12", "s10"), ("s14", "s10"), metric="rmse_0"),
        where="2.4.1.3",
        note="Over 20 to 40 s, the part of the run that the other claims on this table are about, the regulated pairs "
        "turn round (C2.31).",
    ),
    Claim(
        "C2.15",
        "2.8",
        "The regulation (2.8) improves every pair s3/s4 to s17/s18.",
        ordered_pairs(*_REGULATED),
        where="2.4.1.3",
        note="s3/s4 by two per cent only, and reversed where the first ten seconds count.",
    ),
    Claim(
        "C2.16",
        "2.8",
        "The regulation helps the force controller too (s2 against s1, a pair the book does not discuss).",
        less(f"{COMPARISON}.s2.rmse", f"{COMPARISON}.s1.rmse"),
        source="ours",
        where="2.4.1.3",
        note="Staying on the line costs it force error: what dominates is its static error.",
    ),
    Claim(
        "C2.17",
        "2.8",
        "The advantage of (2.8) grows with the desired force.",
        greater(f"{COMPARISON}.group3_gain", f"{COMPARISON}.group2_gain"),
        where="2.4.1.3",
        note="Without (2.8) 7 N cannot be reached with an object of 0.55 m; the value depends on the workspace bounds.",
    ),
    Claim(
        "C2.18",
        "2.8",
        "All runs with movement estimation perform well (with (2.8): within 10 % of the desired force).",
        every(
            *(less(f"{COMPARISON}.s{n}.rmse", 0.1) for n in (6, 8, 12, 14)),
            *(less(f"{COMPARISON}.s{n}.rmse", 0.7) for n in (16, 18)),
        ),
        where="2.4.1.3",
        note="The book says it of all twelve. Without (2.8) four more stay within 10 %; s15 and s17 err by 28 %, "
        "because an object of 0.55 m, a length of ours, cannot give 7 N there.",
    ),
    Claim(
        "C2.19",
        "2.8",
        "Im is better than NoIm in every pair.",
        ordered_pairs(*_LEAD),
        printed=ordered_pairs(("printed_8", "printed_6")),
        where="2.4.1.3",
        note="With the velocity estimate as printed (E2.03) the lead carries almost nothing. Under joint PD the 10 ms "
        "of lead help because they are close to the arm's lag. On Traj. 2 the pairs are within 2 %, s14 and s12 within "
        "half a per cent, and the printed form loses by a tenth of a per cent: ties. s15 and s17 have lost the object.",
    ),
    Claim(
        "C2.30",
        "2.A",
        "On an arm that realises (2.25), as (2.27)-(2.32) assume, Im is better than NoIm in every regulated pair.",
        ordered_pairs(
            ("impedance_8", "impedance_6"), ("impedance_14", "impedance_12"), ("impedance_18", "impedance_16")
        ),
        source="ours",
        where="2.3.3",
    ),
    Claim(
        "C2.31",
        "2.8",
        "With (2.8) passive impedance stays worse on Traj. 2 once the start is over (20 to 40 s).",
        ordered_pairs(("s12", "s10"), ("s14", "s10")),
        source="ours",
        where="2.4.1.3",
        note="Not with the printed PD, whose lag costs the estimating laws more; on an arm without lag they win again.",
    ),
    *(
        Claim(
            identifier,
            "2.A",
            f"With gains tuned under one search budget the order of the laws on Traj. {trajectory} is the book's.",
            ordered(*(f"{COMPARISON}.tuned_{law}_{trajectory}.rmse" for law in _TUNED)),
            source="ours",
            where="2.4.1.3",
        )
        for identifier, trajectory in (("C2.32", 1), ("C2.33", 2))
    ),
)
