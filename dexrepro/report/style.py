"""How figures look: one style, one palette whose colours keep their meaning, and saving as PNG and SVG."""

from __future__ import annotations

import contextlib
import math
import re
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM = 1 / 25.4
ONE_COLUMN = 85 * MM  # inch
TWO_COLUMNS = 178 * MM
TITLE_CHARACTER = 0.076  # inch a character of the title takes

# Okabe-Ito, safe for colour-blind readers. A colour keeps its meaning in all chapters.
BOOK = "#0072B2"  # the book's method
RIVAL = "#E69F00"  # its strongest rival
PLAIN = "#8C8C8C"  # a plain baseline
REFERENCE = "#000000"  # what should be followed; dashed
PRINTED = "#D55E00"  # the uncorrected form of an equation; dotted
EXTRA = ("#009E73", "#CC79A7", "#56B4E9", "#F0E442")  # further cases, in this order

# Keyword arguments for Axes.plot: every curve is told apart by its line style too.
LINES: dict[str, dict[str, Any]] = {
    "book": {"color": BOOK, "linestyle": "-"},
    "rival": {"color": RIVAL, "linestyle": "-."},
    "plain": {"color": PLAIN, "linestyle": (0, (5, 1))},
    "reference": {"color": REFERENCE, "linestyle": "--", "linewidth": 0.8},
    "printed": {"color": PRINTED, "linestyle": ":"},
    "extra1": {"color": EXTRA[0], "linestyle": (0, (3, 1, 1, 1))},
    "extra2": {"color": EXTRA[1], "linestyle": (0, (1, 1))},
    "extra3": {"color": EXTRA[2], "linestyle": (0, (7, 2))},
}

_PARAMETERS: Any = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.1,
    "axes.grid": False,
    "grid.linewidth": 0.4,
    "grid.color": "#DDDDDD",
    "figure.constrained_layout.use": True,
    "savefig.dpi": 200,
    "svg.fonttype": "none",
    "svg.hashsalt": "dexrepro",
    "path.simplify": True,
    "path.simplify_threshold": 0.5,
}


@cache
def _pyplot() -> Any:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot

    return matplotlib.pyplot


def __getattr__(name: str) -> Any:
    """``plt`` is pyplot, loaded when the first figure is drawn: who lists or checks figures needs none of it."""
    if name != "plt":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return _pyplot()


@contextlib.contextmanager
def style() -> Iterator[None]:
    """The style of all figures; the runner draws inside it."""
    with _pyplot().rc_context(_PARAMETERS):
        yield


def subplots(
    rows: int = 1, columns: int = 1, *, width: float = TWO_COLUMNS, height: float = 2.2, **options: Any
) -> Any:
    """``plt.subplots`` at a column's width; height in inches. Small multiples: pass sharex / sharey."""
    return _pyplot().subplots(rows, columns, figsize=(width, height), **options)


def title(figure: Figure, text: str) -> Figure:
    """The figure with its finding above all panels, left-aligned, in lines of like length that fit the width."""
    markup = len(text) - len(re.sub(r"[$\\_^{}]", "", text))
    width = int(figure.get_figwidth() / TITLE_CHARACTER) + markup
    lines = len(textwrap.wrap(text, width))
    while lines > 1 and len(textwrap.wrap(text, width - 1)) == lines:
        width -= 1
    figure.suptitle(textwrap.fill(text, width), x=0.01, ha="left", fontsize=9, fontweight="bold")
    return figure


def at_most(value: float, digits: int) -> str:
    """A bound that ``value`` keeps, rounded up to a number of decimals: for "at most" and "within"."""
    return "?" if math.isnan(value) else f"{math.ceil(value * 10**digits - 1e-9) / 10**digits:.{digits}f}"


def at_least(value: float, digits: int) -> str:
    """A bound that ``value`` exceeds, rounded down to a number of decimals."""
    return "?" if math.isnan(value) else f"{math.floor(value * 10**digits + 1e-9) / 10**digits:.{digits}f}"


def panel(axes: Axes, letter: str, text: str = "") -> None:
    """Name a panel: (a), (b), ..."""
    axes.set_title(f"({letter}) {text}".rstrip())


def panels(axes: Iterable[Axes], *texts: str) -> None:
    """Name panels in the order of reading: (a), (b), ..., each with its text."""
    for letter, axis, text in zip("abcdefgh", axes, texts):
        panel(axis, letter, text)


def edges(grid: Any, x: str, y: str | Iterable[str]) -> None:
    """Label small multiples at the edges: ``x`` below the last row, ``y`` left of the rows (one for all, or each)."""
    grid = np.atleast_2d(grid)
    for axes in grid[-1]:
        axes.set_xlabel(x)
    for axes, text in zip(grid[:, 0], [y] * len(grid) if isinstance(y, str) else y):
        axes.set_ylabel(text)


def curves(
    axes: Axes, recordings: Mapping[str, Any], cases: Mapping[str, tuple[str, str]], channel: str, scale: float = 1.0
) -> None:
    """A channel over time of every case that was run; cases: the name of each in the legend, and its line."""
    for case, (label, line) in cases.items():
        if case in recordings:
            axes.plot(recordings[case].time, scale * recordings[case][channel], label=label, **LINES[line])


def twin(axes: Axes, label: str = "", color: str = "black") -> Axes:
    """A second scale on the right."""
    other = axes.twinx()
    other.spines["right"].set_visible(True)
    other.set_ylabel(label, color=color)
    return other


def level(axes: Axes, value: float, word: str, va: str = "top", x: float = 0.98) -> None:
    """A dashed line at a value, named at the right end."""
    axes.axhline(value, **LINES["reference"])
    axes.annotate(word, (x, value), xycoords=("axes fraction", "data"), ha="right", va=va, fontsize=8)


def drawn(
    figures: Mapping[str, tuple[Callable[..., Figure], Iterable[str]]], recordings: Mapping[str, Any], *others: Any
) -> dict[str, Figure]:
    """Of figures, by their number the function that draws each and the cases it shows, those whose cases were run."""
    return {name: draw(recordings, *others) for name, (draw, cases) in figures.items() if set(cases) <= set(recordings)}


def photos(axes: Iterable[Axes], images: Mapping[Any, Any], texts: Mapping[Any, str], **options: Any) -> None:
    """Pictures in the places of axes without the margin they share: those that ``texts`` names, with these titles."""
    shown = trimmed(images)
    for axis, (name, text) in zip(axes, texts.items()):
        photo(axis, shown[name], text, **options)


def photo(axes: Axes, image: Any, text: str = "", **options: Any) -> None:
    """A picture in the place of axes, with a title."""
    axes.imshow(image)
    axes.set_axis_off()
    axes.set_title(text, **options)


def picture(image: Any, finding: str, height: float = 2.5) -> Figure:
    """A figure of one picture without its white margin, a column wide."""
    figure, axes = subplots(width=ONE_COLUMN, height=height)
    photo(axes, trimmed({"": image})[""])
    return title(figure, finding)


def trimmed(images: Mapping[Any, Any]) -> dict[Any, Any]:
    """Pictures of one size without the white margin that all of them share."""
    dark = np.any([np.asarray(image).min(axis=2) < 250 for image in images.values()], axis=0)
    rows, columns = np.flatnonzero(dark.any(axis=1)), np.flatnonzero(dark.any(axis=0))
    return {name: image[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] for name, image in images.items()}


def event(axes: Axes, time: float, word: str) -> None:
    """A thin vertical line with a word: contact, switching, a trigger."""
    axes.axvline(time, color="#444444", linewidth=0.6)
    axes.annotate(
        word,
        (time, 1),
        xycoords=("data", "axes fraction"),
        xytext=(2, -2),
        textcoords="offset points",
        fontsize=6.5,
        va="top",
    )


def band(axes: Axes, x: Any, low: Any, high: Any, **options: Any) -> None:
    """A prescribed bound or a tolerance, shaded."""
    axes.fill_between(x, low, high, color="#BBBBBB", alpha=0.35, linewidth=0, **options)


def phase(axes: Axes, start: float, end: float, word: str = "", color: str = "#EAF2F8") -> None:
    """A phase as a light background with its name at the top."""
    axes.axvspan(start, end, color=color, linewidth=0, zorder=-10)
    if word:
        axes.annotate(
            word,
            ((start + end) / 2, 1),
            xycoords=("data", "axes fraction"),
            xytext=(0, -2),
            textcoords="offset points",
            fontsize=6.5,
            ha="center",
            va="top",
            color="#555555",
        )


def label_end(axes: Axes, line: Any, text: str, dy: float = 0) -> None:
    """Name a curve at its end, in its colour, instead of in a legend."""
    x, y = line.get_xdata()[-1], line.get_ydata()[-1]
    axes.annotate(
        text,
        (x, y),
        xytext=(3, dy),
        textcoords="offset points",
        color=line.get_color(),
        fontsize=7,
        va="center",
        annotation_clip=False,
    )


def legend_below(figure: Figure, lines: Mapping[str, Mapping[str, Any]]) -> None:
    """A legend below all panels, from names and what their lines look like."""
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], label=name, **look) for name, look in lines.items()]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(lines))


def file_stem(figure_id: str) -> str:
    """ "2.7" -> "fig_2_07", "2.A" -> "fig_2_A", "2.9a" -> "fig_2_09a"."""
    chapter, _, rest = figure_id.partition(".")
    digits = "".join(c for c in rest if c.isdigit())
    return f"fig_{chapter}_{digits.zfill(2)}{rest[len(digits) :]}" if digits else f"fig_{chapter}_{rest}"


def save(figure: Figure, folder: Path, figure_id: str) -> None:
    """Write PNG (200 dpi) and SVG (text as text), free of dates, and close the figure."""
    stem = folder / file_stem(figure_id)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # laid out once, for both files
    figure.savefig(stem.with_suffix(".png"), metadata={"Software": None})
    figure.savefig(stem.with_suffix(".svg"), metadata={"Date": None, "Creator": "dexrepro"})
    _pyplot().close(figure)
