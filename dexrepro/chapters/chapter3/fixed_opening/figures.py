"""What ``fixed_opening`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter3 import drawings
from dexrepro.chapters.chapter3.measures import COLUMNS
from dexrepro.chapters.chapter3.scene import FILMED
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recordings
from dexrepro.report import style

from .experiment import REACHES

_REACH = (
    "Distance of the end point to the target and shortest distance Dis_R of the arm to the remote centre in reach {} "
    "(the book plots the default alone). Simulated: Baxter's right arm with a gripper of {{.gripper:g}} m, mass error "
    "of the nominal model {{.model.mass_error:.0%}}, box and lid as collision bodies. Position-only tasks pass through "
    "the lid untouched, so that laws are compared and not their collisions. The book's time axes are not printed."
)
FIGURES = {
    "3.2": Figure(
        "Tool axis on the way to the opening in reach 1 (simulated), in the plane of the actual and the desired axis: "
        "the angle omega between them, end point X_P, and remote centre and target projected onto that plane. The book "
        "shows a sketch.",
        "The tool axis turns about the end point towards the line from the opening to the target.",
    ),
    "3.3": Figure(
        "Elbow, wrist, end point, remote centre and the shortest distance Dis_R, half-way to the target in reach 1 "
        "with the position-only task (simulated). The book shows a sketch.",
        "The shortest distance runs from the opening's centre to the foot point on the arm.",
    ),
    "3.4": Figure(
        "The simulated workspace: box of {.box.size.1:g} m x {.box.size.0:g} m x {.box.height:g} m, lid with a square "
        "hole, cube at the target of reach 1. The book shows a photograph.",
        "A box with a hole in its lid in front of the robot's right arm.",
    ),
    "3.6": Figure(
        "Four instants of reach 1 (simulated): start, end point at the remote centre, half-way, at the target. The "
        "book shows photographs of the same steps.",
        "Pictures of the arm at the opening and at the cube inside the box.",
    ),
    **{
        f"3.{6 + n}": Figure(_REACH.format(n), f"Reach {n}: distances to the target and to the opening over time.")
        for n in (1, 2, 3, 4)
    },
}
UNITS = {"tracking": "m", "observed": "N m", "nodes": "1", "contact": "1, N, m", "error": "m", "rcm_distance": "m"}
TABLES = {
    "T3.A": "Fixed opening: every law and model, four reaches",
    "T3.S": "Sensitivity: variants of unprinted values and of the reading, and what becomes of the claims",
}
FILM = Film(
    "reach1", "The gripper passes the opening to the cube in the box and the arm stays near the opening's centre.",
    FILMED, "rcm_distance", "Dis_R [mm]", scale=1e3,
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures: dict[str, Any] = {}
    for n in REACHES:
        if f"reach{n}" in recordings:
            figures[f"3.{6 + n}"] = _draw_reach(n, recordings, metrics, config)
    first = recordings.get("reach1")
    if first is not None and first.images:
        figures["3.4"] = style.picture(first.images["start"], "A box entered through its lid", 2.7)
        figures["3.6"] = drawings.steps(first, config.cases["reach1"])
    if first is not None:
        figures["3.2"] = drawings.orientation(first, config.cases["reach1"])
    if "pos1" in recordings:
        figures["3.3"] = drawings.shortest_distance(recordings["pos1"], config.cases["pos1"])
    return figures


CURVES = {
    "reach": ("whole method", "book"),
    "free": ("without null-space torque", "extra2"),
    "pos": ("position-only task", "rival"),
    "posfree": ("position-only, without torque", "plain"),
}


def _draw_reach(n: int, recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, (left, right) = style.subplots(1, 2, height=2.6)
    for prefix, (label, line) in CURVES.items():
        recording = recordings.get(f"{prefix}{n}")
        if recording is not None:
            left.plot(recording.time, 1e3 * np.maximum(recording["error"], 1e-6), label=label, **style.LINES[line])
            right.plot(recording.time, 1e3 * recording["rcm_distance"], label=label, **style.LINES[line])
    approach, insertion, _ = config.cases[f"reach{n}"].phases
    for axes in (left, right):
        for time, word in ((approach, "at $P_R$"), (approach + insertion, "at $X_D$")):
            style.event(axes, time, word)
        axes.set_xlabel("Time [s]")
    left.set(yscale="log", ylabel=r"Distance to target $\|\tilde X\|$ [mm]", ylim=(1e-3, 2e4))
    right.set(yscale="log", ylabel="Distance to centre $Dis_R$ [mm]", ylim=(1e-3, 1e3))
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    found = metrics[f"reach{n}"]
    final, far = 1e6 * found["final_position_error"], style.at_most(1e3 * found["rcm_distance_max"], 2)
    return style.title(figure, f"Reach {n} ends {final:.0f} µm from its target and stays within {far} mm of the centre")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    return {"T3.A": drawings.by_reading(metrics, config), "T3.S": _sensitivity(metrics, config)}


# Variant, what differs, claim, metric, bound that the claim puts on it [m] and the case it departs from.
VARIANTS = (
    ("flange2", "no gripper, reach 2", "C3.01", "final_position_error", 0.002, "reach2"),
    ("flange3", "no gripper, reach 3", "C3.01", "final_position_error", 0.002, "reach3"),
    ("flange3", "no gripper, reach 3", "C3.02", "rcm_distance_max", 0.01, "reach3"),
    ("medium1", "gripper {0.gripper:g} m, reach 1", "C3.02", "rcm_distance_max", 0.01, "reach1"),
    ("short1", "gripper {0.gripper:g} m, reach 1", "C3.02", "rcm_distance_max", 0.01, "reach1"),
    ("short3", "gripper {0.gripper:g} m, reach 3", "C3.02", "rcm_distance_max", 0.01, "reach3"),
    (
        "stronger3",
        "gripper {0.gripper:g} m, K_R {0.null_space.stiffness:g} N/m, held {0.phases[2]:g} s, reach 3",
        "C3.02",
        "rcm_distance_final",
        0.01,
        "short3",
    ),
    ("pose1", "six-dimensional task (3.21), reach 1", "C3.02", "rcm_distance_max", 0.01, "reach1"),
    ("joint1", "q_d integrated in joint space, reach 1", "C3.02", "rcm_distance_max", 0.01, "reach1"),
    ("exact1", "exact model, reach 1", "C3.02", "rcm_distance_max", 0.01, "reach1"),
    ("exact4", "exact model, reach 4", "C3.02", "rcm_distance_max", 0.01, "reach4"),
    ("task4", "weights driven by the task part of e2, reach 4", "C3.02", "rcm_distance_max", 0.01, "reach4"),
    ("pos1", "position-only task, reach 1", "C3.02", "rcm_distance_max", 0.01, "reach1"),
    ("narrow1", "hole of {0.box.opening:g} m, reach 1", "C3.06", "contact_time", 0.001, "reach1"),
    ("weightless1", "no gravity compensation, reach 1", "C3.06", "contact_time", 0.001, "reach1"),
    ("weightless1", "no gravity compensation, reach 1", "C3.01", "final_position_error", 0.002, "reach1"),
    ("slow2", "{0.phases[0]:g} s to the opening, reach 2", "joint speed", "joint_speed_max", 4.0, "reach2"),
)


def _sensitivity(metrics: AllMetrics, config: Config) -> pd.DataFrame:
    rows = []
    for case, what, claim, metric, bound, base in VARIANTS:
        value, before = metrics.get(case, {}).get(metric), metrics.get(base, {}).get(metric)
        if case in metrics and base in metrics:
            holds, held = (x is not None and x < bound for x in (value, before))
            rows.append(
                {(
                    "variant"
                ): what.format(config.cases[case]), (
                    "claim"
                ): claim, (
                    "quantity"
                ): COLUMNS[metric], (
                    "bound"
                ): bound, (
                    "as shipped"
                ): before,
                 "varied": value, "holds": "yes" if holds else "no",
                 "verdict changes": "yes" if holds != held else "no"}
            )  # fmt: skip
    return pd.DataFrame(rows)
