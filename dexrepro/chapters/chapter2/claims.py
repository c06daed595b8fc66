"""What Chapter 2 claims, as predicates over measured numbers."""

from __future__ import annotations

from dexrepro.experiment import Claim, Predicate, Reference, every, greater, less, ordered, within

LINE, ESTIMATION, COMPARISON = "holding_line", "movement_estimation", "holding_comparison"


def _ordered_pairs(*pairs: tuple[str, str], metric: str = "rmse", experiment: str = COMPARISON) -> Predicate:
    """The first case of every pair has the smaller metric."""
    return every(*(less(f"{experiment}.{a}.{metric}", f"{experiment}.{b}.{metric}") for a, b in pairs))


HOLDING_LINE = (
    Claim(
        "C2.01",
        "2.5",
        "From a misaligned start the force error is larger without the regulation (2.8), which cures it.",
        greater(f"{LINE}.case1_without.rmse", f"{LINE}.case1_with.rmse", 3),
        where="2.4.1.1 Case 1",
        note="The mean force without it is that of the closed form k_o (L0 - sqrt((L0 - f_d/k_o)^2 + dy^2)).",
    ),
    Claim(
        "C2.02",
        "2.5",
        "The cause: without the regulation the distance between the end effectors is larger than intended.",
        greater(f"{LINE}.case1_without.mean_distance", f"{LINE}.case1_with.mean_distance"),
        where="2.4.1.1 Case 1",
    ),
    Claim(
        "C2.03",
        "2.5",
        "When the partner deviates across the line, the regulation maintains the force.",
        greater(f"{LINE}.case2_without.rmse", f"{LINE}.case2_with.rmse", 3),
        where="2.4.1.1 Case 2",
    ),
    Claim(
        "C2.04",
        "2.5",
        "Without the regulation the force may become too small to hold the object.",
        every(greater(f"{LINE}.case2_without.lost", 0.05), less(f"{LINE}.case2_with.lost", 0.001)),
        where="2.4.1.1 Case 2",
    ),
    Claim(
        "C2.05",
        "2.5",
        "The regulation lets the follower move up and down with its partner.",
        greater(f"{LINE}.case2_without.largest_offset", f"{LINE}.case2_with.largest_offset", 3),
        where="2.4.1.1",
    ),
    Claim(
        "C2.06",
        "2.5",
        "The regulation matters more where the partner's deviation is larger.",
        greater(f"{LINE}.case2_gain", f"{LINE}.case1_gain"),
        where="2.4.1.1",
    ),
)

MOVEMENT = (
    Claim(
        "C2.07",
        "2.6",
        "The contact force converges to the desired force for stiffnesses of 25, 35 and 45 N/m from an estimate of 30.",
        every(*(less(f"{ESTIMATION}.k{k}.settling_time", 2.0) for k in (25, 35, 45))),
        where="2.4.1.2 Case 1",
    ),
    Claim(
        "C2.08",
        "2.7",
        "With a desired force close to 0 the estimated rest position converges to the true one.",
        every(
            *(less(f"{ESTIMATION}.light{s}.estimation_error", 1e-3) for s in (10, 30)),
            within(f"{ESTIMATION}.offset_ratio", 0.09, 0.11),
        ),
        where="2.4.1.2 Case 2",
        note="In the limit the book names: the offset is proportional to f_d (E2.05).",
    ),
    Claim(
        "C2.09",
        "2.7",
        "The estimation error converges to 0 whatever the partner's speed.",
        every(*(less(f"{ESTIMATION}.light{s}.residual", 2e-4) for s in (10, 30))),
        where="2.4.1.2 Case 2",
        note="Up to the offset f_d (1/khat - 1/k_o), taken off here; the value of f_d in Fig. 2.7 is not printed.",
    ),
    Claim(
        "C2.10",
        "2.7",
        "Convergence takes longer where the partner moves fast (sigma = 10 s).",
        _ordered_pairs(("sigma30", "sigma10"), ("sigma40", "sigma10"), metric="early_residual", experiment=ESTIMATION),
        printed=_ordered_pairs(
            ("printed30", "printed10"), ("printed40", "printed10"), metric="convergence_time", experiment=ESTIMATION
        ),
        where="2.4.1.2 Case 2",
        note="Clear with time counted from the start (10.3, 2.1 and 0.1 s to within 1 mm), weak with a window.",
    ),
    Claim(
        "C2.11",
        "2.7",
        "The force error falls into a small range around 0.",
        every(*(less(f"{ESTIMATION}.sigma{s}.rmse", 0.05) for s in (10, 30, 40))),
        where="2.4.1.2 Case 2",
    ),
    Claim(
        "C2.29",
        "2.2",
        "The follower needs no knowledge of the stiffness, the object's length or its partner's pose.",
        every(*(less(f"{ESTIMATION}.{case}.replay_difference", 1e-12) for case in ("k25", "k45", "sigma10"))),
        where="2.1",
        by_construction="the law's only inputs are its own position and the contact force; fed with these alone from "
        "three runs with other objects and partners it repeats its reference",
    ),
)

_GROUP_1 = ("s3", "s4", "s5", "s6", "s7", "s8")
_REGULATED = [(f"s{n + 1}", f"s{n}") for n in range(3, 19, 2)]
_LEAD = [("s7", "s5"), ("s8", "s6"), ("s13", "s11"), ("s14", "s12"), ("s17", "s15"), ("s18", "s16")]

TABLE = (
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
        _ordered_pairs(("s5", "s3"), ("s7", "s3"), ("s6", "s4"), ("s8", "s4")),
        where="2.4.1.3",
    ),
    Claim(
        "C2.14",
        "2.8",
        "Passive impedance is worse than both estimating laws on Traj. 2 (whole run, as the figure shows it).",
        _ordered_pairs(("s11", "s9"), ("s13", "s9"), ("s12", "s10"), ("s14", "s10"), metric="rmse_0"),
        where="2.4.1.3",
        note="Over 20 to 40 s, the part of the run that the other claims on this table are about, the regulated pairs "
        "turn round (C2.31).",
    ),
    Claim(
        "C2.15",
        "2.8",
        "The regulation (2.8) improves every pair s3/s4 to s17/s18.",
        _ordered_pairs(*_REGULATED),
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
        _ordered_pairs(*_LEAD),
        printed=_ordered_pairs(("printed_8", "printed_6")),
        where="2.4.1.3",
        note="With the velocity estimate as printed (E2.03) the lead carries almost nothing. Under joint PD the 10 ms "
        "of lead help because they are close to the arm's lag. On Traj. 2 the pairs are within 2 %, s14 and s12 within "
        "half a per cent, and the printed form loses by a tenth of a per cent: ties. s15 and s17 have lost the object.",
    ),
    Claim(
        "C2.30",
        "2.A",
        "On an arm that realises (2.25), as (2.27)-(2.32) assume, Im is better than NoIm in every regulated pair.",
        _ordered_pairs(
            ("impedance_8", "impedance_6"), ("impedance_14", "impedance_12"), ("impedance_18", "impedance_16")
        ),
        source="ours",
        where="2.3.3",
    ),
    Claim(
        "C2.31",
        "2.8",
        "With (2.8) passive impedance stays worse on Traj. 2 once the start is over (20 to 40 s).",
        _ordered_pairs(("s12", "s10"), ("s14", "s10")),
        source="ours",
        where="2.4.1.3",
        note="Not with the printed PD, whose lag costs the estimating laws more; on an arm without lag they win again.",
    ),
)

_TUNED = ("impedance", "no_impedance", "passive_impedance", "force_integral", "force")

TUNED = tuple(
    Claim(
        identifier,
        "2.A",
        f"With gains tuned under one search budget the order of the laws on Traj. {trajectory} is the book's.",
        ordered(*(f"{COMPARISON}.tuned_{law}_{trajectory}.rmse" for law in _TUNED)),
        source="ours",
        where="2.4.1.3",
    )
    for identifier, trajectory in (("C2.32", 1), ("C2.33", 2))
)

STATIC, MOVING, STABILITY = "balloon_static", "balloon_movement", "estimation_stability"
_STARTS = ("off_80", "off_100")

BAXTER = (
    Claim(
        "C2.20",
        "2.10",
        "The follower finds the holding position from any initial offset.",
        every(*(less(f"{STATIC}.{start}.lateral_offset", 2e-3) for start in _STARTS)),
        where="2.4.2.1",
    ),
    Claim(
        "C2.21",
        "2.10",
        "Both starts lead to the same destination.",
        less(f"{STATIC}.destination_spread", 2e-3),
        where="2.4.2.1",
    ),
    Claim(
        "C2.22",
        "2.10",
        "The lateral forces f_x and f_z converge to zero.",
        every(*(less(f"{STATIC}.{start}.lateral_force_time", 2.0) for start in _STARTS)),
        where="2.4.2.1",
    ),
    Claim(
        "C2.23",
        "2.10",
        "The force along the holding line converges to 10 N.",
        every(*(within(f"{STATIC}.{start}.force_along", 9.8, 10.2) for start in _STARTS)),
        where="2.4.2.1",
        note="Within 5 % after about 9 s, a time that the smoothing sets.",
    ),
    Claim(
        "C2.24",
        "2.11",
        "After adjusting, the two end effectors keep an approximately fixed distance under the proposed law.",
        every(
            less(f"{MOVING}.proposed.distance_spread", 5e-3),
            *(
                less(f"{MOVING}.proposed.distance_spread", f"{MOVING}.{law}.distance_spread")
                for law in ("force", "passive")
            ),
        ),
        where="2.4.2.2",
    ),
    Claim(
        "C2.25",
        "2.11",
        "The proposed law tracks the force better than force control and passive impedance.",
        every(*(less(f"{MOVING}.proposed.rmse_circle", f"{MOVING}.{law}.rmse_circle") for law in ("force", "passive"))),
        where="2.4.2.2",
        note="Depends on the balloon for passive impedance, which rings against 150 N/m, not against 80 N/m (C2.34); "
        "NoIm does as well as Im, so the estimator earns the result.",
    ),
    Claim(
        "C2.26",
        "2.11",
        "The advantage over force control is more obvious on the circle, after about 20 s.",
        greater(f"{MOVING}.force_excess_circle", f"{MOVING}.force_excess_line"),
        where="2.4.2.2",
    ),
    Claim(
        "C2.35",
        "2.11",
        "The advantage over passive impedance is more obvious on the circle, after about 20 s.",
        greater(f"{MOVING}.passive_excess_circle", f"{MOVING}.passive_excess_line"),
        where="2.4.2.2",
        note="Second half of the sentence behind C2.26. Passive impedance rings from the start and slowly calms down.",
    ),
    Claim(
        "C2.34",
        "2.11",
        "The order holds for a softer balloon of 80 N/m: the proposed law beats passive impedance.",
        less(f"{MOVING}.soft_proposed.rmse_circle", f"{MOVING}.soft_passive.rmse_circle"),
        source="ours",
        where="2.4.2.2",
        note="Against the softer balloon the printed passive impedance is well damped by the arm's lag.",
    ),
    Claim(
        "C2.36",
        "2.11",
        "With gains tuned under one search budget the proposed law beats passive impedance.",
        less(f"{MOVING}.tuned_proposed.rmse_circle", f"{MOVING}.tuned_passive.rmse_circle"),
        source="ours",
        where="2.4.2.2",
    ),
    Claim(
        "C2.37",
        "2.11",
        "With gains tuned under one search budget the proposed law beats (integral) force control.",
        less(f"{MOVING}.tuned_proposed.rmse_circle", f"{MOVING}.tuned_force.rmse_circle"),
        source="ours",
        where="2.4.2.2",
        note="By 5 % with one draw of tremor and sensor noise. Where balloon, sensor and servo vary (study), and on "
        "the axis on which the gains were searched (T2.H), the force law is more often ahead: they are on a par.",
    ),
)

THEORY = (
    Claim(
        "C2.27",
        "2.B",
        "dV <= 0 under (2.16): V decreases as long as there is a prediction error.",
        every(
            less(f"{STABILITY}.lyapunov.largest_rise", 1e-12),
            within(f"{STABILITY}.lyapunov.decrement_ratio", 0.99, 1.01),
        ),
        where="2.3.2",
        note="For constant parameters and a bounded regressor; an explicit step adds the limit dt sum(g_j Y_j^2) < 2 "
        "(E2.02).",
    ),
    Claim(
        "C2.28",
        "2.B",
        "The reference (2.31) makes the steady-state force error vanish.",
        less(f"{STABILITY}.reference.largest_error", 1e-6),
        where="2.3.3",
        by_construction="(2.31) is what (2.30) = 0 gives; an exact arm of impedance (2.25) confirms it",
    ),
)

CLAIMS = tuple(sorted((*HOLDING_LINE, *MOVEMENT, *TABLE, *TUNED, *BAXTER, *THEORY), key=lambda claim: claim.id))

REFERENCES: tuple[Reference, ...] = ()
