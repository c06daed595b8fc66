"""What the book says about ``holding_line``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import about, every, greater, less

fig_2_5 = about("2.5", "2.4.1.1 Case 1")
CLAIMS = (
    fig_2_5(
        "C2.01",
        "From a misaligned start the force error is larger without the regulation (2.8), which cures it.",
        greater(".case1_without.rmse", ".case1_with.rmse", 3),
        control=greater(".aligned_without.rmse", ".aligned_with.rmse", 3),
        note="The mean force without it is that of the closed form k_o (L0 - sqrt((L0 - f_d/k_o)^2 + dy^2)).",
    ),
    fig_2_5(
        "C2.02",
        "The cause: without the regulation the distance between the end effectors is larger than intended.",
        greater(".case1_without_excess", ".case1_with_excess", 3),
        control=greater(".aligned_without_excess", ".aligned_with_excess", 3),
        credits="the misaligned start",
        note="By {.case1_without_excess:.1f} and {.case1_with_excess:.2f} mm.",
    ),
    fig_2_5(
        "C2.03",
        "When the partner deviates across the line, the regulation maintains the force.",
        greater(".case2_without.rmse", ".case2_with.rmse", 3),
        control=greater(".aligned_without.rmse", ".aligned_with.rmse", 3),
        where="2.4.1.1 Case 2",
    ),
    fig_2_5(
        "C2.04",
        "Without the regulation the force may become too small to hold the object.",
        every(greater(".case2_without.lost", 0.05), less(".case2_with.lost", 0.001)),
        control=every(greater(".aligned_without.lost", 0.05), less(".aligned_with.lost", 0.001)),
        where="2.4.1.1 Case 2",
    ),
    fig_2_5(
        "C2.05",
        "The regulation lets the follower move up and down with its partner.",
        greater(".case2_without.largest_offset", ".case2_with.largest_offset", 3),
        control=greater(".case2_without.largest_offset", ".case2_reversed.largest_offset", 3),
        where="2.4.1.1",
        note="Largest lateral distance of the tips after 5 s: {.case2_with.largest_offset:.4f} m with it and "
        "{.case2_without.largest_offset:.2f} m without. The control is the same run with the sign of (2.8) reversed: "
        "{.case2_reversed.largest_offset:.2f} m, and no contact for {.case2_reversed.lost:.0%} of the time.",
    ),
    fig_2_5(
        "C2.06",
        "The regulation matters more where the partner's deviation is larger.",
        greater(".case2_gain", ".case1_gain"),
        control=greater(".aligned_gain", ".case1_gain"),
        where="2.4.1.1",
    ),
)
