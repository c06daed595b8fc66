"""What the book says about ``impedance_stability``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less, within

CLAIMS = (
    Claim(
        "C7.28",
        "7.B",
        "An unsuitable k_s makes the system unstable.",
        every(greater(".gain10.stable", 0.5), less(".gain45.stable", 0.5), within(".limit_ratio", 0.85, 1.15)),
        control=less(".exact_model.stable", 0.5),
        credits="modelling and measuring errors",
        printed=greater(".displaced_printed.finished", 0.5),
        where="7.3.3",
        note="Too large for the sampling period, which no error of model or sensing is needed for: an exact model "
        "without friction is unstable as well (torque travel {.exact_model.torque_travel:.0f} N m "
        "a joint). The limit is where the sampled loop predicts it ({.limit_ratio:.2f} of it). As "
        "printed the law is unstable with a suitable k_s as well (E7.18).",
    ),
    Claim(
        "C7.29b",
        "7.B",
        "(7.40) ensures stability where k_s is too large.",
        greater(".robust_too_large.stable", 0.5),
        source="ours",
        note="A maximum can only raise the gain; the text does not say on which side k_s is unsuitable.",
    ),
    Claim(
        "C7.30",
        "7.B",
        "V decreases.",
        every(less(".displaced.lyapunov_rise", 0), less(".displaced.lyapunov_time", 100)),
        control=less(".displaced_no_estimation.lyapunov_rise", 0),
        printed=less(".displaced_printed.lyapunov_rise", 0),
        where="(7.44)",
        note="At every step down to a ten-thousandth; below that it is a noise floor.",
    ),
)
