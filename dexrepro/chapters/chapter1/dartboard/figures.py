"""What ``dartboard`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recording, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

from .experiment import MAPPINGS, boards

FIGURES = {
    "1.15": Figure(
        "(a) Hit points of thirteen synthetic operators on six boards; ten rings of {.ring:g} m. (b) Hand "
        "speed, scale and distance to the nearest centre of one operator. (c) Posture load of the forearm. The book "
        "shows photographs.",
        "Rings with the hits of two mappings on six boards, hand speed, scale and distance over time, and posture "
        "loads.",
    )
}
UNITS = {"scale": "1", "tool": "m", "hand": "m"}
TABLES = {"T1.D": "Scores with the general and the proposed mapping, for several constant scales and ring widths"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "book" not in recordings:
        return {}
    recording, numbers = recordings["book"], metrics["book"]
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 3.7))
    halves = figure.add_gridspec(1, 2, width_ratios=(1.35, 1.0))
    grid = halves[1].subgridspec(3, 1)
    _draw_hits(figure.add_subplot(halves[0]), recording.frames["hits"].query("panel == 0"), config)
    _draw_speed([figure.add_subplot(grid[k]) for k in (0, 1)], recording)
    axis = figure.add_subplot(grid[2])
    loads = recording.frames["hits"].query("panel == 0").groupby(["person", "mapping"])["load"].first().unstack()
    for k, (mapping, role) in enumerate((("general", "plain"), ("proposed", "book"))):
        axis.plot(loads[mapping], np.full(len(loads), k) + np.linspace(-0.2, 0.2, len(loads)), "o", markersize=3,
                  color=style.LINES[role]["color"])  # fmt: skip
    axis.set_yticks((0, 1), MAPPINGS)
    axis.set(ylim=(-0.5, 1.5), xlabel="Posture load [deg s]")
    style.panel(axis, "c", "forearm, an operator a dot")
    scores = f"{numbers['wins']} of {len(loads)} score higher, {numbers['ties']} equal, {numbers['losses']} lower"
    return {"1.15": style.title(figure, f"Speed-dependent scaling: {scores}")}


def _draw_hits(axis: Any, hits: pd.DataFrame, config: Config) -> None:
    # Boards are drawn side by side, enlarged: their distance of 250 mm would hide the rings.
    for k in range(6):
        x, y = 66.0 * (k // 2), -66.0 * (k % 2)
        for ring in range(1, 11):
            axis.add_patch(
                style.plt.Circle((x, y), 1e3 * config.ring * ring, fill=False, color="#BBBBBB", linewidth=0.3)
            )
        for mapping, role, marker in (("general", "plain", "x"), ("proposed", "book", "o")):
            rows = hits[(hits["board"] == k) & (hits["mapping"] == mapping)]
            axis.plot(x + 1e3 * rows["y"], y + 1e3 * rows["z"], marker, markersize=2.2, markeredgewidth=0.7,
                      color=style.LINES[role]["color"], label=mapping if k == 0 else None)  # fmt: skip
    axis.set_aspect("equal")
    axis.set(xlim=(-34, 166), ylim=(-112, 34))
    axis.set_axis_off()
    axis.plot((-30, -20), (-107, -107), color="black", linewidth=1.0)
    axis.annotate("10 mm", (-25, -106), fontsize=7, ha="center", va="bottom")
    axis.legend(loc="lower right", bbox_to_anchor=(1.0, -0.04), ncols=2)
    style.panel(axis, "a", "hits on six boards")


def _draw_speed(axes: Any, recording: Recording) -> None:
    time = recording.time
    part = time < 12.0
    speed = np.r_[0.0, np.linalg.norm(np.diff(recording["hand"], axis=0), axis=1) / 0.01]
    near = np.min(np.linalg.norm(recording["tool"][:, None, 1:] - boards()[None, :, 1:], axis=2), axis=1)
    axes[0].plot(time[part], speed[part], **style.LINES["plain"])
    axes[0].set_ylabel("Hand [m/s]", color=style.PLAIN)
    twin = style.twin(axes[0], "Scale $s$ [-]", style.BOOK)
    twin.plot(time[part], recording["scale"][part], **style.LINES["book"])
    axes[1].semilogy(time[part], 1e3 * near[part], **style.LINES["rival"])
    axes[1].set(xlabel="Time [s]", ylabel="To centre [mm]")
    axes[0].tick_params(labelbottom=False)
    style.panel(axes[0], "b", "slow near a board, fast between")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    keys = ("wins", "ties", "losses", "p_value", "wins_median", "losses_median", "wins_median_5mm",
            "losses_median_5mm", "wins_median_10mm", "losses_median_10mm", "general_radius", "proposed_radius",
            "general_score", "proposed_score", "general_time", "proposed_time", "general_load",
            "proposed_load")  # fmt: skip
    units = {"radius": "mm", "time": "s", "load": "deg s"}
    found = {key: units.get(key.rpartition("_")[2]) for key in keys}
    columns = {key: key.replace("_", " ") + (f" [{unit}]" if unit else "") for key, unit in found.items()}
    return {"T1.D": by_case(metrics, columns, recordings)}
