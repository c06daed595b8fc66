"""What ``reactive_learning`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd

from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

from .experiment import shown

FIGURES = {
    "7.8": Figure(
        "Reactions to the low, close obstacle learned with 1, 2 and 5 groups of three enhancement nodes, seen from "
        "above; black dashed: ordinary skill; thin: demonstrations (simulated). Below: error against the mean "
        "demonstration while groups are added, median and range of ten draws of the random nodes; the old nodes keep "
        "their weights (blue, as in (7.17)) or are fitted again (orange, the other reading of (7.19)).",
        "Learned and demonstrated reactions for three numbers of groups, and their error over the number of groups.",
    )
}
UNITS = {"ordinary": "cm", "groups": "cm", "demonstrations": "cm"}
TABLES = {"T7.2": "Learning the reactions to the low, close obstacle"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "frozen" not in recordings:
        return {}
    from dexrepro.chapters.chapter7 import pictures

    recording, case = recordings["frozen"], config.cases.frozen
    frozen: Mapping[str, Any] = metrics["frozen"]
    task, condition = skills.reach(case), skills.conditions(case)[shown(case)[0]]
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 4.6))
    grid = figure.add_gridspec(2, 6, height_ratios=[1, 1.15])
    names = list(pictures.DIRECTIONS)
    groups = [g for g in case.shown_groups if f"groups{g}" in recording]
    panels = [figure.add_subplot(grid[0, 2 * k : 2 * k + 2]) for k in range(len(groups))]
    panels.append(figure.add_subplot(grid[1, :3]))
    for letter, number, panel in zip("abcd", [*groups, groups[-1]], panels):
        demonstrations = skills.by_path(recording["demonstrations"])
        for k, path in enumerate(demonstrations):
            line = pictures.DIRECTIONS[names[k * 3 // len(demonstrations)]]
            pictures.plan(panel, path, color=line["color"], linewidth=0.4, alpha=0.5)
        for name, path in zip(names, skills.by_path(recording[f"groups{number}"])):
            pictures.plan(panel, path, **pictures.DIRECTIONS[name])
        pictures.plan(panel, recording["ordinary"], **style.LINES["reference"])
        pictures.footprint(panel, condition.obstacle)
        pictures.ends(panel, task)
        pictures.board(panel)
        error = 10 * frozen[f"rmse{number}"]
        plural = "s" if number > 1 else ""
        style.panel(
            panel,
            letter,
            f"{number} group{plural}, {error:.2g} mm off" if letter != "d" else "final, and demonstrations",
        )
    pictures.name_directions(panels[3])
    curve = figure.add_subplot(grid[1, 3:])
    for name, kind in (("frozen", "book"), ("refit", "rival")):
        if name in recordings:
            learning = recordings[name].frames["learning"].groupby("groups").rmse
            label = {"frozen": "old weights kept (7.17)", "refit": "all weights free"}[name]
            curve.plot(learning.median().index, 10 * learning.median(), label=label, marker=".", **style.LINES[kind])
            style.band(curve, learning.median().index, 10 * learning.min(), 10 * learning.max())
    curve.axhline(10 * frozen["spread"], **style.LINES["reference"])
    curve.annotate("spread of repetitions", (4.5, 9 * frozen["spread"]), fontsize=6.5, va="top")
    equal = 10 * frozen[f"plain_equal{case.shown_groups[-1]}"]
    curve.axhline(equal, label=f"plain kernels, weights of {case.shown_groups[-1]} groups", **style.LINES["plain"])
    curve.set(yscale="log", xlabel="Groups of enhancement nodes [-]", ylabel="RMS error [mm]")
    curve.legend()
    style.panel(curve, "e", "error of ten draws of the nodes")
    errors = ", ".join(f"{10 * frozen[f'rmse{number}']:.2g}" for number in groups)
    style.title(
        figure,
        f"Error of the reactions with {', '.join(map(str, groups))} groups, the old weights kept: {errors} mm; "
        f"of plain kernels with as many weights: {equal:.2g} mm",
    )
    return {"7.8": figure}


def tabulate(recordings: Recordings, metrics: Mapping[str, Any], config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for case, values in metrics.items():
        groups = [g for g in (1, 2, 5, 8) if f"rmse{g}" in values]
        rows.append(
            {"case": case}
            | {f"RMS error, {g} group(s) [mm]": 10 * values[f"rmse{g}"] for g in groups}
            | {f"end error, {g} group(s) [mm]": 10 * values[f"end_error{g}"] for g in groups}
            | {"draws whose forcing error always falls [%]": 100 * values["falling_draws"]}
        )
    return {"T7.2": pd.DataFrame(rows)}
