"""Demonstrated reaches and muscle stiffness, and the ordinary skill learned from them."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter7 import desk, skills
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms, rms_distance
from dexrepro.robots.pen_arm import pen_arm_angles

RATE = 50.0


def simulate(config: Config, rng: Rng) -> Recording:
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
        try:
            recording.images = photographs(config, reactions)
        except ValueError as error:  # of a reach that is longer than the arm
            warnings.warn(f"the arm is not shown: {error}", stacklevel=2)
    return recording


def scene(config: Config) -> Any:
    return desk.demonstration_scene(config)


def photographs(config: Config, reactions: np.ndarray) -> dict[str, Any]:
    """The platform and four instants of a demonstration with the tall, far obstacle, forward.

    It moves away where half the height over the obstacle is reached.
    """
    number = [c.labels for c in skills.conditions(config)].index(("far", "tall", "forward"))
    path = desk.before_arm(reactions[number, 0], config)
    passage = skills.reach(config).moment(config.scene.far)
    half = int(np.argmax(path[:, 2] > path[:, 2].max() / 2))
    instants = {"platform": 0.0, "a": 0.0, "b": half / (len(path) - 1), "c": passage, "d": 1.0}
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
        "ordinary_rmse": float(rms_distance(learned, ordinary.mean(axis=0))),
        "ordinary_end_error": float(np.linalg.norm(learned[-1] - skills.reach(config).ends[1])),
        "stiffness_rmse": float(rms(error) / stiffness.mean()),
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
        "direction_spread": direction_spread(recording, config),
        "final_ratio": float(min(final[d, "tall"] / final[d, "low"] for d in ("close", "far"))),
        "final_difference": float(max(abs(final["close", h] / final["far", h] - 1) for h in ("low", "tall"))),
        **{f"half_rise_{d}_{h}": half[d, h] for d, h in half},
        "slope_difference": float(max(abs(slope["close", h] / slope["far", h] - 1) for h in ("low", "tall"))),
    }


def direction_spread(recording: Recording, config: Config) -> float:
    """Largest relative range of the mean final stiffness over the directions, of all obstacles."""
    final = traces_of(recording, config)[..., -1].mean(axis=1)
    groups: dict[tuple[str, ...], list[float]] = {}
    for condition, value in zip(skills.conditions(config), final):
        groups.setdefault(condition.labels[:2], []).append(float(value))
    return max(float(np.ptp(values) / np.mean(values)) for values in groups.values())
