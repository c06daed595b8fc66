"""What a reader who implements Chapter 2 must know beyond the printed equations."""

from __future__ import annotations

from dexrepro.claims import gap, reading, slip

LINE, ESTIMATION, COMPARISON = "holding_line", "movement_estimation", "holding_comparison"
STABILITY = "estimation_stability"

ERRATA = (
    reading(
        "E2.01",
        "(2.4), (2.5), (2.8)",
        "If D keeps its direction, f_y = -k_o (y_1 - y_2): a partner that rises pulls the follower up, and (2.8) with "
        "its minus sign drives them apart; the text to Fig. 2.3b says that the force points down.",
        "D has constant length and the direction of X_1 - X_2 (a spring that turns freely). Then (2.3), text, figure "
        "and (2.8) agree; x_c of (2.7) depends slightly on X_1 off the holding line.",
        switch="holding_line.object_model=constant_vector",
        evidence=tuple(
            f"{LINE}.{case}.{metric}"
            for case in ("constant_vector", "constant_vector_reversed", "central_reversed")
            for metric in ("survived", "lost")
        ),
    ),
    gap(
        "E2.02",
        "(2.10), (2.16)",
        "With time counted from the start the regressor (x_1, 1, t, t^2) grows without bound; an explicit step needs "
        "dt sum(g_j Y_j^2) < 2, which any rate on t^2 breaks in the end. The rates are not printed.",
        "Small rates on the higher powers, an implicit step, or local time in a window after which the polynomial is "
        "re-expanded (the text does say that the coefficients are constant during a certain period).",
        switch="movement_estimation.law.estimation.window=null",
        evidence=tuple(
            f"{STABILITY}.{case}.{metric}"
            for case in ("rate0p1", "rate1", "rate10")
            for metric in ("divergence_time", "predicted_time")
        ),
    ),
    gap(
        "E2.03",
        "(2.12)",
        "While the coefficients adapt, a_1 + 2 a_2 t is not the rate of the estimate: the coefficients' own rates are "
        "dropped, and with time counted from the start these carry nearly all of the movement. Im then equals NoIm "
        "(with rates that E2.02 allows).",
        "The total derivative of the estimate, or a window.",
        switch="holding_comparison.estimation.window=null holding_comparison.estimation.rates=[10,20,0.5,0.0001]",
        evidence=(
            f"{ESTIMATION}.printed30.velocity_slope",
            f"{ESTIMATION}.total.velocity_slope",
            f"{ESTIMATION}.sigma30.velocity_slope",
            f"{COMPARISON}.printed_6.rmse",
            f"{COMPARISON}.printed_8.rmse",
            f"{COMPARISON}.total_8.rmse",
        ),
    ),
    gap(
        "E2.04",
        "after (2.22)",
        "That the force error vanishes does not follow from dV <= 0 alone: it needs a bounded regressor and constant "
        "k_o a_i, and a sine is no quadratic.",
        "The error stays in a bounded neighbourhood of 0.",
        evidence=tuple(f"{ESTIMATION}.sigma{s}.rmse" for s in (10, 30, 40)),
    ),
    reading(
        "E2.05",
        "Fig. 2.7, text",
        "Once the force is the desired one, the estimated rest position keeps the offset f_d (1/khat - 1/k_o), because "
        "nothing then excites the stiffness estimate; the text names the condition (a desired force close to 0), not "
        "the value used.",
        "The error converges to this offset; to zero only for khat = k_o or f_d -> 0.",
        evidence=tuple(
            f"{ESTIMATION}.{case}.{metric}"
            for case in ("sigma30", "light30")
            for metric in ("estimation_error", "predicted_offset")
        ),
    ),
    slip(
        "E2.06",
        "2.4.1.3, text",
        "'Fig. 2.8a and Fig. 2.8c' show that PIm is worse, but s15 to s18 of panel c hold no PIm run.",
        "Fig. 2.8a and Fig. 2.8b.",
    ),
    gap(
        "E2.07",
        "(2.18)",
        "The law divides by khat, which nothing keeps away from zero. No run came near that: the one with a very fast "
        "stiffness rate ends by the limit of the explicit step (E2.02), whatever the floor, khat never below "
        "{movement_estimation.fast_stiffness.smallest_stiffness:.1f} N/m.",
        "A floor under khat, or the product form p = (-khat, khat a_0, ...), which needs no division.",
        evidence=(f"{ESTIMATION}.fast_stiffness.smallest_stiffness", f"{ESTIMATION}.fast_stiffness.held"),
    ),
    slip("E2.08", "after (2.18)", "'The adaptation laws in (2.15)-(2.17)'.", "(2.16)-(2.18)."),
    slip("E2.09", "after (2.31)", "'khat_o from (2.23)'.", "The estimates come from (2.12) and (2.17)."),
    slip("E2.10", "before (2.14)", "'Subtracting (2.6) by (2.13)'.", "(2.13) minus (2.6)."),
    slip(
        "E2.11",
        "2.4.1.2, text",
        "'Set parameters k_o and x_1 to different values'; the two cases vary k_o and x_2.",
        "k_o and x_2.",
    ),
    slip(
        "E2.12",
        "Remark 2.1, Theorem 2.1",
        "An inequality between vectors; what is called a theorem is an assumption.",
        "A bound on the norm; the heading is probably typesetting.",
    ),
    reading(
        "E2.13",
        "(2.1)",
        "X_2,d = s R X_l without the place where the arm starts.",
        "Positions relative to the start, as Fig. 2.4c and d are drawn; X_2(0) is added.",
    ),
    slip("E2.14", "Table 2.1", "A caption placeholder; 'PI' for PIm in the text.", "PIm."),
)
