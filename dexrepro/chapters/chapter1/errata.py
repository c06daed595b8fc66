"""What a reader who implements Chapter 1 must know beyond the printed equations."""

from __future__ import annotations

from dexrepro.claims import error, gap, reading, slip

TRACKING = "force_tracking"

ERRATA = (
    error(
        "E1.01",
        "(1.3)",
        "k_E (X_c - X_d) is positive feedback for k_E > 0: the arms leave their paths within a tenth of a second.",
        "k_E (X_d - X_c)",
        f"{TRACKING}.inverse_gain=-100",
        (f"{TRACKING}.c1_printed_inverse.finished", f"{TRACKING}.c1_proposed.tracking"),
    ),
    slip("E1.02", "(1.11)", "The last term has Delta X_D in the leader's frame.", "Delta X_L, as in (1.10)"),
    reading(
        "E1.03",
        "(1.11), (1.45)",
        "With s(v) applied to the total displacement since the fixing the tool is pulled back whenever the hand slows "
        "down; (1.11) is stated for a constant s and says that t_0 may be set anew at will.",
        "Apply s to the displacement of each sample (fix anew every sample).",
        evidence=(
            "relative_pose.default.incremental_end",
            "relative_pose.default.total_end",
            "relative_pose.default.total_pull_back",
        ),
    ),
    slip(
        "E1.04",
        "text after (1.12)",
        "1 + r11 + r22 + r33 equals 4 q0^2 and is never negative; the singular case is 0 (half-turns), where rounding "
        "can make it negative.",
        "Take the quaternion from the largest of its four components.",
        evidence=(
            "relative_pose.default.half_turn_printed",
            "relative_pose.default.half_turn",
            "relative_pose.default.radicand",
        ),
    ),
    slip(
        "E1.05",
        "(1.19), (1.21), (1.22), (1.37)",
        "X_1, X_2, z_2, w_m stand for X_D, X_A, z_A, w_um; x_D in the two compared laws of 1.5.1 is AFR's position.",
    ),
    reading(
        "E1.06",
        "(1.20)",
        "d_3 jumps at the upper bound; the weight w_3 gates the jump exactly only where the object is on the holding "
        "line.",
    ),
    reading(
        "E1.07",
        "(1.24)",
        "sgn(F) min(|k_p F|, dX_max) of a vector may be meant by component (taken here) or along F; they agree as long "
        "as nothing is clipped.",
    ),
    slip("E1.08", "(1.27)", "The dots before the last term are missing; m lags make m + 1 weights."),
    slip("E1.09", "(1.29), (1.32), (1.42)", "The derivative is of the estimate (hat), not of its error (tilde)."),
    error(
        "E1.10",
        "(1.25), (1.26) against (1.30), (1.32)",
        "With e_f = f_z - f_d and a compressed spring, -alpha e_f in (1.32) is positive feedback: taken together the "
        "definition and the laws lose contact at once, whatever the direction of z. The laws are consistent among "
        "themselves, and with both compared controllers, for the opposite definitions.",
        "e_f = f_d - f_z and e_z = z_r - z_A, all laws as printed.",
        f"{TRACKING}.law.printed=true",
        (
            f"{TRACKING}.c1_printed.rmse",
            f"{TRACKING}.c1_proposed.rmse",
            "hold_and_move.t1_printed.rmse",
            "sensitivity.tracking.best_printed_c1",
        ),
    ),
    reading(
        "E1.11",
        "(1.30)",
        "The sign of the beta term belongs to the same definition of e_f; part of E1.10, not an error of its own, and "
        "invisible at the printed beta of 1e-4.",
    ),
    reading(
        "E1.12",
        "(1.37), (1.43), (1.44)",
        "With the printed definitions the cross terms of dV/dt do not cancel; part of E1.10, not an error of its own.",
        "As E1.10; (1.44) then stands as printed.",
        "lyapunov.printed=true",
        ("lyapunov.ideal.rising", "lyapunov.printed.rising"),
    ),
    gap(
        "E1.20",
        "after (1.44)",
        "That z~, e_z' and e_f converge does not follow from dV/dt <= 0 alone, which bounds them and makes their "
        "squares integrable: it needs rates that stay bounded (Barbalat), so a bounded regressor and, by E1.17, a "
        "stiffness that does not vary too fast. Of the weights nothing follows.",
        "They converge where Z stays bounded; compare E2.04.",
        evidence=("lyapunov.ideal.end", "force_tracking.c1_proposed.rmse_late", "force_tracking.c3_proposed.rmse_late"),
    ),
    error(
        "E1.13",
        "(1.35), (1.38)-(1.40)",
        "W~ = W - W^ contradicts the signs of (1.38) and (1.39); the dot on W~ in (1.39) and (1.40) is spurious, "
        "possibly by text extraction.",
        "W~ = W^ - W",
    ),
    gap(
        "E1.14",
        "(1.31)",
        "z_d(t - dt) = z_A(t) presumes the tracking that is to be proved; with it V rises during part of the run, and "
        "with small estimator gains the force error grows before it decays.",
        "It does not grow where N (1 - k beta) < L (L + k alpha) with N = Z.Z.",
        evidence=(
            "lyapunov.built.rising",
            "lyapunov.growth.growth_0p12",
            "lyapunov.growth.growth_0p3",
            "lyapunov.growth_long.growth_0p12",
        ),
    ),
    gap(
        "E1.15",
        "(1.33)",
        "With z_r(0) = 0 the literal form puts AFR on DFR.",
        "X_A = X_D + R_D [0, 0, l_c + z_r] with the distance l_c at first contact.",
    ),
    reading(
        "E1.16",
        "1.5.1, compared controllers",
        "With e_f of (1.25) the force controller runs away while the passive one is stable; part of E1.10, not an "
        "error of its own.",
    ),
    gap(
        "E1.17",
        "(1.37)",
        "A varying k_o adds k_o' e_f^2 / (2 k_o^2) to dV/dt; harmless here (0.001 against alpha = 0.11).",
        "alpha > max |k_o'| / (2 k_o^2)",
    ),
    slip("E1.18", "Theorem 1.1", "It is an assumption (perfect tracking without delay), not a theorem."),
    gap(
        "E1.19",
        "1.5.1, 1.5.2",
        "Not printed: M, D, K of the proposed law, sample time and duration of Fig. 1.10, all gains of the potential "
        "field, the stiffness of the object in Fig. 1.18, the gains for rigid boxes.",
    ),
)
