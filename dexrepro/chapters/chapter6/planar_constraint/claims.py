"""What the book says about ``planar_constraint``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, about, every, greater, less, within

READINGS = ("consistent", "printed", "feedforward")
STARTS = ("consistent", "tau1_consistent", "consistent_off", "consistent_fast")
BARRIER = "the barrier of (6.9)"


def kept(*cases: str) -> Predicate:
    return every(*(less(f".{case}.violated_groups", 0.5) for case in cases))


def in_tube(*cases: str) -> Predicate:
    return every(*(less(f".{case}.e_share", 1.0) for case in cases))


def at_the_arc(*cases: str) -> Predicate:
    return every(
        *(greater(f".{case}.peak_in_arc", 0.99) for case in cases),
        *(less(f".{case}.settle_after_arc", 0.6) for case in cases),
    )


def arrives(*cases: str) -> Predicate:
    return every(*(less(f".{case}.goal_error", 0.02) for case in cases))


def clears(*cases: str) -> Predicate:
    return every(*(greater(f".{case}.clearance", 0.0) for case in cases))


def never_rises(case: str) -> Predicate:
    return less(f".{case}.v_rises", 0.5)


fig_6_2d = about("6.2d", "6.4.1")
ours_6_2d = about("6.2d", "6.3.3", source="ours")
CLAIMS = (
    fig_6_2d(
        "C6.06",
        "Under the conditions (6.23) the path stays within 0.5 of the reference.",
        in_tube(*READINGS),
        control=in_tube("consistent_no_barrier", "printed_no_barrier", "no_barrier"),
        credits=BARRIER,
        where="6.4.1, (6.23)",
        note="With tau = the segment's duration the largest distance is {.feedforward.e_max:.4f} cm "
        "with the barrier and {.no_barrier.e_max:.4f} cm without: the tracking gains do the work. "
        "With tau = 1 s they alone leave the tube ({.tau1_no_barrier.e_max:.2f} cm), and the barrier "
        "as weighted in (6.9) is left by {.tau1_feedforward.violated_groups:.0f} groups of six.",
    ),
    fig_6_2d(
        "C6.07",
        "The distance to the reference is largest at the arc and vanishes quickly after it.",
        at_the_arc("printed", "feedforward"),
        control=at_the_arc("none"),
        note="Back {.feedforward.settle_after_arc:.2f} s after the arc; the primitive without extra term, the control, "
        "after {.none.settle_after_arc:.2f} s. Void for the consistent law, which never leaves the reference.",
    ),
    fig_6_2d(
        "C6.09",
        "The constraint (6.7) is never violated, from any start inside of it.",
        kept(*STARTS),
        control=kept(*(f"{case}_no_barrier" for case in STARTS)),
        readings={
            "from starts without a velocity error alone, as in Sect. 6.4": kept(*STARTS[:3]),
            "as printed in (6.15), tau = duration": kept("printed"),
            "with the recorded acceleration (6.12), tau = duration": kept("feedforward"),
            "as printed in (6.15), tau = 1 s": kept("tau1_printed"),
            "with the recorded acceleration (6.12), tau = 1 s": kept("tau1_feedforward"),
        },
        credits=BARRIER,
        searched=(
            "three readings of the acceleration, tau of 1 s and of the segment's duration, starts off the reference "
            "and with a velocity error, the barrier's weight 1 and H^2, steps down to a tenth of ours"
        ),
        where="6.3.3",
        note="In (6.21) V stays finite from any start inside; weighted by 1 in squared centimetres the barrier is "
        "thinner than a step, so that the path leaves the tube where it would leave it without barrier: from a "
        "velocity error of {.cases.consistent_fast.start.speed:g} cm/s after {.consistent_fast.violated_from:.3f} s, "
        "without after {.consistent_fast_no_barrier.violated_from:.3f} s. From starts without one the tracking gains "
        "alone keep it as well.",
    ),
    Claim(
        "C6.11",
        "6.2a",
        "alpha_z, beta_z = alpha_z / 4 make (6.1) and (6.15) critically damped.",
        every(within(".feedforward.damping_primitive", 0.99, 1.01), within(".feedforward.damping_error", 0.99, 1.01)),
        readings={"(6.15) without its extra term, (6.22)": within(".feedforward.damping_primitive", 0.99, 1.01)},
        no_control="arithmetic on the printed values",
        where="Remark 6.6",
        note="Under the law the error has the poles k_z / d_z and k_2, 6 and 10 1/s, a damping ratio of "
        "{.feedforward.damping_error:.3f} on which alpha_z has no influence (E6.17).",
    ),
    fig_6_2d(
        "C6.12",
        "The constrained path converges to the goal.",
        arrives(*READINGS),
        control=arrives("stray"),
        credits="Assumption 6.1, that the reference does",
        where="6.3.3",
        note="For constraints that keep inside of a tube; the outside cases do not arrive, see C6.35. About a "
        "reference that misses the goal by 1 cm, the control, the path ends {.stray.goal_error:.2f} cm off it.",
    ),
    fig_6_2d(
        "C6.14",
        "The extra term does not influence the learned skill: the weights stay as they are.",
        every(*(less(f".{law}.weights_changed", 1e-12) for law in READINGS)),
        where="6.5",
        by_construction="the extra term acts on the movement, nothing is learned anew",
        note="What the skill still contributes to the movement is another matter, see C6.36.",
    ),
    fig_6_2d("C6.15", "The constrained path clears all obstacles.", clears(*READINGS), control=clears("none")),
    ours_6_2d(
        "C6.34",
        "With the discrete projection the constraint is kept by every reading, margin and time constant tried.",
        kept(*(f"{set_up}_{law}_projected" for set_up in ("narrow", "tau1") for law in ("printed", "feedforward"))),
        by_construction="the projection puts a step beyond the barrier back",
    ),
    ours_6_2d(
        "C6.36",
        "The constrained movement still depends on the learned weights under every reading of the law.",
        every(*(greater(f".{law}.weight_effect", 0.01) for law in READINGS)),
        where="6.5",
        note="Not under the consistent law, the one that the proof holds for: it cancels the primitive altogether.",
    ),
    ours_6_2d(
        "C6.38",
        "With tau = 1 s the tracking gains alone leave the tube; a barrier weighted by H^2 keeps it (law with the "
        "recorded acceleration).",
        every(
            greater(".tau1_no_barrier.e_share", 1.0),
            less(".tau1_feedforward_h2.e_share", 1.0),
            kept("tau1_feedforward_h2"),
        ),
        control=every(greater(".no_barrier.e_share", 1.0), kept("feedforward")),
        where="(6.9)",
        note="The path rides the barrier, at {.tau1_feedforward_h2.e_share:.4f} of the tube; the "
        "literal law (6.15) with that weight leaves it at steps of 1 ms in "
        "{.tau1_printed_h2.violated_groups:.0f} groups of six, which is a matter of sampling.",
        turns="the path rides the barrier, which keeps it inside by less than any tolerance; no group violates",
    ),
    fig_6_2d(
        "C6.39",
        "V^c never increases.",
        every(never_rises("consistent"), never_rises("consistent_off")),
        control=never_rises("none"),
        readings={
            "as printed in (6.15)": never_rises("printed"),
            "with the recorded acceleration (6.12)": never_rises("feedforward"),
        },
        credits="the extra term",
        searched="three readings of the acceleration",
        where="(6.21)",
        note="The consistent law alone fulfils the assumption of the proof; under it V rises in no step, nor does it "
        "from a start {.cases.consistent_off.start.offset:g} cm off; as printed in up to {.printed.v_rises:.0f} steps, "
        "with the recorded acceleration in up to {.feedforward.v_rises:.0f}.",
    ),
    fig_6_2d(
        "C6.48",
        "Only part of the previous path is modified.",
        every(*(less(f".{law}.modified_share", 0.5) for law in READINGS)),
        control=less(".feedforward.extended_modified_share", 0.5),
        where="6.5, point 3",
        note="{.feedforward.modified_share:.0%} of sub-skill 2 lies off the previous path; of its "
        "extended primitive, the control, {.feedforward.extended_modified_share:.0%}.",
    ),
    fig_6_2d(
        "C6.49",
        "Where an interval begins inside of its bounds, as the junction condition has it, the constraint is kept "
        "from the start.",
        kept("junction"),
        control=kept("junction_no_barrier"),
        credits=f"{BARRIER}, whose proof asks for the junction condition",
        where="6.3.1, 6.3.3",
        note="{.cases.junction.start.offset:g} cm off at the start, with a margin of {.cases.junction.cdmp.margin:g} "
        "cm: the largest distance is {.junction.e_max:.4f} cm with the barrier and {.junction_no_barrier.e_max:.4f} cm "
        "without, from the same start. A start outside, without the junction condition, violates the constraint by "
        "definition, before any law acts, and would test none.",
    ),
)
