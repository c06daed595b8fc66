"""What ``obstacle_tracking`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter5 import crossing, pen
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recordings
from dexrepro.physics.rendering import Camera
from dexrepro.report import style

from .experiment import crossings

FIGURES = {
    "5.7": Figure(
        "The simulated scene: cubes of 2 cm with a lip on top, start (green), nine goals (orange) and the arm at its "
        "start (rendered; the book shows a photograph).",
        "An arm in front of a stack of cubes with nine goals behind it.",
    ),
    "5.9": Figure(
        "The arm crosses two blocks (above) and three (below) to the central goal, four instants each (rendered from "
        "the simulated run; the book shows photographs).",
        "The arm lifts its pen over the stack and reaches the goal behind it.",
    ),
    "5.F": Figure(
        "Share of the bound that the joint errors use (all 18 runs) and smallest distance of the tracked tip from the "
        "obstacle for every goal. Ours.",
        "Share of the bound used over time, and clearance of the tip for every goal.",
    ),
}
UNITS = {"velocity_error": "rad/s", "desired": "rad", "error": "rad"}
TABLES = {"T5.J": "Tracked crossings: clearance [cm], bound used, tip error [mm], distance from the goal [mm]"}
FILM = Film(
    "film3", "The arm lifts the pen over three cubes and puts it down at the central goal.",
    Camera(target=(0.12, -0.01, -0.035), distance=0.46, yaw=68.0, pitch=-22.0, field_of_view=40.0), "clearance",
    "Pen to obstacle [mm]", scale=10.0,
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    if {"film2", "film3"} <= set(recordings):
        start = recordings["film3"].images["at0"]
        figures["5.7"] = style.picture(start, "The arm, three cubes with their lip, and nine goals")
        figures["5.9"] = _filmstrip(recordings, config)
    if set(crossings(config).values()) <= set(recordings):
        figures["5.F"] = _draw_runs(recordings, metrics, config)
    return figures


def _filmstrip(recordings: Recordings, config: Config) -> Drawing:
    figure, grid = style.subplots(2, len(config.film), height=3.2)
    film = [(case, k) for case in ("film2", "film3") for k in range(len(config.film))]
    pictures = style.trimmed({(case, k): recordings[case].images[f"at{k}"] for case, k in film})
    for row, case in zip(grid, dict.fromkeys(case for case, _ in film)):
        for k, (axes, time) in enumerate(zip(row, config.film)):
            style.photo(axes, pictures[case, k], f"{config.cases[case].blocks} blocks, {time:g} s")
    return style.title(figure, "The arm carries its pen over two and three blocks")


def _draw_runs(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, (left, right) = style.subplots(1, 2, height=2.3, width=style.TWO_COLUMNS)
    places = crossing.goals(config)
    cases = crossings(config)
    lines = ((2, "two", style.EXTRA[0], "o", -0.15), (3, "three", style.BOOK, "s", 0.15))
    for blocks, word, colour, marker, shift in lines:
        stack = [cases[blocks, goal] for goal in range(len(places))]
        for case in stack:
            usage = pen.bound_use(recordings[case], config)
            left.plot(recordings[case].time, usage, color=colour, linewidth=0.5)
        values = [metrics[case]["clearance"] for case in stack]
        right.plot(np.arange(9) + shift, values, marker, ms=4, color=colour, label=f"{word} blocks")
    left.axhline(1, **style.LINES["reference"])
    left.set(yscale="log", ylim=(1e-4, 2), xlabel="Time [s]", ylabel="Largest share\nof the bound [-]")
    right.axhline(0, **style.LINES["reference"])
    right.set_xticks(range(9), [f"{x:g}\n{y:g}" for x, y, _ in places])
    right.set(xlabel="Goal x, y [cm]", ylabel="Clearance of the tip [cm]", ylim=(-0.1, 1.6))
    right.legend()
    runs = [metrics[case] for case in cases.values()]
    good = sum((values["bound_use"] or 2.0) < 1 and (values["clearance"] or -1.0) > 0 for values in runs)
    return style.title(figure, f"{good} of {len(runs)} crossings stay inside the bound and clear of the obstacle")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    names = {"clearance": "clearance [cm]", "bound_use": "largest share of the bound", "tip_rms": "tip error RMS [mm]",
             "end_error": "distance from the goal [mm]"}  # fmt: skip
    rows = [
        {"blocks": blocks, "goal": goal, **{text: metrics[case][name] for name, text in names.items()}}
        for (blocks, goal), case in crossings(config).items()
        if case in metrics
    ]
    return {"T5.J": pd.DataFrame(rows)}
