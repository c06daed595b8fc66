"""Staying outside of an obstacle: the outside law, the filter, and a tube about a detour (Table 6.2, Sect. 6.5)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import learning
from dexrepro.control.motion import minimum_jerk
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.primitives.barrier import Constraint
from dexrepro.primitives.constrained import Path, Reference, rollout
from dexrepro.primitives.dmp import DMP, Trajectory

RATE = 100.0


def simulate(config: Config, rng: Rng) -> Recording:
    primitive = _reach(config)
    movement = primitive.rollout(config.step, horizon=config.duration)
    runs = len(config.offsets)
    time = movement.time
    centres = [_obstacles(config, time, index) for index in range(len(config.places))]
    skill = learning.skill([primitive] * runs, [movement] * runs)
    start = np.broadcast_to(primitive.start, (runs, 2)), np.zeros((runs, 2))
    c = config.cdmp
    if config.route == "detour":
        reference = _detour(config, movement, centres)
        constraint = learning.tube(c, c.margin)
    else:
        reference = centres[0]
        bound = c.kz * config.radius
        constraint = Constraint(False, bound, weight=learning.weight(c, bound))
    path = rollout(skill, reference, constraint, learning.gains(c), learning.law(c), config.step, *start)
    distance = np.min([np.linalg.norm(path.position - c.position, axis=-1) for c in centres], axis=0)
    rows = [_row(path, distance[:, i], time, primitive.goal, i) for i in range(runs)]
    series = {
        "time": time,
        "position": path.position.reshape(len(time), -1),
        "centre": centres[0].position.reshape(len(time), -1),
    }
    series["distance"] = distance
    frame = pd.DataFrame(rows)
    left = frame.left_at.min()
    status = "finished" if np.isnan(left) else f"stepped over the barrier at {left:.3f} s"
    return Recording(series=series, frames={"runs": frame}, steps=len(time), simulated=float(time[-1]), status=status)


def _reach(config: Config) -> DMP:
    """Primitive of a straight minimum-jerk reach along x [cm]."""
    time = np.linspace(0, config.duration, 201)
    path = np.stack([config.reach * minimum_jerk(time / config.duration), np.zeros_like(time)], axis=1)
    return learning.learn(time, path + config.perturbation, config.dmp)


def _passing(config: Config, place: float) -> float:
    """When the reach passes a share ``place`` of its way [s]."""
    u = np.linspace(0, 1, 2001)
    return config.duration * float(np.interp(place, minimum_jerk(u), u))


def _obstacles(config: Config, time: Array, index: int) -> Reference:
    """Centres of the disks at a place of the reach plus an offset, on one side and the other in turn.

    They cross the reach with their speeds as it passes.
    """
    place, side = config.places[index], (-1) ** index
    offsets, speeds = side * np.array(config.offsets, float), side * np.array(config.speeds, float)
    position = np.zeros((len(time), len(offsets), 2))
    position[..., 0] = config.reach * place
    position[..., 1] = offsets + speeds * (time[:, None] - _passing(config, place))
    velocity = np.zeros_like(position)
    velocity[..., 1] = speeds
    return Reference(position, velocity, np.zeros_like(position))


def _detour(config: Config, movement: Trajectory, centres: list[Reference]) -> Reference:
    """Learned path plus sideways bumps, behind each disk, the smallest that clear its forecast by the margin."""
    w, need = config.bump_width, config.radius + config.cdmp.margin
    parts: list[list[Array]] = [[], [], []]
    for i, (offset, speed) in enumerate(zip(config.offsets, config.speeds)):
        found = [part.copy() for part in (movement.position, movement.velocity, movement.acceleration)]
        for index, (place, centre) in enumerate(zip(config.places, centres)):
            u = (movement.time - _passing(config, place)) / w
            shape = np.exp(-0.5 * u**2)
            shapes = [shape, -u / w * shape, (u**2 - 1) / w**2 * shape]
            side = (-1) ** index * (-np.sign(speed) if speed else -np.sign(offset) or 1.0)
            for size in np.arange(0, 5, 0.05):
                bumped = found[0] + side * size * np.outer(shape, [0.0, 1.0])
                if np.linalg.norm(bumped - centre.position[:, i], axis=1).min() > need:
                    break
            found = [part + side * size * np.outer(bump, [0.0, 1.0]) for part, bump in zip(found, shapes)]
        for kept, part in zip(parts, found):
            kept.append(part)
    return Reference(*(np.stack(part, axis=1) for part in parts))


def _row(path: Path, distance: Array, time: Array, goal: Array, run: int) -> dict[str, float]:
    """One run; where its law became undefined it has no goal error, and ``left_at`` [s] says when."""
    last = int(np.flatnonzero(path.defined[:, run])[-1])
    whole, far = last == len(time) - 1, float(np.linalg.norm(path.position[last, run] - goal))
    return {
        "min_distance": float(np.nanmin(distance)),
        "goal_error": far if whole else np.nan,
        "last_distance": far,
        "left_at": np.nan if whole else float(time[last + 1]),
    }


def measure(recording: Recording, config: Config) -> Metrics:
    runs = recording.frames["runs"]
    lost = runs.left_at.notna()
    return {
        "min_distance": float(runs.min_distance.min()),
        "distance_share": float(runs.min_distance.min() / config.radius),
        "goal_error": None if lost.all() else float(runs.goal_error.min()),
        "goal_error_worst": None if lost.any() else float(runs.goal_error.max()),
        "last_distance": float(runs.last_distance.min()),
        "stepped_over": int(lost.sum()),
        "stepped_over_at": float(runs.left_at.min()) if lost.any() else None,
    }
