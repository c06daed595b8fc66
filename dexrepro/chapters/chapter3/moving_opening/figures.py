"""What ``moving_opening`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.chapters.chapter3 import drawings
from dexrepro.chapters.chapter3.scene import FILMED
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Metrics, Recording, Recordings
from dexrepro.report import style

_SHOWN = "The simulated arm and the moving lid {} after its movement began. The book shows photographs."
FIGURES = {
    "3.13": Figure(_SHOWN.format("0 s"), "The arm stands in the hole of the lid before it moves."),
    "3.14": Figure(
        _SHOWN.format("1.25 s and 10 s") + " The path is closed, so that at 10 s the opening is back.",
        "The arm stands in the hole of the lid while it is aside and after it has come back.",
    ),
    "3.15": Figure(
        "Path of the moving remote centre, ours: the book draws its path without numbers. Seen from above and "
        "over time.",
        "The centre of the opening runs through a figure of eight.",
    ),
    "3.16": Figure(
        "Distance to the target and Dis_R while the opening moves (simulated; lid and box are collision bodies for the "
        "whole method). The law knows, without noise or delay, where the opening is, and not how fast it moves.",
        "Distance to the target and to the opening's centre over time while the opening moves.",
    ),
}
UNITS = {
    "lid": "m", "centre": "m", "tracking": "m", "observed": "N m", "nodes": "1", "contact": "1, N, m", "error": "m",
    "rcm_distance": "m",
}  # fmt: skip
TABLES = {"T3.D": "Moving opening: laws and models"}
FILM = Film(
    "track", "The lid moves along a figure of eight while the arm stands in its opening and holds the target.", FILMED,
    "rcm_distance", "Dis_R [mm]", scale=1e3, span=(4.0, 15.5),
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures: dict[str, Any] = {}
    run = recordings.get("track")
    if run is None:
        return figures
    if run.images:
        figures["3.13"] = style.picture(run.images["begin"], "0 s: the arm stands in the opening", 2.7)
        pair = {"1.25 s: the opening is aside": run.images["quarter"], "10 s: it has come back": run.images["end"]}
        figures["3.14"] = drawings.pictures(pair, "The arm has followed the opening")
    figures["3.15"] = _draw_path(run, metrics["track"], config.cases["track"])
    figures["3.16"] = _draw_tracking(recordings, metrics, config)
    return figures


def _draw_path(run: Recording, found: Metrics, config: Config) -> Drawing:
    figure, (left, right) = style.subplots(1, 2, height=2.4)
    x, y, z = run["centre"].T
    left.plot(x, y, **style.LINES["reference"])
    left.plot(x[0], y[0], marker="*", color=style.REFERENCE, markersize=9, linestyle="none", label="start and end")
    left.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    left.legend(loc="upper center", bbox_to_anchor=(0.5, 1.0))
    for values, name, line in ((x, "x", "book"), (y, "y", "rival"), (z, "z", "extra1")):
        (curve,) = right.plot(run.time, 1e3 * (values - values[0]), **style.LINES[line])
        style.label_end(right, curve, name, {"x": 8, "z": -8}.get(name, 0))
    style.phase(right, config.motion.start, config.motion.start + config.motion.period, "moving")
    right.set(xlabel="Time [s]", ylabel="Shift of $P_R$ [mm]", ylim=(-60, 75))
    speed = 1e3 * found["centre_speed_max"]  # type: ignore[operator]
    return style.title(figure, f"The opening moves at up to {speed:.0f} mm/s")


CURVES = {
    "track": ("whole method", "book"),
    "free": ("without null-space torque", "extra2"),
    "pos": ("position-only task", "rival"),
    "posfree": ("position-only, without torque", "plain"),
}


def _draw_tracking(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, (left, right) = style.subplots(1, 2, height=2.7)
    style.curves(left, recordings, CURVES, "error", 1e3)
    style.curves(right, recordings, CURVES, "rcm_distance", 1e3)
    motion = config.cases["track"].motion
    for axes in (left, right):
        style.phase(axes, motion.start, motion.start + motion.period, "opening moves")
        axes.set_xlabel("Time [s]")
    left.set(ylabel=r"$\|\tilde X\|$ [mm]", yscale="log", ylim=(1e-3, 2e3))
    right.set(ylabel="$Dis_R$ [mm]", yscale="log", ylim=(1e-3, 2e3))
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncol=4)
    found = metrics["track"]
    far, tip = (style.at_most(1e3 * found[f"moving_{key}_max"], 1) for key in ("distance", "error"))
    finding = f"The arm follows the opening within {far} mm while its end point errs by at most {tip} mm"
    return style.title(figure, finding)


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    return {"T3.D": drawings.by_reading(metrics, config)}
