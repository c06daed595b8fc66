"""What a reader who implements Chapter 6 must know."""

from __future__ import annotations

from dexrepro.claims import error, gap, reading, slip

ERRATA = (
    reading(
        "E6.01",
        "(6.9)-(6.18)",
        "The bounds h are on x^c - x, the barrier's argument is z1 = k_z (x^c - x). Taken in the units of z1, h = 0.5 "
        "is a tube 1/k_z as wide, in which the deviation described for Fig. 6.2d cannot occur.",
        "Scaled bound H = k_z h.",
        switch="planar_constraint.cdmp.bound_scaling=printed",
        evidence=(
            "planar_constraint.unscaled_printed.violated_from",
            "planar_constraint.unscaled_feedforward.violated_from",
        ),
    ),
    reading(
        "E6.02",
        "(6.13)-(6.15)",
        "(6.15) literally holds the acceleration that it defines. Three readings: the primitive's own acceleration at "
        "the present state (the proof (6.21) then holds, and the primitive cancels), the literal equation solved for "
        "the acceleration (an average), the recorded acceleration (6.12) as a function of time. Taken one sample late, "
        "it diverges for every time step.",
        "Laws consistent, printed, feedforward and lagged; feedforward gives the path described for Fig. 6.2d.",
        switch="planar_constraint.cdmp.law=printed",
        evidence=(
            "planar_constraint.consistent.v_rises",
            "planar_constraint.printed.v_rises",
            "planar_constraint.feedforward.v_rises",
            "planar_constraint.lagged.violated_from",
        ),
    ),
    error(
        "E6.03",
        "(6.17)",
        "The denominator of alpha_2 lacks a factor z1 (possibly lost in print): for z1 < 0 the printed term pushes "
        "into the forbidden band, and the limit K_1 = 0 contradicts Table 6.2.",
        "K_2 z1 - K_1 z1^3.",
        switch="constraint_cases.printed=true",
        evidence=(
            "constraint_cases.asymmetric_outside_printed.rising_states",
            "constraint_cases.asymmetric_outside_printed.hit_time",
            "constraint_cases.asymmetric_outside.rising_states",
        ),
    ),
    reading(
        "E6.04",
        "(6.16)",
        "With both bounds positive and z1 > 0 one logarithm has a negative argument; (6.9) drops the bound nearer to "
        'zero. "and/or" may mean that one bound alone is active.',
        "Bounds restricted to lower < 0 < upper.",
        evidence=("constraint_cases.asymmetric_outside_printed.same_sign_undefined",),
    ),
    error(
        "E6.05",
        "Table 6.2, Remark 6.2, 6.3.3",
        "The outside cases have their infimum of V^c at an infinite error: z1^2 grows by 2 (k_z/d_z) t, z1 does not "
        "tend to zero, and the path does not reach the goal.",
        "Use the tube about a detour (as the book's experiments do) or a safety filter.",
        evidence=(
            "constraint_cases.symmetric_outside.growth_gap",
            "keep_out.still_consistent.goal_error",
            "keep_out.still_printed_h2.goal_error",
            "keep_out.still_filter.goal_error",
        ),
    ),
    reading(
        "E6.06",
        "(6.9)",
        "A matter of scaling: a logarithm without unit beside the square of a length. With the printed gains the "
        "barrier outweighs k_2 only where 1 - (e/h)^2 is below {barrier_anatomy.feedforward.half_gap_one:.0e} (tau = "
        "duration) or {barrier_anatomy.tau1_feedforward.half_gap_one:.0e} (1 s); the tracking gains do the work, and "
        "fixed steps pass over so thin a layer.",
        "Barrier weight H^2, or the discrete projection.",
        evidence=(
            "barrier_anatomy.feedforward.half_gap_one",
            "barrier_anatomy.tau1_feedforward.half_gap_one",
            "planar_constraint.no_barrier.e_max",
            "planar_constraint.feedforward.e_max",
            "planar_constraint.tau1_feedforward_h2.e_max",
        ),
    ),
    error(
        "E6.07",
        "(6.10)",
        "Bounds are called functions, but their rate is missing in (6.10) and alpha_2. Without effect where they are "
        "constant within an interval, as in both experiments.",
        "alpha_2 gets the term -(e hdot / h) / g1.",
        evidence=(
            "constraint_cases.symmetric_inside.shrinking_printed",
            "constraint_cases.symmetric_inside.shrinking_corrected",
        ),
    ),
    slip(
        "E6.09",
        "(6.19)-(6.22)",
        'The derivative of V^1 is negative for v != 0 only, and "V^1 < 0" lacks a dot; convergence to the goal rests '
        'on Assumption 6.1 (called "Assumption 5.1").',
        "dV^1/dt <= 0, with LaSalle's argument for v = 0.",
    ),
    slip("E6.10", "(6.4), (6.5)", "The difference is not squared; v in (6.5) lacks the index j.", "Sum of squares."),
    slip(
        "E6.11",
        "6.3-6.4, labels",
        '"Condition 6.3" is Condition 6.2; cases 1 and 2 are swapped between the conditions; the lower-bar h bounds '
        'from above in Condition 6.2; "Part C" is 6.3.3; Fig. 6.10 cites (6.21) for (6.25); three experiments are '
        "announced, "
        "two exist.",
    ),
    gap(
        "E6.12",
        "Table 6.1",
        "The norm bars in phi are missing (text extraction); the axis is not defined at phi = 0; the phase of [20] "
        "depends on c_i(x) and is not of the form (6.6).",
        "p = 0 at phi = 0, v = tau dx/dt.",
        evidence=("coupled_primitives.distance_waiting.goal_error",),
    ),
    reading(
        "E6.13",
        "(6.24)",
        "x_j^dw refers to itself, so that |d| = 33 <= 1 would be asked; an index for the other hand is probably lost "
        "(possibly in extraction). One hand about the other within 1 cm keeps the distance within 1 cm; both about "
        "their common centre within 1 cm each, within 2 cm. (6.25) leaves the directions open.",
        "Both hands about their common centre, in the present direction, with half the margin.",
        switch="skeleton_constraints.hand_margin=1.0",
        evidence=(
            "skeleton_constraints.printed_margin.hands_error_constrained",
            "skeleton_constraints.feedforward.hands_error_constrained",
        ),
    ),
    slip(
        "E6.14",
        "6.4.2, 6.4.1",
        "The printed range [24, 25] of the hand distance lies outside of 33 +- 1 ([34, 35] would fit the rest); the "
        "map of 20 x 16 cm is called a square.",
        evidence=(
            "skeleton_constraints.feedforward.hands_constrained_low",
            "skeleton_constraints.feedforward.hands_constrained_high",
        ),
    ),
    reading(
        "E6.15",
        "6.4, gamma = 0.7",
        "With tau equal to the duration the forcing term is at half its weight at the end, and the path leaves the "
        "goal afterwards. With tau = 1 s and segments of several seconds, a natural reading too, it hardly does.",
        "Movements end at their duration; both time constants are run.",
        switch="planar_skill.dmp.tau=1.0",
        evidence=("planar_skill.book.late_drift_max", "planar_skill.tau_1s.late_drift_max"),
    ),
    gap(
        "E6.16",
        "Remark 6.6",
        "The error is said to grow with k_2 (the authors: not conclusive); map, durations and law behind it are not "
        "printed. Here it falls under every law and time constant.",
        evidence=("barrier_anatomy.printed.k2_slope", "barrier_anatomy.feedforward.k2_slope"),
    ),
    reading(
        "E6.17",
        "Remark 6.6",
        "k_z = d_z^2 / 4 resembles critical damping; the poles of the error are k_z / d_z and k_2, so it has no such "
        "role. A heuristic.",
    ),
    slip(
        "E6.20",
        "below (6.6)",
        "f_2 is given as alpha_z (beta_z (g - x) - v), without the 1 / tau that v' of (6.6) needs and Remark 6.4 has.",
        "f_2 = alpha_z (beta_z (g - x) - v) / tau.",
    ),
    gap(
        "E6.21",
        "Fig. 6.8, (6.24), (6.25)",
        "Loop 1 corrects the elbow from the shoulder and the wrist from the elbow; (6.24) and (6.25) print constraints "
        "on the shoulder about the elbow and on the elbow about the wrist only, those of loop 2.",
        "Loop 1 holds the elbow at 22 cm from the shoulder and the wrist at 28 cm from the elbow, in their present "
        "directions and with the same margin.",
        switch="skeleton_constraints.loop1=false",
        evidence=tuple(
            f"skeleton_constraints.{case}.rmse_shoulder_left_constrained" for case in ("feedforward", "no_loop1")
        ),
    ),
    reading(
        "E6.19",
        "6.3.1",
        "A Lagrange polynomial is named as an example of interpolation; through many nodes it oscillates. Harmless "
        "with few local nodes.",
        "Cubic splines, as in the book's experiment.",
        evidence=("planar_skill.book.lagrange_deviation_max",),
    ),
)
