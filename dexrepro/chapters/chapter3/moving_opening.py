"""The opening moves while the arm holds the target inside the box (Sect. 3.5.4)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from dexrepro.chapters.chapter3 import drawings, reach
from dexrepro.chapters.chapter3.measures import add_distances, headed, reach_metrics
from dexrepro.chapters.chapter3.scene import ARM, FILMED, Touching, build, cutaway
from dexrepro.experiment import Config, Figure, Film, Metrics, Recording
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World

Array = NDArray[np.float64]
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
        "The centre of the opening runs through a figure of eight of 10 cm by 6 cm in 10 s.",
    ),
    "3.16": Figure(
        "Distance to the target and Dis_R while the opening moves (simulated; lid and box are collision bodies for the "
        "whole method). The law knows, without noise or delay, where the opening is, and not how fast it moves.",
        "The arm follows the moving opening within a few millimetres.",
    ),
}
TABLES = {"T3.D": "Moving opening: laws and models"}
RATE = 50.0
VIEW = Camera(target=(0.45, -0.15, 0.2), distance=1.6, yaw=30.0, pitch=-40.0)
FILM = Film(
    "track", "The lid moves along a figure of eight while the arm stands in its opening and holds the target.", FILMED,
    "rcm_distance", "Dis_R [mm]", scale=1e3, span=(4.0, 15.5),
)  # fmt: skip


def path(config: Config) -> Callable[[float], Array]:
    """P_R(t) (3,) [m]: a figure of eight for one period from ``motion.start`` [s], still before and after."""
    home, motion = np.array(config.centre, dtype=float), config.motion
    (a, b), rate = motion.amplitude, 2 * math.pi / motion.period

    def centre(time: float) -> Array:
        u = min(max(time - motion.start, 0.0), motion.period)
        return home + np.array((a * math.sin(rate * u), b * math.sin(2 * rate * u), 0.0))

    return centre


def scene(config: Config) -> World:
    return build(config, path(config))


def stage(world: World, recording: Recording, config: Config) -> Recording:
    shown = cutaway(world, recording, config)
    shown.series["lid.pose"] = recording["centre"]
    return shown


def simulate(config: Config, rng: Any) -> Recording:
    centre = path(config)
    with scene(config) as world:
        recording = reach.run(world, config, centre, Touching(world))
        if config.pictures:
            for name, time in (("begin", 0.0), ("quarter", 1.25), ("end", config.motion.period)):
                now = config.motion.start + time
                index = min(round(now / config.step), len(recording.time) - 1)
                pose = {"lid": [*centre(now), 0.0, 0.0, 0.0, 1.0]}
                positions = {ARM: recording[f"{ARM}.position"][index]}
                recording.images[name] = world.render(positions, pose, VIEW, (1000, 750))
    recording.series["centre"] = np.array([centre(time) for time in recording.time])
    add_distances(recording, config, recording["centre"])
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    metrics = reach_metrics(recording, config)
    start, period = config.motion.start, config.motion.period
    moving = recording.between(start, start + period)
    speed = np.linalg.norm(np.gradient(recording["centre"], config.step, axis=0), axis=1)
    if metrics["finished"]:
        metrics["moving_distance_max"] = float(recording["rcm_distance"][moving].max())
        metrics["moving_distance_mean"] = float(recording["rcm_distance"][moving].mean())
        metrics["moving_error_max"] = float(recording["error"][moving].max())
    metrics["centre_speed_max"] = float(speed[moving].max())
    excursion = np.linalg.norm(recording["centre"] - np.array(config.centre), axis=1)
    metrics["excursion"] = float(excursion.max())
    return metrics


def summarise(metrics: Mapping[str, Metrics], config: Config) -> Metrics:
    """How much larger the mean Dis_R is without the null-space torque."""
    result: Metrics = {}
    for name, (without, whole) in {"default": ("free", "track"), "position": ("posfree", "pos")}.items():
        values = [metrics.get(case, {}).get("moving_distance_mean") for case in (without, whole)]
        result[f"{name}_ratio"] = values[0] / values[1] if None not in values else None  # type: ignore[operator]
    return result


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    figures: dict[str, Any] = {}
    run = recordings.get("track")
    if run is None:
        return figures
    if run.images:
        figures["3.13"] = drawings.picture(run.images["begin"], "0 s: the arm stands in the opening")
        pair = {"1.25 s: the opening is aside": run.images["quarter"], "10 s: it has come back": run.images["end"]}
        figures["3.14"] = drawings.pictures(pair, "The arm has followed the opening")
    figures["3.15"] = _draw_path(run, metrics["track"], config.cases["track"])
    figures["3.16"] = _draw_tracking(recordings, metrics, config)
    return figures


def _draw_path(run: Recording, found: Metrics, config: Config) -> Any:
    from dexrepro.report import style

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
    style.title(figure, f"The opening moves at up to {speed:.0f} mm/s")
    return figure


CURVES = {
    "track": ("whole method", "book"),
    "free": ("without null-space torque", "extra2"),
    "pos": ("position-only task", "rival"),
    "posfree": ("position-only, without torque", "plain"),
}


def _draw_tracking(recordings: Any, metrics: Any, config: Config) -> Any:
    from dexrepro.report import style

    figure, (left, right) = style.subplots(1, 2, height=2.7)
    for case, (label, line) in CURVES.items():
        if case in recordings:
            run = recordings[case]
            left.plot(run.time, 1e3 * run["error"], label=label, **style.LINES[line])
            right.plot(run.time, 1e3 * run["rcm_distance"], label=label, **style.LINES[line])
    motion = config.cases["track"].motion
    for axes in (left, right):
        style.phase(axes, motion.start, motion.start + motion.period, "opening moves")
        axes.set_xlabel("Time [s]")
    left.set(ylabel=r"$\|\tilde X\|$ [mm]", yscale="log", ylim=(1e-3, 2e3))
    right.set(ylabel="$Dis_R$ [mm]", yscale="log", ylim=(1e-3, 2e3))
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncol=4)
    found = metrics["track"]
    far, tip = 1e3 * found["moving_distance_max"], 1e3 * found["moving_error_max"]
    style.title(figure, f"The arm follows the opening within {far:.1f} mm while its end point errs by {tip:.1f} mm")
    return figure


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config
) -> dict[str, pd.DataFrame]:
    rows = [
        {"case": case, "reading": drawings.describe(config.cases[case]), **values}
        for case, values in metrics.items()
        if case in config.cases
    ]
    return {"T3.D": headed(rows)}
