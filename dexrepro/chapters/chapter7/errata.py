"""What a reader who implements Chapter 7 must know beyond the printed equations."""

from __future__ import annotations

from dexrepro.claims import error, gap, reading, slip

DEMONSTRATIONS, LEARNING = "reaching_demonstrations", "reactive_learning"
STYLES, FUZZY = "style_separation", "fuzzy_generalisation"
TRACKING, STABILITY = "impedance_tracking", "impedance_stability"

ERRATA = (
    error(
        "E7.01", "(7.1), (7.38), (7.42), (7.43)",
        "J F_e: a force on the tip loads the joints through the transposed Jacobian; for a square J the dimensions "
        "do not show it.",
        "J^T F_e.",
    ),
    slip("E7.02", "Property 7.1", "M - 2 C is called skew-symmetric; (7.43) has dM/dt.", "dM/dt - 2 C."),
    slip(
        "E7.03", "(7.3), text", "K and D are called damping and stiffness, in this order.",
        "K is the stiffness, D the damping.",
    ),
    slip("E7.04", "(7.4)", "The fraction bar is missing; (7.15) has it.", "psi_i = phi_i s / sum phi."),
    reading(
        "E7.05", "(7.14)-(7.16)",
        "Gamma 'has a confirmed value': at a given s. It depends on s, and needs sum eta > - sum phi, which an odd "
        "activation breaks in some draws of the nodes.",
        "Write Gamma(s); use a positive activation.",
        evidence=(f"{LEARNING}.frozen.gamma_lowest", f"{LEARNING}.frozen.gamma_highest",
                  f"{LEARNING}.frozen.tanh_crossings"),
    ),
    reading(
        "E7.06", "(7.19), Step 6.3",
        "theta^N Xi^A lacks transposes and equals (7.18) only if the old nodes keep theta; Step 6.3 optimises all of "
        "theta^N. With free old weights (7.19) is a definition of Delta f and only (7.17) is lost.",
        "Keep theta (gradual learning), or declare the old block a free set of weights (best fit).",
        switch=f"{LEARNING}.old_weights=refit",
        evidence=(f"{LEARNING}.frozen.rmse1", f"{LEARNING}.refit.rmse1"),
    ),
    slip(
        "E7.07", "(7.7), (7.8)", "The first line of (7.8) writes W_e for W_h, the text below F^n for Z^n.",
        "W_h, Z^n.",
    ),
    reading(
        "E7.08", "Remark 7.2 with (7.9)",
        "A new group changes Gamma(s) and with it every old column of Xi^A, so that (7.9), which appends columns, "
        "does not update theta^N; the text never says that it does, and (7.24) from scratch is its procedure.",
        "Fit again at every stage.",
    ),
    error(
        "E7.09", "(7.21)-(7.23)",
        "- D v: solving (7.3) for f gives + D v. Printed three times. In (7.23) alone the learned reaction is worse "
        "than none.",
        "+ D v.", switch="shared.printed_target=true",
        evidence=(f"{DEMONSTRATIONS}.corrected.ordinary_rmse", f"{DEMONSTRATIONS}.printed_sign.ordinary_rmse",
                  f"{LEARNING}.frozen.no_reaction", f"{LEARNING}.frozen.printed_difference"),
    ),
    reading(
        "E7.10", "(7.3), (7.21), (7.36)",
        "The factor g - x0 of each coordinate vanishes where start and goal agree (heights, stiffness) and turns no "
        "path: the known limitation of this form of the primitive.",
        "Carry the forcing over by a matrix in the frame of the path.",
        switch=f"{FUZZY}.task.printed=[scaling]",
        evidence=(f"{FUZZY}.main.clearance_three", f"{FUZZY}.printed_per_axis.clearance_three"),
    ),
    slip(
        "E7.11", "(7.20)",
        "k-means is no supervised method; the sum over demonstrations runs to n, the number of kernels.",
        "(Weighted) least squares over all demonstrations.",
    ),
    slip(
        "E7.12", "(7.15)", "eta_{k-n} = 0 for k - n < 0 leaves k = n out; harmless, its factor is 0.",
        "k <= n.",
    ),
    reading(
        "E7.13", "(7.26)-(7.28)",
        "lambda_k reads as a number or as a row of style parameters. With styles as rows the shapes conform and the "
        "singular value decomposition keeps several; 'coefficient' and the list of K numbers suggest one.",
        "Several style parameters, as the singular values ask for.", switch="shared.style.rank=1",
        evidence=(f"{STYLES}.per_coordinate.mean1", f"{STYLES}.per_coordinate.mean2"),
    ),
    slip("E7.14", "throughout", "lambda_k, Gamma, gamma, K, tau, T, M, V and G have two meanings each."),
    slip(
        "E7.15", "(7.11), (7.32), (7.35)",
        "The sums over rules run to m; x_i and t_i name the same inputs, X_i can be the condition of the new task.",
        "Sums to n_j, the number of rules.",
    ),
    slip(
        "E7.16", "(7.33), (7.36)",
        "T X' = V' has a dot too many, by print or by text extraction; literally the movement ends "
        "{fuzzy_generalisation.printed_kinematics.end_error:.0f} cm short.",
        "T X' = V, as in (7.3) and (7.12).", switch=f"{FUZZY}.task.printed=[kinematics]",
        evidence=(f"{FUZZY}.main.end_error", f"{FUZZY}.printed_kinematics.end_error"),
    ),
    reading(
        "E7.17", "(7.33), text",
        "T, the 'sampling time interval', is the duration of the sampled motion; 'start and end as G and X_0' is "
        "swapped.",
        "Start X_0, end G.",
    ),
    error(
        "E7.18", "(7.38), (7.39) second line",
        "tau_hat is subtracted, and its second line is minus what acted plus K_imp r: what acted comes out right, "
        "K_imp r with the wrong sign. The closed loop M r' + (C - K) r diverges.",
        "tau = ... + tau_hat with tau_hat = (tau - M q'' - C q' - G)(t - L) + K_imp r.",
        switch=f"{TRACKING}.law.printed=[second_line]",
        evidence=(f"{TRACKING}.muscle.rms_error", f"{TRACKING}.printed.diverged_at",
                  f"{TRACKING}.printed_unlimited.diverged_at", f"{STABILITY}.displaced_printed.lyapunov_rise"),
    ),
    error(
        "E7.19", "(7.39)",
        "Its two lines differ in sign: with tau_e = f - J^T F_e, tau_e = tau - M q'' - C q' - G. The first line, "
        "subtracted as in (7.38), diverges as well.",
        "As E7.18, or define tau_e = J^T F_e - f.", switch=f"{TRACKING}.law.printed=[first_line]",
        evidence=(f"{TRACKING}.printed_first_line.diverged_at",),
    ),
    error(
        "E7.20", "(7.40)",
        "sign(r) Gamma eps / r is infinite at r = 0, so that K r is a relay of Gamma eps (100 N m if eps is in N, "
        "which is not printed), and r is a vector. Within the torque limit it chatters.",
        "A joint at a time, with a boundary layer; Gamma just above alpha is enough.",
        switch=f"+{TRACKING}.cases.as_printed={{law:{{impedance:{{_target_:dexrepro.control.time_delay_impedance"
        ".RobustImpedance,stiffness_gain:10.0,switching_gain:100.0,force_bound:1.0,boundary_layer:1e-9}}}",
        evidence=(f"{TRACKING}.robust_printed.rms_error", f"{TRACKING}.robust_printed.torque_travel",
                  f"{TRACKING}.robust_small.rms_error", f"{TRACKING}.jumps_robust_printed.rms_error"),
    ),
    slip(
        "E7.21", "(7.42)", "M r lacks a dot, as (7.43) shows; it follows from (7.39), not from Step 6.3.",
        "M r' + (C + K_imp) r.",
    ),
    slip("E7.22", "(7.43)", "2 alpha eps r lacks a norm.", "2 alpha eps |r|."),
    gap(
        "E7.23", "(7.42)-(7.44)",
        "The proof is in continuous time with exact M, C, G and has no upper bound on K_imp; the sampled loop is "
        "stable only for 0 < Mb/M < 2 and K_imp < (4 M - 2 Mb)/L (one axis).",
        "Bound k_s by the spectral radius of the sampled loop.",
        evidence=(f"{STABILITY}.measured_stable", f"{STABILITY}.measured_unstable", f"{STABILITY}.predicted_unstable"),
    ),
    reading(
        "E7.25", "7.4.1",
        "'From 1 block to 3 blocks' against a tall obstacle of 8 cm, four cubes; defensible if three blocks are added.",
        "2 and 8 cm, as in Table 7.1.",
    ),
    slip(
        "E7.26", "7.3.1, Table 7.1, (7.34)",
        "Steps are numbered 6.x; Table 7.1 lacks the long distance and (7.34) its number.",
    ),
    gap(
        "E7.27", "7.4",
        "Coordinates have no unit and no single one fits: in mm the far obstacle leaves the board or the new end "
        "lies on an obstacle. Here numbers up to 21 are cm, larger ones mm.",
        "State the units.",
    ),
    error(
        "E7.28", "(7.42), (7.43)",
        "+ J (F_e - F_e(t - L)): with tau_e = f - J^T F_e the sign is minus; harmless, only the norm is used.",
        "- J^T (F_e - F_e(t - L)).",
    ),
)  # fmt: skip
