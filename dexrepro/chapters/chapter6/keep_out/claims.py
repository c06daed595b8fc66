"""What the book says about ``keep_out``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

OUT = "keep_out"

CLAIMS = (
    Claim(
        "C6.30",
        "6.C",
        "Moving obstacles are passed with a forecast, a detour as reference and a tube about it.",
        every(
            *(
                greater(f"{OUT}.moving_detour_{law}.distance_share", 1.0)
                for law in ("consistent", "printed", "feedforward")
            ),
            *(
                less(f"{OUT}.moving_detour_{law}.goal_error_worst", 0.05)
                for law in ("consistent", "printed", "feedforward")
            ),
        ),
        where="6.5, point 2",
        by_construction="the detour clears the forecast obstacle by the margin",
    ),
    Claim(
        "C6.35",
        "6.C",
        "With the outside constraints of Table 6.2 about an obstacle, the path converges to the goal (Remark 6.2).",
        every(
            *(
                less(f"{OUT}.still_{law}.goal_error", 0.2)
                for law in ("consistent", "printed", "feedforward", "printed_h2", "feedforward_h2")
            ),
        ),
        where="Remark 6.2, 6.3.3",
        note="Its Lyapunov function has its infimum at infinity: the error grows like sqrt(t), and the path "
        "stops before the obstacle. The safety filter arrives.",
    ),
)
