"""What ``style_separation`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "7.A": Figure(
        "Error of the twelve learned reactions against the number of style parameters (simulated; not in the book). "
        "(a) Style parameters of each coordinate, (b) shared by the three coordinates; open: worst reaction, red: "
        "number of reactions that touch the obstacle. (c) Singular values of the reactive forcing terms of each "
        "coordinate. Green: demonstrations whose shape differs between directions.",
        "Errors over the number of style parameters, for each coordinate and for all together, and singular values.",
    )
}
TABLES = {"T7.A": "Reactions represented by a common basis and style parameters"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"per_coordinate", "shared"} <= set(recordings):
        return {}
    numbers: Mapping[str, Any] = metrics["per_coordinate"]
    figure, axes = style.subplots(1, 3, height=2.6)
    pairs = {"per_coordinate": ("book", axes[0]), "non_separable": ("extra1", axes[0]), "shared": ("book", axes[1])}
    for name, (line, panel) in pairs.items():
        if name not in recordings:
            continue
        ranks = recordings[name].frames["ranks"]
        label = {"non_separable": "shape differs by direction"}.get(name, "mean")
        panel.semilogy(ranks["rank"], 10 * ranks["mean"], marker=".", label=label, **style.LINES[line])
        if name != "non_separable":
            panel.semilogy(ranks["rank"], 10 * ranks["worst"], "o", fillstyle="none", color=style.BOOK, label="worst")
            for rank, worst, count in ranks[["rank", "worst", "collisions"]].to_numpy().tolist():
                if count:
                    panel.annotate(f"{count:.0f}", (rank, 10 * worst), xytext=(0, 5),
                                   textcoords="offset points", fontsize=7, ha="center")  # fmt: skip
    for letter, panel, text in zip("ab", axes, ("a set of each coordinate", "one set for all coordinates")):
        panel.axhline(10 * numbers["spread"], label="spread of repetitions", **style.LINES["reference"])
        panel.set(xlabel="Style parameters R [-]", ylabel="RMS error [mm]", ylim=(0.1, 300), xlim=(0.6, 6.4))
        panel.set_xticks(range(1, 7))
        style.panel(panel, letter, text)
    axes[0].plot([], [], "k", linestyle="none", marker="$n$", markersize=4, label="number that touch")
    axes[0].legend(loc="upper right", fontsize=6.5)
    spectrum = recordings["per_coordinate"].frames["spectrum"]
    names = ("along", "lateral", "vertical")
    for column, name, line in zip(spectrum.columns, names, ("extra1", "extra2", "extra3")):
        axes[2].semilogy(spectrum.index + 1, spectrum[column], marker=".", label=name, **style.LINES[line])
    axes[2].set(xlabel="Component [-]", ylabel="Singular value [cm]", xticks=range(1, 7))
    axes[2].legend()
    style.panel(axes[2], "c", "singular values")
    one, two = (f"{10 * numbers[f'mean{rank}']:.2g}" for rank in (1, 2))
    style.title(
        figure,
        f"With one style parameter a coordinate reactions err by {one} mm and {numbers['collisions1']:.0f} of twelve "
        f"touch, with two by {two} mm and {numbers['collisions2']:.0f} touch",
    )
    return {"7.A": figure}


def tabulate(recordings: Recordings, metrics: Mapping[str, Any], config: Config) -> dict[str, pd.DataFrame]:
    rows = [
        {
            "reactions": case,
            "style parameters": rank,
            "mean RMS error [mm]": 10 * values[f"mean{rank}"],
            "worst RMS error [mm]": 10 * values[f"worst{rank}"],
            "touch the obstacle": values[f"collisions{rank}"],
        }
        for case, values in metrics.items()
        for rank in range(1, config.ranks + 1)
        if f"mean{rank}" in values
    ]
    return {"T7.A": pd.DataFrame(rows)}
