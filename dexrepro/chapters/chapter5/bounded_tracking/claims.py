"""What the book says about ``bounded_tracking``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less

TRACKING = "bounded_tracking"
LETTERS = ("a", "w", "z", "k", "l", "capital")

CLAIMS = (
    Claim(
        "C5.18",
        "5.5b",
        "While drawing, tracking errors stay within the performance limits.",
        every(*(less(f"{TRACKING}.letter_{letter}.bound_use", 1.0) for letter in LETTERS)),
        printed=less(f"{TRACKING}.printed.bound_use", 1.0),
        where="5.5.2, 5.5.4",
    ),
    Claim(
        "C5.19",
        "5.D",
        "The controller (5.32)-(5.44) as printed keeps the errors within the limits.",
        less(f"{TRACKING}.printed.bound_use", 1.0),
        where="5.4.2",
        note="The sign of the network's term and u of (5.44), which is not defined: with the sign corrected the errors "
        "stay inside for u of 0 to 0.3, not for 1; with the printed sign they leave for u = 0 as well (T5.G).",
    ),
    Claim(
        "C5.27",
        "5.D",
        "The Lyapunov function decays and stays bounded.",
        every(
            less(f"{TRACKING}.letter_w.lyapunov_peak", 1.01),
            less(f"{TRACKING}.letter_w.lyapunov_late", 0.05),
        ),
        printed=less(f"{TRACKING}.printed.bound_use", 1.0),
        where="(5.50)",
        note="rho V_1 + V_2 with the plant's own mass matrix; the term of the weights needs the unknown best weights. "
        "Under the printed law the errors leave its domain.",
    ),
    Claim(
        "C5.33",
        "5.D",
        "With the sign of the network's term corrected and u = 0, the printed law keeps the errors within the limits.",
        less(f"{TRACKING}.sign_only.bound_use", 1.0),
        source="ours",
        where="5.4.2",
        note="Printed L, and no barrier term in the torque. With u = 1 they leave (sign_robust in T5.G).",
    ),
    Claim(
        "C5.34",
        "5.D",
        "The tuned law tracks better than PD control with gravity compensation tuned with the same effort.",
        every(
            *(less(f"{TRACKING}.tuned.tip_rms", f"{TRACKING}.{pd}.tip_rms") for pd in ("pd_tuned", "pd_stiffest")),
            less(f"{TRACKING}.tuned_encoders.tip_rms", f"{TRACKING}.pd_stiffest_encoders.tip_rms"),
        ),
        source="ours",
        note="16 settings each, chosen on the letter a. The best PD gain, 30 N m/rad, is the largest of the 16: with "
        "300 PD control is ten times as good and equals the law with its untuned gains, with encoders at ten times the "
        "torque ripple (T5.G, T5.H).",
    ),
    Claim(
        "C5.35",
        "5.D",
        "The network makes the tracking accurate: without it the pen's error is at least ten times larger.",
        greater(f"{TRACKING}.no_network.tip_rms", f"{TRACKING}.letter_w.tip_rms", factor=10.0),
        source="ours",
    ),
)
