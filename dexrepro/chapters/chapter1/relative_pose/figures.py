"""What ``relative_pose`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "1.5": Figure(
        "A hand moves {.move:g} m in a minimum-jerk movement of three durations; tool displacement with "
        "s(v) applied to each sample's step and to the total displacement since the fixing (Eq. (1.11) to the "
        "letter). The book shows the frames of the transformation.",
        "Displacement of the tool over time in the incremental and the total form, for three durations of the "
        "movement.",
    ),
    "1.6": Figure(
        "Tool frames of DFR and AFR for three orientations of DFR, by Eq. (1.14); z axes thick. The book shows one.",
        "Pairs of tool frames with their z axes, for three orientations.",
    ),
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "default" not in recordings:
        return {}
    frames = recordings["default"].frames
    return {"1.5": _draw_moves(frames["moves"]), "1.6": _draw_triads(frames["triads"].to_numpy())}


def _draw_moves(moves: pd.DataFrame) -> Drawing:
    durations = sorted(moves["duration"].unique())
    figure, axes = style.subplots(1, len(durations), height=2.0, sharey=True)
    for axis, duration in zip(axes, durations):
        for form, role in (("incremental", "book"), ("total", "printed")):
            rows = moves[(moves["duration"] == duration) & (moves["form"] == form)]
            axis.plot(rows["time"], 1e3 * rows["tool"], label=f"{form}", **style.LINES[role])
        axis.plot(rows["time"], 1e3 * rows["hand"], label="hand", **style.LINES["reference"])
        axis.set(xlabel="Time [s]", title=f"{duration:g} s movement")
    axes[0].set_ylabel("Displacement [mm]")
    axes[0].legend(loc="upper left")
    return style.title(figure, "Scaled step by step the tool stays where it went; scaled as a whole it is pulled back")


def _draw_triads(triads: Any) -> Drawing:
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 2.2))
    for k, (own, faced) in enumerate(zip(triads[:3].reshape(-1, 3, 3), triads[3:].reshape(-1, 3, 3))):
        axis = figure.add_subplot(1, 3, k + 1, projection="3d")
        for place, frame, name in ((0 * own[:, 2], own, "DFR"), (2.6 * own[:, 2], faced, "AFR")):
            for i, colour in enumerate((style.RIVAL, style.EXTRA[0], style.BOOK)):
                axis.plot(*zip(place, place + frame[:, i]), color=colour, linewidth=2.4 if i == 2 else 1.2)
            away = place - 0.35 * frame.sum(axis=1)
            axis.text(*away, name, fontsize=7, ha="center", va="center")
        axis.set_axis_off()
        axis.set_aspect("equal")
    for name, colour in (("x", style.RIVAL), ("y", style.EXTRA[0]), ("z", style.BOOK)):
        axis.plot([], [], color=colour, linewidth=2.4 if name == "z" else 1.2, label=f"{name} axis")
    figure.legend(*axis.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return style.title(figure, "AFR always points at DFR, its x axis along DFR's")
