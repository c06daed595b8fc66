"""What ``planar_constraint`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter6 import plane
from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recording, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "6.2d": Figure(
        "Path of the constrained primitive (law with the recorded acceleration) in its tube, distance to the reference "
        "and V^c for the readings of the law; above with a time constant of the segment's duration, below of 1 s. A "
        "curve ends, with a cross, where its law is no longer defined. The book shows the path alone.",
        "Paths, distances to the reference and Lyapunov functions for the readings of the law and two time constants.",
    )
}
UNITS = {"position": "cm", "reference": "cm", "distance": "cm", "lyapunov": "1", "projected": "1"}
TABLES = {
    "T6.A": "Laws on the planar map: largest distance, violations, projections, goal error, clearance",
    "T6.S": "Variants that decide whether the constraint is kept without projection",
}
LINES = {"consistent": "extra1", "printed": "printed", "feedforward": "book", "lagged": "extra2", "filter": "rival"}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    columns = {
        "e_max": "largest distance [cm]",
        "violated_groups": f"groups that violate, of {config.demonstrations.groups}",
        "projections": "projected steps, most",
        "v_max": "largest V",
        "goal_error": "goal error [cm]",
        "clearance": "clearance [cm]",
        "weight_effect": "path change for other weights [cm]",
    }

    def told(case: str) -> dict[str, Any]:
        c = config.cases[case]
        tau = "segment" if c.dmp.tau is None else f"{c.dmp.tau:g} s"
        return {"law": c.cdmp.law, "tau": tau, "margin [cm]": c.cdmp.margin, "weight": c.cdmp.weight}

    table = by_case(metrics, columns, recordings, told=told)
    plain = table["case"].isin(list(LINES) + ["none"])
    return {"T6.A": table[plain], "T6.S": table[~plain]}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    rows = {
        r"$\tau$ = duration": {"shown": "feedforward", **{law: law for law in LINES}},
        r"$\tau$ = 1 s": {
            "shown": "tau1_feedforward_projected",
            **{f"{law}": f"tau1_{law}" for law in LINES},
            "H^2 weight": "tau1_feedforward_h2",
            "projected": "tau1_feedforward_projected",
        },
    }
    if not {"feedforward", "tau1_feedforward_projected"} <= set(recordings):
        return {}
    figure, grid = style.subplots(2, 3, height=4.4, width=style.TWO_COLUMNS)
    dashes = {**LINES, "H^2 weight": "extra3", "projected": "reference"}
    for (name, cases), (space, far, level) in zip(rows.items(), grid):
        shown = cases.pop("shown")
        _draw_tube(space, recordings[shown], config.cases[shown])
        space.set(ylabel=f"{name}\ny [cm]")
        for label, case in cases.items():
            if case in recordings:
                run = recordings[case]
                text = {"H^2 weight": "feedforward, $H^2$", "projected": "feedforward, proj."}.get(label, label)
                front = 4 if label in ("printed", "feedforward") else 2
                far.plot(run.time, run["distance"], label=text, zorder=front, **style.LINES[dashes[label]])
                held = np.flatnonzero(np.isfinite(run["distance"]))[-1]
                if held < len(run.time) - 1:
                    colour = style.LINES[dashes[label]]["color"]
                    far.plot(run.time[held], run["distance"][held], "x", color=colour, markersize=6, zorder=5)
                level.plot(run.time, np.maximum(run["lyapunov"], 1e-3), **style.LINES[dashes[label]])
        far.axhline(config.cases[shown].cdmp.margin, color="black", linewidth=0.6)
        far.set(ylabel="$\\|x^c-x\\|$ [cm]", ylim=(0, 0.6))
        level.set(ylabel="$V^c$ [-]", yscale="log", ylim=(1e-1, 1e9))
    for axes in grid[1, 1:]:
        axes.set_xlabel("Time in sub-skill 2 [s]")
    grid[0, 0].set_xlabel("")
    figure.legend(*grid[1, 1].get_legend_handles_labels(), loc="outside lower center", ncols=7, fontsize=6.5)
    one = metrics["tau1_feedforward"]["violated_from"]
    within = style.at_most(max(metrics[law]["e_max"] or np.inf for law in ("printed", "feedforward")), 2)
    margin = config.cases["feedforward"].cdmp.margin
    late = rf"; with $\tau$ = 1 s the barrier is stepped over at {one:.1f} s" if one else ""
    style.title(figure, rf"Printed and feedforward: at most {within} of {margin:g} cm off with $\tau$ = duration{late}")
    return {"6.2d": figure}


def _draw_tube(axes: Any, run: Recording, settings: Config) -> None:
    plane.draw_map(axes, settings)
    normal = np.gradient(run["reference"], axis=0)[:, ::-1] * [1, -1]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True) + 1e-9
    edges = [run["reference"] + side * settings.cdmp.margin * normal for side in (1, -1)]
    axes.fill(*np.vstack([edges[0], edges[1][::-1]]).T, color="#BBBBBB", alpha=0.5, linewidth=0)
    axes.plot(*run["reference"].T, **style.LINES["reference"])
    axes.plot(*run["position"].T, **style.LINES["book"])
    axes.set(xlim=(3.5, 18.5), ylim=(3, 15.5))
