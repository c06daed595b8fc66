"""What ``ready_to_hold`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recording, Recordings
from dexrepro.physics.rendering import Camera
from dexrepro.report import style
from dexrepro.report.tables import by_case

from .experiment import APPROACH, HOLD, INSTANTS, PITCHED, SHAKEN

FIGURES = {
    "1.7": Figure(
        "Potential (lines) and force (arrows) in the plane of the holding line for DFR far from, near to and at the "
        "object (circle), with the three points of Eq. (1.19). The book shows a sketch.",
        "Potential as lines and force as arrows in a plane, for three places of DFR.",
    ),
    "1.12": Figure(
        "Simulated. The camera's object: four edge points, their noisy average at {.camera.rate:g} Hz, "
        "off-centre, over two seconds.",
        "Points of the measured position about the true centre of an object.",
    ),
    "1.16": Figure(
        "Simulated Baxter. Top: pictures at the book's instants. Then: AFR, DFR and object along the holding line, "
        "across it and up; clearance of AFR's end point from the object, which feels no contact here, so that it ends "
        "inside; weights; angles between the tools' axes and between "
        "AFR's axis and the direction to DFR. The book shows photographs.",
        "Pictures of the task, and positions of both arms and the angle between them over time.",
    ),
}
UNITS = {
    "follower": "m", "leader": "m", "object": "m", "seen": "m", "weights": "1", "ready": "m", "facing": "rad",
    "pointing": "rad", "joints": "rad",
}  # fmt: skip
TABLES = {"T1.E": "Potential field: adjustable weights and ablations"}
FILM = Film(
    "adjustable", "The left arm follows the ball that a person moves, and comes to it when the right arm does; contact "
    "is not simulated.", Camera(target=(0.5, -0.08, 0.27), distance=1.4, yaw=75.0, pitch=-18.0),
    "clearance", "Distance to the ball [mm]", scale=1e3,
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "adjustable" not in recordings:
        return {}
    recording = recordings["adjustable"]
    return {
        "1.7": _draw_field(recording.frames["field"], config),
        "1.12": _draw_camera(recording, config),
        "1.16": _draw_task(recording, config, float(metrics["adjustable"]["pointing"] or 0.0)),
    }


def _draw_field(field: pd.DataFrame, config: Config) -> Drawing:
    figure, axes = style.subplots(1, 3, height=2.25, sharey=True)
    for axis, word, (_, part) in zip(axes, ("far", "near", "touching"), field.groupby("distance", sort=False)):
        y, z = np.unique(part["y"]), np.unique(part["z"])
        grid = {key: part[key].to_numpy().reshape(len(z), len(y)) for key in ("potential", "fy", "fz")}
        axis.contour(
            y, z, np.sqrt(grid["potential"]), levels=np.linspace(0.02, 0.5, 13), colors=style.PLAIN, linewidths=0.5
        )
        step, size = (slice(None, None, 6), slice(None, None, 6)), np.hypot(grid["fy"], grid["fz"]) + 1e-9
        show = np.minimum(size, 0.3) / size
        axis.quiver(y[step[1]], z[step[0]], (show * grid["fy"])[step], (show * grid["fz"])[step], color=style.BOOK,
                    scale=4, width=0.005)  # fmt: skip
        axis.add_patch(style.plt.Circle((0, 0), config.radius, color=style.RIVAL, alpha=0.35, linewidth=0))
        for k in (1, 2, 3):
            place = part[f"p{k}y"].iloc[0], part[f"p{k}z"].iloc[0]
            axis.plot(*place, "k.", markersize=4)
            below = k == 3
            axis.annotate(f"$P_{k}$", place, xytext=(0, -3 if below else 3), textcoords="offset points", fontsize=8,
                          ha="center", va="top" if below else "bottom")  # fmt: skip
        axis.set_aspect("equal")
        axis.set(xlabel="Along the holding line [m]", title=f"DFR {word}, {1e3 * part['distance'].iloc[0]:.0f} mm away",
                 xlim=(-0.2, 0.6))  # fmt: skip
    axes[0].set_ylabel("Across [m]")
    return style.title(figure, "The closer DFR comes, the more the field draws AFR into the object")


def _draw_camera(recording: Recording, config: Config) -> Drawing:
    figure, axis = style.subplots(width=style.ONE_COLUMN, height=2.9)
    still = recording.between(SHAKEN, SHAKEN + 2.0)
    centre, seen = recording["object"][still], 1e3 * (recording["seen"] - recording["object"])[still]
    angles = np.linspace(0, 2 * np.pi, 200)
    axis.plot(1e3 * config.radius * np.cos(angles), 1e3 * config.radius * np.sin(angles), color=style.PLAIN)
    for angle in (0, 0.5 * np.pi, np.pi, 1.5 * np.pi):
        axis.plot(1e3 * config.radius * np.cos(angle), 1e3 * config.radius * np.sin(angle), "s", color=style.RIVAL,
                  markersize=4, label="edge point" if angle == 0 else None)  # fmt: skip
    axis.plot(0, 0, "+", color="black", label="true centre")
    axis.plot(seen[:, 0], seen[:, 2], "o", markersize=2, color=style.BOOK, alpha=0.6, label="measured")
    axis.set_aspect("equal")
    axis.set(xlabel="x [mm]", ylabel="z [mm]", xlim=(-170, 170), ylim=(-170, 170))
    figure.legend(loc="outside lower center", ncols=3, handletextpad=0.3, columnspacing=0.8)
    offset = np.linalg.norm(seen.mean(axis=0)) if len(centre) else 0.0
    return style.title(figure, f"The camera sees the object {offset:.0f} mm off centre")


def _draw_task(recording: Recording, config: Config, off: float) -> Drawing:
    """off: largest angle between AFR's axis and the direction to DFR [deg]."""
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 8.6))
    grid = figure.add_gridspec(7, 7, height_ratios=(0.7, 1, 1, 1, 0.8, 0.6, 0.8))
    pictures = style.trimmed(recording.images)
    for k, (name, at) in enumerate(INSTANTS.items()):
        axis = figure.add_subplot(grid[0, k])
        style.photo(axis, pictures[name], f"({name}) {at:g} s", fontsize=7)
    axes = [figure.add_subplot(grid[row, :]) for row in range(1, 7)]
    time = recording.time
    for k, axis, label in zip((1, 0, 2), axes, ("Along [m]", "Across [m]", "Up [m]")):
        for name, role in (("follower", "book"), ("leader", "extra1"), ("object", "reference")):
            axis.plot(time, recording[name][:, k], label={"follower": "AFR", "leader": "DFR"}.get(name, name),
                      **style.LINES[role])  # fmt: skip
        axis.set_ylabel(label)
    axes[0].legend(ncols=3, loc="lower right")
    clearance = np.linalg.norm(recording["follower"] - recording["object"], axis=1) - config.radius
    axes[3].axhline(0, color="black", linewidth=0.4)
    axes[3].plot(time, 1e3 * clearance, **style.LINES["book"])
    axes[3].set_ylabel("Clearance [mm]")
    for k, role in ((0, "plain"), (2, "book")):
        axes[4].plot(time, recording["weights"][:, k], label=f"$w_{k + 1}$", **style.LINES[role])
    axes[4].set_ylabel("Weight [-]")
    axes[4].legend(loc="center right")
    for name, role in (("facing", "book"), ("pointing", "rival")):
        axes[5].plot(time, np.rad2deg(recording[name]), label=name, **style.LINES[role])
    axes[5].set(xlabel="Time [s]", ylabel="Angle [deg]")
    axes[5].legend(ncols=2, loc="upper right")
    words = ("left, right", "back, forth", "up, down", "DFR comes", "held", "yaw", "yaw and pitch")
    edges = (0.0, 6.0, 12.0, SHAKEN, APPROACH, HOLD, PITCHED, time[-1])
    for axis in axes[:-1]:
        axis.set_xticklabels([])
    for axis in axes:
        axis.set_xlim(0, time[-1])
        for k in range(7):
            if k % 2 == 0:
                style.phase(axis, edges[k], edges[k + 1])
    for k, word in enumerate(words):
        axes[0].annotate(word, (0.5 * (edges[k] + edges[k + 1]), 1.0), xycoords=("data", "axes fraction"),
                         fontsize=6.5, ha="center", va="bottom", color="#555555")  # fmt: skip
    finding = f"AFR keeps its distance, comes when DFR comes and points to it within {style.at_most(off, 1)} deg"
    return style.title(figure, finding)


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    columns = {"lag_rms": "lag RMS [m]", "lag_most": "largest lag [m]", "clearance": "least clearance [m]",
               "own_contact": "AFR touches [s]", "partner_contact": "DFR touches [s]", "facing": "facing [deg]",
               "pointing": "pointing [deg]"}  # fmt: skip
    return {"T1.E": by_case(metrics, columns, recordings).replace("_", " ", regex=True)}
