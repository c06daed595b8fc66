"""What ``grasp_classes`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Metrics, Recording, Recordings
from dexrepro.report import style

from .experiment import NAMES

FIGURES = {
    "3.C": Figure(
        "Accuracy on training and on new scenes over {.epochs} epochs, and confusion on the new scenes, "
        "for a patch of {.patch_size:g} m that shows the walls. Synthetic RGB-D scenes rendered in place "
        "of Cornell's data (the book states 98 % training accuracy and no test accuracy).",
        "Accuracy over the epochs on training and on new scenes, and a table of classes found and true.",
    ),
    "3.E": Figure(
        "A new synthetic scene: the rectangle the network scores highest as safe, all candidates coloured by their "
        "found class, and the boundary of the safety region.",
        "A scene from above with candidate grasps, the chosen one and the safety region.",
    ),
}
TABLES = {"T3.F": "Confusion on new scenes (rows: true class)"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures: dict[str, Any] = {}
    wide = recordings.get("wide")
    if wide is None:
        return figures
    figures["3.C"] = _draw_training(wide, metrics["wide"])
    if "grasps" in wide.frames:
        figures["3.E"] = _draw_example(wide)
    return figures


def _draw_training(recording: Recording, found: Metrics) -> Drawing:
    figure, (left, right) = style.subplots(1, 2, height=2.5, width_ratios=(1.4, 1))
    epochs = recording.frames["epochs"]
    left.plot(epochs.epoch, 100 * epochs.train, label="training scenes", **style.LINES["book"])
    left.plot(epochs.epoch, 100 * epochs.test, label="new scenes", **style.LINES["rival"])
    left.axhline(98, label="book, training", **style.LINES["reference"])
    left.set(xlabel="Epoch", ylabel="Accuracy [%]")
    left.legend(loc="lower right")
    counts = recording.frames["confusion"].to_numpy()
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    right.imshow(shares, cmap="Blues", vmin=0, vmax=1)
    for i in range(3):
        for j in range(3):
            dark = shares[i, j] > 0.5
            right.text(j, i, str(counts[i, j]), ha="center", va="center", color="white" if dark else "black")
    right.set(xticks=range(3), yticks=range(3), xticklabels=NAMES, yticklabels=NAMES, xlabel="Found", ylabel="True")
    accuracy, missed = 100 * found["test_accuracy"], 100 * found["unsafe_called_safe"]  # type: ignore[operator]
    return style.title(figure, f"New scenes: {accuracy:.0f} % right, {missed:.0f} % of unsafe grasps pass for safe")


def _draw_example(recording: Recording) -> Drawing:
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=2.7)
    axes.imshow(recording.images["scene"])
    grasps = recording.frames["grasps"]
    colours = (style.BOOK, style.RIVAL, style.PLAIN)
    best = int(grasps.score.argmax())
    for index, row in enumerate(grasps.to_dict("records")):
        u, v = ([row[f"{axis}{k % 4}"] for k in range(5)] for axis in "uv")
        found = int(row["found"])
        axes.plot(u, v, color=colours[found], linewidth=2.2 if index == best else 0.7)
    boundary = recording.frames["boundary"]
    axes.plot(boundary.u, boundary.v, label="safety region", **style.LINES["reference"])
    for colour, name in zip(colours, NAMES):
        axes.plot([], [], color=colour, label=f"found {name}")
    figure.legend(loc="outside lower center", ncols=2)
    axes.set_axis_off()
    right = float((grasps.found == grasps.true).mean())
    return style.title(figure, f"{100 * right:.0f} % of this scene's grasps are told right")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    tables = []
    for case, recording in recordings.items():
        table = recording.frames["confusion"].copy()
        table.insert(0, "true", list(NAMES)[: len(table)])
        table.insert(0, "patch", case)
        tables.append(table)
    return {"T3.F": pd.concat(tables)} if tables else {}
