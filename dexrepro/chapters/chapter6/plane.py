"""The planar map of experiment 1: obstacles, demonstrations, the two learned sub-skills and their references."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.chapters.chapter6 import learning
from dexrepro.chapters.demonstrations import corners, recorded
from dexrepro.errors import InputError
from dexrepro.experiment import Config
from dexrepro.humans.segmentation import change_point, slowest_point
from dexrepro.humans.waypoints import Drawing, average, draw
from dexrepro.primitives.constrained import Reference
from dexrepro.primitives.dmp import DMP, Trajectory
from dexrepro.primitives.obstacles import Polygon, clearance
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
        """Estimated minus true cut [s] of each demonstration whose pause is known."""
        return np.array([cut - one.pauses[0] for cut, one in zip(self.cuts, self.drawings) if len(one.pauses)])


def obstacles(config: Config) -> tuple[list[Polygon], Polygon]:
    """The old obstacles and the additional block: of the map, or the user's own."""
    old, block = [Polygon.rectangle(*box) for box in config.map.boxes], Polygon(np.array(config.map.block, float))
    if config.map.get("obstacle_files"):
        old = [Polygon(found) for found in corners(config.map.obstacle_files, config, "map.obstacle_files")]
    if config.map.get("block_file"):
        block = Polygon(corners(config.map.block_file, config, "map.block_file")[0])
    return old, block


def teach(config: Config, rng: np.random.Generator) -> list[Lesson]:
    """``demonstrations.groups`` independent groups of demonstrations, each learned; the user's own are one group."""
    groups = 1 if config.demonstrations.get("files") else config.demonstrations.groups
    return [_lesson(config, rng) for _ in range(groups)]


def _drawings(config: Config, rng: np.random.Generator) -> list[Drawing]:
    """The user's drawings, of which nobody says where they pause, or else those of a synthetic person."""
    d = config.demonstrations
    if d.get("files"):
        time = np.arange(round(200 * d.duration) + 1) / 100
        return [Drawing(time, path, np.empty(0)) for path in recorded(d.files, d.count, len(time), config, axes=2)]
    strokes = [np.array(points, float) for points in d.strokes]
    strokes[1] += np.outer([0.0, *np.ones(len(strokes[1]) - 2), 0.0], [0.0, d.lift])
    drawings = []
    for _ in range(d.count):
        paces = d.duration * (1 + 0.08 * rng.normal(size=2))
        drawings.append(draw(strokes, paces, rng, d.spread, d.tremor))
    return drawings


def _lesson(config: Config, rng: np.random.Generator) -> Lesson:
    drawings = [replace(w, position=w.position * (1 + config.perturbation)) for w in _drawings(config, rng)]
    cut = CUTS[config.segmentation]
    cuts = [cut(drawing.time, drawing.position) for drawing in drawings]
    halves = []
    for keep in (np.less_equal, np.greater_equal):
        pieces = [(w.time[keep(w.time, cut)], w.position[keep(w.time, cut)]) for w, cut in zip(drawings, cuts)]
        halves.append(average(pieces))
    durations = np.array([time[-1] for time, _ in halves])
    return Lesson(drawings, cuts, durations, *(learning.learn(time, path, config.dmp) for time, path in halves))


def preferred_arc(config: Config) -> Array:
    """The operator's points round the new block, in the direction of travel."""
    a = config.reference.arc
    return arc(a.centre, a.radius, np.radians(a.angles[0]), np.radians(a.angles[1]))


def spline_reference(config: Config, movement: Trajectory) -> tuple[Reference, Array, tuple[int, int]]:
    """Reference by interpolation for sub-skill 2 on the movement's grid.

    Also its 100 samples and the indices where the movement is left and resumed.
    """
    around, path = preferred_arc(config), movement.position
    leave, resume = _passage(config, around, path)
    at, points = detour(movement.time, path, around, leave, resume)
    return differentiable(at, points, movement.time), points, (leave, resume)


def _passage(config: Config, around: Array, path: Array) -> tuple[int, int]:
    """Where a path (n, 2) is left for the arc and resumed after it, along the way from the arc's start to its end."""
    along = (around[-1] - around[0]) / np.linalg.norm(around[-1] - around[0])
    progress, (enter, end) = path @ along, around[[0, -1]] @ along
    leave = int(np.argmax(progress > enter - config.reference.gap_in)) - 1
    return leave, int(np.argmax(progress > end + config.reference.gap_out))


def check_arc(config: Config, path: Array) -> None:
    """Raises InputError, with an arc that would do, where the operator's does not lead a path round the new block."""
    (old, block), given = obstacles(config), config.reference.arc
    leave, resume = _passage(config, preferred_arc(config), path)
    if np.linalg.norm(block.vertices - given.centre, axis=1).max() <= given.radius and 0 <= leave < resume:
        return
    centre = _rounded(block.centroid)
    size = float(np.linalg.norm(block.vertices - centre, axis=1).max())
    radius = float(_rounded(size + min(1.0, size / 2)))
    inside = np.flatnonzero(np.linalg.norm(path - centre, axis=1) < radius)
    if not len(inside) or inside[0] == 0 or inside[-1] == len(path) - 1:
        key = "map.block_file" if config.map.get("block_file") else "map.block"
        start, middle, goal = path[0], path[len(path) // 2], path[-1]
        room = min(float(np.linalg.norm(middle - end)) for end in (start, goal))
        vertices = _rounded(middle + min(1.0, room / 5 / size) * (block.vertices - block.centroid))
        moved = f"planar_skill.map.block={vertices.tolist()}".replace(", ", ",")
        way = [f"({x:.4g}, {y:.4g})" for x, y in (centre, start, middle, goal)]
        raise InputError(
            f"{key}: the new block about {way[0]} cm must lie across the second of the two sub-skills into which the "
            f"demonstrations are cut, from {way[1]} over {way[2]} to {way[3]} cm, away from its ends; set {moved}"
            + " planar_skill.map.block_file=null"
            * (key == "map.block_file")
        )
    first, last = (np.degrees(np.arctan2(*(path[k] - centre)[::-1])) for k in inside[[0, -1]])
    turns = [[first, first + (last - first) % 360], [first, first - (first - last) % 360]]
    angles = max(turns, key=lambda turn: clearance(arc(centre, radius, *np.radians(turn)), old))
    words = {"arc.centre": centre.tolist(), "arc.radius": radius, "arc.angles": [round(float(a), 1) for a in angles]}
    gap = float(_rounded(0.55 * radius))
    words |= {key: gap for key in ("gap_in", "gap_out") if config.reference[key] > gap}
    raise InputError(
        "reference.arc: it does not lead round the new block; set "
        + " ".join(f"planar_skill.reference.{key}={value}".replace(", ", ",") for key, value in words.items())
    )


def _rounded(values: Any) -> Array:
    """Values to six digits, as they are offered for a key."""
    return np.vectorize(lambda value: float(f"{value:.6g}"))(values)


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
    axes.set(aspect="equal", xlabel="x [cm]")
    if not config.demonstrations.get("files"):
        axes.set(xlim=(0, 20), ylim=(0, 16.3))
