"""The planar map of experiment 1: obstacles, demonstrations, the two learned sub-skills and their references."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.chapters.chapter6 import learning
from dexrepro.experiment import Config
from dexrepro.humans.segmentation import change_point, slowest_point
from dexrepro.humans.waypoints import Drawing, average, draw
from dexrepro.primitives.constrained import Reference
from dexrepro.primitives.dmp import DMP, Trajectory
from dexrepro.primitives.obstacles import Polygon
from dexrepro.primitives.reference_path import arc, detour, differentiable

CUTS = {"ruptures": change_point, "slowest": slowest_point}


@dataclass(frozen=True)
class Lesson:
    """One group of demonstrations: the drawings, where they were cut, and the two sub-skills learned from them."""

    drawings: list[Drawing]
    cuts: list[float]
    durations: Array
    first: DMP
    second: DMP

    @property
    def segmentation_errors(self) -> Array:
        """Estimated minus true cut [s] of each demonstration."""
        return np.array([cut - drawing.pauses[0] for cut, drawing in zip(self.cuts, self.drawings)])


def obstacles(config: Config) -> tuple[list[Polygon], Polygon]:
    """The old obstacles and the additional block."""
    old = [Polygon.rectangle(*box) for box in config.map.boxes]
    return old, Polygon(np.array(config.map.block, float))


def teach(config: Config, rng: np.random.Generator) -> list[Lesson]:
    """``demonstrations.groups`` independent groups of demonstrations, each learned."""
    return [_lesson(config, rng) for _ in range(config.demonstrations.groups)]


def _lesson(config: Config, rng: np.random.Generator) -> Lesson:
    d = config.demonstrations
    strokes = [np.array(points, float) for points in d.strokes]
    strokes[1] += np.outer([0.0, *np.ones(len(strokes[1]) - 2), 0.0], [0.0, d.lift])
    drawings = []
    for _ in range(d.count):
        paces = d.duration * (1 + 0.08 * rng.normal(size=2))
        drawings.append(draw(strokes, paces, rng, d.spread, d.tremor))
    drawings = [replace(w, position=w.position * (1 + config.perturbation)) for w in drawings]
    cut = CUTS[config.segmentation]
    cuts = [cut(drawing.time, drawing.position) for drawing in drawings]
    halves = []
    for keep in (np.less_equal, np.greater_equal):
        pieces = [(w.time[keep(w.time, cut)], w.position[keep(w.time, cut)]) for w, cut in zip(drawings, cuts)]
        halves.append(average(pieces))
    durations = np.array([time[-1] for time, _ in halves])
    return Lesson(drawings, cuts, durations, *(learning.learn(time, path, config.dmp) for time, path in halves))


def preferred_arc(config: Config) -> Array:
    """The operator's points round the new block, in the direction of travel (towards smaller x)."""
    a = config.reference.arc
    return arc(a.centre, a.radius, np.radians(a.angles[0]), np.radians(a.angles[1]))


def spline_reference(config: Config, movement: Trajectory) -> tuple[Reference, Array, tuple[int, int]]:
    """Reference by interpolation for sub-skill 2 on the movement's grid.

    Also its 100 samples and the indices where the movement is left and resumed.
    """
    around, path = preferred_arc(config), movement.position
    leave = int(np.argmax(path[:, 0] < around[0, 0] + config.reference.gap_in)) - 1
    resume = int(np.argmax(path[:, 0] < around[-1, 0] - config.reference.gap_out))
    at, points = detour(movement.time, path, around, leave, resume)
    return differentiable(at, points, movement.time), points, (leave, resume)


def extended_paths(config: Config, lesson: Lesson, steps: int) -> list[Trajectory]:
    """Reference by extended primitives: new goals and starts for the learned sub-skills.

    "subskill": sub-skill 1 ends at the arc's start, sub-skill 2 begins at its end. "local": sub-skill 2 is cut at the
    points where the spline leaves it, and only its two parts are relearned and stretched to the arc.
    """
    around = preferred_arc(config)
    first, second = lesson.first, lesson.second
    if config.reference.intervals == "subskill":
        one = first.rollout(lesson.durations[0] / steps, horizon=lesson.durations[0], goal=around[0])
        two = second.rollout(lesson.durations[1] / steps, horizon=lesson.durations[1], start=around[-1])
        return [one, two]
    movement = second.rollout(lesson.durations[1] / steps, horizon=lesson.durations[1])
    _, _, (leave, resume) = spline_reference(config, movement)
    paths = []
    for part, goal, start in ((slice(0, leave + 1), around[0], None), (slice(resume, None), None, around[-1])):
        time = movement.time[part] - movement.time[part][0]
        pieces = max(1, len(time) // 100)
        piece = learning.learn(time[::pieces], movement.position[part][::pieces], config.dmp)
        paths.append(piece.rollout(time[-1] / steps, horizon=time[-1], start=start, goal=goal))
    return paths


def draw_map(axes: Any, config: Config, reference: bool = True) -> None:
    """Obstacles in orange, the additional block in light blue and the operator's arc, in cm."""
    old, block = obstacles(config)
    for polygon in old:
        axes.fill(*polygon.vertices.T, color="#F3C78D", linewidth=0)
    axes.fill(*block.vertices.T, color="#A8DCF0", linewidth=0)
    if reference:
        axes.plot(*preferred_arc(config).T, "o", color="#0072B2", markersize=1.2)
    axes.set(aspect="equal", xlim=(0, 20), ylim=(0, 16.3), xlabel="x [cm]")
