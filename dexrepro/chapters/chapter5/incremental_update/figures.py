"""What ``incremental_update`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recording, Recordings
from dexrepro.report import style

from .experiment import LOST

FIGURES = {
    "5.2": Figure(
        "How an IDMP is made: kernels phi, random features eta of them, the share 1/Gamma that is left to the old "
        "skill, and the three blocks of Eq. (5.21) over time; the features sum to the phase s at every instant (the "
        "book shows a diagram).",
        "Kernels, added features and the three blocks of the extended feature vector.",
    ),
    "5.G": Figure(
        "Left: multiplications for five more features (wall times are in the benchmark) "
        "against the number there are, by the block update of the pseudo-inverse and by solving anew. Right: how far "
        "the fit of a letter by repeated updates is from the one solved anew, as random features of 5 and 20 kernels, "
        "which are nearly dependent, are appended. Ours; the book claims low cost.",
        "Multiplications of the update and of solving anew, and their difference on two numbers of kernels.",
    ),
}
TABLES = {"T5.K": "Largest relative error (at least 1e-9) of the updated pseudo-inverse by kind of added columns"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    if "mechanism" in recordings:
        figures["5.2"] = _draw_mechanism(recordings["mechanism"])
    if {"cost", "drift"} <= set(recordings):
        figures["5.G"] = _draw_cost(recordings["cost"].frames["cost"], recordings["drift"].frames["drift"])
    return figures


def _draw_mechanism(recording: Recording) -> Drawing:
    frame = recording.frames["blocks"]
    instants = np.linspace(0, recording.time[-1], len(frame))
    panels = {
        "kernels": ("kernels $\\varphi_i$", style.PLAIN),
        "features": ("random features $\\eta_j$", style.BOOK),
        "share": ("share of the old skill $1/\\Gamma$", style.EXTRA[0]),
        "old": ("old skill $\\psi_i$", style.PLAIN),
        "modified": ("change of it $(1/\\Gamma - 1)\\psi_i$", style.RIVAL),
        "new": ("new $(1 - 1/\\Gamma)\\gamma_j$", style.BOOK),
    }
    figure, grid = style.subplots(2, 3, height=3.2, sharex=True)
    for axes, (name, (text, colour)) in zip(grid.flat, panels.items()):
        axes.plot(instants, frame.filter(regex=rf"^{name}\d+$"), color=colour, linewidth=0.9)
        axes.set_title(text)
    total = frame.filter(regex=r"^(old|modified|new)\d+$").sum(axis=1)
    grid[1, 0].plot(instants, total, **style.LINES["book"])
    grid[1, 0].plot(instants, frame["phase0"], **style.LINES["reference"])
    grid[1, 0].annotate("all features sum\nto the phase s", (0.95, 0.6), xycoords="axes fraction", ha="right")
    style.edges(grid, "Time [s]", "[-]")
    finding = "Random images of the kernels join the old features; together they still sum to the phase"
    return style.title(figure, finding)


def _draw_cost(cost: pd.DataFrame, drift: pd.DataFrame) -> Drawing:
    figure, (left, right) = style.subplots(1, 2, height=2.3)
    left.plot(cost.features, 1e-6 * cost.anew, label="solved anew", marker="s", ms=3, **style.LINES["plain"])
    left.plot(cost.features, 1e-6 * cost["update"], label="updated", marker="o", ms=3, **style.LINES["book"])
    left.set(yscale="log", xlabel="Features there are [-]", ylabel="Multiplications [10$^6$]")
    left.legend()
    for (count, part), line in zip(drift.groupby("kernels"), ("rival", "book")):
        right.plot(part.m, part.gap, label=f"{count} kernels", marker="o", ms=3, **style.LINES[line])
    right.set(yscale="log", xlabel="Added features m [-]", ylabel="Update minus anew,\nshare of the target [-]")
    right.legend()
    ratio = style.at_least((cost.anew / cost["update"]).iloc[-1], 0)
    lost = " and ".join(str(count) for count, part in drift.groupby("kernels") if part.gap.iloc[-1] > LOST)
    end = f"; with {lost} kernels it loses the solution" if lost else ""
    return style.title(figure, f"The update costs up to {ratio} times less{end}")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    if "lemma" not in recordings:
        return {}
    frame = recordings["lemma"].frames["lemma"]
    table = frame.groupby(["kind", "reading"])[["error", "fit"]].max().clip(lower=1e-9).reset_index()
    names = {"kind": "added columns", "error": "error of the pseudo-inverse [-]", "fit": "error of the fit [-]"}
    return {"T5.K": table.rename(columns=names)}
