"""The opening moves while the arm holds the target inside the box (Sect. 3.5.4)."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter3 import reach
from dexrepro.chapters.chapter3.measures import add_distances, reach_metrics
from dexrepro.chapters.chapter3.scene import ARM, Touching, build, cutaway
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World

RATE = 50.0
VIEW = Camera(target=(0.45, -0.15, 0.2), distance=1.6, yaw=30.0, pitch=-40.0)


def path(config: Config) -> Callable[[float], Array]:
    """P_R(t) (3,) [m]: a figure of eight for one period from ``motion.start`` [s], still before and after."""
    home, motion = np.array(config.centre, dtype=float), config.motion
    (a, b), rate = motion.amplitude, 2 * math.pi / motion.period

    def centre(time: float) -> Array:
        u = min(max(time - motion.start, 0.0), motion.period)
        return home + np.array((a * math.sin(rate * u), b * math.sin(2 * rate * u), 0.0))

    return centre


def scene(config: Config) -> World:
    return build(config, path(config))


def stage(world: World, recording: Recording, config: Config) -> Recording:
    shown = cutaway(world, recording, config)
    shown.series["lid.pose"] = recording["centre"]
    return shown


def simulate(config: Config, rng: Rng) -> Recording:
    centre = path(config)
    with scene(config) as world:
        seen = lambda time: centre(max(time - config.motion.delay, 0.0))  # noqa: E731
        recording = reach.run(world, config, seen, Touching(world))
        if config.pictures:
            for name, time in (("begin", 0.0), ("quarter", 1.25), ("end", config.motion.period)):
                now = config.motion.start + time
                index = min(round(now / config.step), len(recording.time) - 1)
                pose = {"lid": [*centre(now), 0.0, 0.0, 0.0, 1.0]}
                positions = {ARM: recording[f"{ARM}.position"][index]}
                recording.images[name] = world.render(positions, pose, VIEW, (1000, 750))
    recording.series["centre"] = np.array([centre(time) for time in recording.time])
    add_distances(recording, config, recording["centre"])
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    metrics = reach_metrics(recording, config)
    start, period = config.motion.start, config.motion.period
    moving = recording.between(start, start + period)
    speed = np.linalg.norm(np.gradient(recording["centre"], config.step, axis=0), axis=1)
    if metrics["finished"]:
        metrics["moving_distance_max"] = float(recording["rcm_distance"][moving].max())
        metrics["moving_distance_mean"] = float(recording["rcm_distance"][moving].mean())
        metrics["moving_error_max"] = float(recording["error"][moving].max())
    metrics["centre_speed_max"] = float(speed[moving].max())
    excursion = np.linalg.norm(recording["centre"] - np.array(config.centre), axis=1)
    metrics["excursion"] = float(excursion.max())
    return metrics


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """How much larger the mean Dis_R is without the null-space torque."""
    result: Metrics = {}
    for name, (without, whole) in {"default": ("free", "track"), "position": ("posfree", "pos")}.items():
        values = [metrics.get(case, {}).get("moving_distance_mean") for case in (without, whole)]
        result[f"{name}_ratio"] = values[0] / values[1] if None not in values else None  # type: ignore[operator]
    return result
