"""What a reader who implements Chapter 4 must know beyond the printed equations."""

from __future__ import annotations

from dexrepro.claims import error, gap, reading, slip

S, B, P = "skill_reuse", "barrier_and_switch", "payload_transfer"

ERRATA = (
    error(
        "E4.01",
        "(4.13)",
        "The joint-space matrices M, C, G multiply task-space derivatives of x.",
        "M(q) q'' + C(q, q') q' + G(q) = tau, as (4.14), (4.24) and (4.25) use it; plus J^T f_d in Sect. 4.5.",
    ),
    slip("E4.02", "(4.16), (4.18)", "The index of the error's component is missing.", "z_1(i)."),
    error(
        "E4.03",
        "(4.19)",
        "The term Pi has the wrong sign: the derivative of 1/2 ln 1/(1 - delta^2) holds -z phi'/phi^2. No effect on "
        "the law.",
        "Pi = -sum of h delta_b^2 phi_b'/((1 - delta_b^2) phi_b) + (1 - h) delta_a^2 phi_a'/((1 - delta_a^2) phi_a).",
    ),
    error(
        "E4.04",
        "(4.22)",
        "The bounds a and b are exchanged (h selects b; no matter where beta_a = beta_b), and the denominators carry "
        "dots, possibly by text extraction.",
        "l_i + h phi_b'/phi_b + (1 - h) phi_a'/phi_a >= 0; it holds with either sign, as l_i exceeds both ratios.",
    ),
    slip("E4.06", "(4.19)-(4.27), (4.33)", "P^T J is a row where a column of torques is meant.", "J^T P."),
    reading(
        "E4.07",
        "(4.26)",
        "Whether the square belongs to the exponential or to its argument is open, and omega has no printed value. "
        "With the square inside, E <= 1 needs omega >= 0.638, outside omega >= 2; below that E exceeds 1.",
        "The square inside and omega = 1; outside with 0.5, 1 and 2 runs as cases.",
        switch=f"{B}.law.switch.square_outside=true",
        evidence=tuple(f"{B}.{case}.rmse_mm" for case in ("base", "outside_half", "outside_one", "outside_two")),
    ),
    reading(
        "E4.08",
        "(4.26)",
        "The switching function is called smooth; it is continuous, with kinks at d_a and d_b. No effect was found.",
    ),
    reading(
        "E4.09",
        "below (4.26), 4.5",
        "d_a and d_b are multiples of the farthest node's radius, and also constants. Read: constants in the "
        "experiments, for all networks; the multiples are not printed, and large ones let the run diverge.",
        switch=f"{B}.law.switch.node_scaled=true",
        evidence=(f"{B}.base.rmse_mm", f"{B}.scaled_small.rmse_mm", f"{B}.scaled_large.diverged"),
    ),
    slip(
        "E4.10",
        "(4.30), (4.33)",
        "The law has the regressor Sn (k entries) for the weights Wn (3k entries, (4.12)); it may stand for all "
        "features. Taken literally the enhancement weights stay zero, which is the network without enhancement.",
        "Gn = [S, H].",
        switch=f"{B}.law.network.basis.enhanced=false",
        evidence=tuple(f"{B}.{case}.steady_rmse_mm" for case in ("base", "gaussians", "gaussians_equal_gain")),
    ),
    slip(
        "E4.11",
        "(4.7), (4.32)",
        "c-bar stands for c-bar_min; Theta is a threshold and, in (4.32), the inverse of Delta; beta and omega are "
        "reused.",
    ),
    gap(
        "E4.12",
        "4.5",
        "Neither the arm's initial state nor the phase of the ellipse is printed. From rest at the centre, a start at "
        "(1.3, 0) would be 0.3 m away, outside the bound of 0.25 m.",
        "Start at rest at the centre, ellipse from (1, 0.2).",
        switch=f"{B}.task.phase=0",
        evidence=(f"{B}.start_outside.max_usage", f"{B}.start_outside.violations"),
    ),
    slip("E4.13", "(4.33)", "A tilde stands for a hat.", "-E z_2 (W-hat - W*)^T S + E z_2 W-tilde^T S = 0."),
    error(
        "E4.14",
        "(4.38)",
        "Q lacks the factor 1/2 of V_1 in (4.17). The printed eta_s remains valid and is only conservative.",
        "Q = sum of 1/2 ln 1/(1 - chi_i^2).",
    ),
    error(
        "E4.15",
        "(4.39)",
        "V' = eta_s V + mu_s cannot give (4.40), and mu_s lacks gamma; letters of its last term differ from (4.35). "
        "Signs and letters may be text extraction.",
        "V' <= -eta_s V + mu_s, with 1/2 gamma |W*|^2 + 1/2 epsilon^2 + iota omega-bar.",
    ),
    error(
        "E4.16",
        "after (4.40)",
        "V' is not definitely negative, as mu_s > 0.",
        "Negative outside a ball; the errors are uniformly ultimately bounded, as the theorem itself says.",
    ),
    reading(
        "E4.17",
        "4.6",
        "nu = 0 for the three orientation rows would divide by zero; with zeros in the same rows of K_1 they mean that "
        "orientation is not controlled. Read: three rows.",
        evidence=(f"{P}.reuse.hand_tilt",),
    ),
    slip("E4.18", "4.6", "A comma is missing in the points A, B, C.", "z = -0.25 m."),
    slip(
        "E4.19",
        "4.6",
        "The fourth interval of the box, [0.8, 0.1], is reversed; the value that is meant is open.",
        "[0.8, 1.0], a guess.",
    ),
    gap(
        "E4.20",
        "4.6",
        "Where the references of phase III begin is not stated; from A they would start far from the arm, outside "
        "the bound.",
        "They begin at the initial position.",
    ),
    slip("E4.21", "(4.27)", "tau_x is a joint torque.", "tau."),
    gap(
        "E4.22",
        "4.5, 4.6",
        "Delta, gamma, eta, n, beta of (4.6), T, Y^U, m, c and the duration of the motions are not printed. Delta and "
        "eta decide several rankings: see the rows of one common gain and those of equal effective gain in Table T4.A.",
        "Chosen as stated in the configuration.",
        evidence=tuple(
            f"{S}.{case}.rmse_mm" for case in ("broad20", "rbf_tuned", "common_rbf10", "fuzzy", "common_fuzzy")
        ),
    ),
    gap(
        "E4.23",
        "4.6",
        "Whether 58 and 72 nodes are those added in phases I and II, or those there are after each, is not said.",
        "Both are given: after phase I, after II, and by their difference those added in II.",
        evidence=(f"{P}.reuse.nodes_phase1", f"{P}.reuse.nodes_phase2"),
    ),
)
