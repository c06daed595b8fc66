"""What ``barrier_and_switch`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.control.global_adaptive import Switch
from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "4.3": Figure(
        "Above: the switching function E of one input component for both readings of the square in (4.26) and several "
        "omega; E must not exceed 1. Below: E and the largest input component while the two-link arm draws the ellipse "
        "from an empty network (threshold 20, a dot a recorded sample), and its error with and without the robust "
        "term. The book sketches the three regions.",
        "The switch hands over to the robust term only in the transient, and stays below 1 with the square inside.",
    )
}
UNITS = {
    "error": "m", "tip": "m", "position": "rad", "torque": "N m", "virtual_acceleration": "rad/s²", "usage": "1",
    "share": "1", "nodes": "1", "feature_energy": "1", "input_norm": "mixed", "input_peak": "mixed", "segment": "1",
}  # fmt: skip
TABLES = {
    "T4.B": "The ellipse from an empty network, one change at a time",
    "T4.S": "Changes that turn a verdict of chapter 4",
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figure, ((inside, outside), (share, error)) = style.subplots(2, 2, height=3.8)
    law = next(iter(config.cases.values())).law
    inner, outer = law.switch.inner, law.switch.outer
    size = np.linspace(0, 1.15 * outer, 400)
    lines = [style.LINES[name] for name in ("plain", "extra1", "book", "rival")]
    for axes, square_outside, text in ((inside, False, "(u/ω)² in the exponent"), (outside, True, "(exp(u/ω))²")):
        for line, shape in zip(lines, (0.5, 0.64, 1.0, 2.0)):
            switch = Switch(inner, outer, shape, square_outside)
            axes.plot(size, [switch([value]) for value in size], label=f"ω = {shape:g}", **line)
        axes.axhline(1, color="#999999", linewidth=0.6)
        for value, word in ((inner, "$d_a$"), (outer, "$d_b$")):
            style.event(axes, value, word)
        highest = max(float(line.get_ydata().max()) for line in axes.get_lines()[: len(lines)])
        axes.set(xlabel=r"$|\Xi_k|$ [-]", ylabel="E [-]", ylim=(0, 1.4 * highest), title=text)
    inside.legend(loc="upper left", bbox_to_anchor=(0.29, 1.04), ncols=2, handlelength=1.8, columnspacing=0.8)
    if "base" in recordings:
        _draw_run(recordings, share, error)
    found = metrics.get("base", {})
    transient, orbit = found.get("smallest_share"), found.get("settled_share")
    if transient is not None and orbit is not None:
        style.title(
            figure,
            f"The robust term takes over in the transient (E falls to {transient:.2g}); on the orbit E = {orbit:.2g}",
        )
    return {"4.3": figure}


def _draw_run(recordings: Recordings, share: Any, error: Any) -> None:
    base = recordings["base"]
    now = base.time <= 3.0
    share.plot(base.time[now], base["share"][now], marker=".", markersize=2.5, **style.LINES["book"])
    share.set(xlabel="Time [s]", ylabel="E [-]", ylim=(-0.05, 1.1), title="in the run")
    twin = style.twin(share, r"largest $|\Xi_k|$ [-]", style.RIVAL)
    twin.plot(base.time[now], base["input_peak"][now], **style.LINES["rival"])
    share.yaxis.label.set_color(style.BOOK)
    for case, label, line in (("base", "with robust term", "book"), ("no_robust", "without", "plain")):
        if case in recordings:
            recording = recordings[case]
            size = 1e3 * np.linalg.norm(recording["error"], axis=1)
            error.plot(recording.time, size, label=label, **style.LINES[line])
    error.set(xlabel="Time [s]", ylabel=r"$\|z_1\|$ [mm]", yscale="log", ylim=(0.1, 400), title="tracking error")
    error.legend(loc="upper right")


COLUMNS = {
    "diverged": "diverged",
    "rmse_mm": "RMSE [mm]",
    "transient_rmse_mm": "RMSE 1-5 s [mm]",
    "steady_rmse_mm": "RMSE last half [mm]",
    "torque_increment_nm": "torque increment [N m per 10 ms]",
    "max_usage": "largest share of the bound",
    "violations": "samples outside",
    "nodes": "nodes",
    "smallest_share": "smallest E",
    "effective_gain": "effective gain",
}

# What a change turns: claim, case, metric, and the case whose number it is held against (None: the bound itself).
TURNS = (
    ("C4.01", "fixed network of width 10 with 39 times the gain", "rbf10_high_gain", "rmse_mm", "base"),
    ("C4.01", "fixed network of width 2, equal effective gain", "rbf2", "rmse_mm", "base"),
    ("C4.01", "fixed network of width 6, equal effective gain", "rbf6", "rmse_mm", "base"),
    ("C4.01", "fixed network of width 10, equal effective gain", "rbf10", "rmse_mm", "base"),
    ("C4.02a", "fuzzy network, equal effective gain", "fuzzy", "rmse_mm", "base"),
    ("C4.02a", "fuzzy network, the same gamma for all methods", "fuzzy_common_gamma", "rmse_mm", "common_gamma"),
    ("C4.17a", "no enhancement, the same gain", "gaussians", "rmse_mm", "base"),
    ("C4.17a", "no enhancement, equal effective gain", "gaussians_equal_gain", "rmse_mm", "base"),
    ("C4.28", "a new node at the input, the same gain", "one_neighbour", "rmse_mm", "base"),
    ("C4.28", "a new node at the input, equal effective gain", "at_input", "rmse_mm", "base"),
    ("C4.04", "ellipse starts 0.3 m from the arm", "start_outside", "max_usage", None),
    ("C4.04", "radii scaled by the farthest node, factors 0.2 and 0.6", "scaled_small", "max_usage", None),
    ("C4.04", "radii scaled by the farthest node, factors 0.5 and 1.5", "scaled_large", "max_usage", None),
    ("C4.04", "no barrier", "no_barrier", "max_usage", None),
    ("C4.04", "no robust term", "no_robust", "max_usage", None),
)


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    found = {case: numbers for case, numbers in metrics.items() if case in config.cases}
    turns = []
    for claim, change, case, metric, against in TURNS:
        if case not in found or (against is not None and against not in found):
            continue
        value = found[case].get(metric)
        limit = 1.0 if against is None else found[against].get(metric)
        holds = _holds(value, limit, below=against is None)
        turns.append({"claim": claim, "change": change, "quantity": COLUMNS[metric], "value": value,
                      "held against": limit, "claim holds": holds})  # fmt: skip
    return {"T4.B": by_case(found, COLUMNS), "T4.S": pd.DataFrame(turns)}


def _holds(value: float | None, limit: float | None, below: bool) -> str:
    """Whether a rival's number stays above the book's method's, or a share of the bound below 1."""
    if value is None or limit is None:
        return "no, diverged"
    return "yes" if (value < limit) == below else "no"
