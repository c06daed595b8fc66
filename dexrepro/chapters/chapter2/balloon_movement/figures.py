"""What ``balloon_movement`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter2 import balloon_pair
from dexrepro.chapters.chapter2.measures import gains, shown
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recording, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "2.9c": Figure(
        "Path of the partner's gripper on the simulated Baxter (synthetic operator): a line in three directions, then "
        "a lap of a circle, ours in place of the book's drawing.",
        "The partner's path, a straight line followed by a circle.",
    ),
    "2.11": Figure(
        "Simulated Baxter, synthetic operator, balloon as a spring of {.stiffness:g} N/m. (a), (b) "
        "Paths of both grippers under the proposed law; (c) holding force under the three laws of the book's figure; "
        "(d) force errors on the line (12 to 20 s) and on the circle (from 20 s), with the printed and with tuned "
        "gains (F: integral).",
        "Paths of both grippers, holding forces of three laws over time, and bars of their errors with two sets of "
        "gains.",
    ),
}
UNITS = {"reference": "m"}
TABLES = {"T2.2": "Force errors of the Baxter experiment: printed and tuned gains, two balloons"}
FILM = Film(
    "proposed", "The follower, which feels only the force, holds the balloon along a line and a lap of a circle.",
    balloon_pair.VIEW, "object.force", "Holding force [N]", reference="desired_force",
)  # fmt: skip


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    def told(case: str) -> dict[str, Any]:
        its = config.cases[case]
        return {"law": (case if its.law else its.controller).replace("_", " "), "gains": gains(its, config),
                "k_o [N/m]": its.stiffness, "regulation (2.8), (2.9)": "yes" if its.regulation else "no"}  # fmt: skip

    columns = {"rmse_line": "RMSE on the line [N]", "rmse_circle": "RMSE on the circle [N]",
               "mean_error_circle": "mean error on the circle [N]",
               "distance_spread": "std of the distance on the circle [m]"}  # fmt: skip
    return {"T2.2": by_case(metrics, columns, config.cases, told=told)}


SHOWN = {"force": ("F", "plain"), "passive": ("PIm", "rival"), "proposed": ("proposed", "book")}
BARS = {**SHOWN, "tuned_force": ("F, tuned", "plain"), "tuned_passive": ("PIm, tuned", "rival")}
BARS |= {"tuned_proposed": ("proposed,\ntuned", "book")}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"proposed", "force", "passive"} <= set(recordings):
        return {}
    return {"2.9c": _draw_path(recordings["proposed"]), "2.11": _draw_result(recordings, metrics, config)}


def _draw_path(recording: Recording) -> Drawing:
    figure = style.plt.figure(figsize=(style.ONE_COLUMN, 2.9))
    axes: Any = figure.add_subplot(projection="3d")
    place = 1e3 * recording["leader.tip"][recording.between(0)]
    axes.plot(*place.T, **style.LINES["book"])
    axes.plot(*place[0], "o", color=style.REFERENCE, ms=4)
    axes.text(*(place[0] - (0, 0, 25)), " start", fontsize=7)
    axes.set(xlabel="x [mm]", ylabel="y [mm]", zlabel="z [mm]")
    axes.set_box_aspect(None, zoom=0.82)
    axes.locator_params(nbins=4)
    return style.title(figure, "A line in three directions, then a circle")


def _draw_result(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, grid = style.subplots(2, 2, height=4.8, width_ratios=(1, 1.6))
    run, shape = recordings["proposed"], config.path
    held = run.between(0)
    for axes, first, letter in ((grid[0, 0], 1, "a"), (grid[1, 0], 0, "b")):
        for role, label, line in (("follower", "follower", "book"), ("leader", "partner", "plain")):
            tip = 1e3 * run[f"{role}.tip"][held]
            axes.plot(tip[:, first], tip[:, 2], label=label, **style.LINES[line])
        axes.set(xlabel=f"{'xyz'[first]} [mm]", ylabel="z [mm]")
        style.panel(axes, letter, f"paths in the {'xyz'[first]}z plane")
    grid[0, 0].legend()
    forces, bars = grid[0, 1], grid[1, 1]
    for case, (label, line) in SHOWN.items():
        time, look = recordings[case].time, style.LINES[line]
        dense = {"linestyle": "-", "linewidth": 0.7} if case == "passive" else {}
        forces.plot(time[time >= 0], recordings[case]["object.force"][time >= 0], label=label, **{**look, **dense})
    forces.axhline(config.desired_force, **style.LINES["reference"])
    style.phase(forces, shape.line_start, shape.line_end, "line")
    style.phase(forces, shape.circle_start, run.time[-1], "circle", "#F3F3F3")
    forces.set(xlabel="Time since contact [s]", ylabel="Holding force $\\|F\\|$ [N]", ylim=(0, 24))
    forces.legend(ncols=3, loc="upper right", bbox_to_anchor=(1, 0.94))
    style.panel(forces, "c", "printed gains")
    cases = [case for case in BARS if case in recordings]
    place = np.arange(len(cases))
    for shift, phase, shade in ((-0.2, "line", 0.5), (0.2, "circle", 1.0)):
        colours = [style.LINES[BARS[case][1]]["color"] for case in cases]
        values = [shown(metrics[case][f"rmse_{phase}"]) for case in cases]
        found = bars.bar(place + shift, values, 0.38, color=colours, alpha=shade, label=phase)
        bars.bar_label(found, fmt="%.2f", fontsize=6.5)
    bars.set_xticks(place, [BARS[case][0] for case in cases], fontsize=6.5)
    bars.set(ylabel="Force RMSE [N]", yscale="log", ylim=(0.01, 20))
    style.panel(bars, "d", "line (pale) and circle")
    best = style.at_most(shown(metrics["proposed"]["rmse_circle"]), 2)
    finding = f"The proposed law holds {config.desired_force:g} N within {best} N rms on the circle (simulated Baxter)"
    return style.title(figure, finding)
