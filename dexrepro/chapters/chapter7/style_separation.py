"""How many style parameters the twelve reactions need: singular values, errors and collisions against the rank."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.measures import rms_distance
from dexrepro.primitives.reactive import Styles

FIGURES = {
    "7.A": Figure(
        "Error of the twelve learned reactions against the number of style parameters (simulated; not in the book). "
        "(a) Style parameters of each coordinate, (b) shared by the three coordinates; open: worst reaction, red: "
        "number of reactions that touch the obstacle. (c) Singular values of the reactive forcing terms of each "
        "coordinate. Green: demonstrations whose shape differs between directions.",
        "One style parameter a reaction is not enough for two obstacles; two a coordinate are.",
    ),
}
TABLES = {"T7.A": "Reactions represented by a common basis and style parameters"}
RATE = 50.0


def simulate(config: Config, rng: Any) -> Recording:
    ordinary, reactions = skills.demonstrate(config)
    learned = skills.Skills(config, ordinary, reactions)
    chosen = [i for i, c in enumerate(skills.conditions(config)) if c.labels[:2] in subset(config)]
    targets = learned.reaction_targets[chosen] @ learned.reach.axes.T
    change = learned.features.blocks(learned.primitive.phases).change
    rows = []
    for rank in range(1, min(config.ranks, len(chosen)) + 1):
        styles = Styles.separate(targets, rank, config.style.shared)
        weights = styles.fit(learned.features, learned.primitive.phases, config.enhancement.ridge)
        paths = learned.perform(change @ weights)
        error = rms_distance(paths, learned.demonstrated[chosen])
        clearance = [
            float(skills.conditions(config)[i].obstacle.clearance(path, config.scene.tool_radius))
            for i, path in zip(chosen, paths)
        ]
        rows.append(
            {"rank": rank, "mean": error.mean(), "worst": error.max(), "collisions": int(np.less(clearance, 0).sum()),
             "end_error": np.linalg.norm(paths[:, -1] - learned.goal, axis=-1).max()}
        )  # fmt: skip
    spectrum = pd.DataFrame(styles.spectrum[:, : len(chosen)].T, columns=range(len(styles.spectrum)))
    frames = {"ranks": pd.DataFrame(rows), "spectrum": spectrum.head(config.ranks)}
    spread = np.sqrt(((reactions - reactions.mean(axis=1)[:, None]) ** 2).sum(axis=-1).mean(axis=(1, 2)))
    frames["spread"] = pd.DataFrame({"spread": spread[chosen]})
    return Recording(series={"time": learned.primitive.time}, frames=frames, steps=len(rows))


def subset(config: Config) -> set[tuple[str, str]]:
    """The obstacles (distance, height) whose reactions are taken together."""
    labels = {c.labels[:2] for c in skills.conditions(config)}
    return labels if config.obstacles == "all" else {tuple(config.obstacles)}


def measure(recording: Recording, config: Config) -> Metrics:
    ranks = recording.frames["ranks"].set_index("rank")
    return {
        **{f"mean{r}": float(ranks["mean"][r]) for r in ranks.index},
        **{f"worst{r}": float(ranks["worst"][r]) for r in ranks.index},
        **{f"collisions{r}": int(ranks["collisions"][r]) for r in ranks.index},
        "end_error": float(ranks["end_error"].iloc[-1]),
        "spread": float(recording.frames["spread"]["spread"].mean()),
    }


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Any], config: Config) -> dict[str, Any]:
    if not {"per_coordinate", "shared"} <= set(recordings):
        return {}
    from dexrepro.report import style

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
        panel.axhline(
            10 * metrics["per_coordinate"]["spread"], label="spread of repetitions", **style.LINES["reference"]
        )
        panel.set(
            xlabel="Style parameters R [-]",
            ylabel="RMS error [mm]",
            ylim=(0.1, 300),
            xlim=(0.6, 6.4),
            xticks=range(1, 7),
        )
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
    style.title(figure, "One style parameter is not enough for two obstacles, two of each coordinate are")
    return {"7.A": figure}


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Any], config: Config
) -> dict[str, pd.DataFrame]:
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
