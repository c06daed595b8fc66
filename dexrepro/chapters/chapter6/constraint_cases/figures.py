"""What ``constraint_cases`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

from .experiment import constraint_of

CLOSE = 0.4  # s, shown in panel d
FIGURES = {
    "6.A": Figure(
        "(a, b) V^c relative to its start and (c) the scaled error of the error dynamics under the consistent law for "
        "the four cases of Conditions 6.1 and 6.2; (d) the second asymmetric case under (6.17) corrected and as "
        "printed. (b) has a linear axis: outside of a bound V falls slowly, because the pull away from it fades. "
        "Ours; the book has no such figure.",
        "Lyapunov functions and scaled errors over time for four constraint cases, and for (6.17) as printed.",
    )
}
UNITS = {"error": "1", "rate": "1", "lyapunov": "1"}
TABLES = {"T6.2": "alpha_2 and k_n of the four cases, and the worst dV^c/dt over random states"}
SYMBOLS = {  # constraint, W in alpha_2 = (xdot^c - f1)/g1 - W/(d_z g1), B in k_n = k_2/d_z + k_z g1^2 B/(4 d_z^2)
    "asymmetric_inside": ("H_l < z1 < H_u", "-z1", "rho/(H_s^2 - z1^2)"),
    "symmetric_inside": ("|z1| < H", "-z1", "rho/(H^2 - z1^2)"),
    "symmetric_outside": ("|z1| > H", "z1/|z1|^2", "H^2/(|z1|^2 - H^2)"),
    "asymmetric_outside": ("z1 > H_u or z1 < H_l", "1/z1", "H_s^2/(z1^2 - H_s^2)"),
    "asymmetric_outside_printed": ("z1 > H_u or z1 < H_l", "(K_2 + K_1 z1^4)/(K_2 - K_1 z1^3)", "K_1 + K_2"),
}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for case, (constraint, pull, share) in SYMBOLS.items():
        if case in metrics:
            states = recordings[case].frames["states"]
            worst = {f"worst dV/dt, g1 = {g:.2g} [1/s]": states[f"rate_{g:.2g}"].max() for g in config.couplings}
            rows.append({"case": case, "constraint": constraint, "W": pull, "B": share, **worst})
    return {"T6.2": pd.DataFrame(rows)}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figure, ((inner, outer), (right, close)) = style.subplots(2, 2, height=4.2)
    lines = ("extra1", "book", "rival", "extra2", "printed")
    fallen = []
    for (case, recording), name in zip(recordings.items(), lines):
        bound = constraint_of(config.cases[case])
        time, error = recording.time, np.linalg.norm(recording["error"], axis=1)
        value = recording["lyapunov"] / recording["lyapunov"][0]
        edges = [bound.upper if bound.lower is None or z > 0 else -bound.lower for z in recording["error"][:, 0]]
        label = case.replace("_", " ")
        if not config.cases[case].printed:
            (inner if bound.inside else outer).plot(time, value, label=label, **style.LINES[name])
            right.plot(time, error / np.array(edges), **style.LINES[name])
            if not bound.inside:
                fallen.append(100 * (1 - value[-1]))
        if not bound.inside and bound.lower is not None:
            close.plot(time, error / np.array(edges), label=label, **style.LINES[name])
    for axes in (right, close):
        style.level(axes, 1, "bound", x=0.99)
        axes.set_xlabel("Time [s]")
    inner.set(ylabel="$V^c(t)/V^c(0)$ [-]", yscale="log", ylim=(1e-6, 3), xlim=(-0.05, 1))
    outer.set(ylabel="$V^c(t)/V^c(0)$ [-]")
    right.set(ylabel="$|z_1|/H$ [-]", ylim=(0, None))
    close.set(ylabel="$|z_1|/H$ [-]", xlim=(0, CLOSE), ylim=(0.99, 1.04))
    parts = [axes.get_legend_handles_labels() for axes in (inner, outer, close)]
    found = {label: handle for handles, labels in parts for handle, label in zip(handles, labels)}
    figure.legend(found.values(), found.keys(), loc="outside lower center", ncols=3)
    texts = ("V, inside", "V, outside", "scaled error and bound", f"second asymmetric case, first {CLOSE:g} s")
    style.panels((inner, outer, right, close), *texts)
    hit = metrics.get("asymmetric_outside_printed", {}).get("hit_time")
    slow = f"outside V falls by {min(fallen):.1f} to {max(fallen):.1f} % in {config.duration:g} s" if fallen else ""
    late = f"; with (6.17) as printed the bound is hit after {hit:.2f} s" if hit else ""
    return {"6.A": style.title(figure, f"Under the corrected terms {slow}{late}")}
