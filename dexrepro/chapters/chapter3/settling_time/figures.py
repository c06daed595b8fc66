"""What ``settling_time`` shows: its figures and tables."""

from __future__ import annotations

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "3.A": Figure(
        "Time until V' stays below that of an error of 1 mrad, worst of three directions, over that from 1 rad, "
        "against the first joint error, for the printed gains and parts of them. A fixed-time law's curve ends flat, "
        "an exponential law's goes on rising. Error dynamics of Baxter's right arm under perfect compensation, torque "
        "unlimited (ours: the book states a bound, Table T3.E, and shows no settling times).",
        "Settling times rise with the first error; only the printed gains' curve is flat at the right end.",
    )
}
TABLES = {"T3.E": "Settling time [s] by law and first error"}


CURVES = {
    "printed": ("printed gains", "book"),
    "linear": ("$K_{11}$, $K_{21}$ alone", "plain"),
    "fractional": ("terms in SIG alone", "extra1"),
    "weak": ("$K_{11}$ = $K_{21}$ = 5", "rival"),
    "weak_linear": ("5 alone", "extra2"),
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"printed", "linear"} <= set(recordings):
        return {}
    figure, axes = style.subplots(height=2.8)
    growth = []
    for case, (label, line) in CURVES.items():
        if case in recordings:
            worst = recordings[case].frames["settling"].groupby("error")["time"].max()
            growth.append(worst[10.0] / worst[3.16] - 1)
            axes.plot(worst.index, worst / worst[1.0], marker="o", markersize=3, label=label, **style.LINES[line])
    axes.set(xscale="log", xlabel=r"First joint error $\|e_1(0)\|$ [rad]", ylabel="Settling time over that from 1 rad")
    axes.set_ylim(0, None)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    change = f"printed gains {growth[0]:+.1%}, linear terms alone {growth[1]:+.1%}"
    return {"3.A": style.title(figure, f"From 3.16 to 10 rad: {change} of settling time")}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = [{"law": case, **values} for case, values in metrics.items() if case in config.cases]
    names = {f"settling_{size:g}".replace(".", "p"): f"settling from {size:.3g} rad [s]" for size in config.errors}
    names |= {
        "settling_max": "longest settling [s]",
        "growth": "largest growth of V [-]",
        "torque_1": "torque from 1 rad [N m]",
        "k11": "k_11",
        "k21": "k_21",
        "inertia_max": "largest inertia [kg m^2]",
        "bound": "bound, corrected [s]",
        "bound_printed": "bound, printed [s]",
    }
    return {"T3.E": pd.DataFrame(rows).rename(columns=names)}
