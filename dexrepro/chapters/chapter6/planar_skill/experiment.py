"""Planar map: two sub-skills learned from demonstrations, and two ways to a reference path (Figs. 6.1, 6.2 a-c)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter6 import plane
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.segmentation import pauses
from dexrepro.humans.waypoints import Drawing
from dexrepro.primitives.obstacles import Polygon, clearance
from dexrepro.primitives.reference_path import lagrange

RATE = 0.0


def simulate(config: Config, rng: Rng) -> Recording:
    lessons = plane.teach(config, rng("demonstrations"))
    rows, frames = [], {}
    for group, lesson in enumerate(lessons):
        row, lines = _study(config, lesson)
        rows.append(row)
        if group == 0:
            frames = lines
    return Recording(frames={"groups": pd.DataFrame(rows), **frames}, steps=len(lessons))


def _study(config: Config, lesson: plane.Lesson) -> tuple[dict[str, float], dict[str, pd.DataFrame]]:
    """Numbers of one group of demonstrations, and the lines to draw."""
    old, block = plane.obstacles(config)
    steps = config.samples
    first, second = (
        skill.rollout(duration / steps, horizon=duration)
        for skill, duration in zip((lesson.first, lesson.second), lesson.durations)
    )
    plane.check_arc(config, second.position)
    reference, samples, (leave, resume) = plane.spline_reference(config, second)
    movements = plane.extended_paths(config, lesson, steps)
    extended = [movement.position for movement in movements]
    goal = lesson.second.goal + config.moved
    moved = lesson.second.rollout(lesson.durations[1] / steps, horizon=lesson.durations[1], goal=goal)
    inside = np.concatenate([lies_inside(path, [*old, block]) for path in extended])
    inside_old = np.concatenate([lies_inside(path, old) for path in extended])
    found = [pauses(drawing.time, drawing.position) for drawing in lesson.drawings]
    known = {} if config.demonstrations.files else {
        "segmentation_error": np.abs(lesson.segmentation_errors).max(),
        "pause_error": max(abs(t - w.pauses[0]) for times, w in zip(found, lesson.drawings) for t in times or [np.inf]),
        "pauses_in_one": max(len(_second_alone(drawing)) for drawing in lesson.drawings),
    }  # fmt: skip
    row = {
        **known,
        "pauses_fewest": min(map(len, found)),
        "pauses_most": max(map(len, found)),
        "clearance_new": clearance(second.position, [block]),
        "clearance_old": min(clearance(first.position, old), clearance(second.position, old)),
        "clearance_first_new": clearance(first.position, [block]),
        "clearance_reference": clearance(reference.position, [*old, block]),
        "acceleration_reference": _largest(reference.acceleration),
        "acceleration_extended": max(_largest(movement.acceleration) for movement in movements),
        "moved_goal_reference": float(np.linalg.norm(reference.position[-1] - goal)),
        "moved_goal_extended": float(np.linalg.norm(moved.position[-1] - goal)),
        "kept_share": 1 - (resume - leave) / len(second.position),
        "clearance_extended_1": clearance(extended[0], [*old, block]),
        "clearance_extended_2": clearance(extended[1], [*old, block]),
        **{f"clearance_extended_{i}_old": clearance(path, old) for i, path in enumerate(extended, 1)},
        "inside_share_extended": float(inside.mean()),
        "inside_share_extended_old": float(inside_old.mean()),
        "goal_error": float(np.linalg.norm(second.position[-1] - lesson.second.goal)),
        "late_drift": _late_drift(lesson),
        "lagrange_deviation": _lagrange_deviation(samples),
    }
    lines = {
        "first": first.position,
        "second": second.position,
        "reference": samples,
        "reserved": np.vstack([second.position[: leave + 1], [[np.nan, np.nan]], second.position[resume:]]),
        "extended_1": extended[0],
        "extended_2": extended[1],
        **{f"demonstration_{i}": drawing.position for i, drawing in enumerate(lesson.drawings)},
    }
    return row, {
        name: pd.DataFrame(line[:: max(1, len(line) // 400)], columns=["x", "y"]) for name, line in lines.items()
    }


def _second_alone(drawing: Drawing) -> list[float]:
    """Pauses found in the second stroke alone, which has none."""
    later = drawing.time > drawing.pauses[0] + 0.3
    return pauses(drawing.time[later], drawing.position[later])


def _largest(acceleration: Any) -> float:
    return float(np.linalg.norm(acceleration, axis=1).max())


def lies_inside(path: Any, polygons: list[Polygon]) -> Any:
    return np.any([polygon.contains(path) for polygon in polygons], axis=0)


def _late_drift(lesson: plane.Lesson) -> float:
    """Largest distance from the goal between the end of sub-skill 2 and 1.5 times its duration [cm] (E6.15)."""
    skill, duration = lesson.second, lesson.durations[1]
    late = skill.rollout(duration / 400, horizon=1.5 * duration).position[400:]
    return float(np.linalg.norm(late - skill.goal, axis=1).max())


def _lagrange_deviation(samples: Any) -> float:
    """Distance of the reference from the polynomial through 15 of its points [cm] (E6.19)."""
    u = np.linspace(-1, 1, len(samples))
    nodes = np.linspace(0, len(samples) - 1, 15).round().astype(int)
    return float(np.linalg.norm(lagrange(u[nodes], samples[nodes], u) - samples, axis=1).max())


def measure(recording: Recording, config: Config) -> Metrics:
    groups = recording.frames["groups"]
    metrics: Metrics = {f"{name}_min": float(column.min()) for name, column in groups.items()}
    metrics |= {f"{name}_max": float(column.max()) for name, column in groups.items()}
    return metrics
