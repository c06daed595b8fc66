"""Demonstrated reaches and muscle stiffness, and the ordinary skill learned from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter7 import desk, skills
from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.robots.pen_arm import pen_arm_angles

FIGURES = {
    "7.4": Figure(
        "The simulated platform: desktop arm with finger handle, board of 21 x 13 cm, four cubes of 2 cm as obstacle, "
        "start and goal (blue). The book shows a photograph of a joystick.",
        "A small arm over a board with a stack of cubes.",
    ),
    "7.5": Figure(
        "A simulated demonstration with the tall obstacle at the far place: the arm is led over it.",
        "Four pictures of the arm passing over the stack.",
    ),
    "7.6": Figure(
        "Simulated demonstrations on the board. (a) Plan view and height of ordinary reaches (grey) and of the "
        "movement primitive learned from them (blue); red: learned with the printed sign of D v. (b) Muscle "
        "stiffness likewise. (c-f) Reactions to a low (2 cm) and a tall (8 cm) obstacle, far and close, in three "
        "directions; d': distance of forward and right at the obstacle in standard deviations. The book's figure "
        "shows recordings of one person with a joystick.",
        "Ordinary reaches are reproduced to a fraction of a millimetre; forward and right reactions separate for a low "
        "obstacle and overlap for a tall one.",
    ),
    "7.7": Figure(
        "Simulated muscle stiffness from EMG for the four obstacles, five repetitions in each of three directions, "
        "with the mean ordinary stiffness as reference. The dependence on height and distance is built in.",
        "Stiffness ends higher for the tall obstacle and rises earlier for the close one.",
    ),
}
TABLES = {"T7.1": "Factors and experimental conditions, completed, with what the demonstrations do"}
RATE = 50.0


def simulate(config: Config, rng: Any) -> Recording:
    ordinary, reactions = skills.demonstrate(config)
    stiffness, traces = skills.measure_stiffness(config)
    learned = skills.Skills(config, ordinary, reactions)
    level = skills.Primitive(config, config.dmp.stiffness_kernels)
    mean = stiffness.mean(axis=0)[:, None]
    target = level.target(mean, mean[-1], config.dmp.stiffness_cutoff, "even")
    forcing = level.kernels.features(level.phases) @ level.fit(target)
    recording = Recording(
        series={
            "time": learned.primitive.time,
            "ordinary": by_sample(ordinary),
            "reactions": by_sample(reactions),
            "learned": learned.perform(),
            "stiffness": by_sample(stiffness),
            "traces": by_sample(traces),
            "learned_stiffness": level.rollout(forcing, mean[0], mean[-1])[:, 0],
        },
        steps=len(learned.primitive.time),
    )
    if config.pictures:
        recording.images = photographs(config, reactions)
    return recording


def scene(config: Config) -> Any:
    return desk.demonstration_scene(config)


def photographs(config: Config, reactions: np.ndarray) -> dict[str, Any]:
    """The platform and four instants of a demonstration with the tall, far obstacle, forward."""
    number = [c.labels for c in skills.conditions(config)].index(("far", "tall", "forward"))
    path = reactions[number, 0]
    passage = skills.reach(config).moment(config.scene.far)
    instants = {"platform": 0.0, "a": 0.0, "b": 0.25, "c": passage, "d": 1.0}
    angles = {name: pen_arm_angles(desk.to_robot(path[round(u * (len(path) - 1))])) for name, u in instants.items()}
    with scene(config) as world:
        return desk.photographs(world, angles, camera=desk.WIDE)


def by_sample(data: np.ndarray) -> np.ndarray:
    """Samples first: (..., N, 3) to (N, ... 3) for paths, (..., N) to (N, ...) for traces, flattened."""
    axis = -2 if data.shape[-1] == 3 else -1
    moved = np.moveaxis(data, axis, 0)
    return moved.reshape(len(moved), -1)


def paths_of(recording: Recording, channel: str, config: Config) -> np.ndarray:
    """Paths (..., repetitions, N, 3) of a channel of :func:`by_sample`."""
    values = recording[channel]
    return np.moveaxis(values.reshape(len(values), -1, config.demonstration.repetitions, 3), 0, 2)


def traces_of(recording: Recording, config: Config) -> np.ndarray:
    """Stiffness traces (conditions, repetitions, N)."""
    values = recording["traces"]
    return np.moveaxis(values.reshape(len(values), -1, config.demonstration.repetitions), 0, 2)


def measure(recording: Recording, config: Config) -> Metrics:
    ordinary = paths_of(recording, "ordinary", config)[0]
    stiffness = recording["stiffness"].mean(axis=1)
    learned = recording["learned"]
    error = recording["learned_stiffness"] - stiffness
    return {
        "ordinary_rmse": float(skills.rms(learned, ordinary.mean(axis=0))),
        "ordinary_end_error": float(np.linalg.norm(learned[-1] - skills.reach(config).ends[1])),
        "stiffness_rmse": float(np.sqrt(np.mean(error**2)) / stiffness.mean()),
        "smallest_clearance": min(
            float(c.obstacle.clearance(paths, config.scene.tool_radius).min())
            for c, paths in zip(skills.conditions(config), paths_of(recording, "reactions", config))
        ),
        **separations(config),
        **stiffness_metrics(recording, config),
    }


def separations(config: Config) -> Metrics:
    """Sensitivity index d' between forward and right at the obstacle, from many repetitions of the same person."""
    someone, task = skills.person(config), skills.reach(config)
    rng, result = skills.generator(config, "separation"), {}
    for condition in skills.conditions(config):
        distance, height, direction = condition.labels
        moment = round(task.moment(condition.obstacle.position) * (someone.samples - 1))
        paths = someone.demonstrate(task, condition.obstacle, condition.direction, config.separation_repetitions, rng)
        result[distance, height, direction] = paths[:, moment] @ task.axes[1]
    return {
        f"separation_{distance}_{height}": float(
            abs(forward.mean() - right.mean()) / np.sqrt((forward.var(ddof=1) + right.var(ddof=1)) / 2)
        )
        for distance, height in {key[:2]: None for key in result}
        for forward, right in [(result[distance, height, "forward"], result[distance, height, "right"])]
    }


def stiffness_metrics(recording: Recording, config: Config) -> Metrics:
    bundles = skills.bundle_means(config, traces_of(recording, config))
    final = {key: curve[-1] for key, curve in bundles.items()}
    half = {key: float(recording.time[np.argmax(curve > (curve[0] + curve[-1]) / 2)]) for key, curve in bundles.items()}
    slope = {key: np.gradient(curve, recording.time).max() for key, curve in bundles.items()}
    return {
        "final_ratio": float(min(final[d, "tall"] / final[d, "low"] for d in ("close", "far"))),
        "final_difference": float(max(abs(final["close", h] / final["far", h] - 1) for h in ("low", "tall"))),
        **{f"half_rise_{d}_{h}": half[d, h] for d, h in half},
        "slope_difference": float(max(abs(slope["close", h] / slope["far", h] - 1) for h in ("low", "tall"))),
    }


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Any], config: Config) -> dict[str, Any]:
    if "corrected" not in recordings:
        return {}
    config = config.cases.corrected
    figures = {"7.6": draw_paths(recordings, metrics, config), "7.7": draw_stiffness(recordings["corrected"], config)}
    if recordings["corrected"].images:
        figures |= draw_pictures(recordings["corrected"].images)
    return figures


def draw_pictures(images: Mapping[str, Any]) -> dict[str, Any]:
    from dexrepro.report import style

    shown = style.trimmed({name: image for name, image in images.items() if name != "platform"})
    platform, axes = style.subplots(width=style.ONE_COLUMN, height=2.5)
    axes.imshow(style.trimmed({"platform": images["platform"]})["platform"])
    axes.axis("off")
    style.title(platform, "Arm, board and obstacle (simulated)")
    figure, panels = style.subplots(1, 4, height=1.7)
    words = ("start", "move away", "cross over", "reach the target")
    for letter, word, panel in zip("abcd", words, panels):
        panel.imshow(shown[letter])
        panel.axis("off")
        style.panel(panel, letter, word)
    style.title(figure, "The person leads the arm over the tall obstacle (simulated)")
    return {"7.4": platform, "7.5": figure}


def draw_paths(recordings: Mapping[str, Recording], metrics: Mapping[str, Any], config: Config) -> Any:
    from dexrepro.chapters.chapter7 import pictures
    from dexrepro.report import style

    recording, task = recordings["corrected"], skills.reach(config)
    figure, plans, sides = pictures.plans_over_sides(3, height=5.6)
    level = pictures.joined(figure, plans, sides, 0, 1)
    level.plot(recording.time, recording["stiffness"], color="#AAAAAA", linewidth=0.6, linestyle="--")
    level.set(xlabel="Time [s]", ylabel="Stiffness $X^{stf}$ [-]", ylim=(0.02, 0.045))
    style.panel(level, "b", "ordinary stiffness")
    ordinary = paths_of(recording, "ordinary", config)[0]
    pictures.plan(plans[0, 0], ordinary, color="#AAAAAA", linewidth=0.6, linestyle="--")
    pictures.side(sides[0, 0], ordinary, task, color="#AAAAAA", linewidth=0.6, linestyle="--")
    for case, kind in (("corrected", "book"), ("printed_sign", "printed")):
        if case in recordings:
            pictures.plan(plans[0, 0], recordings[case]["learned"], **style.LINES[kind])
            pictures.side(sides[0, 0], recordings[case]["learned"], task, **style.LINES[kind])
            level.plot(recording.time, recordings[case]["learned_stiffness"], **style.LINES[kind])
    sides[0, 0].set_ylim(0, 2)
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
    style.title(figure, "Forward and right are distinct for a low obstacle and overlap for a tall one (simulated)")
    return figure


def draw_stiffness(recording: Recording, config: Config) -> Any:
    from dexrepro.chapters.chapter7 import pictures
    from dexrepro.report import style

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
    for panel in axes[1]:
        panel.set_xlabel("Time [s]")
    for panel in axes[:, 0]:
        panel.set_ylabel("Stiffness $X^{stf}$ [-]")
    style.title(figure, "Stiffness ends higher for a tall obstacle and rises earlier for a close one (built in)")
    return figure


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Any], config: Config
) -> dict[str, pd.DataFrame]:
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
