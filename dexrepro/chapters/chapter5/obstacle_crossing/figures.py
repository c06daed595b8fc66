"""Figures of the crossing: paths in space and from the side, with the obstacle to scale."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.chapters.chapter5 import crossing
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recording, Recordings
from dexrepro.humans.crossing import obstacle_boxes
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "5.8": Figure(
        "(a) Demonstrations over one block (grey) and the skill that a DMP learns; (b) the skill changes to two and "
        "three blocks as features are added, thin: every five features; (c, d) the learned skills (thick) and their "
        "generalisations to nine goals (orange), in space and from the side, with the smallest distance of the paths "
        "from the obstacle. Synthetic demonstrations; the book shows recorded ones.",
        "Demonstrated, learned and generalised paths over one, two and three blocks, in space and from the side.",
    ),
    "5.C": Figure(
        "How much the path changes with every five added features, from one block to two and from two to three; all "
        "draws (thin) and their median. Ours.",
        "Change of the path with every five features, of all draws and their median.",
    ),
}
TABLES = {
    "T5.E": "Clearance [cm] of the generalised paths, median of the draws",
    "T5.F": "Sensitivity of the crossing to amplitude and demonstration",
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "default" not in recordings:
        return {}
    recording, found = recordings["default"], metrics["default"]
    return {"5.8": crossings(recording, found, config), "5.C": changes(recording, found, config)}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    tables = {}
    if "default" in recordings:
        reached = recordings["default"].frames["goals"]
        table = reached.groupby(["blocks", "x", "y"]).clearance.median().unstack("y").reset_index()
        columns = [name if isinstance(name, str) else f"y = {name:g} cm" for name in table]
        tables["T5.E"] = table.set_axis(columns, axis=1).rename(columns={"x": "x [cm]"})
    names = {"skill2.last_change": "last change over the first [-]"}
    for blocks in (2, 3):
        names |= {
            f"goals{blocks}.clearance": f"{blocks} blocks: smallest clearance [cm]",
            f"goals{blocks}.free": f"{blocks} blocks: share of paths that touch nothing",
            f"goals{blocks}.end_error": f"{blocks} blocks: largest distance from the goal [cm]",
        }
    tables["T5.F"] = by_case(metrics, names, first="variant")
    return tables


COLOURS = {1: style.EXTRA[1], 2: style.EXTRA[0], 3: style.BOOK}  # of the skills, by blocks


def crossings(recording: Recording, metrics: Any, config: Config) -> Drawing:
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 4.0))
    grid = figure.add_gridspec(2, 4, width_ratios=(1.15, 1, 1.15, 1))
    paths, reached = recording.frames["paths"], recording.frames["goals"]
    skills = {b: _lines(paths, "skill", b, colour, 1.6) for b, colour in COLOURS.items()}
    contents: list[tuple[str, int, list[Any]]] = [
        ("demonstrations", 1, [_lines(paths, "demonstration", 1, "#999999", 0.6), skills[1]]),
        ("one to three blocks", 3, [*_growth(paths), *skills.values()]),
        ("goals, two blocks", 2, [_lines(paths, "goal", 2, style.RIVAL, 0.8), skills[2]]),
        ("goals, three blocks", 3, [_lines(paths, "goal", 3, style.RIVAL, 0.8), skills[3]]),
    ]
    for place, (name, blocks, groups) in enumerate(contents):
        row, column = place // 2, 2 * (place % 2)
        space = figure.add_subplot(grid[row, column], projection="3d", computed_zorder=False)
        side = figure.add_subplot(grid[row, column + 1])
        _space(space, blocks, groups)
        _side(side, blocks, groups)
        space.set_title(f"({'abcd'[place]}) {name}", y=0.98)
        if row == 1:
            _distances(side, reached[(reached.draw == 0) & (reached.blocks == blocks)])
    names = {"demonstrations": "#999999", "one block": COLOURS[1], "two blocks": COLOURS[2], "three blocks": COLOURS[3]}
    colours = {**names, "goals": style.RIVAL}
    style.legend_below(figure, {name: {"color": colour} for name, colour in colours.items()})
    worst = min(metrics[f"goals{b}.clearance"] for b in (2, 3))
    finding = f"Added features lift the skill; no path of any draw comes nearer than {style.at_least(worst, 1)} cm"
    return style.title(figure, finding)


def _lines(paths: Any, kind: str, blocks: int, colour: Any, width: float) -> tuple[list[Any], Any, float]:
    part = paths[(paths.kind == kind) & (paths.blocks == blocks)]
    return [line[["x", "y", "z"]].to_numpy() for _, line in part.groupby("index")], colour, width


def _growth(paths: Any) -> list[tuple[list[Any], Any, float]]:
    """The thin curves between the skills, from the old skill's colour to the new one's."""
    from matplotlib.colors import LinearSegmentedColormap

    groups = []
    for blocks in crossing.HEIGHTS[1:]:
        blend = LinearSegmentedColormap.from_list("growth", [COLOURS[blocks - 1], COLOURS[blocks]])
        part = paths[(paths.kind == "step") & (paths.blocks == blocks)]
        last = part["index"].max()
        for m, line in part.groupby("index"):
            groups.append(([line[["x", "y", "z"]].to_numpy()], blend(m / last), 0.5))
    return groups


def _space(axes: Any, blocks: int, groups: list[Any]) -> None:
    for low, high in obstacle_boxes(blocks):
        _box(axes, low, high)
    for lines, colour, width in groups:
        for line in lines:
            axes.plot(*line.T, color=colour, linewidth=width)
    axes.set(xlim=(-7, 9), ylim=(-5, 5), zlim=(0, 10), yticks=(-4, 0, 4), zticks=(0, 5, 10))
    axes.set_box_aspect((16, 10, 10), zoom=1.15)
    axes.view_init(elev=18, azim=-62)
    axes.tick_params(labelsize=6.5, pad=-3)
    axes.set_xlabel("x [cm]", fontsize=7, labelpad=-7)
    axes.set_ylabel("y [cm]", fontsize=7, labelpad=-7)


def _box(axes: Any, low: Any, high: Any) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped]

    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    faces = [
        corners[list(i)] for i in ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
    ]
    axes.add_collection3d(Poly3DCollection(faces, facecolor="#D9C7A5", edgecolor="#8A7A55", linewidth=0.3, alpha=0.8))


def _side(axes: Any, blocks: int, groups: list[Any]) -> None:
    for low, high in obstacle_boxes(blocks):
        width, height = high[0] - low[0], high[2] - low[2]
        patch = style.plt.Rectangle(
            (low[0], low[2]), width, height, facecolor="#D9C7A5", edgecolor="#8A7A55", linewidth=0.4
        )
        axes.add_patch(patch)
    for lines, colour, width in groups:
        for line in lines:
            axes.plot(line[:, 0], line[:, 2], color=colour, linewidth=width)
    axes.set(xlim=(-7, 9), ylim=(-0.5, 9.5), aspect="equal", xlabel="x [cm]", ylabel="z [cm]")


def _distances(axes: Any, reached: Any) -> None:
    """Smallest clearance [cm] of the paths to the goals."""
    axes.set_title(f"clear by {reached.clearance.min():.2f} cm", fontsize=7, fontweight="normal")


def changes(recording: Recording, metrics: Any, config: Config) -> Drawing:
    frame = recording.frames["changes"]
    figure, axes = style.subplots(1, 2, height=2.2, sharey=True)
    for panel, blocks in zip(axes, crossing.HEIGHTS[1:]):
        table = frame[frame.blocks == blocks].pivot(index="m", columns="draw", values="change")
        panel.plot(table.index, table, color="#BBBBBB", linewidth=0.6)
        panel.plot(table.index, table.median(axis=1), marker="o", ms=3, **style.LINES["book"])
        panel.set(yscale="log", xlabel="Added features m [-]", title=f"{blocks - 1} to {blocks} blocks")
    axes[0].set_ylabel("RMS change\nof the path [cm]")
    worst = max(metrics[f"skill{b}.last_change"] for b in (2, 3))
    return style.title(
        figure,
        f"The last five features change the path by at most {style.at_most(100 * worst, 0)} % of what the first do",
    )
