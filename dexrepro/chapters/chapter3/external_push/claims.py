"""What the book says about ``external_push``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, about, every, less, ordered, within

WAYS = ("plus", "minus")


def _lower(metric: str, case: str, rival: str) -> Predicate:
    """A metric is lower in both directions; cases by what stands before the direction."""
    mine = {way: f"{case}_{way}" if case else way for way in WAYS}
    return every(*(less(f".{mine[way]}.{metric}", f".{rival}_{way}.{metric}") for way in WAYS))


ours_3_11 = about("3.11", source="ours")
fig_3_12 = about("3.12", "3.5.3")
CLAIMS = (
    ours_3_11(
        "C3.07",
        "The observer gives the external torque accurately: rms error below a tenth of it, with a model 10 % "
        "too light.",
        less(".plus.observer_error", 0.1),
        where="3.5.3",
        note="A harder test than the book's, which takes the model for exact (C3.07b): the observer takes the weight "
        "that it does not know for a push.",
    ),
    Claim(
        "C3.07b",
        "3.11",
        "With an exact model the observer is that accurate, and its lag is the predicted 1/K_Ex (within 20 %).",
        every(less(".exact_plus.observer_error", 0.1), within(".exact_plus.observer_lag_ratio", 0.8, 1.2)),
        control=every(less(".plus.observer_error", 0.1), within(".plus.observer_lag_ratio", 0.8, 1.2)),
        where="3.2.4",
        note="The control is the same observer with a model 10 % too light. Joint angles, "
        "speeds and torques are measured without noise; with noise see C3.08. Where what is not printed varies it "
        "may fail (study).",
    ),
    ours_3_11(
        "C3.07c",
        "The change of the observed torque since before the push is within a tenth of it even with the wrong model.",
        less(".plus.observer_change_error", 0.1),
    ),
    Claim(
        "C3.08",
        "3.B",
        "A larger observer gain means a smaller time constant, and too large a gain does harm.",
        every(
            ordered(*(f".exact_plus.lag_{gain}" for gain in (500, 200, 100, 50, 20, 10, 5))),
            less(".exact_plus.noisy_50", ".exact_plus.noisy_5"),
            less(".exact_plus.noisy_50", ".exact_plus.noisy_500"),
        ),
        control=every(
            less(".exact_plus.clean_50", ".exact_plus.clean_5"), less(".exact_plus.clean_50", ".exact_plus.clean_500")
        ),
        where="3.2.4",
        note="The harm shown is that of noise on the momentum, without which (control) a larger gain is better; above "
        "2 / period the observer itself is unstable. With a smaller hole it may fail (study).",
    ),
    fig_3_12(
        "C3.09",
        "After a large push the arm returns to the remote centre within 2 s, pushed along +y or -y.",
        every(*(less(f".{way}.rcm_recovery_time", 2.0) for way in WAYS)),
        control=every(*(less(f".free_{way}.rcm_recovery_time", 2.0) for way in WAYS)),
        credits="the null-space control algorithm",
        note="After {.plus.rcm_recovery_time:.2f} s; without the null-space torque after "
        "{.free_plus.rcm_recovery_time:.2f} s: the main task's orientation rule brings the arm back.",
    ),
    fig_3_12(
        "C3.10",
        "Compensating the observed torque lowers the peak of Dis_R, pushed along +y or -y.",
        _lower("rcm_peak", "", "plain"),
        control=_lower("rcm_peak", "free", "plain"),
        credits="the compensation of the observed torque",
        readings={"exact model": _lower("rcm_peak", "exact", "exactplain")},
        note="From {.plain_plus.rcm_peak:.4f} to {.plus.rcm_peak:.4f} m and from "
        "{.plain_minus.rcm_peak:.4f} to {.minus.rcm_peak:.4f} m, in single runs; where what "
        "is not printed varies it may be otherwise (study). The control drops the null-space torque altogether.",
    ),
    Claim(
        "C3.10b",
        "3.12",
        "With the tool axis left free, too, compensation lowers the peak of Dis_R in both directions.",
        every(
            less(".pos_plus.rcm_peak", ".posplain_plus.rcm_peak"),
            less(".pos_minus.rcm_peak", ".posplain_minus.rcm_peak"),
        ),
        source="ours",
        note="A joint comes to its limit in these runs: the smallest change of the start may move a "
        "peak by more than the difference.",
        turns="a free tool axis meets a joint limit, where the smallest change decides how far the arm goes",
    ),
    fig_3_12(
        "C3.11",
        "Compensation reduces the effect of the push on the end-effector, pushed along +y or -y.",
        _lower("error_peak", "", "plain"),
        control=_lower("error_peak", "free", "plain"),
        credits="the null-space control algorithm",
        readings={"exact model": _lower("error_peak", "exact", "exactplain")},
        note="From {.plain_plus.error_peak:.4f} to {.plus.error_peak:.4f} m and from {.plain_minus.error_peak:.4f} to "
        "{.minus.error_peak:.4f} m, in single runs. Without any null-space torque the peak is "
        "{.free_plus.error_peak:.4f} and {.free_minus.error_peak:.4f} m. Where what is not printed varies it may "
        "fail (study).",
    ),
)
