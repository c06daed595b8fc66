"""Skills carried over to new ends, another obstacle and directions between the demonstrated ones by fuzzy rules."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms

RATE = 50.0


def simulate(config: Config, rng: Rng) -> Recording:
    ordinary, reactions = skills.demonstrate(config)
    learned = skills.Skills(config, ordinary, reactions)
    task = skills.NewTask(config, learned)
    _, traces = skills.measure_stiffness(config)
    named = [config.scene[name] for name in ("left", "forward", "right")]
    moment = task.reach.moment(task.obstacle.position)
    series = {
        "time": learned.primitive.time,
        "old": learned.perform(),
        "new": task.perform(),
        **{f"height{h:g}": paths(task, named, h) for h in (config.scene.low, task.obstacle.height, config.scene.tall)},
        "between": paths(task, config.between),
        "chosen": paths(task, [config.direction]),
        "stiffness": skills.generalised_stiffness(config, task, traces, "average"),
        "stiffness_fuzzy": skills.generalised_stiffness(config, task, traces, "fuzzy"),
        "stiffness_truth": skills.muscle(config).stiffness(
            learned.primitive.time / learned.primitive.duration, task.obstacle.height, moment
        ),
    }
    bundles = skills.bundle_means(config, traces)
    for height in ("low", "tall"):
        series[f"stiffness_{height}"] = (bundles["close", height] + bundles["far", height]) / 2
    return Recording(series=series, steps=len(learned.primitive.time) * (10 + len(config.between)))


def paths(task: skills.NewTask, directions: list[float], height: float | None = None) -> np.ndarray:
    """Generalised movements (N, 3 k) in k directions."""
    found = task.perform(task.reaction(np.asarray(directions), height))
    return np.moveaxis(found, 1, 0).reshape(found.shape[1], -1)


def measure(recording: Recording, config: Config) -> Metrics:
    task = skills.Reach(config.task.start, config.task.goal)
    obstacle = skills.Obstacle(config.task.obstacle, config.task.height, config.scene.cube)
    heights = [config.scene.low, config.task.height, config.scene.tall]
    sets = {h: skills.by_path(recording[f"height{h:g}"]) for h in heights}
    lateral = {h: (sets[h] - recording["new"]) @ task.axes[1] for h in heights}
    lift = {h: sets[h][..., 2].max(axis=1) for h in heights}
    reached = {h: np.take_along_axis(v, np.abs(v).argmax(axis=1)[:, None], 1)[:, 0] for h, v in lateral.items()}
    between = skills.by_path(recording["between"])
    clearance = obstacle.clearance(between, config.scene.tool_radius)
    aside = ((between - recording["new"]) @ task.axes[1]).mean(axis=1)
    three = obstacle.clearance(sets[config.task.height], config.scene.tool_radius)
    return {
        "end_error": float(np.linalg.norm(recording["new"][-1] - task.ends[1])),
        "ordinary_clearance": float(obstacle.clearance(recording["new"], config.scene.tool_radius)),
        **{f"clearance_{name}": float(c) for name, c in zip(("left", "forward", "right"), three)},
        "clearance_three": float(three.min()),
        "clearance_chosen": float(obstacle.clearance(recording["chosen"], config.scene.tool_radius)),
        "clearance_between": float(clearance.min()),
        "worst_direction": float(config.between[int(clearance.argmin())]),
        **{
            f"separation_{h:g}": rms(lateral[h][1] - lateral[h][2]) for h in heights
        },
        "between_heights": min(betweenness(*(found[h] for h in heights)) for found in (lift, reached)),
        "lateral_steps": float(np.diff(-aside).min() / np.ptp(aside)),
        **stiffness_metrics(recording),
    }  # fmt: skip


def betweenness(low: np.ndarray, middle: np.ndarray, high: np.ndarray) -> float:
    """Smallest relative distance of ``middle`` from both others; positive if it lies between in every direction."""
    share = (middle - low) / (high - low)
    return float(np.minimum(share, 1 - share).min())


def stiffness_metrics(recording: Recording) -> Metrics:
    late = recording.time > recording.time[-1] / 2
    level, low, tall = (recording[name][late] for name in ("stiffness", "stiffness_low", "stiffness_tall"))
    return {
        "stiffness_between": float(((level > low) & (level < tall)).mean()),
        **{f"{name}_end": float(recording[name][-1]) for name in ("stiffness", "stiffness_fuzzy", "stiffness_truth")},
    }
