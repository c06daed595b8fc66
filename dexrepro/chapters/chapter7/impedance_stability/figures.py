"""What ``impedance_stability`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

from .experiment import CHATTER, FLOOR, gains

FIGURES = {
    "7.B": Figure(
        "(a) Largest spectral radius of the sampled loop along the path against the gain k_s, and (b) what the "
        "simulated arm does with that gain: how far its torque travels up and down in all. (c) V = r' M r after an "
        "initial error of 0.2 rad in each joint, torque limit lifted. Not in the book, whose proof in continuous time "
        "has no upper bound.",
        "Spectral radius and measured torque travel against the gain, and V over time, logarithmic.",
    )
}
UNITS = {
    "reference": "rad", "planned": "m", "filtered_error": "rad/s", "impedance": "N m s/rad", "stiffness": "1",
    "lyapunov": "J",
}  # fmt: skip
TABLES = {"T7.B": "Stability against gain, period and model, predicted and measured"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    rows = gains(metrics, config)
    if not rows:
        return {}
    figure, axes = style.subplots(2, 2, height=3.2, sharex="col")
    (bound, _), (travel, _) = axes
    for panel in axes[:, 1]:
        panel.remove()
    fall = figure.add_subplot(axes[0, 0].get_gridspec()[:, 1])
    values = np.array([[gain, m["predicted_radius"], m["torque_travel"] or np.nan] for gain, m in rows])
    bound.plot(values[:, 0], values[:, 1], marker=".", **style.LINES["book"])
    bound.set(ylabel="Spectral radius [-]", ylim=(0.6, 1.6))
    style.level(bound, 1.0, "stability limit")
    travel.semilogy(values[:, 0], values[:, 2], "o", color=style.BOOK, markersize=4)
    style.level(travel, CHATTER, f"chatter: above {CHATTER:g} N m")
    travel.set(xlabel="Gain $k_s$ [N m s/rad]", ylabel="Torque travel\na joint [N m]", ylim=(0.05, 1e4))
    travel.set_yticks((0.1, 10, 1000))
    for panel in (bound, travel):
        panel.axvline(config.printed_gain, color="#444444", linewidth=0.6)
    bound.annotate(
        "printed", (config.printed_gain, 1.5), xytext=(3, 0), textcoords="offset points", va="top", fontsize=8
    )
    style.panels((bound, travel, fall), "predicted along the path", "measured", "V after an initial error")
    for case, line, label in (
        ("displaced_printed", "printed", "as printed"),
        ("displaced_no_estimation", "plain", "without estimation"),
        ("displaced", "book", "with estimation"),
    ):
        if case in recordings:
            value = recordings[case]["lyapunov"]
            fall.semilogy(1e3 * recordings[case].time, value / value[0], label=label, **style.LINES[line])
    style.level(fall, FLOOR, "judged down to here", "bottom")
    fall.set(xlabel="Time [ms]", ylabel="V / V(0) [-]", xlim=(0, 200), ylim=(1e-9, 1e3))
    fall.legend(fontsize=8)
    limits = metrics["summary"]
    measured, predicted = (
        " and ".join(f"{limits[f'{kind}_{side}']:g}" for side in ("stable", "unstable") if limits[f"{kind}_{side}"])
        for kind in ("measured", "predicted")
    )
    finding = f"The loop turns unstable between $k_s$ = {measured}, predicted between {predicted}"
    return {"7.B": style.title(figure, finding)}


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
