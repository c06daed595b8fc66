"""What a reader who implements Chapter 8 must know about its equations and numbers."""

from __future__ import annotations

from dexrepro.claims import error, reading, slip

CIRCLE, OBJECT, SPONGE = "circle_tracking", "unknown_object", "sponge"

ERRATA = (
    reading(
        "E8.01",
        "8.4.1",
        "The pose of the arm is not stated. Elbow-down and with rate 1 the law holds less in the middle of "
        "the y bound than the load at the start: the arm comes to rest near the bound, which a sampling "
        "time of {circle_tracking.step:g} s does not survive.",
        "Elbow-up. Elbow-down with a step of {circle_tracking.cases.down_unit_fine.step:g} s no bound is violated "
        "either.",
        "circle_tracking.arm.elbow=1",
        (f"{CIRCLE}.down_unit.violated_at", f"{CIRCLE}.down_unit_fine.bound_used"),
    ),
    reading(
        "E8.02",
        "(8.30)",
        "phi changes its sign beyond the bound, and sqrt(2) iota is a stable false equilibrium: after a violation, "
        "which only sampling can bring about, a run may look settled.",
        "A violation ends the run and is reported.",
    ),
    reading(
        "E8.03",
        "(8.38)-(8.40)",
        "The laws have no adaptation rate. With rate 1 and leakage 5 the networks supply "
        "{circle_tracking.broad_unit.network_force:.2g} N, with tuned rates {circle_tracking.broad.network_force:.2g} "
        "N. (8.36) is consistent with rate 1; rates may be unprinted.",
        "Rates Gamma, given beside the printed 1.",
        "circle_tracking.networks.rates=[1,1,1]",
        (
            f"{CIRCLE}.broad_unit.network_force",
            f"{CIRCLE}.broad.network_force",
            f"{CIRCLE}.friction_broad_unit.early_y",
            f"{CIRCLE}.orbit_left_unit.bound_used",
        ),
    ),
    slip(
        "E8.04",
        "(8.31)",
        "M_x + C_x + G_x stands where the estimates and their factors belong; the sentence after it and (8.35) have "
        "them.",
        "D alpha' + C alpha + G, all estimated.",
    ),
    error(
        "E8.05",
        "(8.27), (8.31)",
        "tau_e acts on the robot with a plus in (8.1), (8.6) and with a minus in (8.5), (8.27): the plus in (8.31) "
        "cancels it with (8.27) and doubles it with (8.1). In the simulation the error in x is "
        "{unknown_object.force_sign_printed.max_error_x:.2f} mm with it, {unknown_object.soft.max_error_x:.2f} mm "
        "without: too little to tell which.",
        "-tau_e in (8.31) with (8.1) and (8.6).",
        "unknown_object.law.printed=true",
        (f"{OBJECT}.force_sign_printed.max_error_x", f"{OBJECT}.soft.max_error_x"),
    ),
    error(
        "E8.06",
        "(8.35)",
        "With the tilde as hat minus star the approximation error enters with a minus.",
        "-E; harmless, as Kr > |E|.",
    ),
    error(
        "E8.07",
        "(8.36)-(8.42)",
        "Sums start at 0; gamma contains 2 k1 where the barrier part decays with exactly k1; beta is lost from "
        "(8.42), gamma and nu; (8.41) is an inequality.",
        "gamma = min(k1, 2 lmin(Kp)/lmax(M_x), beta), nu = beta/2 |W*|^2. Boundedness itself is not touched.",
    ),
    reading(
        "E8.08",
        "(8.21)",
        "[W_b | 0, 0] adds two zeros, a node adds three features; the zeros may be blocks.",
        "Three zeros.",
    ),
    error(
        "E8.09",
        "(8.8)",
        "s' = M s with x_d = N s cannot generate the circle of (8.46), and M = -1 contradicts it. Regressing on s = "
        "x_d/N gives a gain of the wrong sign. Which s the authors regressed on is not stated.",
        "An auxiliary s that obeys s' = M s in the regression (the identity holds for any), the desired path in the "
        "law.",
        "unknown_object.interaction.gain.exosystem=null",
        (f"{OBJECT}.soft.desired_path_gain_x", f"{OBJECT}.soft.gain_x"),
    ),
    reading(
        "E8.10",
        "(8.6), 8.4.3",
        "The object's force has the offset 0.22 m, which (8.6) lacks: x must count from the surface, whose position "
        "must then be known. In absolute coordinates the gain is wrong and the bound is violated.",
        "x and x_d from the surface found by touch.",
        "unknown_object.interaction.origin=0.0",
        (f"{OBJECT}.absolute.violated_at", f"{OBJECT}.soft.surface_low_gain_x", f"{OBJECT}.soft.surface_high_gain_x"),
    ),
    error(
        "E8.11",
        "Algorithm 8.1",
        "tau_e = K_0 zeta (three times) against tau_e = -K zeta above (8.9); K_0 stabilises only with the minus. With "
        "tau_e as the force on the environment the plus would be right: the clash of E8.05.",
        "Minus.",
        "unknown_object.interaction.printed=true",
        (f"{OBJECT}.plus.diverged_at",),
    ),
    error(
        "E8.12",
        "(8.12), (8.13)",
        "Q + K^T R K^T does not multiply; indices k and m are mixed; the list of P lacks 2 P_13 ... 2 P_1p (harmless "
        "for p = 2, perhaps lost in extraction).",
        "Q_m = Q' + K_m^T R K_m and all upper entries of P.",
    ),
    error(
        "E8.14",
        "8.5",
        "U = 0.001 > 0 is a growing mode that cannot be stabilised: the Riccati equation has no stabilising solution. "
        "Ce = -0.4 is negative damping (a reading: with tau_e on the environment only A has the wrong sign, and the "
        "gain is {sponge.lqr_printed_environment.gain_x:.0f} in place of {sponge.lqr.gain_x:.0f} N/m). With tau_e on "
        "the robot the printed gain runs away.",
        "Ce = 0.4, M = -1.",
        "+sponge.cases.as_printed={interaction:{gain:{_target_:dexrepro.control.impedance_learning.ConstantGain,gain:{_target_:dexrepro.control.interaction_optimum.model_gain,model:[7,-0.4,0.001],cost:${sponge.cost}}}}}",
        (f"{SPONGE}.lqr_printed.stopped_at", f"{SPONGE}.lqr_printed_environment.final_compression"),
    ),
    reading(
        "E8.16",
        "8.5",
        "Equal thresholds for D and G with the same rule and input give equal counts, 14 and 38 are printed: their "
        "inputs, or m and beta_1, must differ. They are not printed.",
        "Task-space inputs; joint inputs would make more nodes.",
        "",
        (f"{SPONGE}.learned.nodes_d", f"{SPONGE}.learned.nodes_g", f"{SPONGE}.learned.joint_nodes_d"),
    ),
    reading(
        "E8.17",
        "8.5",
        "At the printed 50 Hz the velocity loop is unstable on this model, with "
        "{sponge.cases.at_200_hz.control_period:g} s between samples it is not. The real robot has inner loops and "
        "friction that the model lacks.",
        "{sponge.control_period:g} s between samples.",
        "sponge.control_period=0.02",
        (f"{SPONGE}.at_50_hz.stopped_at", f"{SPONGE}.at_200_hz.bound_used"),
    ),
    error(
        "E8.18",
        "(8.2)-(8.4)",
        "J is said to be k x d and is inverted; it is d x k, and not square for the Baxter arm.",
        "(J M^-1 J^T)^-1 for the task inertia.",
    ),
    slip(
        "E8.19",
        "8.4",
        "Case 1 cites Fig. 8.8c, d (it is Fig. 8.6); RBFNN and FNN name the same network; subsection II-B and Theorem "
        "1 do not exist.",
    ),
)
