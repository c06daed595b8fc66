"""What ``hold_and_move`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recording, Recordings
from dexrepro.report import style

from .claims import PRINTED
from .experiment import VIEW

EARLY = 1.5  # s, shown below
FIGURES = {
    "1.1": Figure(
        "Simulated Baxter: the right arm (DFR) is teleoperated, the left arm (AFR) assists; the object is soft. The "
        "book shows a photograph of a system of three robots.",
        "Two arms of a Baxter robot hold a ball above a table.",
    ),
    "1.18": Figure(
        "Contact force on AFR along three synthetic trajectories, simulated Baxter arms under torque; the book shows "
        "measurements. Errors after the 8th second (right of the line) are in T1.B. Bottom: the start.",
        "Contact forces of three laws over time on three trajectories, with the start enlarged.",
    ),
    "1.19": Figure(
        "Simulated Baxter. Instants of the task in the first trajectory, proposed law: start, object on the left, "
        "tilted by pi/4, swinging along the holding line, level over the right target, pressed on it. Below: DFR's "
        "motion and tilt. The book shows photographs.",
        "Six instants of two arms that lift, tilt, swing and put down a ball.",
    ),
    "1.A": Figure(
        "Our own tests of Fig. 1.18, first trajectory: force samples that are late by one control period, an object "
        "twice as stiff, and gains that fit (T1.B). Bars: RMS force error after the 8th second.",
        "Force errors of three laws in four settings: as printed, one late sample, a stiff object, tuned gains.",
    ),
}
UNITS = {
    "force": "N", "measured": "N", "reference": "m", "distance": "m", "partner": "m", "tilt": "rad", "lag": "m",
    "twist": "rad", "turned": "rad", "pointing": "rad", "slip": "m", "object": "m, m, m, 1, 1, 1, 1", "joints": "rad",
}  # fmt: skip
TABLES = {"T1.B": "Force error after the 8th second along three trajectories, beside the book's nine numbers"}
FILM = Film(
    "t1_proposed",
    "Two arms lift the ball, tilt and swing it and put it down while the force stays at {.desired_force:g} N.", VIEW,
    "force", "Contact force [N]", reference="desired_force",
)  # fmt: skip
LAWS = {"proposed": "book", "passive": "rival", "fixed": "plain"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    if all(f"{trial}_{law}" in recordings for trial in PRINTED for law in LAWS):
        figures["1.18"] = _draw_forces(recordings, metrics, config)
    shown = recordings.get("t1_proposed")
    if shown and shown.images:
        figures["1.1"] = _draw_scene(shown)
        figures["1.19"] = _draw_task(shown)
    if {"t1_proposed_late", "t1_passive_late"} <= set(metrics):
        figures["1.A"] = _draw_limits(metrics)
    return figures


def _draw_forces(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, axes = style.subplots(2, 3, height=3.8, sharey="row")
    for column, trial in enumerate(PRINTED):
        for law, role in reversed(LAWS.items()):
            recording = recordings[f"{trial}_{law}"]
            axes[0, column].plot(recording.time, recording["force"], label=law, **style.LINES[role])
            early = recording.time <= EARLY
            axes[1, column].plot(recording.time[early], recording["force"][early], **style.LINES[role])
        numbers = [metrics[f"{trial}_{law}"]["rmse"] for law in LAWS]
        axes[0, column].set_title("RMSE " + " / ".join(f"{value:.2f}" for value in numbers) + " N")
        for axis in axes[:, column]:
            axis.axhline(config.desired_force, **style.LINES["reference"])
            axis.set_ylim(0, 30)
        style.event(axes[0, column], config.settled, f"{config.settled:g} s")

    style.edges(axes, "Time [s]", ("Contact force [N]", f"First {EARLY:g} s [N]"))
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    best = all(
        metrics[f"{t}_proposed"]["rmse"] < min(metrics[f"{t}_{law}"]["rmse"] for law in ("passive", "fixed"))
        for t in PRINTED
    )
    where = "all three trajectories" if best else "some of the trajectories only"
    return style.title(figure, f"The proposed law holds the force best on {where} (proposed / passive / fixed)")


def _draw_scene(recording: Recording) -> Drawing:
    figure, axis = style.subplots(width=style.ONE_COLUMN, height=2.4)
    _show(axis, style.trimmed(recording.images)["b"])
    return style.title(figure, "Two simulated Baxter arms hold a soft object")


def _show(axis: Any, picture: Any) -> None:
    """A picture from before the robot, whose right arm is at the left."""
    style.photo(axis, picture)
    for place, arm in ((0.15, "DFR"), (0.85, "AFR")):
        axis.text(place, 0.0, arm, transform=axis.transAxes, ha="center", va="top", fontsize=7)


def _draw_task(recording: Recording) -> Drawing:
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 6.0))
    grid = figure.add_gridspec(4, 3, height_ratios=(1.4, 1.4, 0.8, 0.6))
    pictures = style.trimmed(recording.images)
    words = ("start", "on the left", "tilted", "swinging", "over the right", "pressed")
    for k, (name, word) in enumerate(zip("abcdef", words)):
        axis = figure.add_subplot(grid[k // 3, k % 3])
        _show(axis, pictures[name])
        style.panel(axis, name, word)
    path, tilt = figure.add_subplot(grid[2, :]), figure.add_subplot(grid[3, :])
    for k, (label, role) in enumerate((("x", "plain"), ("y", "book"), ("z", "rival"))):
        path.plot(recording.time, recording["partner"][:, k], label=label, **style.LINES[role])
    path.set_ylabel("DFR [m]")
    path.legend(ncols=3, loc="lower left")
    tilt.plot(recording.time, np.rad2deg(recording["tilt"]), **style.LINES["book"])
    tilt.set(xlabel="Time [s]", ylabel="Tilt [deg]")
    return style.title(figure, "One arm is led, the other keeps holding: left, tilt, swing, right, press")


def _draw_limits(metrics: Any) -> Drawing:
    groups = {"as\nprinted": "", "one sample\nlate": "_late", "twice\nas stiff": "_stiff", "own\ngain": "_tuned"}
    figure, axis = style.subplots(width=style.ONE_COLUMN, height=2.4)
    for k, (law, role) in enumerate(LAWS.items()):
        values = [metrics.get(f"t1_{law}{ending}", {}).get("rmse") for ending in groups.values()]
        places = [(i + 0.27 * (k - 1), value) for i, value in enumerate(values) if value is not None]
        bars = axis.bar(*zip(*places), width=0.25, color=style.LINES[role]["color"], label=law)
        axis.bar_label(bars, fmt="%.2f", fontsize=6.5)
    axis.set_xticks(range(len(groups)), groups)
    axis.set_yscale("log")
    axis.set_ylabel("RMS force error [N]")
    axis.legend(ncols=3, loc="upper left", fontsize=6.5, handlelength=1.0, columnspacing=0.8)
    axis.set_ylim(0.1, 10)
    worse = metrics["t1_proposed_late"]["rmse"] > metrics["t1_passive_late"]["rmse"]
    return style.title(figure, "One late sample " + ("undoes" if worse else "does not undo") + " the advantage")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    book = {f"{trial}_{law}": value for trial, values in PRINTED.items() for law, value in zip(LAWS, values)}
    rows = [
        {"case": case.replace("_", " "), "RMSE [N]": values.get("rmse"), "book [N]": book.get(case),
         "as measured [N]": values.get("rmse_measured"), "rise [s]": values.get("rise"),
         "overshoot [-]": values.get("overshoot"), "settling [s]": values.get("settling"),
         "twist [deg]": values.get("twist"), "object held": bool(values.get("finished"))}
        for case, values in metrics.items()
        if case in config.cases
    ]  # fmt: skip
    return {"T1.B": pd.DataFrame(rows)}
