"""Figures for other places than the page: a PDF, PNG or SVG in the look of slides, of print, or on a dark ground."""

from __future__ import annotations

import colorsys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure, FigureBase
from matplotlib.text import Text

from dexrepro.errors import refused
from dexrepro.experiment import Experiment
from dexrepro.report.style import TWO_COLUMNS, file_stem, style
from dexrepro.result import drawn, recorded
from dexrepro.selection import matches

FORMATS = ("pdf", "png", "svg")
SLIDE = 12.0  # inch: a figure as wide as a slide (13.33) with its margins
STYLES = {"paper": 1.0, "slides": SLIDE / TWO_COLUMNS, "dark": SLIDE / TWO_COLUMNS}
"""The looks, and how much larger all of a figure becomes: letters and lines too."""
SIZES = ("fontsize", "linewidth", "linewidths", "markersize", "markeredgewidth", "sizes")
COLOURS = ("color", "facecolor", "edgecolor", "markerfacecolor", "markeredgecolor")
GROUND = 0.11  # lightness of the dark ground


def export(
    experiment: Experiment, folder: Path, target: Path, kind: str, look: str, wanted: str | None = None
) -> list[Path]:
    """Draw a result from its files, as ``target/fig_2_07.pdf``; the result stays as it is. wanted: one figure alone."""
    draw, made = experiment.function("draw"), []
    recordings, nested, config, _ = recorded(experiment, folder)
    target.mkdir(parents=True, exist_ok=True)
    with style():
        for identifier, figure in (drawn(experiment, draw(recordings, nested, config)) if draw else {}).items():
            if wanted and not matches(wanted, identifier):
                continue
            path = target / f"{file_stem(identifier)}.{kind}"
            enlarge(figure, STYLES[look])
            if look == "dark":
                darken(figure)
            dates = {"pdf": {"CreationDate": None}, "svg": {"Date": None}, "png": {"Software": None}}
            figure.savefig(path, dpi=200 if look == "paper" else 160, metadata=dates[kind])
            plt.close(figure)
            made.append(path)
    return made


def checked(kind: str, look: str) -> tuple[str, str]:
    """Raises InputError for a format or a look that does not exist."""
    for key, value, known in (("format", kind, FORMATS), ("style", look, tuple(STYLES))):
        if value not in known:
            raise refused(key, value, f"be one of {', '.join(known)}")
    return kind, look


def enlarge(figure: Figure, factor: float) -> None:
    """Make a figure and everything in it larger, so that its proportions stay."""
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # laid out once, at the size for which it was drawn
    figure.set_size_inches(*(figure.get_size_inches() * factor))
    for artist in figure.findobj():
        for name in SIZES:
            _change(artist, name, lambda value, name=name: value * (factor**2 if name == "sizes" else factor))
        if (
            isinstance(artist, Text)
            and hasattr(artist, "xyann")
            and getattr(artist, "anncoords", "") == "offset points"
        ):
            artist.xyann = tuple(value * factor for value in artist.xyann)
    for axes in figure.axes:
        for which in ("x", "y", "z"):
            if (axis := getattr(axes, f"{which}axis", None)) is not None and (ticks := axis.get_major_ticks()):
                axis.labelpad *= factor
                axis.set_tick_params(pad=ticks[0].get_pad() * factor, length=ticks[0].tick1line.get_markersize())


def darken(figure: Figure) -> None:
    """Turn black on white into white on black; what has a colour keeps it."""
    for artist in set(figure.findobj()):
        if not isinstance(artist, Axes | FigureBase):  # their patches are artists too
            found = {name: getattr(artist, f"get_{name}")() for name in COLOURS if hasattr(artist, f"set_{name}")
                     and hasattr(artist, f"get_{name}")}  # fmt: skip
            for name, value in found.items():  # read first: one may follow another
                getattr(artist, f"set_{name}")(_turned(value))


def _turned(colour: Any) -> Any:
    """A grey of the opposite lightness, above the ground; a colour as it is, if pale or dark in its opposite tone."""
    several = getattr(colour, "ndim", 1) == 2
    rows, turned = [to_rgba(one) for one in (colour if several else [colour])], []
    if not any(alpha for *_, alpha in rows):
        return "none"
    for red, green, blue, alpha in rows:
        hue, light, saturation = colorsys.rgb_to_hls(red, green, blue)
        if max(red, green, blue) - min(red, green, blue) < 0.12:
            light = 1 - (1 - GROUND) * light
        turned.append((*colorsys.hls_to_rgb(hue, light, saturation), alpha))
    return turned if several else turned[0]


def _change(artist: Any, name: str, change: Any) -> None:
    """Set a property to what becomes of its present value, where the artist has it."""
    get, put = getattr(artist, f"get_{name}", None), getattr(artist, f"set_{name}", None)
    if get and put:
        value = get()
        put([change(one) for one in value] if isinstance(value, list) else change(value))
