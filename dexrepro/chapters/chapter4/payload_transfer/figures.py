"""What ``payload_transfer`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recording, Recordings
from dexrepro.physics.rendering import Camera
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "4.11": Figure(
        "The simulated right arm with its hanging 1.5 kg payload in the three phases: near B, near E and on the way "
        "from A to D; orange: points A, B, C, green: D, E, F. The book shows photographs of the same phases.",
        "Three pictures of a red seven-joint arm carrying a small sphere past coloured points.",
    ),
    "4.12": Figure(
        "Tracking error of the nine trajectories of phase III: the broad network with what it learned in phases I and "
        "II against the fixed network of 16384 nodes with the width of least error, likewise trained, and the bound; "
        "below, the error of each trajectory for all methods, an integrator (one constant node) among them. Simulated "
        "Baxter arm with gravity compensation for the bare arm. The book shows the error of both methods.",
        "Error over time of two networks within the bound, and bars of the error of each trajectory for all methods.",
    ),
}
UNITS = {
    "error": "m", "tip": "m", "reference": "m", "position": "rad", "torque": "N m", "usage": "1", "share": "1",
    "nodes": "1", "activation": "1", "feature_energy": "1", "phase": "1",
}  # fmt: skip
TABLES = {"T4.C": "Nine trajectories with a hanging payload: errors, bound and nodes by method"}
FILM = Film(
    "reuse", "With what it learned the arm carries the loose payload from A to D, E and F (drawn hanging straight).",
    Camera(target=(0.42, -0.45, 0.08), distance=1.25, yaw=-60.0, pitch=-20.0), "error", "Tracking error [mm]",
    scale=1e3, span=(24.0, 39.0),
)  # fmt: skip


BARS = {
    "none": ("no network", "plain"),
    "zero": ("broad, untrained", "extra1"),
    "frozen": ("broad, frozen", "extra3"),
    "rbf_medium": (r"RBF, $\eta$ = 1.5", "rival"),
    "rbf_tuned": ("RBF, tuned width", "extra2"),
    "constant": ("one constant node", "reference"),
    "reuse": ("broad, trained", "book"),
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    drawn = {}
    if "reuse" in recordings and recordings["reuse"].images:
        drawn["4.11"] = _draw_phases(recordings["reuse"], config)
    if {"reuse", "rbf_tuned", "constant"} <= set(recordings):
        drawn["4.12"] = _draw_errors(recordings, metrics, config)
    return drawn


def _draw_phases(recording: Recording, config: Config) -> Drawing:
    figure, axes = style.subplots(1, 3, height=2.6)
    instants = zip(config.cases["reuse"].task.pictured, ("near B", "near E", "from A to D"))
    words = {f"phase{k}": f"phase {'I' * k}, {time:.1f} s: {where}" for k, (time, where) in enumerate(instants, 1)}
    style.photos(axes, recording.images, words)
    axes[0].annotate("orange: A, B, C; green: D, E, F", (0, -0.04), xycoords="axes fraction", size=7, va="top")
    return style.title(figure, "The payload hangs from the gripper on a ball joint")


def _draw_errors(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, axes = style.subplots(2, 3, height=4.4)
    bound = config.cases["reuse"].law.bound
    length = sum(config.cases["reuse"].task.times)
    time = np.linspace(0, length, 200)
    limit = 1e3 * bound.upper * ((bound.initial - bound.final) * np.exp(-bound.decay * time) + bound.final)
    shown = [(case, *BARS[case]) for case in ("rbf_tuned", "reuse")]
    for case, label, line in shown:
        recording, options = recordings[case], {**style.LINES[line], "linewidth": 0.7, "alpha": 0.8}
        for number in range(2, int(recording["phase"].max()) + 1):
            now = recording["phase"] == number
            run, error = recording.time[now] - recording.time[now][0], 1e3 * recording["error"][now]
            for panel, values in zip(axes.flat, (*error.T, np.linalg.norm(error, axis=1))):
                panel.plot(run, values, label=label if number == 2 else None, **options)
    for panel, name in zip(axes.flat, ("$z_{1,x}$ [mm]", "$z_{1,y}$ [mm]", "$z_{1,z}$ [mm]", r"$\|z_1\|$ [mm]")):
        panel.set(ylabel=name, xlabel="Time [s]", xlim=(0, length))
    for panel in axes[0]:
        style.band(panel, time, -limit, limit, zorder=-5)
        panel.set_ylim(-220, 220)
    style.legend_below(figure, {label: style.LINES[line] for _, label, line in shown})
    _draw_bars(figure, axes, metrics)
    fixed, constant, broad = (metrics[case]["rmse_mm"] for case in ("rbf_tuned", "constant", "reuse"))
    finding = f"Mean error {broad:.1f} mm broad, {fixed:.1f} mm fixed, {constant:.1f} mm for one node (bound: grey)"
    return style.title(figure, finding)


def _draw_bars(figure: Any, axes: Any, metrics: AllMetrics) -> None:
    grid = axes[1, 1].get_gridspec()
    for panel in axes[1, 1:]:
        panel.remove()
    panel = figure.add_subplot(grid[1, 1:])
    shown = [case for case in BARS if case in metrics]
    for k, case in enumerate(shown):
        runs = [value for name, value in metrics[case].items() if name.startswith("trajectory")]
        panel.barh(k, metrics[case]["rmse_mm"], color=style.LINES[BARS[case][1]]["color"], alpha=0.6)
        panel.plot(
            runs, np.full(len(runs), k) + np.linspace(-0.25, 0.25, len(runs)), ".", color="#333333", markersize=3
        )
    panel.set_yticks(range(len(shown)), [BARS[case][0] for case in shown])
    panel.set(xlabel="RMSE of a trajectory (dots) and mean (bar) [mm]")


COLUMNS = {
    "rmse_mm": "mean RMSE [mm]",
    "worst_rmse_mm": "worst RMSE [mm]",
    "oscillation_mm_s": "rms error rate [mm/s]",
    "max_usage": "largest share of the bound",
    "violations": "samples outside",
    "nodes_phase1": "nodes after phase I",
    "nodes_phase2": "nodes after phase II",
    "most_nodes": "most nodes",
    "gain_ratio": "effective gain over that aimed at",
    "hand_tilt": "hand tilt (sine)",
}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    return {"T4.C": by_case(metrics, COLUMNS, config.cases)}
