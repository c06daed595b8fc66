"""What the book says about ``holding_line``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import about, every, greater, less

LINE = "holding_line"

fig_2_5 = about("2.5", "2.4.1.1 Case 1")
CLAIMS = (
    fig_2_5(
        "C2.01",
        "From a misaligned start the force error is larger without the regulation (2.8), which cures it.",
        greater(f"{LINE}.case1_without.rmse", f"{LINE}.case1_with.rmse", 3),
        control=greater(f"{LINE}.aligned_without.rmse", f"{LINE}.aligned_with.rmse", 3),
        note="The mean force without it is that of the closed form k_o (L0 - sqrt((L0 - f_d/k_o)^2 + dy^2)).",
    ),
    fig_2_5(
        "C2.02",
        "The cause: without the regulation the distance between the end effectors is larger than intended.",
        greater(f"{LINE}.case1_without_excess", f"{LINE}.case1_with_excess", 3),
        control=greater(f"{LINE}.aligned_without_excess", f"{LINE}.aligned_with_excess", 3),
        credits="the misaligned start",
        note="By {holding_line.case1_without_excess:.1f} and {holding_line.case1_with_excess:.2f} mm.",
    ),
    fig_2_5(
        "C2.03",
        "When the partner deviates across the line, the regulation maintains the force.",
        greater(f"{LINE}.case2_without.rmse", f"{LINE}.case2_with.rmse", 3),
        control=greater(f"{LINE}.aligned_without.rmse", f"{LINE}.aligned_with.rmse", 3),
        where="2.4.1.1 Case 2",
    ),
    fig_2_5(
        "C2.04",
        "Without the regulation the force may become too small to hold the object.",
        every(greater(f"{LINE}.case2_without.lost", 0.05), less(f"{LINE}.case2_with.lost", 0.001)),
        control=every(greater(f"{LINE}.aligned_without.lost", 0.05), less(f"{LINE}.aligned_with.lost", 0.001)),
        where="2.4.1.1 Case 2",
    ),
    fig_2_5(
        "C2.05",
        "The regulation lets the follower move up and down with its partner.",
        greater(f"{LINE}.case2_without.largest_offset", f"{LINE}.case2_with.largest_offset", 3),
        control=greater(f"{LINE}.case2_without.largest_offset", f"{LINE}.central_reversed.largest_offset", 3),
        where="2.4.1.1",
    ),
    fig_2_5(
        "C2.06",
        "The regulation matters more where the partner's deviation is larger.",
        greater(f"{LINE}.case2_gain", f"{LINE}.case1_gain"),
        control=greater(f"{LINE}.aligned_gain", f"{LINE}.case1_gain"),
        where="2.4.1.1",
    ),
)
