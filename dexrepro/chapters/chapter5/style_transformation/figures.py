"""Figures of the style transformation: the cross of shapes, and mixtures of letters."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recording, Recordings
from dexrepro.report import style

FIGURES = {
    "5.5a": Figure(
        "Five synthetic handwritten letters with common start and end, as demonstrated; the book shows recorded ones.",
        "The five demonstrated letters a, z, l, k and w.",
    ),
    "5.6": Figure(
        "Synthetic hand: the letter a (centre, blue frame; red in the book) turns into four other letters as shared "
        "random features are added, five at a time, along the diagonals; black frames: demonstrations. Only the "
        "weights of the new features are learned. Right: distance to the target and to the initial letter over the "
        "number of added features, median of the draws. The book shows the left part.",
        "Shapes between the letter a and four others by added features, and their distances from both.",
    ),
    "5.B": Figure(
        "Mixing styles by their weights, Eq. (5.30): from one letter (alpha = 1) to another (alpha = 0). The result is "
        "the pointwise mixture of the two paths. Ours; the book describes it.",
        "Interpolated weights give the pointwise mixture of two letters.",
    ),
}
TABLES = {
    "T5.C": "Distance to the target letter [cm] over the number of added features",
    "T5.D": "Sensitivity of the transformation to what the book does not print",
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "default" not in recordings:
        return {}
    recording = recordings["default"]
    drawn = {"5.5a": demonstrations(recording, config), "5.6": cross(recording, config)}
    return drawn | ({"5.B": mixtures(recording, config)} if len(recording.frames["mixtures"]) else {})


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    tables = {}
    if "default" in recordings:
        medians = recordings["default"].frames["errors"].groupby(["letter", "m"]).target.median()
        tables["T5.C"] = medians.unstack().add_prefix("m = ").reset_index()
    columns = {
        "start": "distance to the target, m = 0 [cm]",
        "final": "distance to the target, all features [cm]",
        "first_step": "distance left after the first features, smallest share",
        "approaches": "share of draws that always come nearer",
        "leaves_base": "share of draws that always leave the base",
        "distinct": "share of draws nearest to their own letter",
    }
    tables["T5.D"] = pd.DataFrame(
        {"variant": case, "letter": letter, **{text: values.get(f"{letter}.{key}") for key, text in columns.items()}}
        for case, values in metrics.items()
        for letter in config.hand.targets
        if f"{letter}.final" in values
    )
    return tables


CORNERS = ((-1, 1), (1, 1), (-1, -1), (1, -1))
CELL = 5.2  # cm on the sheet, distance of neighbouring shapes of 4 cm
"""The initial letter in the centre, the targets toward the corners."""


def demonstrations(recording: Recording, config: Config) -> Drawing:
    paths = recording.frames["paths"]
    names = (config.hand.base, *config.hand.targets)
    figure, axes = style.subplots(1, len(names), height=1.9, sharex=True, sharey=True)
    for panel, name in zip(axes, names):
        part = paths[(paths.letter == name) & (paths.m == -1)]
        panel.plot(part.x, part.y, color=style.BOOK if name == config.hand.base else style.REFERENCE, linewidth=1.1)
        panel.plot([part.x.iloc[0], part.x.iloc[-1]], [part.y.iloc[0], part.y.iloc[-1]], "o", ms=3, color=style.RIVAL)
        panel.set(aspect="equal", xlabel="x [cm]", title=name)
    axes[0].set_ylabel("y [cm]")
    return style.title(figure, f"The {len(names)} demonstrated letters begin and end at the same points (dots)")


def cross(recording: Recording, config: Config) -> Drawing:
    figure, axes = style.plt.subplots(
        2, 2, figsize=(style.TWO_COLUMNS, 4.6), gridspec_kw={"width_ratios": (2.3, 1)}, squeeze=False
    )
    sheet = axes[0, 0].get_gridspec()
    for old in axes[:, 0]:
        old.remove()
    _cross(figure.add_subplot(sheet[:, 0]), recording, config)
    _distances(axes[:, 1], recording, config)
    names = config.hand.targets
    text = f"{', '.join(names[:-1])} and {names[-1]}" if names[1:] else names[0]
    return style.title(figure, f"From {config.hand.base} to {text} as features are added")


def _cross(axes: Any, recording: Recording, config: Config) -> None:
    paths, counts = recording.frames["paths"], config.features.counts
    start = paths[(paths.m == 0) & (paths.letter == config.hand.targets[0])]
    _shape(axes, start, (0, 0), style.BOOK, frame=True)
    for letter, (right, up) in zip(config.hand.targets, CORNERS):
        for k, m in enumerate(counts, 1):
            shade = style.plt.get_cmap("viridis")(0.15 + 0.6 * k / len(counts))
            _shape(axes, paths[(paths.letter == letter) & (paths.m == m)], (right * k, up * k), shade)
            if right > 0 and up > 0:
                axes.annotate(f"m = {m}", (CELL * k + 3.0, CELL * k - 1.4), fontsize=6.5)
        corner = (right * (len(counts) + 1), up * (len(counts) + 1))
        _shape(axes, paths[(paths.letter == letter) & (paths.m == -1)], corner, style.REFERENCE, frame=True)
    axes.set(aspect="equal", xticks=[], yticks=[])
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)


def _shape(axes: Any, path: Any, cell: tuple[int, int], colour: Any, frame: bool = False) -> None:
    x, y = CELL * cell[0], CELL * cell[1]
    axes.plot(x + path.x - 2, y + path.y - 2.6, color=colour, linewidth=0.9)
    if frame:
        axes.add_patch(style.plt.Rectangle((x - 2.6, y - 3.1), 5.2, 7.2, fill=False, edgecolor=colour, linewidth=0.8))


def _distances(axes: Any, recording: Recording, config: Config) -> None:
    errors = recording.frames["errors"]
    names = ("book", "rival", "extra1", "extra2")
    for column, panel, text in (("target", axes[0], "to the target"), ("base", axes[1], "to the initial letter")):
        medians = errors.groupby(["letter", "m"])[column].median()
        for letter, name in zip(config.hand.targets, names):
            panel.plot(medians[letter].index, medians[letter], label=letter, marker="o", ms=2.5, **style.LINES[name])
        panel.set(ylabel=f"RMS distance\n{text} [cm]", ylim=(0, None))
    axes[1].set_xlabel("Added features m [-]")
    axes[0].legend(ncols=2)


def mixtures(recording: Recording, config: Config) -> Drawing:
    frame = recording.frames["mixtures"]
    pairs = list(dict.fromkeys(frame.pair))
    shares = sorted(config.interpolation, reverse=True)
    height = 1.7 * len(pairs) + 0.4
    figure, grid = style.subplots(len(pairs), len(shares), height=height, sharex=True, sharey="row", squeeze=False)
    for row, pair in zip(grid, pairs):
        for axes, share in zip(row, shares):
            path = frame[(frame.pair == pair) & (frame.share == share)]
            axes.plot(path.x, path.y, **style.LINES["book"])
            axes.set_aspect("equal")
            axes.set_title(rf"$\alpha$ = {share:g}")
        row[0].set_ylabel(f"{pair[0]} to {pair[1]}\ny [cm]")
    for axes in grid.flat:
        axes.tick_params(labelbottom=True)
        axes.set_xlabel("x [cm]")
    return style.title(figure, "Mixed weights give the pointwise mixture of two letters")
