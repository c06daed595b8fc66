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
    for axes, (label, image) in zip(grid, style.trimmed(images).items()):
        style.photo(axes, image, label)
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
    shown = style.trimmed(recording.images)
    for axes, (name, label) in zip(grid, labels.items()):
        style.photo(axes, shown[name], label)
    return style.title(figure, "The gripper enters through the opening and reaches the cube")


def orientation(recording: Recording, config: Config) -> Drawing:
    """Fig. 3.2 from a recorded instant half-way to the opening."""
    index = int(np.abs(recording.time - config.phases[0] / 2).argmin())
    tip, rotation = forward(gripper_arm(config.gripper), recording[f"{ARM}.position"][index])
    centre, target = np.array(config.centre), np.array(config.target)
    wanted = tool_axis(centre, centre, target, config.lever)
    figure, axes = _space(style)
    length = 0.22
    axes.plot(*np.stack((tip - length * rotation[:, 2], tip)).T, **style.LINES["book"])
    axes.plot(*np.stack((tip - length * wanted, tip)).T, **style.LINES["reference"])
    axes.plot(*np.stack((centre, target)).T, color=style.PLAIN, linewidth=0.8)
    axes.text(*(tip - length * rotation[:, 2] + (0.02, 0.0, 0.0)), "actual tool axis", fontsize=7, color=style.BOOK)
    axes.text(*(tip - length * wanted), "final desired axis  ", fontsize=7, ha="right")
    axes.text(*(centre + target) / 2, "opening to target  ", fontsize=7, color="#555555", ha="right", va="top")
    _mark(style, axes, {"$P_R$": centre, "$X_D$": target, "$X_P$": tip})
    angle = float(np.degrees(np.linalg.norm(tilt(wanted, rotation[:, 2]))))
    return style.title(figure, f"Half-way to the opening {angle:.0f}° of the turn remain")


def shortest_distance(recording: Recording, config: Config) -> Drawing:
    """Fig. 3.3 from a recorded instant half-way to the target."""
    time = config.phases[0] + config.phases[1] / 2
    index = int(np.abs(recording.time - time).argmin())
    corners = centreline(gripper_arm(config.gripper), recording[f"{ARM}.position"][index])
    centre = np.array(config.centre)
    _, foot = closest_point(centre, list(corners))
    figure, axes = _space(style)
    axes.plot(*corners.T, color=style.BOOK, linewidth=2.5)
    axes.plot(*np.stack((centre, foot)).T, color=style.RIVAL, linewidth=2.0)
    axes.text(*(centre + foot) / 2, "$Dis_R$ ", fontsize=8, color=style.RIVAL, ha="right", va="bottom")
    axes.text(*(corners[0] + corners[1]) / 2, "  forearm", fontsize=7, color=style.BOOK)
    axes.text(*(corners[1] + corners[2]) / 2, "  tool", fontsize=7, color=style.BOOK)
    _mark(style, axes, {"elbow": corners[0], "$P_{EA}$": corners[1], "$P_E$": corners[2], "$P_R$": centre})
    distance = 1e3 * float(np.linalg.norm(centre - foot))
    return style.title(figure, f"With a free tool axis the arm passes {distance:.0f} mm beside the centre")


def _space(style: Any) -> tuple[Any, Any]:
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=3.4, subplot_kw={"projection": "3d"})
    for name, set_label in zip("xyz", (axes.set_xlabel, axes.set_ylabel, axes.set_zlabel)):
        set_label(f"{name} [m]", labelpad={"x": -3, "y": 0, "z": 5}[name])
    axes.tick_params(pad=-1)
    axes.tick_params(axis="z", pad=3)
    axes.locator_params(nbins=4)
    axes.view_init(elev=18, azim=-60)
    return figure, axes


def _mark(style: Any, axes: Any, points: dict[str, Any]) -> None:
    for name, point in points.items():
        axes.scatter(*point, color="#222222", s=12)
        axes.text(*(np.asarray(point) - (0.03, 0.0, 0.03)), name, fontsize=8, ha="right", va="top")
    limits = np.array([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()])
    axes.set_box_aspect(np.ptp(limits, axis=1), zoom=0.76)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(style.plt.MultipleLocator(0.2))
