"""Pictures of the arm at the opening that several experiments share."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter3.measures import headed
from dexrepro.chapters.chapter3.scene import ARM, centreline, gripper_arm
from dexrepro.control.remote_centre import closest_point, tool_axis
from dexrepro.experiment import AllMetrics, Config, Drawing, Recording
from dexrepro.report import style
from dexrepro.robots.kinematics import forward
from dexrepro.robots.rotations import tilt


def describe(config: Config) -> str:
    """One case in a few words."""
    error = config.model.mass_error
    known = f"mass error {100 * error:g} %" if isinstance(error, (int, float)) else "mass errors that differ"
    parts = [f"{config.task.replace('_', ' ')} task", known]
    if config.straight:
        parts.append("straight to the target")
    parts.append(f"K_R {config.null_space.stiffness:g} N/m" if config.null_space.enabled else "no null-space torque")
    parts.append("no network" if config.law.get("network") is None else f"weights by {config.adaptation} e2")
    return ", ".join(parts)


def by_reading(metrics: AllMetrics, config: Config) -> pd.DataFrame:
    """One row a case: what it is in a few words, and all its metrics."""
    rows = [
        {"case": case, "reading": describe(config.cases[case]), **values}
        for case, values in metrics.items()
        if case in config.cases
    ]
    return headed(rows)


def pictures(images: dict[str, Any], finding: str) -> Drawing:
    """Rendered views side by side, each with its label."""
    figure, grid = style.subplots(1, len(images), height=2.9)
    style.photos(grid, images, {label: label for label in images})
    return style.title(figure, finding)


def steps(recording: Recording, config: Config) -> Drawing:
    """The four instants of Fig. 3.6."""
    approach, insertion, _ = config.phases
    labels = {
        "start": "(a) 0 s:\nstart",
        "centre": f"(b) {approach:g} s:\nat the opening",
        "half": f"(c) {approach + insertion / 2:g} s:\nhalf-way",
        "target": f"(d) {sum(config.phases):g} s:\nat the target",
    }
    figure, grid = style.subplots(1, 4, height=2.3)
    style.photos(grid, recording.images, labels)
    return style.title(figure, "The gripper enters through the opening and reaches the cube")


def orientation(recording: Recording, config: Config) -> Drawing:
    """Fig. 3.2 from a recorded instant half-way to the opening, in the plane of both tool axes."""
    index = int(np.abs(recording.time - config.phases[0] / 2).argmin())
    tip, rotation = forward(gripper_arm(config.gripper), recording[f"{ARM}.position"][index])
    centre, target = np.array(config.centre), np.array(config.target)
    wanted, actual = tool_axis(centre, centre, target, config.lever), rotation[:, 2]
    across = actual - (actual @ wanted) * wanted
    plane = np.stack((wanted, -across / np.linalg.norm(across)))
    angle = float(np.linalg.norm(tilt(wanted, actual)))
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=2.3)
    length = 1e3 * config.gripper or 150.0
    for axis, line, text in ((actual, "book", "actual axis"), (wanted, "reference", "desired axis $q_D$")):
        end = -length * (plane @ axis)
        axes.plot(*np.stack((end, (0.0, 0.0))).T, label=text, **style.LINES[line])
    turn = np.linspace(0.0, angle, 60)
    arc = 0.7 * length * np.stack((-np.cos(turn), np.sin(turn)))
    axes.plot(*arc, color=style.RIVAL, linewidth=1.2)
    text = rf"$\omega$ = {np.degrees(angle):.0f}°"
    axes.annotate(text, arc[:, 30], (-5, 0), textcoords="offset points", ha="right", va="center", color=style.RIVAL)
    for name, point in {"$X_P$": tip, "$P_R$": centre, "$X_D$": target}.items():
        place = 1e3 * (plane @ (point - tip))
        axes.plot(*place, "o", color="#222222", markersize=4)
        axes.annotate(name, place, (0, -5), textcoords="offset points", ha="center", va="top")
    way = 1e3 * (plane @ np.stack((centre - tip, target - tip)).T)
    axes.plot(*way, color=style.PLAIN, linewidth=0.8, label="opening to target")
    axes.set(xlabel="Along the desired axis [mm]", ylabel="Across it [mm]", aspect="equal")
    axes.margins(0.2, 0.45)
    figure.legend(loc="outside lower center", ncols=2)
    return style.title(figure, f"Half-way to the opening {np.degrees(angle):.0f}° of the turn remain")


def shortest_distance(recording: Recording, config: Config) -> Drawing:
    """Fig. 3.3 from a recorded instant half-way to the target."""
    time = config.phases[0] + config.phases[1] / 2
    index = int(np.abs(recording.time - time).argmin())
    corners = centreline(gripper_arm(config.gripper), recording[f"{ARM}.position"][index])
    centre = np.array(config.centre)
    _, foot = closest_point(centre, list(corners))
    figure, axes = _space()
    axes.plot(*corners.T, color=style.BOOK, linewidth=2.5)
    axes.plot(*np.stack((centre, foot)).T, color=style.RIVAL, linewidth=2.0)
    axes.text(*(centre + foot) / 2, "$Dis_R$ ", fontsize=8, color=style.RIVAL, ha="right", va="bottom")
    axes.text(*(corners[0] + corners[1]) / 2, "  forearm", fontsize=7, color=style.BOOK)
    axes.text(*(corners[1] + corners[2]) / 2, "  tool", fontsize=7, color=style.BOOK)
    _mark(axes, {"elbow": corners[0], "$P_{EA}$": corners[1], "$P_E$": corners[2], "$P_R$": centre})
    distance = 1e3 * float(np.linalg.norm(centre - foot))
    return style.title(figure, f"With a free tool axis the arm passes {distance:.0f} mm beside the centre")


def _space() -> tuple[Any, Any]:
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=3.4, subplot_kw={"projection": "3d"})
    for name, set_label in zip("xyz", (axes.set_xlabel, axes.set_ylabel, axes.set_zlabel)):
        set_label(f"{name} [m]", labelpad={"x": -3, "y": 0, "z": 5}[name])
    axes.tick_params(pad=-1)
    axes.tick_params(axis="z", pad=3)
    axes.locator_params(nbins=4)
    axes.view_init(elev=18, azim=-60)
    return figure, axes


def _mark(axes: Any, points: dict[str, Any]) -> None:
    for name, point in points.items():
        axes.scatter(*point, color="#222222", s=12)
        axes.text(*(np.asarray(point) - (0.03, 0.0, 0.03)), name, fontsize=8, ha="right", va="top")
    limits = np.array([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()])
    axes.set_box_aspect(np.ptp(limits, axis=1), zoom=0.76)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(style.plt.MultipleLocator(0.2))
