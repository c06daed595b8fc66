"""What ``impedance_stability`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings

from .experiment import gains

FIGURES = {
    "7.B": Figure(
        "(a) Largest spectral radius of the sampled loop along the path against the gain k_s (line), and what the "
        "simulated arm does with that gain: torque travel (points, right axis; at the smallest gain the task itself). "
        "Dashed: stability limit. (b) V = r' M r after an initial error of 0.2 rad in each joint, torque limit "
        "lifted, with and without time-delay estimation. Not in the book, whose proof in continuous time has no upper "
        "bound.",
        "Spectral radius and measured torque travel against the gain, and V over time, logarithmic.",
    ),
}
TABLES = {"T7.B": "Stability against gain, period and model, predicted and measured"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    from dexrepro.report import style

    rows = gains(metrics, config)
    if not rows:
        return {}
    figure, (bound, fall) = style.subplots(1, 2, height=2.5)
    values = np.array([[gain, m["predicted_radius"], m["torque_travel"] or np.nan] for gain, m in rows])
    bound.plot(values[:, 0], values[:, 1], **style.LINES["book"])
    bound.axhline(1.0, **style.LINES["reference"])
    bound.set(xlabel="Gain $k_s$ [N m s/rad]", ylabel="Predicted spectral radius [-]", ylim=(0.6, 1.6))
    bound.yaxis.label.set_color(style.BOOK)
    ripple = bound.twinx()
    ripple.spines["right"].set_visible(True)
    ripple.semilogy(values[:, 0], values[:, 2], "o", color=style.RIVAL, markersize=4)
    ripple.set(ylabel="Measured torque travel [N m]", ylim=(0.05, 1e4))
    ripple.yaxis.label.set_color(style.RIVAL)
    bound.axvline(config.printed_gain, color="#444444", linewidth=0.6)
    bound.annotate("printed", (config.printed_gain, 0.62), xytext=(2, 0), textcoords="offset points", fontsize=6.5)
    style.panel(bound, "a", "predicted and measured")
    for case, line, label in (
        ("displaced", "book", "with estimation"),
        ("displaced_no_estimation", "plain", "without"),
    ):
        if case in recordings:
            value = recordings[case]["lyapunov"]
            fall.semilogy(1e3 * recordings[case].time, value / value[0], label=label, **style.LINES[line])
    fall.axhline(1e-4, **style.LINES["reference"])
    fall.set(xlabel="Time [ms]", ylabel="V / V(0) [-]", xlim=(0, 200))
    fall.legend()
    style.panel(fall, "b", "V after an initial error")
    limits = metrics["summary"]
    measured, predicted = (
        " and ".join(f"{limits[f'{kind}_{side}']:g}" for side in ("stable", "unstable") if limits[f"{kind}_{side}"])
        for kind in ("measured", "predicted")
    )
    style.title(figure, f"The loop turns unstable between $k_s$ = {measured}, predicted between {predicted}")
    return {"7.B": figure}


def tabulate(recordings: Recordings, metrics: Mapping[str, Any], config: Config) -> dict[str, pd.DataFrame]:
    rows = [
        {
            "case": case,
            "k_s": config.cases[case].stiffness_gain,
            "L [ms]": 1e3 * config.cases[case].control_period,
            "predicted spectral radius": values["predicted_radius"],
            "predicted": "stable" if values["predicted_radius"] < 1 else "unstable",
            "measured": "stable" if values["stable"] else "unstable",
            "RMS tip error [mm]": values["rms_error"],
            "torque travel a joint [N m]": values["torque_travel"],
        }
        for case, values in metrics.items()
        if case in config.cases and config.cases[case].initial_error == config.initial_error
    ]
    return {"T7.B": pd.DataFrame(rows)}
