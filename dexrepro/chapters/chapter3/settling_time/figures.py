"""What ``settling_time`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings

FIGURES = {
    "3.A": Figure(
        "Time until V' stays below that of an error of 1 mrad, worst of three directions, against the first "
        "joint error, "
        "for the printed gains and parts of them, with the bound T_max of Lemma 3.2 (printed and corrected constants). "
        "Error dynamics of Baxter's right arm under perfect compensation, torque unlimited (ours: the book states the "
        "bound and shows no settling times).",
        "With the terms in SIG the settling time hardly depends on the first error, and stays far below the bound.",
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
    from dexrepro.report import style

    if "printed" not in recordings:
        return {}
    figure, axes = style.subplots(height=2.8)
    found: Any = metrics["printed"]
    for case, (label, line) in CURVES.items():
        if case in recordings:
            worst = recordings[case].frames["settling"].groupby("error")["time"].max()
            axes.plot(worst.index, worst, marker="o", markersize=3, label=label, **style.LINES[line])
    bounds = (("bound", "$T_{max}$, corrected", "reference"), ("bound_printed", "$T_{max}$, printed", "printed"))
    for name, text, line in bounds:
        axes.axhline(found[name], label=f"{text}: {found[name]:.1f} s", **style.LINES[line])
    axes.set(xscale="log", yscale="log", xlabel=r"First joint error $\|e_1(0)\|$ [rad]", ylabel="Settling time [s]")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    worst = found["settling_max"]
    times = found["bound"] / worst
    style.title(figure, f"Any first error settles within {worst:.2f} s; the bound is {times:.0f} times longer")
    return {"3.A": figure}


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
