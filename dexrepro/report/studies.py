"""A study as a figure: how often each claim holds, by what margin, and which parameter decides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from dexrepro import chapters
from dexrepro.claims import FRAGILE, OPEN, ROBUST, Claim
from dexrepro.report import style, verdicts
from dexrepro.result import flat
from dexrepro.study.samples import read_samples, samples_file, summary_file

ROW = 0.2  # inch a claim
EDGES = (0.62, 0.42)  # inch above and below the rows
LONGEST = 30  # characters of a parameter's name
LOOKS: dict[str, dict[str, Any]] = {  # the book's claims and ours, told apart by colour and mark
    "book": {"color": style.BOOK, "marker": "o"},
    "ours": {"color": style.RIVAL, "marker": "s"},
}


def finding(study: Mapping[str, Any]) -> str:
    """The study in one sentence."""
    words = [verdicts.robustness(row) for row in study["claims"].values()]
    counts = [f"{words.count(word)} {word}" for word in (ROBUST, FRAGILE, OPEN) if word in words]
    return f"Of {len(words)} claim{'s' * (len(words) != 1)} over {study['samples']} samples: {', '.join(counts)}"


def draw(study: Mapping[str, Any]) -> Any:
    """The figure of a stored study: share of the samples, margin, most influential parameter; one claim a row."""
    sources = {claim.id: claim.source for claim in chapters.load(study["chapter"]).claims}
    rows = dict(sorted(study["claims"].items(), reverse=True))
    height = ROW * len(rows) + sum(EDGES)
    with style.style(), style.plt.rc_context({"figure.constrained_layout.use": False}):
        figure, (shares, margins) = style.subplots(1, 2, height=height, sharey=True, width_ratios=(1, 1))
        figure.subplots_adjust(0.085, EDGES[1] / height, 0.72, 1 - EDGES[0] / height, wspace=0.06)
        for place, (claim, row) in enumerate(rows.items()):
            look = LOOKS["book" if sources.get(claim, "book") == "book" else "ours"]
            _share(shares, place, row, look)
            _margin(margins, place, row, look)
            margins.annotate(
                _parameter(row, study["experiment"]), (1, place), xycoords=("axes fraction", "data"),
                xytext=(6, 0), textcoords="offset points", va="center", fontsize=7,
            )  # fmt: skip
        shares.set(xlabel="Share of the samples [%]", xlim=(-4, 104), ylim=(-0.6, len(rows) - 0.4))
        shares.set_yticks(range(len(rows)), list(rows))
        margins.set(xlabel="Margin [-]", xlim=(-1.08, 1.08))
        margins.axvline(0, **style.LINES["reference"])
        for axes, word in ((shares, "holds in"), (margins, "by a margin of")):
            axes.set_title(word)
            axes.grid(axis="x")
            axes.set_axisbelow(True)
            axes.tick_params(axis="y", length=0)
        margins.annotate("follows most", (1, 1), xycoords="axes fraction", xytext=(6, 4), textcoords="offset points",
                         fontweight="bold")  # fmt: skip
        _legend(figure, {sources.get(claim, "book") for claim in rows})
        style.title(figure, finding(study))
    return figure


def save(study: Mapping[str, Any], path: Path) -> Path:
    """Write the figure as SVG and return its path."""
    figure = draw(study)
    with style.style():
        figure.savefig(path, metadata={"Date": None, "Creator": "dexrepro"})
    style.plt.close(figure)
    return path


def samples(study: Mapping[str, Any], results: Path) -> list[dict[str, Any]]:
    """The samples behind a stored summary, {index, values, margins}; none where those at hand are not the same many.

    Margins are those of claims about single cases; a number over several cases is not made again.
    """
    name = study["experiment"]
    for shipped in (False, True):
        entries = list(read_samples(samples_file(summary_file(name, results, shipped))))
        if len(entries) == study["samples"]:
            claims = chapters.load(study["chapter"]).claims_of(name)
            return [_sample(name, claims, entry) for entry in entries]
    return []


def _sample(experiment: str, claims: Sequence[Claim], entry: Mapping[str, Any]) -> dict[str, Any]:
    metrics = flat(experiment, {case: row["metrics"] for case, row in entry["cases"].items() if "metrics" in row})
    margins = {claim.id: claim.evaluate(metrics).margin for claim in claims}
    return {"index": entry["index"], "values": entry["values"], "margins": margins}


def _share(axes: Axes, place: int, row: Mapping[str, Any], look: Mapping[str, Any]) -> None:
    axes.plot([100 * row["low"], 100 * row["high"]], [place, place], color=look["color"], solid_capstyle="butt")
    axes.plot(100 * row["share"], place, linestyle="", markersize=4.5, **look)


def _margin(axes: Axes, place: int, row: Mapping[str, Any], look: Mapping[str, Any]) -> None:
    """Line from 5 to 95 %, bar from 25 to 75 %, mark at the median; what is beyond -1 or 1 is drawn at the edge."""
    low, first, middle, third, high = np.clip(row["quantiles"], -1, 1)
    axes.plot([low, high], [place, place], color=look["color"])
    axes.plot([first, third], [place, place], color=look["color"], linewidth=4.5, alpha=0.45, solid_capstyle="butt")
    axes.plot(middle, place, linestyle="", markersize=3.5, **look)


def _parameter(row: Mapping[str, Any], experiment: str) -> str:
    if not row["parameter"]:
        return "\u2013"
    name = row["parameter"].removeprefix(f"{experiment}.")
    name = name if len(name) <= LONGEST else f"\u2026{name[-LONGEST:]}"
    return f"{name} ({row['correlation']:+.1f})".replace("-", "\u2212")


def _legend(figure: Any, sources: set[str]) -> None:
    words = {"book": "claim of the book", "ours": "test of ours"}
    handles = [
        style.plt.Line2D([], [], markersize=4.5, label=words[name], **LOOKS[name])
        for name in LOOKS
        if name in sources or (name == "ours" and sources - {"book"})
    ]
    figure.legend(handles=handles, loc="upper right", ncols=2, fontsize=7)
