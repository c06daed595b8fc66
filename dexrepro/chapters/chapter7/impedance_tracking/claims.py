"""What the book says about ``impedance_tracking``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, about, every, greater, less

CHATTER = 1.0  # N m of torque travel a joint; smooth runs have 0.15


def stable(case: str) -> Predicate:
    return every(greater(f".{case}.finished", 0.5), less(f".{case}.rms_error", 1.0))


def tracks(case: str) -> Predicate:
    return every(less(f".{case}.rms_error", 0.05), less(f".{case}.torque_travel", CHATTER))


def absorbs(exact: str, encoders: str) -> Predicate:
    """A tenth of the error of the same law without estimation or integral, with each sensing."""
    pairs = ((exact, "no_estimation"), (encoders, "encoders_no_estimation"))
    return every(*(less(f".{case}.rms_error", f".{plain}.rms_error", 0.1) for case, plain in pairs))


fig_7_11 = about("7.11", "7.4.3")
ours_7_11 = about("7.11", source="ours")
CLAIMS = (
    fig_7_11(
        "C7.26",
        "Adaptive impedance keeps the arm stable.",
        stable("muscle"),
        control=stable("constant_mean"),
        credits="the adaptive impedance",
        printed=stable("printed"),
        note="Errors {.muscle.rms_error:.2g} mm, with a constant K of the same mean {.constant_mean.rms_error:.2g} mm.",
    ),
    fig_7_11(
        "C7.27",
        "Adaptive impedance lets the gripper track the generalised trajectory (to 0.05 mm, without chatter).",
        tracks("muscle"),
        control=tracks("constant_mean"),
        credits="the adaptive impedance",
        printed=tracks("printed"),
        note="Exact sensing: {.muscle.rms_error:.2g} mm, and {.constant_mean.rms_error:.2g} mm with a constant K of "
        "the same mean. With encoders see C7.27c.",
    ),
    ours_7_11(
        "C7.27c",
        "With the encoders of a desktop device it does so without chatter, too.",
        tracks("encoders"),
        note="{.encoders.rms_error:.2g} mm at a torque travel of {.encoders.torque_travel:.0f} N m a joint; integral "
        "action in place of the estimation {.encoders_integral.rms_error:.2g} mm at "
        "{.encoders_integral.torque_travel:.0f}, neither {.encoders_no_estimation.rms_error:.2g} mm at "
        "{.encoders_no_estimation.torque_travel:.0f}.",
    ),
    ours_7_11(
        "C7.27b",
        "With encoders the delayed torque must pass the velocity's filter.",
        less(".encoders.rms_error", ".encoders_unmatched.rms_error", 0.1),
    ),
    Claim(
        "C7.29",
        "7.B",
        "(7.40) ensures stability where k_s is too small.",
        less(".jumps_robust.rms_error", ".jumps_no_gain.rms_error", 0.1),
        control=less(".jumps_constant.rms_error", ".jumps_no_gain.rms_error", 0.1),
        credits="the maximum in (7.40)",
        printed=less(".jumps_robust_printed.rms_error", ".jumps_no_gain.rms_error", 0.1),
        where="7.3.3",
        note="Force jumps below eps. With Gamma just above alpha and a boundary layer, which r never leaves: a "
        "constant K of Gamma eps over the layer gives {.jumps_constant.rms_error:.3g} mm, (7.40) "
        "{.jumps_robust.rms_error:.3g} mm. As printed it chatters.",
    ),
    ours_7_11(
        "C7.32",
        "Muscle-like impedance tracks better than its mean as a constant.",
        less(".muscle.rms_error", ".constant_mean.rms_error"),
        note="{.muscle.rms_error:.2g} and {.constant_mean.rms_error:.2g} mm; the "
        "text claims stability and tracking only.",
    ),
    ours_7_11(
        "C7.32e",
        "Tuned alike, muscle-like impedance tracks better than a constant one.",
        less(".tuned_muscle.rms_error", ".tuned_constant.rms_error"),
        note="{.tuned_muscle.rms_error:.2g} and {.tuned_constant.rms_error:.2g} mm, each with the best gains of a "
        "search.",
    ),
    fig_7_11(
        "C7.33",
        "Time-delay estimation absorbs unmodelled dynamics (error below a tenth, also with encoders).",
        absorbs("muscle", "encoders"),
        control=absorbs("integral", "encoders_integral"),
        credits="time-delay estimation",
        printed=less(".printed.rms_error", ".no_estimation.rms_error", 0.1),
        where="7.3.3",
        note="Without it {.no_estimation.rms_error:.3g} mm, with it {.muscle.rms_error:.2g} mm; integral action on the "
        "same K r, {.integral.rms_error:.2g} mm. With encoders {.encoders_no_estimation.rms_error:.3g}, "
        "{.encoders.rms_error:.2g} and {.encoders_integral.rms_error:.2g} mm.",
    ),
    ours_7_11(
        "C7.33b",
        "It does so against the same law with tuned gains, too (error below a hundredth).",
        less(".tuned_muscle.rms_error", ".tuned_no_estimation.rms_error", 0.01),
        note="{.tuned_no_estimation.rms_error:.3g} mm become {.tuned_muscle.rms_error:.2g} mm; with integral action "
        "{.tuned_integral.rms_error:.2g} mm. Gravity compensation with tuned gains errs by "
        "{.tuned_gravity_pd.rms_error:.2g} mm.",
    ),
)
