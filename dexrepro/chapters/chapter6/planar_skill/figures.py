"""What ``planar_skill`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.chapters.chapter6 import plane
from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

from .experiment import lies_inside

FIGURES = {
    "6.1": Figure(
        "Simulated map with demonstrations (thin lines), the old obstacles (orange), the additional block (light blue) "
        "and the operator's arc (dots). The book shows a board of 20 x 16 cm; its obstacles are not printed.",
        "Five demonstrated paths pass the old obstacles; the additional block lies across them.",
    ),
    "6.2a": Figure(
        "The two sub-skills learned from five demonstrations that were cut at a change point. The book shows the same.",
        "The learned path among the obstacles, its two sub-skills and the cut between them.",
    ),
    "6.2b": Figure(
        "Reference path by cubic splines (thin) between the kept parts of the learned path and the arc.",
        "The spline reference among the obstacles, with the kept parts of the learned path.",
    ),
    "6.2c": Figure(
        "Reference path by extended primitives: sub-skill 1 with its goal moved to the arc's start, sub-skill 2 with "
        "its start moved to the arc's end; crosses mark samples inside an obstacle. The book reports such collisions.",
        "Extended sub-skills among the obstacles; crosses where they lie inside one.",
    ),
}
TABLES = {"T6.Sa": "Variants of the map, of the segmentation and of the intervals, and what they change"}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    shown = {
        "segmentation_error_max": "largest cut error [s]",
        "clearance_new_max": "learned path to new block, largest [cm]",
        "clearance_old_min": "learned path to old obstacles, smallest [cm]",
        "clearance_reference_min": "spline reference, smallest clearance [cm]",
        "clearance_extended_1_max": "extended primitive 1, largest clearance [cm]",
        "clearance_extended_2_max": "extended primitive 2, largest clearance [cm]",
        "late_drift_max": "largest drift from the goal after the end [cm]",
    }
    return {"T6.Sa": by_case(metrics, shown, first="variant")}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "book" not in recordings:
        return {}
    lines = {name: frame.to_numpy() for name, frame in recordings["book"].frames.items() if name != "groups"}
    numbers, settings = metrics["book"], config.cases["book"]
    figures = {}
    for identifier in FIGURES:
        figures[identifier], axes = style.subplots(width=style.ONE_COLUMN, height=3.0)
        plane.draw_map(axes, settings)
        axes.set_ylabel("y [cm]")
        text = _PANELS[identifier](axes, lines, numbers, settings)
        style.title(figures[identifier], text)
        handles = axes.get_legend_handles_labels()
        if handles[0]:
            figures[identifier].legend(*handles, loc="outside lower center", ncols=3)
    return figures


def _demonstrations(axes: Any, lines: Any, numbers: Any, settings: Config) -> str:
    for i in range(settings.demonstrations.count):
        axes.plot(*lines[f"demonstration_{i}"].T, color=style.PLAIN, linewidth=0.6)
    if not settings.demonstrations.files:
        axes.annotate("start", (3, 16), xytext=(0.3, 15.2), fontsize=7)
        axes.annotate("goal", (5, 14), xytext=(4.6, 14.5), fontsize=7)
    return "The new block lies across the\ndemonstrated paths"


def _learned(axes: Any, lines: Any, numbers: Any, settings: Config) -> str:
    axes.plot(*lines["first"].T, color=style.BOOK, label="sub-skill 1")
    axes.plot(*lines["second"].T, color=style.EXTRA[0], linestyle="-.", label="sub-skill 2")
    return f"The learned path cuts {-numbers['clearance_new_max']:.2f} cm or more\ninto the new block"


def _spline(axes: Any, lines: Any, numbers: Any, settings: Config) -> str:
    axes.plot(*lines["first"].T, color=style.BOOK, label="sub-skill 1")
    axes.plot(*lines["reference"].T, color="black", linewidth=0.8, label="spline")
    axes.plot(*lines["reserved"].T, color=style.EXTRA[0], linestyle="-.", label="kept of sub-skill 2")
    return f"The spline reference clears everything\nby {numbers['clearance_reference_min']:.2f} cm"


def _extended(axes: Any, lines: Any, numbers: Any, settings: Config) -> str:
    old, block = plane.obstacles(settings)
    axes.set(
        xlim=(min(0.0, lines["extended_1"][:, 0].min() - 0.5), 20), ylim=(0, lines["extended_1"][:, 1].max() + 0.5)
    )
    for name, colour, dash, text in (
        ("extended_1", style.BOOK, "-", "1, new goal"),
        ("extended_2", style.EXTRA[0], "-.", "2, new start"),
    ):
        path = lines[name]
        axes.plot(*path.T, color=colour, linestyle=dash, label=f"sub-skill {text}")
        axes.plot(*path[lies_inside(path, [*old, block])].T, "x", color="black", markersize=2.5, markeredgewidth=0.5)
    share = style.at_least(100 * numbers["inside_share_extended_old_min"], 0)
    return f"Extended sub-skills run through old\nobstacles (at least {share} % of the samples)"


_PANELS = {"6.1": _demonstrations, "6.2a": _learned, "6.2b": _spline, "6.2c": _extended}
