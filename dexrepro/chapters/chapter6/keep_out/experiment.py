"""Staying outside of an obstacle: the outside law, the filter, and a tube about a detour (Table 6.2, Sect. 6.5)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import learning
from dexrepro.config import one_of
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.waypoints import minimum_jerk
from dexrepro.primitives.barrier import Constraint
from dexrepro.primitives.constrained import Path, Reference, rollout
from dexrepro.primitives.dmp import DMP, Trajectory

RATE = 100.0


def simulate(config: Config, rng: Rng) -> Recording:
    primitive = _reach(config)
    movement = primitive.rollout(config.step, horizon=config.duration)
    runs = len(config.offsets)
    time = movement.time
    centre = _obstacles(config, time)
    skill = learning.skill([primitive] * runs, [movement] * runs)
    start = np.broadcast_to(primitive.start, (runs, 2)), np.zeros((runs, 2))
    c = config.cdmp
    if one_of("route", config.route, ("outside", "detour")) == "detour":
        reference = _detour(config, movement, centre)
        constraint = learning.tube(c, c.margin)
    else:
        reference = centre
        bound = c.kz * config.radius
        constraint = Constraint(False, bound, weight=learning.weight(c, bound))
    path = rollout(skill, reference, constraint, learning.gains(c), learning.law(c), config.step, *start)
    distance = np.linalg.norm(path.position - centre.position, axis=-1)
    rows = [_row(path, distance[:, i], primitive.goal, i) for i in range(runs)]
    series = {
        "time": time,
        "position": path.position.reshape(len(time), -1),
        "centre": centre.position.reshape(len(time), -1),
    }
    series["distance"] = distance
    return Recording(series=series, frames={"runs": pd.DataFrame(rows)}, steps=len(time), simulated=float(time[-1]))


def _reach(config: Config) -> DMP:
    """Primitive of a straight minimum-jerk reach along x [cm]."""
    time = np.linspace(0, config.duration, 201)
    path = np.stack([config.reach * minimum_jerk(time / config.duration), np.zeros_like(time)], axis=1)
    return learning.learn(time, path + config.perturbation, config.dmp)


def _obstacles(config: Config, time: Array) -> Reference:
    """Centres of the disks: amid the reach plus an offset, crossing it at mid-time with their speeds."""
    offsets, speeds = np.array(config.offsets, float), np.array(config.speeds, float)
    position = np.zeros((len(time), len(offsets), 2))
    position[..., 0] = config.reach / 2
    position[..., 1] = offsets + speeds * (time[:, None] - config.duration / 2)
    velocity = np.zeros_like(position)
    velocity[..., 1] = speeds
    return Reference(position, velocity, np.zeros_like(position))


def _detour(config: Config, movement: Trajectory, centre: Reference) -> Reference:
    """Learned path plus the smallest sideways bump, behind the disk, that clears its forecast by the margin."""
    time, w = movement.time, config.bump_width
    u = (time - config.duration / 2) / w
    shape = np.exp(-0.5 * u**2)
    shapes = [shape, -u / w * shape, (u**2 - 1) / w**2 * shape]
    need = config.radius + config.cdmp.margin
    parts: list[list[NDArray[Any]]] = [[], [], []]
    for i, (offset, speed) in enumerate(zip(config.offsets, config.speeds)):
        side = -np.sign(speed) if speed else -np.sign(offset) or 1.0
        for size in np.arange(0, 5, 0.05):
            bumped = movement.position + side * size * np.outer(shape, [0.0, 1.0])
            if np.linalg.norm(bumped - centre.position[:, i], axis=1).min() > need:
                break
        for part, base, bump in zip(parts, (movement.position, movement.velocity, movement.acceleration), shapes):
            part.append(base + side * size * np.outer(bump, [0.0, 1.0]))
    return Reference(*(np.stack(part, axis=1) for part in parts))


def _row(path: Path, distance: Array, goal: Array, run: int) -> dict[str, float]:
    last = int(np.flatnonzero(path.defined[:, run])[-1])
    return {
        "min_distance": float(np.nanmin(distance)),
        "goal_error": float(np.linalg.norm(path.position[last, run] - goal)),
        "defined": bool(path.defined[:, run].all()),
    }


def measure(recording: Recording, config: Config) -> Metrics:
    runs = recording.frames["runs"]
    return {
        "min_distance": float(runs.min_distance.min()),
        "distance_share": float(runs.min_distance.min() / config.radius),
        "goal_error": float(runs.goal_error.min()),
        "goal_error_worst": float(runs.goal_error.max()),
        "stepped_over": int((~runs.defined.astype(bool)).sum()),
    }
