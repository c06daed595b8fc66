"""What ``reaching_demonstrations`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recording, Recordings
from dexrepro.report import style

from .experiment import paths_of, traces_of

FIGURES = {
    "7.4": Figure(
        "The simulated platform: desktop arm with finger handle, board of 21 x 13 cm, four cubes of 2 cm as obstacle, "
        "start and goal (blue). The book shows a photograph of a joystick.",
        "A small arm over a board with a stack of cubes.",
    ),
    "7.5": Figure(
        "A simulated demonstration with the tall obstacle at the far place, at its start, at half its height, at the "
        "obstacle and at its end.",
        "Four pictures of the arm passing over the stack.",
    ),
    "7.6": Figure(
        "Simulated demonstrations on the board. (a) Ordinary reaches (grey) and the movement primitive learned from "
        "them (blue) from above, and their way along the straight line over time; red: learned with the printed sign "
        "of D v, which delays it. (b) Muscle stiffness likewise. (c-f) Reactions to a low (2 cm) and a tall (8 cm) "
        "obstacle, far and close, in three directions; d': distance of forward and right at the obstacle in standard "
        "deviations. The book's figure shows recordings of one person with a joystick.",
        "Paths in three directions past four obstacles, from above and from the side, and the ordinary reaches.",
    ),
    "7.7": Figure(
        "Simulated muscle stiffness from EMG for the four obstacles, five repetitions in each of three directions, "
        "with the mean ordinary stiffness as reference. The dependence on height and distance is built in.",
        "Muscle stiffness over time for four obstacles, by direction, with the ordinary one.",
    ),
}
UNITS = {
    "ordinary": "cm", "reactions": "cm", "learned": "cm", "stiffness": "1", "traces": "1", "learned_stiffness": "1",
}  # fmt: skip
TABLES = {"T7.1": "Factors and experimental conditions, completed, with what the demonstrations do"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "corrected" not in recordings:
        return {}
    config = config.cases.corrected
    figures = {
        "7.6": draw_paths(recordings, metrics, config),
        "7.7": draw_stiffness(recordings["corrected"], metrics["corrected"], config),
    }
    if recordings["corrected"].images:
        figures |= draw_pictures(recordings["corrected"].images)
    return figures


def draw_pictures(images: Mapping[str, Any]) -> Drawings:
    platform = style.picture(images["platform"], "Arm, board and obstacle (simulated)")
    figure, panels = style.subplots(1, 4, height=1.7)
    words = {"a": "(a) start", "b": "(b) move away", "c": "(c) cross over", "d": "(d) reach the target"}
    style.photos(panels, {name: image for name, image in images.items() if name != "platform"}, words)
    style.title(figure, "The person leads the arm over the tall obstacle (simulated)")
    return {"7.4": platform, "7.5": figure}


def draw_paths(recordings: Recordings, metrics: Mapping[str, Any], config: Config) -> Drawing:
    from dexrepro.chapters.chapter7 import pictures

    recording, task = recordings["corrected"], skills.reach(config)
    figure, plans, sides = pictures.plans_over_sides(3, height=5.6)
    level = pictures.joined(figure, plans, sides, 0, 1)
    level.plot(recording.time, recording["stiffness"], color="#AAAAAA", linewidth=0.6, linestyle="--")
    level.set(xlabel="Time [s]", ylabel="Stiffness $X^{stf}$ [-]", ylim=(0.02, 0.045))
    style.panel(level, "b", "ordinary stiffness")
    ordinary = paths_of(recording, "ordinary", config)[0]
    pictures.plan(plans[0, 0], ordinary, color="#AAAAAA", linewidth=0.6, linestyle="--")
    progress(sides[0, 0], recording.time, ordinary, task, color="#AAAAAA", linewidth=0.6, linestyle="--")
    for case, kind in (("corrected", "book"), ("printed_sign", "printed")):
        if case in recordings:
            pictures.plan(plans[0, 0], recordings[case]["learned"], **style.LINES[kind])
            progress(sides[0, 0], recording.time, recordings[case]["learned"], task, **style.LINES[kind])
            level.plot(recording.time, recordings[case]["learned_stiffness"], **style.LINES[kind])
    sides[0, 0].set(xlabel="Time [s]", ylabel="Along [cm]")
    style.panel(plans[0, 0], "a", f"ordinary, {10 * metrics['corrected']['ordinary_rmse']:.1f} mm off")
    places = {("far", "low"): (0, 2), ("far", "tall"): (1, 0), ("close", "low"): (1, 1), ("close", "tall"): (1, 2)}
    for condition, paths in zip(skills.conditions(config), paths_of(recording, "reactions", config)):
        place, line = places[condition.labels[:2]], pictures.DIRECTIONS[condition.labels[2]] | {"linewidth": 0.7}
        pictures.plan(plans[place], paths, **line)
        pictures.side(sides[place], paths, task, **line)
        if condition.labels[2] == "left":
            pictures.footprint(plans[place], condition.obstacle)
            pictures.profile(sides[place], condition.obstacle, task)
            sides[place].set_ylim(0, 13)
    for letter, ((distance, height), place) in zip("cdef", places.items()):
        separation = metrics["corrected"][f"separation_{distance}_{height}"]
        style.panel(plans[place], letter, f"{height}, {distance}: d' = {separation:.1f}")
    for place in ((0, 0), *places.values()):
        pictures.ends(plans[place], task)
    looks = {"demonstrated, ordinary": {"color": "#AAAAAA", "linewidth": 0.6, "linestyle": "--"}}
    looks |= {"learned": style.LINES["book"], "printed sign": style.LINES["printed"], **pictures.DIRECTIONS}
    style.legend_below(figure, looks)
    low, tall = ([metrics["corrected"][f"separation_{d}_{h}"] for d in ("far", "close")] for h in ("low", "tall"))
    return style.title(
        figure,
        f"Forward and right are {style.at_least(min(low), 1)} deviations or more apart at a low obstacle, "
        f"{style.at_most(max(tall), 1)} or less at a tall one (simulated)",
    )


def progress(axes: Any, time: np.ndarray, paths: np.ndarray, reach: skills.Reach, **line: Any) -> None:
    """How far paths (N, 3) or (k, N, 3) [cm] are along the straight line from start to goal, over time."""
    for path in np.reshape(paths, (-1, *np.shape(paths)[-2:])):
        axes.plot(time, (path - reach.ends[0]) @ reach.axes[0], **line)


def draw_stiffness(recording: Recording, found: Mapping[str, Any], config: Config) -> Drawing:
    from dexrepro.chapters.chapter7 import pictures

    figure, axes = style.subplots(2, 2, height=3.3, sharex=True, sharey=True)
    traces = traces_of(recording, config)
    bundles = [("far", "low"), ("far", "tall"), ("close", "low"), ("close", "tall")]
    for letter, key, panel in zip("abcd", bundles, axes.flat):
        for condition, group in zip(skills.conditions(config), traces):
            if condition.labels[:2] == key:
                line = pictures.DIRECTIONS[condition.labels[2]] | {"linewidth": 0.6}
                panel.plot(recording.time, group.T, **line)
        panel.plot(recording.time, recording["stiffness"].mean(axis=1), **style.LINES["reference"])
        moment = skills.reach(config).moment(config.scene[key[0]])
        style.event(panel, moment * config.demonstration.duration, "at obstacle")
        style.panel(panel, letter, f"{key[1]} obstacle, {key[0]}")
    axes[0, 0].plot([], [], label="no obstacle", **style.LINES["reference"])
    pictures.name_directions(axes[0, 0])
    axes[0, 0].set_ylim(0.02, 0.15)
    style.edges(axes, "Time [s]", "Stiffness $X^{stf}$ [-]")
    earlier = min(found[f"half_rise_far_{height}"] - found[f"half_rise_close_{height}"] for height in ("low", "tall"))
    return style.title(
        figure,
        f"Built in: stiffness ends {found['final_ratio']:.1f} times higher for a tall obstacle and rises "
        f"{style.at_least(earlier, 1)} s earlier for a close one",
    )


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    if "corrected" not in recordings:
        return {}
    recording, config = recordings["corrected"], config.cases.corrected
    task = skills.reach(config)
    ordinary = paths_of(recording, "ordinary", config)[0].mean(axis=0)
    rows = []
    for condition, paths in zip(skills.conditions(config), paths_of(recording, "reactions", config)):
        offset = (paths - ordinary) @ task.axes[1]
        widest = np.abs(offset).argmax(axis=1)
        distance, height, direction = condition.labels
        rows.append(
            {
                "distance to obstacle": f"{'long' if distance == 'far' else 'short'} ({condition.distance:.1f} cm)",
                "height of obstacle": f"{height} ({condition.obstacle.height:g} cm)",
                "direction": direction,
                "mean clearance [cm]": condition.obstacle.clearance(paths, config.scene.tool_radius).mean(),
                "mean lift [cm]": paths[..., 2].max(axis=1).mean(),
                "lateral excursion [cm, left +]": offset[np.arange(len(paths)), widest].mean(),
            }
        )
    return {"T7.1": pd.DataFrame(rows)}
