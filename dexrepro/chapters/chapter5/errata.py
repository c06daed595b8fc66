"""What a reader who implements Chapter 5 must know beyond the printed equations."""

from __future__ import annotations

from dexrepro.claims import error, gap, reading, slip

ACCURACY, STYLES, TRACKING = "letter_accuracy", "style_transformation", "bounded_tracking"
UPDATE, CROSSING = "incremental_update", "obstacle_crossing"

ERRATA = (
    error(
        "E5.01",
        "(5.5), (5.23), (5.26)",
        "The target forcing has - D v; solving (5.1) for f gives + D v (chapter 6 prints it so).",
        "+ D v",
        switch="letter_accuracy.training.printed=true",
        evidence=(
            *(f"{ACCURACY}.{case}.n20.dmp.mse" for case in ("default", "printed_damping")),
            *(f"{STYLES}.{case}.z.final" for case in ("default", "printed_damping")),
            *(f"{CROSSING}.{case}.skill3.rms" for case in ("default", "printed_damping")),
        ),
    ),
    slip(
        "E5.02",
        "(5.4)",
        "The index k runs over samples in the sum and over demonstrations in the text; K is also the stiffness.",
        "Two indices.",
    ),
    reading(
        "E5.03",
        "(5.8), text",
        "The sum of the features being s is called the insurance of monotone convergence to g. It is sufficient for "
        "convergence (non-negative features that sum to s vanish with it), not necessary, and has nothing to do with "
        "monotony: every letter has turning points.",
        "Any bounded features times s converge.",
        evidence=tuple(f"{ACCURACY}.default.n{n}.idmp60.limit" for n in (5, 20)),
    ),
    error(
        "E5.04",
        "(5.12), (5.19)",
        "The first line of (5.19) has n + m weights, the last 2n + m; they agree only where theta_C = theta.",
        "The last line, whose features still sum to s.",
        evidence=(f"{UPDATE}.mechanism.sum_to_phase",),
    ),
    slip(
        "E5.05",
        "(5.14), text",
        "psi_k is said to be scaled up by sum phi / (sum phi + sum eta); for positive eta that is less than 1.",
        "Scaled down.",
        evidence=(f"{UPDATE}.mechanism.share_low", f"{UPDATE}.mechanism.share_high"),
    ),
    error(
        "E5.06",
        "(5.17), (5.18)",
        "gamma_j contains s, and (5.18) multiplies it by s once more; (5.19)-(5.21) do not.",
        "No further s in (5.18).",
        evidence=(f"{UPDATE}.mechanism.printed_miss",),
    ),
    reading(
        "E5.07",
        "(5.11)",
        "The map zeta is left open. One that takes both signs lets sum phi + sum eta, which everything is divided by, "
        "pass through zero.",
        "A positive map; here the logistic sigmoid.",
        evidence=tuple(f"{UPDATE}.activations.{name}.changes_sign" for name in ("sigmoid", "tanh", "sin")),
    ),
    reading(
        "E5.08",
        "Lemma 5.1",
        "Taken exactly, the hypothesis Y = A W leaves nothing to update (b^T Y = 0); meant is the least-squares sense, "
        "W = A^+ Y.",
        "W = A^+ Y.",
    ),
    reading(
        "E5.09",
        "Lemma 5.1, c = 0",
        "1 + d^T d needs the identity for 1 where more than one column is added, as is usual in the broad-learning "
        "literature; the fit is the same, the pseudo-inverse is not.",
        "I + d^T d.",
        evidence=(f"{UPDATE}.lemma.dependent.printed.error", f"{UPDATE}.lemma.dependent.scalar.error"),
    ),
    error(
        "E5.11",
        "(5.24), (5.29)",
        "The initial theta_C = Psi^+ Delta f lacks the factor Gamma / (1 - Gamma), which is negative: the first update "
        "leads away from the target style.",
        "Psi^+ [Gamma / (1 - Gamma) Delta f].",
        switch="style_transformation.training.relearn_old=true style_transformation.training.solution=printed_start",
        evidence=tuple(f"{STYLES}.{case}.z.{m}" for case in ("printed_start", "row_wise") for m in ("start", "final")),
    ),
    reading(
        "E5.12",
        "(5.24), (5.29)",
        "Gamma depends on s, so Gamma / (1 - Gamma) stands for a diagonal matrix over the samples, between b^T and "
        "Delta f; read as one number the fit is poorer.",
        "Row by row, or least squares of Delta f, which is as accurate.",
        switch="letter_accuracy.training.solution=scalar",
        evidence=tuple(f"{ACCURACY}.{case}.n20.idmp30.mse" for case in ("default", "row_wise", "scalar")),
    ),
    error(
        "E5.13",
        "(5.24), (5.29)",
        "c = Psi^+ Psi Upsilon - Upsilon and d = -Psi^+ Upsilon ask for Psi stored in two ways; their shapes do not "
        "fit each other.",
        "c = Psi Psi^+ Upsilon - Upsilon.",
    ),
    error(
        "E5.14",
        "Algorithm 5.1",
        "Loops end 'until j < m' and 'until e does not reach delta', j is nowhere incremented, and (5.16), (5.17) are "
        "cited for (5.17), (5.18).",
        "Until j = m; until e < delta or a largest m.",
    ),
    reading(
        "E5.15",
        "(5.1)",
        "The amplitude g - x0 is the usual one and degenerates where start and goal agree on an axis: letters in y, "
        "crossings in y and z.",
        "A constant amplitude on such axes.",
        switch="obstacle_crossing.dmp.amplitude=printed obstacle_crossing.demonstration.end_offset=0.02",
        evidence=tuple(f"{CROSSING}.{case}.goals3.free" for case in ("default", "printed_amplitude")),
    ),
    slip(
        "E5.16",
        "Property 5.1",
        "M' - C is not skew-symmetric; M' - 2C is, which (5.42) uses and chapter 8 prints.",
        "M' - 2C.",
    ),
    error(
        "E5.17",
        "(5.32)",
        "The network enters with the wrong sign for the weight law (5.44); it changes between (5.33) and (5.34). The "
        "printed sign makes learning a positive feedback.",
        "+ g(S), or the first sign of (5.44) turned.",
        switch="bounded_tracking.law.printed=[network]",
        evidence=tuple(
            f"{TRACKING}.{c}.{m}"
            for c in ("letter_w", "printed_sign", "sign_only", "printed", "printed_no_robust")
            for m in ("bound_use", "outside")
        )
        + ("obstacle_tracking.printed.bound_use", "knowledge_reuse.printed_sign.w.early"),
    ),
    error(
        "E5.18",
        "(5.33)",
        "- G(q_d) - G(q) should be G(q) - G(q_d).",
        "G(q) - G(q_d); K_3 in the same line is K_tau (possibly text extraction).",
    ),
    error(
        "E5.19",
        "(5.34)",
        "Signs of K_tau delta, of the contact error tau_e - tau_e_hat (also in Y before (5.33)) and of G(q_d) - G(q); "
        "(5.42) has the right sign of K_tau.",
        "- K_tau delta, - (tau_e - tau_e_hat).",
    ),
    error(
        "E5.20",
        "(5.35)",
        "The argument of the second logarithm is negative everywhere inside the bound, and the factor 1/2 of (5.37) "
        "is missing.",
        "1/2 ln((k_1 v)^2 / ((k_1 v)^2 - e^2)).",
    ),
    error(
        "E5.21",
        "(5.37)-(5.43)",
        "k_1 and k_2 multiply e e' but were lost from the other term.",
        "(e e' - e^2 v'/v) / (b^2 - e^2), F_i = e / (b^2 - e^2); for k_1 = k_2 = 1 (5.37) is right.",
    ),
    error(
        "E5.22",
        "(5.39), (5.40)",
        "e^2 / (e^2 - (k_1 v)^2) > 0 does not hold inside the bound.",
        "(k_1 v)^2 - e^2; (k_2 L - v')/v in (5.39) is probably a matter of text extraction.",
    ),
    reading(
        "E5.23",
        "L before (5.39)",
        "(5.39) needs L - v'/v <= -k_c; L = -sqrt(1/k_2^2 + 1/k_1^2 + k_c^2) |v'/v| gives about k_c |v'/v|, whose "
        "unit is not that of a rate: enough where |v'/v| is above about 1/s, too little below, and nothing once v has "
        "reached a floor. A radical over the first two terms may have been meant.",
        "L = -(k_c + |v'/v|), so that L - v'/v <= -k_c.",
        switch="bounded_tracking.law.printed=[virtual_gain]",
        evidence=tuple(
            f"{TRACKING}.{c}.{m}"
            for c in ("printed_gain", "printed_gain_no_network")
            for m in ("bound_use", "error_rms")
        ),
    ),
    gap(
        "E5.24",
        "(5.32), (5.47)",
        "The gradient F of the barrier never enters the torque; (5.47) asks the weight law to dominate it, but the "
        "sign of that term is indefinite.",
        "+ rho F in the torque.",
        switch="bounded_tracking.law.barrier_gain=0",
        evidence=tuple(f"{TRACKING}.{case}.bound_use" for case in ("no_network", "no_network_no_barrier")),
    ),
    error(
        "E5.25",
        "(5.44)",
        "u tanh(u delta / w) delta is never negative: it drives every weight upward whatever the error; u, w and iota "
        "are not defined.",
        "u = 0; the term belongs into the torque.",
        switch="bounded_tracking.law.robust_rate=1",
        evidence=tuple(
            f"{TRACKING}.{case}.outside" for case in ("letter_w", "small_robust", "printed_robust", "sign_robust")
        ),
    ),
    error(
        "E5.26",
        "(5.45), (5.49)",
        "V_m and the V_2 of V lack the factor 1/2, and (5.49) has = for <=; the third entry of eta is twice too large.",
        "1/2 W~^T Gamma_s^-1 W~; <=.",
    ),
    error(
        "E5.32",
        "(5.46)-(5.48)",
        "The step to (5.48) bounds epsilon delta by delta^2 / 2 + epsilon^2 / 2, writes the second term and drops the "
        "first; with it the decay is by K_tau - 1/2, so that K_tau > 1/2 is needed.",
        "epsilon delta <= a delta^2 + epsilon^2 / (4 a) with a < K_tau: decay by K_tau - a for any K_tau, and a larger "
        "sigma. Here K_tau is below 1/2.",
        evidence=(f"{TRACKING}.letter_w.lyapunov_late",),
    ),
    reading(
        "E5.27",
        "v(t)",
        "A pure exponential makes the bound vanish, and no sampled law stays inside; 'exponentially decaying "
        "performance function' usually includes a floor.",
        "v = (v_0 - v_inf) exp(-a t) + v_inf.",
        switch="bounded_tracking.bound.final=0",
        evidence=tuple(f"{TRACKING}.{case}.outside" for case in ("letter_w", "exponential", "exponential_slow")),
    ),
    error(
        "E5.29",
        "(5.38), (5.40)",
        "- k_1 e (L e) becomes + L k_1 e^2; this compensates the wrong sign of e^2 - (k_1 v)^2.",
        "(L - v'/v) e^2 / (b^2 - e^2) on both sides.",
    ),
    error(
        "E5.30",
        "(5.42), (5.43)",
        "F_i is called positive and limited; it has the sign of e_i and grows without limit at the bound.",
        "F_i = e_i / (b^2 - e_i^2).",
    ),
    slip("E5.31", "text before (5.28)", "theta_i^C multiplies Upsilon^c.", "theta_i^U, as in (5.27)."),
)
