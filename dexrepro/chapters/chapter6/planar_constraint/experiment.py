"""Planar map: the constrained primitive along its reference under every reading of the law (Fig. 6.2 d)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial import cKDTree

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import learning, plane
from dexrepro.control.motion import minimum_jerk_rates
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.primitives.constrained import Path, Reference
from dexrepro.primitives.dmp import Trajectory
from dexrepro.primitives.obstacles import clearance

RATE = 100.0


def simulate(config: Config, rng: Rng) -> Recording:
    lessons = plane.teach(config, rng("demonstrations"))
    durations = np.array([lesson.durations[1] for lesson in lessons])
    primitives = [lesson.second for lesson in lessons]
    steps = round(float(durations[0]) / config.step)
    movements = learning.nominal(primitives, durations, steps)
    references = [_strayed(plane.spline_reference(config, m)[0], m.time, config.reference.stray) for m in movements]
    # The same groups once more with other weights, in one batch, to see what the learned skill does to the path.
    stronger = [replace(p, weights=config.weight_factor * p.weights) for p in primitives]
    skill = learning.skill(primitives + stronger, movements + learning.nominal(stronger, durations, steps))
    reference = learning.stack(references * 2)
    dt = np.tile(durations / steps, 2)[:, None]
    learned = [p.weights.copy() for p in primitives]
    across = np.stack([_across(r) for r in references * 2])
    velocity = np.stack([p.time_constant * np.broadcast_to(p.velocity, p.goal.shape) for p in primitives * 2])
    velocity = velocity + skill.time_constant * config.start.speed * across
    path = learning.constrained(skill, reference, config.cdmp, dt, velocity, config.start.offset * across)
    changed = max(float(np.abs(p.weights - before).max()) for p, before in zip(primitives, learned))
    rows = [_row(path, reference, movements[group], group, lesson, config) for group, lesson in enumerate(lessons)]
    series = {
        "time": movements[0].time,
        "position": path.position[:, 0],
        "reference": reference.position[:, 0],
        "distance": path.distance[:, 0],
        "lyapunov": path.lyapunov[:, 0],
        "projected": path.projected[:, 0],
    }
    frames = {"groups": pd.DataFrame(rows).assign(weights_changed=changed)}
    left = frames["groups"].violated_from.min()
    status = "finished" if np.isnan(left) else f"left the tube at {left:.3f} s"
    return Recording(series=series, frames=frames, steps=steps, simulated=float(durations[0]), status=status)


def _across(reference: Reference) -> Array:
    """The direction (2,) across the reference in which it is first left, to the left of its way."""
    way = reference.position[20] - reference.position[0]
    return np.array([-way[1], way[0]]) / np.linalg.norm(way)


def _strayed(reference: Reference, time: Array, size: float) -> Reference:
    """The reference with its end moved by ``size`` [cm] along x, as smoothly as a minimum-jerk movement."""
    if not size:
        return reference
    span = time[-1] - time[0]
    share, rate, acceleration = minimum_jerk_rates((time[:, None] - time[0]) / span, span)
    shift = np.array([size, 0.0])
    return Reference(
        reference.position + shift * share,
        reference.velocity + shift * rate,
        reference.acceleration + shift * acceleration,
    )


def _row(
    path: Path, reference: Reference, movement: Trajectory, group: int, lesson: plane.Lesson, config: Config
) -> dict[str, Any]:
    """Numbers of one group; lengths in cm, times in s, from the start of sub-skill 2."""
    old, block = plane.obstacles(config)
    position, distance, v = path.position[:, group], path.distance[:, group], path.lyapunov[:, group]
    time = np.linspace(0, lesson.durations[1], len(distance))
    defined = np.isfinite(distance)
    limit = config.cdmp.margin if learning.scaled(config.cdmp) else config.cdmp.margin / config.cdmp.kz
    beyond = ~defined | (distance > limit * (1 + 1e-9))
    around = plane.preferred_arc(config)
    passing = [
        float(time[np.linalg.norm(reference.position[:, group] - end, axis=1).argmin()]) for end in around[[0, -1]]
    ]
    off = np.flatnonzero(defined & (distance > config.settled))
    peak = float(time[np.nanargmax(distance)])
    whole = bool(defined.all())
    extended = plane.extended_paths(config, lesson, 500)[1].position
    return {
        "e_max": float(np.nanmax(distance)),
        "violated_from": float(time[beyond.argmax()]) if beyond.any() else np.nan,
        "projections": int(path.projected[:, group].sum()),
        "altered": int(path.altered[:, group].sum()),
        "peak_in_arc": float(passing[0] - 0.3 <= peak <= passing[1] + 0.3) if whole else np.nan,
        "settle_after_arc": max(0.0, float(time[off[-1]]) - passing[1] if off.size else 0.0) if whole else np.nan,
        "goal_error": float(np.linalg.norm(position[-1] - lesson.second.goal)) if whole else np.nan,
        "clearance": clearance(position, [*old, block]) if whole else np.nan,
        "modified_share": _modified(position, movement.position, config.settled) if whole else np.nan,
        "extended_modified_share": _modified(extended, movement.position, config.settled),
        "v_rises": float((np.diff(v) > 1e-3 * v[:-1] + 1).sum()) if whole else np.nan,
        "v_max": float(np.nanmax(v)) if np.isfinite(v).any() else np.nan,
        "weight_effect": float(np.nanmax(np.abs(path.position[:, group + config.demonstrations.groups] - position))),
    }


def _modified(path: Array, original: Array, tolerance: float) -> float:
    """Share of a path that lies farther than ``tolerance`` [cm] from the original one, wherever it passes."""
    return float(np.mean(cKDTree(original).query(path[::5])[0] > tolerance))


WORST = {"e_max": "max", "projections": "max", "altered": "max", "peak_in_arc": "mean", "settle_after_arc": "max",
         "goal_error": "max", "clearance": "min", "modified_share": "max", "extended_modified_share": "min",
         "v_rises": "max", "v_max": "max", "weight_effect": "max", "weights_changed": "max"}  # fmt: skip
"""What stands for all groups; undefined where it is for one of them."""


def measure(recording: Recording, config: Config) -> Metrics:
    groups, c = recording.frames["groups"], config.cdmp
    metrics: Metrics = {
        name: float(groups[name].agg(how)) if groups[name].notna().all() else None for name, how in WORST.items()
    }
    left = groups.violated_from
    # Without forcing (6.1) has the poles of tau^2 p^2 + alpha_z tau p + alpha_z beta_z; those of the error under the
    # law, with the barrier left out, are -k_z/d_z and -k_2.
    first, second = c.kz / c.dz, c.k2
    return metrics | {
        "e_share": float(groups.e_max.max() / c.margin),
        "violated_groups": int(left.notna().sum()),
        "violated_from": float(left.min()) if left.notna().any() else None,
        "damping_primitive": config.dmp.alpha_z / (2 * np.sqrt(config.dmp.alpha_z * config.dmp.beta_z)),
        "damping_error": (first + second) / (2 * np.sqrt(first * second)),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Share by which the barrier (weight 1) changes the largest distance with tau = duration."""
    if not {"feedforward", "no_barrier"} <= set(metrics):
        return {}
    with_barrier, without = (float(metrics[case]["e_max"] or 0) for case in ("feedforward", "no_barrier"))
    return {"barrier_effect": abs(with_barrier - without) / without}
