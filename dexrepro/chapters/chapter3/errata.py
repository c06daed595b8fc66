"""What a reader who implements Chapter 3 must know beyond the printed equations."""

from __future__ import annotations

from dexrepro.claims import error, gap, reading, slip

FIXED, PUSH, SETTLING = "fixed_opening", "external_push", "settling_time"

ERRORS = (
    error(
        "E3.07",
        "(3.15)",
        "The quadratic term has a minus sign; from Lagrange's equations d p_i/dt = dL/dq_i + tau_i.",
        "+ (1/2) dq^T (dM/dq_i) dq, which is (C^T dq)_i. The observer uses C^T dq, so nothing else is affected.",
    ),
    error(
        "E3.12",
        "(3.25)",
        "x_2d contains + e_2 while e_2 = x_2 - x_2d: the right side is then x_2, and (3.34) is derived without the "
        "term. Solved for e_2 it halves the second error; evaluated one sample late it diverges.",
        "Drop + e_2.",
        switch="fixed_opening.law.printed=true",
        evidence=(f"{FIXED}.virtual1.tracking_error_max", f"{FIXED}.reach1.tracking_error_max"),
    ),
    error(
        "E3.16",
        "(3.31), bracket",
        "The scale multiplies the whole difference, so R lies along P_R to P_EA: not across the link and not the "
        "shortest distance that Fig. 3.3 and the text describe. Of little consequence here: with the arrows of the "
        "reading E3.16b it pulls the arm as near as the corrected form does.",
        "R = P_R P_E - P_EA P_E cos(theta_R) |P_R P_E| / |P_EA P_E|, the foot point's offset; pointing to P_R.",
        switch="fixed_opening.null_space.printed=true",
        evidence=tuple(f"{FIXED}.{c}.rcm_distance_final" for c in ("bracket1", "exactpos1", "exactposfree1")),
    ),
    error(
        "E3.21",
        "(3.38)",
        "The rate of V_3 in p is twice too large.",
        "lambda / lambda_max(Gamma^-1): (lambda/2) tr(e_W^T e_W) >= (lambda / lambda_max(Gamma^-1)) V_3.",
    ),
    error(
        "E3.23",
        "(3.41), (3.42)",
        "Exponents of 2 and of lambda_max(M), K_12 in place of K_13 and the split of V' into V_1 and V_2 are lost; the "
        "printed bound is optimistic, though no run comes near either.",
        "kappa_1 = min(K12 2^((1+a)/2), K22 (2/lmax(M))^((1+a)/2)), "
        "kappa_2 = 2^((1-b)/2) n^((1-b)/2) min(K13 2^((1+b)/2), K23 (2/lmax(M))^((1+b)/2)).",
        evidence=tuple(f"{SETTLING}.printed.{m}" for m in ("bound", "bound_printed", "settling_max")),
    ),
)

READINGS = (
    reading(
        "E3.09",
        "omega, q_U before (3.21)",
        "q_D x q is the axis that turns the desired direction into the actual one, the text wants the reverse; "
        "with Theta "
        "as tool-to-base the printed axis doubles the angle. With Theta = base-to-tool and q_U in tool coordinates the "
        "printed order is right. The arctan of a quotient of vectors is read as atan2 of norm and dot product.",
        "Turn about -q_U (reading used: Theta maps tool to base coordinates).",
        switch="fixed_opening.task=pose fixed_opening.printed=true",
        evidence=(f"{FIXED}.wrong_axis1.tracking_error_max", f"{FIXED}.pose1.tracking_error_max"),
    ),
    reading(
        "E3.13",
        "(3.23)",
        "The external torque of (3.1) is dropped: the nominal system without contact.",
        "Kept here; it enters the residual nu.",
    ),
    reading(
        "E3.15b",
        "(3.30), J_R",
        "The Jacobian of the last three joints is a design choice consistent with the text. It leaves out joints that "
        "move the link near the opening; with the tool axis free it makes things worse, with the whole task it changes "
        "nothing.",
        "Jacobian of the body-fixed nearest point, all joints that move it.",
        switch="fixed_opening.null_space.jacobian=last3",
        evidence=tuple(f"{FIXED}.{case}.rcm_distance_final" for case in ("last3pos1", "exactpos1", "exactposfree1")),
    ),
    reading(
        "E3.16b",
        "(3.31), direction",
        "With an arrow from its first to its second letter R, with the bracket as printed or corrected, points away "
        "from P_R and drives the arm off; the opposite convention makes it right.",
        "F_R = K_R (P_R - foot point).",
        switch="fixed_opening.null_space.arrows=outward",
        evidence=tuple(f"{FIXED}.{c}.rcm_distance_final" for c in ("printed_force1", "bracket1", "exactposfree1")),
    ),
    reading(
        "E3.18",
        "3.5.2, positions",
        "In experiments 1 and 2 the target is 0.27 m and 0.26 m beside the opening, more than half the box: the "
        "opening is not in the middle of the lid, or the box was moved.",
        "The box is placed anew for each reach, hole and target inside.",
    ),
    reading(
        "E3.24",
        "(3.26)-(3.28) with (3.29)",
        "The weights are driven by all of e_2, so with the tool axis free the network also works against the "
        "null-space "
        "torque; driven by the task part of e_2 it does not, and then lets the null space sag if gravity is not known.",
        "As printed for the whole task; the task part of e_2 where the tool axis is left free.",
        switch="fixed_opening.adaptation=task",
        evidence=tuple(f"{FIXED}.{c}.rcm_distance_final" for c in ("fullpos1", "exactpos1"))
        + (f"{FIXED}.task4.rcm_distance_max", f"{FIXED}.reach4.rcm_distance_max"),
    ),
    reading(
        "E3.25",
        "3.2.5, 'calculated online based on X_P'",
        "The tool axis may follow from the measured or from the reference position.",
        "From the reference, so that the axis carries no measurement noise.",
    ),
    reading(
        "E3.26",
        "Lemma 3.4",
        "The bound is right and of no use in 28 dimensions: its first term is 3 * 28 * 2^27; with one node |S| <= 1.",
    ),
    reading(
        "E3.28",
        "(3.43)",
        "U_1 bounds e_2 and e_W through V(0): the residual set depends on the initial state although T_max does not "
        "(practical fixed-time stability).",
    ),
)

GAPS = (
    gap(
        "E3.17",
        "3.5.2",
        "The gripper's length is not printed, and decides how near the straight tool lets the wrist come to "
        "the opening.",
        "0.15 m beyond the flange's end point; shorter ones are in the sensitivity table.",
        switch="fixed_opening.gripper=0",
        evidence=tuple(f"{FIXED}.{c}.rcm_distance_max" for c in ("flange3", "short3", "reach3")),
    ),
    gap(
        "E3.27",
        "'dynamics unknown'",
        "(3.16)-(3.18) and (3.29) with S = H(q) need a nominal model; the book writes hats and then equates them with "
        "the true values. What the robot's own gravity compensation contributes is not said.",
        "A nominal model 10 % too light for gravity compensation and observer; the exact one beside it. The projector "
        "does not feel an error that all masses and inertias share.",
        switch="external_push.model.mass_error=0",
        evidence=(f"{PUSH}.plus.observer_error", f"{PUSH}.exact_plus.observer_error"),
    ),
    gap(
        "E3.29",
        "(3.24)",
        "How the desired joint angles q_d follow from the Cartesian target is not printed, nor are Gamma, lambda, K_R, "
        "K_Ex, the size of the opening, the time axes and the path of the moving opening.",
        "e_1 is the task error mapped by a damped inverse; q_d integrated in joint space is a case beside it.",
        switch="fixed_opening.reference=joint",
        evidence=(f"{FIXED}.joint1.rcm_distance_max", f"{FIXED}.reach1.rcm_distance_max"),
    ),
)


SLIPS = (
    slip(
        "E3.01",
        "(3.1), (3.14)",
        "The external torque has a minus sign in (3.1) and a plus sign later; no effect but the sign of the "
        "reported force.",
        "One convention; plus, 'applied on the manipulator', here.",
    ),
    slip(
        "E3.02",
        "(3.2)",
        "W is n x k but W^T S is used; m is not the task dimension in z.",
        "W is k x n, z has 4n = 28.",
    ),
    slip(
        "E3.03", "(3.4), (3.7)", "The distance lacks z and has two names.", "d_node = |z - zeta_min|, as the text says."
    ),
    slip("E3.04", "(3.10)", "'for k < 1' where the power mean needs k > 1; used with k > 1 only.", "k > 1."),
    slip(
        "E3.05",
        "(3.12)",
        "A square root over a vector of either sign, and no exponent on SIG; (3.34) needs the form without the root.",
        "SIG^r(x)_i = |x_i|^r sign(x_i).",
    ),
    slip("E3.08", "(3.17)", "d sigma = K (dp - p_hat).", "d sigma = K (dp - dp_hat), as (3.18)."),
    slip("E3.10", "(3.21)", "Brackets are missing.", "(I + Lambda sin w + 2 Lambda^2 sin^2(w/2)) Theta."),
    slip(
        "E3.11",
        "(3.22)",
        "Entries (1,2) and (2,3) are not those of the skew matrix that the other four belong to.",
        "(1,2) = -rho_z and (2,3) = -rho_x.",
    ),
    slip("E3.14", "(3.29)", "m joints in n dimensions, Jbar n x n, U m x n.", "Jbar 7 x m, U 7 x 7; S is the inertia."),
    slip("E3.15", "(3.30)", "Three zeros and three torques for seven joints.", "Four zeros."),
    slip("E3.19", "(3.35)", "K_12 e_2, M without a dot, lost e and S.", "K_21 e_2, (1/2) e_2^T dM e_2, e_2^T e_W^T S."),
    slip("E3.20", "(3.36)", "Transposes are lost.", "tr(e_W^T Gamma^-1 dW), e_2^T e_W^T S."),
    slip("E3.22", "(3.40), lines 2, 3", "e_1 under K_22 and K_23.", "e_2, as line 4."),
)

ERRATA = (*ERRORS, *GAPS, *READINGS, *SLIPS)
