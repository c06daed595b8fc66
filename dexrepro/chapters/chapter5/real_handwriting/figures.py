"""What ``real_handwriting`` shows: its figure and table."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Metrics, Recording, Recordings
from dexrepro.report import style

from .experiment import of_shapes

FIGURES = {
    "5.H": Figure(
        "The letters' claims on the LASA handwriting set, written by people on a tablet (not in the book): the first "
        "recording of each shape, its colour the IDMP's error over the DMP+'s with many kernels; the share of the "
        "shapes on which each claim of the book and its control hold; and, shape by shape, the share of the draws of "
        "kernels in which the methods are ordered as printed. All shapes meet the same draws. A result on the "
        "synthetic A need not hold on these.",
        "Small pictures of handwritten shapes, bars of the share of shapes on which each claim holds, and the order "
        "of the methods on each shape.",
    )
}
TABLES = {"T5.L": "The letters' claims on people's own shapes: order of the methods, errors, and which claims fail"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "default" not in recordings:
        return {}
    return {"5.H": _draw(recordings["default"], metrics["default"], config)}


def _draw(recording: Recording, metrics: Metrics, config: Config) -> Drawing:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    few, many = min(config.kernels.counts), max(config.kernels.counts)
    ratio = f"n{many}.idmp{max(config.features.counts)}.ratio"
    figure, (left, middle, right) = style.subplots(1, 3, height=4.6, width_ratios=[1.1, 1, 1])
    colours = ScalarMappable(Normalize(0, 1), "viridis")
    columns, size = 4, 1.3 * config.hand.size
    for k, (shape, path) in enumerate(recording.frames["paths"].groupby("shape", sort=False)):
        x, y = size * (k % columns), -size * (k // columns)
        middle_of = [(path[axis].max() + path[axis].min()) / 2 for axis in "xy"]
        colour = colours.to_rgba(np.array(metrics[f"{shape}.{ratio}"]))
        left.plot(x + path.x - middle_of[0], y + path.y - middle_of[1], color=colour, linewidth=1.2)
    left.set(aspect="equal", anchor="N")
    left.axis("off")
    figure.colorbar(colours, ax=left, location="bottom", label=f"IDMP over DMP+, {many} kernels [-]", shrink=0.8)
    _, verdicts = of_shapes(recording.frames["draws"], config)
    book = verdicts[verdicts.source == "book"]
    claims = sorted(book.dropna(subset="margin").claim.unique(), reverse=True)
    middle.barh(claims, [metrics[f"holds.{claim}"] for claim in claims], color=style.BOOK, height=0.6, label="claim")
    with_control = [claim for claim in claims if f"control.{claim}" in metrics]
    middle.plot([metrics[f"control.{claim}"] for claim in with_control], with_control, "o", label="its control",
                markerfacecolor="white", markeredgecolor=style.PLAIN)  # fmt: skip
    middle.set(xlim=(0, 1.04), xlabel="Share of the shapes [-]")
    middle.legend(loc="center right")
    order = sorted(config.shapes, key=lambda shape: metrics[f"{shape}.n{many}.ordered"])  # type: ignore[arg-type,return-value]
    for count, filled in ((many, style.BOOK), (few, "none")):
        values = [metrics[f"{shape}.n{count}.ordered"] for shape in order]
        right.plot(values, np.arange(len(order)), "o", markerfacecolor=filled, markeredgecolor=style.BOOK,
                   markersize=4, label=f"{count} kernels")  # fmt: skip
    right.set(ylim=(-0.7, len(order) - 0.3), xlabel="Draws ordered as printed [-]", xlim=(None, 1.01))
    right.set_yticks(range(len(order)), order, fontsize=5)
    right.legend(loc="lower right")
    style.panels((left, middle, right), "", "", "")
    ordered, halved = (100 * (metrics.get(f"holds.{claim}") or 0) for claim in ("C5.07", "C5.06"))
    return style.title(
        figure,
        f"With {few} kernels {ordered:.0f} % of people's shapes keep the printed order; with {many} the IDMP halves "
        f"the DMP+'s error on {halved:.0f} % of them",
    )


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    if "default" not in recordings:
        return {}
    found, verdicts = of_shapes(recordings["default"].frames["draws"], config)
    failing = verdicts[verdicts.margin <= 0].groupby("shape").claim.agg(", ".join)
    many, best = max(config.kernels.counts), f"idmp{max(config.features.counts)}"
    return {
        "T5.L": pd.DataFrame(
            {"shape": shape}
            | {
                f"ordered with {n} kernels [%]": 100 * (found[shape][f"n{n}.ordered"] or 0)
                for n in config.kernels.counts
            }
            | {f"IDMP over DMP+, {many} kernels [-]": found[shape][f"n{many}.{best}.ratio"]}
            | {"claims that fail": failing.get(shape, "")}
            for shape in config.shapes
        )
    }
