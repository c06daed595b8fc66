"""What ``rigid_boxes`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recordings
from dexrepro.physics.rendering import Camera
from dexrepro.report import style
from dexrepro.report.tables import by_case

from .experiment import RELEASED, SIZES

FIGURES = {
    "1.17": Figure(
        "Rigid boxes held by sides of {.cases.small.width:g}, {.cases.medium.width:g} and {.cases.large.width:g} m, "
        "simulated Baxter arms, friction contact: pictures at holding, carrying and after the drop; contact force on "
        "AFR; height of the box. Lines: the start poses. The book shows photographs.",
        "Pictures of boxes of three sizes at three instants, and contact force and height over time.",
    ),
    "1.B": Figure(
        "Contact force on AFR with a rigid box while it is gripped and lifted, for five gains of the force law; the "
        "gain printed for the soft object (0.25) is the last. The force then alternates with every control sample.",
        "Contact force over time for five gains of the force law.",
    ),
}
UNITS = {"force": "N", "height": "m", "phase": "1"}
TABLES = {"T1.F": "Boxes carried into the bin"}
FILM = Film(
    "medium", "Two arms grip a rigid box by friction, carry it and drop it into the bin.",
    Camera(target=(0.5, -0.09, 0.22), distance=1.4, yaw=75.0, pitch=-22.0), "force_0", "Contact force [N]",
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    if all(size in recordings and recordings[size].images for size in SIZES):
        figures["1.17"] = _draw_boxes(recordings, metrics, config)
    gains = [case for case in ("medium", "gain2", "gain3", "gain10", "gain25") if case in recordings]
    if len(gains) == 5:
        figures["1.B"] = _draw_gains(gains, recordings, metrics, config)
    return figures


def _draw_boxes(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 5.6))
    grid = figure.add_gridspec(5, 3, height_ratios=(0.75, 0.75, 0.75, 1, 0.8))
    pictures = style.trimmed(
        {(size, name): picture for size in SIZES for name, picture in recordings[size].images.items()}
    )
    for column, size in enumerate(SIZES):
        recording = recordings[size]
        for row, name in enumerate(("held", "carried", "dropped")):
            axis = figure.add_subplot(grid[row, column])
            style.photo(axis, pictures[size, name])
            if row == 0:
                numbers = metrics[size]
                axis.set_title(f"{size}: {numbers['successes']} of {numbers['runs']}")
        force, height = figure.add_subplot(grid[3, column]), figure.add_subplot(grid[4, column])
        part = recording.time < RELEASED + 0.8
        for k in range(int(metrics[size]["runs"] or 0)):
            if f"force_{k}" in recording:
                force.plot(recording.time[part], recording[f"force_{k}"][part], color=style.BOOK, linewidth=0.5)
                height.plot(recording.time[part], recording[f"height_{k}"][part], color=style.RIVAL, linewidth=0.7)
        force.axhline(15.0, **style.LINES["reference"])
        force.set_ylim(0, 30)
        height.set(xlabel="Time [s]", ylim=(0, 0.45))
        if column == 0:
            force.set_ylabel("Force [N]")
            height.set_ylabel("Height [m]")
    wins = sum(metrics[size]["successes"] or 0 for size in SIZES)
    runs = sum(metrics[size]["runs"] or 0 for size in SIZES)
    return style.title(figure, f"Rigid boxes of three sizes: {wins} of {runs} are carried into the bin")


def _draw_gains(gains: Any, recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, axes = style.subplots(1, 5, height=2.0, sharey=True)
    for axis, case in zip(axes, gains):
        recording = recordings[case]
        part = (recording.time > 2.0) & (recording.time < 6.4)
        axis.plot(recording.time[part], recording["force_0"][part], color=style.BOOK, linewidth=0.6)
        axis.axhline(15.0, **style.LINES["reference"])
        axis.set(xlabel="Time [s]", title=f"{config.cases[case].law['gain']:g} m/(s N)", ylim=(0, 40))
    axes[0].set_ylabel("Contact force [N]")
    loud = [config.cases[case].law["gain"] for case in gains if (metrics[case]["rmse"] or 0.0) > 1.0]
    found = f": from {min(loud):g} on the contact force jumps between samples" if loud else ""
    return style.title(figure, f"A rigid box wants a small gain{found}")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    columns = {"runs": "runs", "successes": "successes", "slip": "largest slip [m]", "rmse": "RMS force error [N]",
               "bounces": "bounces", "switches": "switches", "least_moved": "least way [m]"}  # fmt: skip
    return {"T1.F": by_case(metrics, columns, recordings)}
