"""What ``fuzzy_generalisation`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recording, Recordings
from dexrepro.report import style

FIGURES = {
    "7.9": Figure(
        "Generalisation to the printed start (4.6, 0), goal (18, 4) cm and height of 4 cm (simulated). (a) Ordinary "
        "skill, old and new task; obstacle on the path (full) and where the printed coordinates read in cm put it "
        "(dashed); red dotted: T X' = V' as printed in (7.33). (b) Three directions, from above and from the side; "
        "shaded: what they do before obstacles of 2 to 8 cm. (c) Directions in between, grey, and the left-forward "
        "one, with the clearance against the direction. (d) Stiffness between those of the demonstrated heights.",
        "Paths to a new goal past a new obstacle in three directions, and by how much the directions between clear it.",
    )
}
UNITS = {
    "old": "cm", "new": "cm", "height": "cm", "between": "cm", "chosen": "cm", "stiffness": "1",
    "stiffness_fuzzy": "1", "stiffness_truth": "1", "stiffness_low": "1", "stiffness_tall": "1",
}  # fmt: skip
TABLES = {"T7.9": "Clearance of the generalised reactions in the new task", "T7.S": "Choices that turn a verdict"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "main" not in recordings:
        return {}
    from dexrepro.chapters.chapter7 import pictures

    recording, case = recordings["main"], config.cases.main
    task, old = skills.Reach(case.task.start, case.task.goal), skills.reach(case)
    obstacle = skills.Obstacle(case.task.obstacle, case.task.height, case.scene.cube)
    figure, plans, sides = pictures.plans_over_sides(2, height=6.4)
    level = pictures.joined(figure, plans, sides, 1, 1)
    draw_ordinary(plans[0, 0], sides[0, 0], recordings, case, obstacle)
    bounds = (skills.by_path(recording[f"height{height:g}"]) for height in (case.scene.low, case.scene.tall))
    for line, low, tall in zip(pictures.DIRECTIONS.values(), *bounds):
        band = {"color": line["color"], "alpha": 0.18, "linewidth": 0}
        plans[0, 1].fill(*np.concatenate([low, tall[::-1]])[:, :2].T, **band)
        outline = np.concatenate([low, tall[::-1]])
        sides[0, 1].fill((outline - task.ends[0]) @ task.axes[0], outline[:, 2], **band)
    for name, path in zip(pictures.DIRECTIONS, skills.by_path(recording[f"height{case.task.height:g}"])):
        pictures.plan(plans[0, 1], path, **pictures.DIRECTIONS[name])
        pictures.side(sides[0, 1], path, task, **pictures.DIRECTIONS[name])
    sides[0, 1].set_ylim(0, 13)
    sides[0, 1].annotate(
        f"shaded: obstacles of {case.scene.low:g} to {case.scene.tall:g} cm", (0.98, 1), xycoords="axes fraction",
        fontsize=8, ha="right", va="top",
    )  # fmt: skip
    for panel, top in ((plans[0, 0], 10.5), (plans[0, 1], 10.5), (plans[1, 0], 7.5)):
        panel.set_ylim(-1.5, top)
    pictures.name_directions(plans[0, 1])
    pictures.plan(plans[1, 0], skills.by_path(recording["between"]), color="#AAAAAA", linewidth=0.6)
    pictures.plan(plans[1, 0], recording["chosen"], **style.LINES["book"])
    for panel in (plans[0, 1], plans[1, 0]):
        pictures.footprint(panel, obstacle)
        pictures.ends(panel, task)
    pictures.profile(sides[0, 1], obstacle, task)
    draw_clearance(sides[1, 0], recording, case, obstacle)
    worst: Mapping[str, Any] = metrics["main"]
    style.panel(plans[0, 0], "a", f"ordinary skill, {style.at_most(10 * worst['end_error'], 1)} mm from the new goal")
    style.panel(plans[0, 1], "b", f"three directions, {style.at_least(worst['clearance_three'], 1)} cm clear")
    style.panel(
        plans[1, 0], "c", f"left-forward ({case.direction:g}), {style.at_least(worst['clearance_chosen'], 2)} cm clear"
    )
    draw_stiffness(level, recording, case)
    style.panel(level, "d", f"stiffness for the {case.task.height:g} cm obstacle")
    style.title(
        figure,
        f"Three directions clear the new obstacle by {style.at_least(worst['clearance_three'], 1)} cm; in between "
        f"the clearance falls to {10 * worst['clearance_between']:.1f} mm ($t_3$ = {worst['worst_direction']:.2g})",
    )
    pictures.ends(plans[0, 0], old)
    return {"7.9": figure}


def draw_ordinary(plan: Any, side: Any, recordings: Recordings, case: Config, obstacle: Any) -> None:
    from dexrepro.chapters.chapter7 import pictures

    task, old = skills.Reach(case.task.start, case.task.goal), skills.reach(case)
    curves = {"old task": ("main", "old", old, "plain"), "new task": ("main", "new", task, "book"),
              "printed (7.33)": ("printed_kinematics", "new", task, "printed")}  # fmt: skip
    for label, (name, channel, reach, line) in curves.items():
        if name in recordings:
            pictures.plan(plan, recordings[name][channel], label=label, **style.LINES[line])
            pictures.side(side, recordings[name][channel], reach, **style.LINES[line])
    pictures.footprint(plan, obstacle)
    read = skills.Obstacle(case.as_read, case.task.height, case.scene.cube)
    pictures.footprint(plan, read, facecolor="none", linestyle="--")
    pictures.ends(plan, task)
    side.set_ylim(0, 2)
    plan.legend(loc="upper left", borderpad=0.1)


def draw_clearance(panel: Any, recording: Recording, case: Config, obstacle: Any) -> None:
    clearance = obstacle.clearance(skills.by_path(recording["between"]), case.scene.tool_radius)
    panel.plot(case.between, clearance, marker=".", color="#888888")
    chosen = obstacle.clearance(recording["chosen"], case.scene.tool_radius)
    panel.plot([case.direction], [chosen], "o", color=style.BOOK)
    panel.axhline(0, color="k", linewidth=0.6)
    panel.axhspan(-1, 0, color="#F3D9CC", linewidth=0)
    panel.annotate("touches", (0.02, -0.5), fontsize=6.5, va="center")
    panel.set(xlabel="Direction $t_3$ (left 0, forward 0.8, right 1) [-]", ylabel="Clearance [cm]",
              ylim=(-0.8, 1.5))  # fmt: skip


def draw_stiffness(panel: Any, recording: Recording, case: Config) -> None:
    style.band(panel, recording.time, recording["stiffness_low"], recording["stiffness_tall"])
    for name, side in (("low", "top"), ("tall", "bottom")):
        place = (0.98 * recording.time[-1], recording[f"stiffness_{name}"][-1])
        panel.annotate(f"{case.scene[name]:g} cm", place, fontsize=8, va=side, ha="right")
    panel.plot(recording.time, recording["stiffness"], label="average ends (as printed)", **style.LINES["book"])
    panel.plot(recording.time, recording["stiffness_fuzzy"], label="fuzzy ends", **style.LINES["rival"])
    panel.plot(recording.time, recording["stiffness_truth"], label="the person's own", **style.LINES["reference"])
    panel.set(xlabel="Time [s]", ylabel="Stiffness $X^{stf}$ [-]", ylim=(0, 0.13))
    panel.legend(loc="upper left")


CLEAR = {"clearance_three": "three directions pass (C7.19)", "clearance_chosen": "left-forward passes (C7.21)",
         "clearance_between": "every direction in between passes (C7.21b)"}  # fmt: skip


def tabulate(recordings: Recordings, metrics: Mapping[str, Any], config: Config) -> dict[str, pd.DataFrame]:
    columns = ("left", "forward", "right", "chosen", "between")
    clearances = [
        {"case": case, "distance sets": config.cases[case].task.scope}
        | {f"{name} [cm]": values[f"clearance_{name}"] for name in columns}
        | {"direction of the smallest [-]": values["worst_direction"], "ordinary [cm]": values["ordinary_clearance"]}
        for case, values in metrics.items()
    ]
    if "main" not in metrics:
        return {"T7.9": pd.DataFrame(clearances)}
    flips = [
        {"verdict": text, "as shipped [cm]": metrics["main"][metric], "variant": case, "then [cm]": values[metric]}
        for metric, text in CLEAR.items()
        for case, values in metrics.items()
        if (values[metric] > 0) != (metrics["main"][metric] > 0)
    ]
    return {"T7.9": pd.DataFrame(clearances), "T7.S": pd.DataFrame(flips)}
