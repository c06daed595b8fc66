"""What ``planar_platform`` shows: its figures and tables."""

from __future__ import annotations

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "2.3": Figure(
        "Force on the follower against its lateral offset, for an object that turns freely (central spring) and for "
        "one that keeps its direction (constant vector). The book sketches the first: a follower below its partner is "
        "pushed down, and (2.8) moves it up. The desired force is 1 N, the object 45 N/m.",
        "Lateral force over the lateral offset for two models of the object.",
    ),
    "2.4": Figure(
        "(a), (b) The two planar arms in the printed initial poses; (c), (d) the leader's paths Traj. 1 and Traj. 2 "
        "relative to the start, as in the book.",
        "Two three-link arms face each other.",
    ),
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    frames = next(iter(recordings.values())).frames
    return {"2.3": _draw_forces(frames["forces"]), "2.4": _draw_platform(frames["arms"], frames["paths"])}


def _draw_forces(forces: pd.DataFrame) -> Drawing:
    figure, axes = style.subplots(1, 2, height=2.3)
    for panel, (axis, letter) in zip(axes, (("x", "a"), ("y", "b"))):
        for model, label, line in (("central", "central spring", "book"), ("constant", "constant vector", "printed")):
            panel.plot(1e3 * forces["offset"], forces[f"{model}_{axis}"], label=label, **style.LINES[line])
        panel.set(xlabel="Offset $y_1 - y_2$ [mm]", ylabel=f"$f_{axis}$ [N]")
        style.panel(panel, letter, "along the holding line" if axis == "x" else "across")
    axes[1].set_ylim(-0.4, 0.4)
    axes[1].axhline(0, color=style.REFERENCE, linewidth=0.5)
    axes[1].annotate(
        "central: $-k_y f_y$ closes the offset",
        (70, 0.1),
        (0, 0.25),
        fontsize=7,
        arrowprops={"arrowstyle": "->", "lw": 0.6},
    )
    axes[0].legend()
    return style.title(figure, "Only with a central spring does the sign of (2.8) bring the follower back to the line")


def _draw_platform(arms: pd.DataFrame, paths: pd.DataFrame) -> Drawing:
    figure, axes = style.subplots(1, 4, height=1.9, width_ratios=(1.45, 1.45, 1, 1))
    for panel, (pose, rows) in zip(axes, arms.groupby("pose")):
        for arm, line in (("leader", "plain"), ("follower", "book")):
            links, colour = rows[rows["arm"] == arm], style.LINES[line]["color"]
            panel.plot(links["x"], links["y"], "-o", color=colour, ms=3)
            name, place = ("partner", -0.4) if arm == "leader" else ("follower", 0.5)
            panel.text(place, 0.77, name, color=colour, fontsize=7)
            panel.plot(links["x"].iloc[0], links["y"].iloc[0], "s", color=colour, ms=6)
            panel.plot(links["x"].iloc[-1], links["y"].iloc[-1], "D", color=colour, ms=4)
        panel.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", xlim=(-0.42, 1.0), ylim=(-0.08, 0.85))
        style.panel(panel, str(pose), f"pose {pose}")
    for panel, (trajectory, rows), letter in zip(axes[2:], paths.groupby("trajectory"), "cd"):
        panel.plot(rows["x"], rows["y"], color=style.BOOK)
        for index in (20, 100) if trajectory == 1 else (10, 60, 110, 160, 260, 360):
            ahead = rows[["x", "y"]].iloc[index + 4]
            panel.annotate(
                "", ahead, rows[["x", "y"]].iloc[index], arrowprops={"arrowstyle": "->", "color": style.BOOK}
            )
        panel.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", xlim=(-0.25, 0.25), ylim=(-0.25, 0.25))
        style.panel(panel, letter, f"Traj. {trajectory}")
    tips = arms.groupby(["pose", "arm"])[["x", "y"]].last().unstack("arm")
    apart = (tips["x", "follower"] - tips["x", "leader"])["a"]
    off = 1e3 * (tips["y", "follower"] - tips["y", "leader"]).abs()["b"]
    finding = f"Two planar arms {apart:g} m apart (pose b: {off:.0f} mm off the line) and the leader's two paths"
    return style.title(figure, finding)
