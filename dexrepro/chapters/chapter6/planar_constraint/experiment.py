"""Planar map: the constrained primitive along its reference under every reading of the law (Fig. 6.2 d)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import learning, plane
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.primitives.constrained import Path, Reference
from dexrepro.primitives.obstacles import clearance

RATE = 100.0


def simulate(config: Config, rng: Rng) -> Recording:
    lessons = plane.teach(config, rng("demonstrations"))
    durations = np.array([lesson.durations[1] for lesson in lessons])
    primitives = [lesson.second for lesson in lessons]
    steps = round(float(durations[0]) / config.step)
    movements = learning.nominal(primitives, durations, steps)
    references = [plane.spline_reference(config, movement)[0] for movement in movements]
    # The same groups once more with other weights, in one batch, to see what the learned skill does to the path.
    stronger = [replace(p, weights=config.weight_factor * p.weights) for p in primitives]
    skill = learning.skill(primitives + stronger, movements + learning.nominal(stronger, durations, steps))
    reference = learning.stack(references * 2)
    dt = np.tile(durations / steps, 2)[:, None]
    learned = [p.weights.copy() for p in primitives]
    path = learning.constrained(skill, reference, config.cdmp, dt, _start(primitives * 2))
    changed = max(float(np.abs(p.weights - before).max()) for p, before in zip(primitives, learned))
    rows = [_row(path, reference, group, lesson, config) for group, lesson in enumerate(lessons)]
    series = {
        "time": movements[0].time,
        "position": path.position[:, 0],
        "reference": reference.position[:, 0],
        "distance": path.distance[:, 0],
        "lyapunov": path.lyapunov[:, 0],
        "projected": path.projected[:, 0],
    }
    frames = {"groups": pd.DataFrame(rows).assign(weights_changed=changed)}
    return Recording(series=series, frames=frames, steps=steps, simulated=float(durations[0]))


def _start(primitives: list[Any]) -> Array:
    return np.stack([p.time_constant * np.broadcast_to(p.velocity, p.goal.shape) for p in primitives])


def _row(path: Path, reference: Reference, group: int, lesson: plane.Lesson, config: Config) -> dict[str, Any]:
    """Numbers of one group; lengths in cm, times in s, from the start of sub-skill 2."""
    old, block = plane.obstacles(config)
    position, distance, v = path.position[:, group], path.distance[:, group], path.lyapunov[:, group]
    time = np.linspace(0, lesson.durations[1], len(distance))
    defined = np.isfinite(distance)
    limit = config.cdmp.margin if config.cdmp.bound_scaling == "scaled" else config.cdmp.margin / config.cdmp.kz
    beyond = ~defined | (distance > limit * (1 + 1e-9))
    around = plane.preferred_arc(config)
    passing = [
        float(time[np.linalg.norm(reference.position[:, group] - end, axis=1).argmin()]) for end in around[[0, -1]]
    ]
    off = np.flatnonzero(defined & (distance > config.settled))
    peak = float(time[np.nanargmax(distance)])
    whole = bool(defined.all())
    return {
        "e_max": float(np.nanmax(distance)),
        "violated_from": float(time[beyond.argmax()]) if beyond.any() else np.nan,
        "projections": int(path.projected[:, group].sum()),
        "altered": int(path.altered[:, group].sum()),
        "peak_in_arc": bool(passing[0] - 0.3 <= peak <= passing[1] + 0.3),
        "settle_after_arc": max(0.0, float(time[off[-1]]) - passing[1]) if whole and off.size else 0.0,
        "goal_error": float(np.linalg.norm(position[-1] - lesson.second.goal)) if whole else np.nan,
        "clearance": clearance(position, [*old, block]) if whole else np.nan,
        "v_rises": int((np.diff(v[defined]) > 1e-3 * v[defined][:-1] + 1).sum()),
        "v_max": float(np.nanmax(v)) if np.isfinite(v).any() else np.nan,
        "weight_effect": float(np.nanmax(np.abs(path.position[:, group + config.demonstrations.groups] - position))),
    }


def measure(recording: Recording, config: Config) -> Metrics:
    groups = recording.frames["groups"]
    defined = groups.notna().all(axis=0)
    return {
        "e_max": float(groups.e_max.max()),
        "e_share": float(groups.e_max.max() / config.cdmp.margin),
        "violated_groups": int(groups.violated_from.notna().sum()),
        "violated_from": float(groups.violated_from.min()) if groups.violated_from.notna().any() else None,
        "projections": int(groups.projections.max()),
        "altered": int(groups.altered.max()),
        "peak_in_arc": float(groups.peak_in_arc.mean()),
        "settle_after_arc": float(groups.settle_after_arc.max()),
        "goal_error": float(groups.goal_error.max()) if defined.goal_error else None,
        "clearance": float(groups.clearance.min()) if defined.clearance else None,
        "v_rises": int(groups.v_rises.min()),
        "v_max": float(groups.v_max.max()) if defined.v_max else None,
        "weight_effect": float(groups.weight_effect.max()),
        "weights_changed": float(groups.weights_changed.max()),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Share by which the barrier (weight 1) changes the largest distance with tau = duration."""
    if not {"feedforward", "no_barrier"} <= set(metrics):
        return {}
    with_barrier, without = (float(metrics[case]["e_max"] or 0) for case in ("feedforward", "no_barrier"))
    return {"barrier_effect": abs(with_barrier - without) / without}
