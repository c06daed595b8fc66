"""What the book says about ``holding_line``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

LINE = "holding_line"

CLAIMS = (
    Claim(
        "C2.01",
        "2.5",
        "From a misaligned start the force error is larger without the regulation (2.8), which cures it.",
        greater(f"{LINE}.case1_without.rmse", f"{LINE}.case1_with.rmse", 3),
        control=greater(f"{LINE}.aligned_without.rmse", f"{LINE}.aligned_with.rmse", 3),
        where="2.4.1.1 Case 1",
        note="The mean force without it is that of the closed form k_o (L0 - sqrt((L0 - f_d/k_o)^2 + dy^2)).",
    ),
    Claim(
        "C2.02",
        "2.5",
        "The cause: without the regulation the distance between the end effectors is larger than intended.",
        greater(f"{LINE}.case1_without_excess", f"{LINE}.case1_with_excess", 3),
        control=greater(f"{LINE}.aligned_without_excess", f"{LINE}.aligned_with_excess", 3),
        credits="the misaligned start",
        where="2.4.1.1 Case 1",
        note="By {holding_line.case1_without_excess:.1f} and {holding_line.case1_with_excess:.2f} mm.",
    ),
    Claim(
        "C2.03",
        "2.5",
        "When the partner deviates across the line, the regulation maintains the force.",
        greater(f"{LINE}.case2_without.rmse", f"{LINE}.case2_with.rmse", 3),
        control=greater(f"{LINE}.aligned_without.rmse", f"{LINE}.aligned_with.rmse", 3),
        where="2.4.1.1 Case 2",
    ),
    Claim(
        "C2.04",
        "2.5",
        "Without the regulation the force may become too small to hold the object.",
        every(greater(f"{LINE}.case2_without.lost", 0.05), less(f"{LINE}.case2_with.lost", 0.001)),
        control=every(greater(f"{LINE}.aligned_without.lost", 0.05), less(f"{LINE}.aligned_with.lost", 0.001)),
        where="2.4.1.1 Case 2",
    ),
    Claim(
        "C2.05",
        "2.5",
        "The regulation lets the follower move up and down with its partner.",
        greater(f"{LINE}.case2_without.largest_offset", f"{LINE}.case2_with.largest_offset", 3),
        control=greater(f"{LINE}.case2_without.largest_offset", f"{LINE}.central_reversed.largest_offset", 3),
        where="2.4.1.1",
    ),
    Claim(
        "C2.06",
        "2.5",
        "The regulation matters more where the partner's deviation is larger.",
        greater(f"{LINE}.case2_gain", f"{LINE}.case1_gain"),
        control=greater(f"{LINE}.aligned_gain", f"{LINE}.case1_gain"),
        where="2.4.1.1",
    ),
)
