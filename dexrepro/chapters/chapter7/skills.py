"""What the experiments of this chapter share: one person's demonstrations, the skills learned from them, new tasks.

Paths are in centimetres on the board. All demonstrations and EMG traces are synthetic.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.chapters.demonstrations import check_by_name, recorded
from dexrepro.control.contract import printed_forms
from dexrepro.errors import InputError, nearest, refused
from dexrepro.experiment import Config
from dexrepro.humans.muscle import Muscle, low_pass
from dexrepro.humans.reaching import Obstacle, Reach, Reacher
from dexrepro.networks.fuzzy import FuzzySystem
from dexrepro.primitives import GaussianKernels, SpringDamper, phase
from dexrepro.primitives.incremental import ExtendedKernels
from dexrepro.primitives.reactive import Styles, path_scaling, ridge_weights


def generator(config: Config, purpose: str) -> np.random.Generator:
    """Random numbers of one purpose, the same in all experiments: the chapter has one person and one set of nodes."""
    return np.random.default_rng(np.random.SeedSequence([config.seed, zlib.crc32(f"chapter7 {purpose}".encode())]))


@dataclass(frozen=True)
class Condition:
    """One row of the rule table: labels of distance, height and direction, and what they stand for."""

    labels: tuple[str, str, str]
    obstacle: Obstacle
    distance: float
    direction: float

    @property
    def name(self) -> str:
        distance, height, direction = self.labels
        return f"{height}/{distance} {direction}"

    @property
    def inputs(self) -> dict[str, float]:
        return {"distance": self.distance, "height": self.obstacle.height, "direction": self.direction}


def reach(config: Config, part: str = "scene") -> Reach:
    """The task of the demonstrations, or the new ``task``."""
    start, goal = config[part].start, config[part].goal
    if start == goal:
        raise refused(f"{part}.goal", goal, f"be another place than {part}.start")
    return Reach(start, goal)


def conditions(config: Config) -> list[Condition]:
    """Conditions of Table 7.1 in the order of the rules."""
    scene, result = config.scene, []
    for name in ("far", "close"):
        if not 0.02 < reach(config).locate(scene[name])[0] < 0.98:
            raise InputError(
                f"scene.{name} = {_point(scene[name])} is not allowed: the reach from {_point(scene.start)} to "
                f"{_point(scene.goal)} cm must pass it; set {moved_scene(scene.start, scene.goal)}"
            )
    for labels in config.fuzzy.rules:
        distance, height, direction = labels
        obstacle = Obstacle(scene[distance], scene[height], scene.cube)
        away = float(np.hypot(*np.subtract(obstacle.position, scene.start)))
        result.append(Condition(tuple(labels), obstacle, away, scene[direction]))
    return result


def person(config: Config) -> Reacher:
    samples = round(config.demonstration.duration * config.demonstration.rate) + 1
    return Reacher(**config.person, tool_radius=config.scene.tool_radius, samples=samples,
                   directions=[config.scene[name] for name in ("left", "forward", "right")],
                   heights=[config.scene.low, config.scene.tall])  # fmt: skip


def muscle(config: Config) -> Muscle:
    return Muscle(**config.muscle, heights=[config.scene.low, config.scene.tall])


def demonstrate(config: Config) -> tuple[Array, Array]:
    """Ordinary reaches (repetitions, N, 3) and reactions (conditions, repetitions, N, 3) [cm]."""
    rng, count = generator(config, "demonstrations"), config.demonstration.repetitions
    someone, task = person(config), reach(config)
    ordinary = someone.demonstrate_ordinary(task, count, rng)
    if config.get("demonstrations"):
        ordinary = recorded_reaches(config, ordinary.shape)
    try:
        reactions = [someone.demonstrate(task, c.obstacle, c.direction, count, rng) for c in conditions(config)]
    except RuntimeError as error:
        raise InputError(f"scene: {error}; set {moved_scene(config.scene.start, config.scene.goal)}") from error
    return moved(config, ordinary), moved(config, np.array(reactions))


def recorded_reaches(config: Config, shape: tuple[int, ...]) -> Array:
    """The user's ordinary reaches, (repetitions, N, 3) [cm], heights counted from where each begins.

    Raises InputError where one does not join the ends of the task, to within 1 cm.
    """
    count, samples, axes = shape
    paths = np.array(recorded(config.demonstrations, count, samples, config, axes))
    paths[..., 2] -= paths[:, :1, 2]
    ends, wanted = paths[:, [0, -1]], np.array(reach(config).ends)
    if np.abs(ends[..., 2]).max() > 1.0:
        raise InputError(f"demonstrations: they end {ends[:, 1, 2].max():.3g} cm above their start; it must be as high")
    if np.linalg.norm(ends - ends.mean(axis=0), axis=-1).max() > 1.0:
        raise InputError("demonstrations: their starts, or their goals, lie more than 1 cm from their mean")
    if np.linalg.norm(ends - wanted, axis=-1).max() > 1.0:
        start, goal = ends.mean(axis=0)[:, :2]
        if _point(start) == _point(goal):
            raise InputError(f"demonstrations: their start and their goal are the same place, {_point(start)} cm")
        raise InputError(
            f"demonstrations: they go from {_point(start)} to {_point(goal)} cm instead of from {_point(wanted[0])} to "
            f"{_point(wanted[1])} cm; set {moved_scene(start, goal)}"
        )
    return paths


def with_recorded_reactions(config: Config, reactions: Array) -> Array:
    """The same (conditions, repetitions, N, 3) [cm] with the user's own in the place of some, by condition."""
    known = {"_".join(c.labels): index for index, c in enumerate(conditions(config))}
    check_by_name(config.reactions, "reactions", next(iter(known)))
    for name, files in (config.reactions or {}).items():
        if name not in known:
            raise InputError(f"reactions: unknown condition '{name}': {nearest(name, known)}")
        try:
            own = recorded_reaches(Config({**config, "demonstrations": files}), reactions.shape[1:])
        except InputError as error:
            raise InputError(str(error).replace("demonstrations", f"reactions.{name}", 1)) from error
        reactions[known[name]] = moved(config, own)
    return reactions


def moved_scene(start: ArrayLike, goal: ArrayLike) -> str:
    """Overrides that take the book's scene to another way (2,), (2,) [cm]: the obstacles stand at the same share of
    it, and are smaller where it is short."""
    configuration = import_module("dexrepro.config")  # by name: what words a sentence is no part of a case's key
    scene = Config.of(configuration.compose_chapter("7")["shared"]["scene"])
    old, new = (np.array(ends, dtype=float) @ (1, 1j) for ends in ((scene.start, scene.goal), (start, goal)))
    turn = (new[1] - new[0]) / (old[1] - old[0])
    places = {
        name: new[0] + turn * (np.dot(scene[name], (1, 1j)) - old[0]) for name in ("start", "goal", "far", "close")
    }
    words = [f"shared.scene.{name}=[{z.real + 0:.3g},{z.imag + 0:.3g}]" for name, z in places.items()]
    if abs(turn) < 0.8:
        words += [f"shared.scene.{name}={abs(turn) * scene[name]:.2g}" for name in ("cube", "tool_radius")]
    return " ".join(words)


def _point(place: ArrayLike) -> str:
    return f"({', '.join(f'{value:.3g}' for value in np.asarray(place)[:2])})"


def measure_stiffness(config: Config) -> tuple[Array, Array]:
    """Stiffness traces: ordinary (repetitions, N) and reactive (conditions, repetitions, N), normalised."""
    rng, demo, arm = generator(config, "muscle"), config.demonstration, muscle(config)
    samples = round(demo.duration * demo.rate) + 1
    ordinary = [arm.measure(demo.duration, samples, rng) for _ in range(demo.repetitions)]
    reactive = [
        [
            arm.measure(demo.duration, samples, rng, c.obstacle.height, reach(config).moment(c.obstacle.position))
            for _ in range(demo.repetitions)
        ]
        for c in conditions(config)
    ]
    return moved(config, np.array(ordinary)), moved(config, np.array(reactive))


def moved(config: Config, data: Array) -> Array:
    """Data disturbed by the share ``perturbation`` of its range; unchanged in an ordinary run."""
    if not config.perturbation:
        return data
    noise = generator(config, "perturbation").standard_normal(data.shape)
    return data + config.perturbation * np.ptp(data) * noise


class Primitive:
    """The movement primitive of the chapter: its phases, kernels and spring-damper, Eqs. (7.3)-(7.5)."""

    def __init__(self, config: Config, kernels: int) -> None:
        self.duration, self.rate = config.demonstration.duration, config.demonstration.rate
        self.time = np.linspace(0.0, self.duration, round(self.duration * self.rate) + 1)
        self.phases = phase(self.time, self.duration, config.dmp.phase_decay)
        self.kernels = GaussianKernels.spaced(kernels, config.dmp.phase_decay, config.dmp.overlap)
        self.system = SpringDamper(config.dmp.stiffness, config.dmp.damping)
        self.printed_target = config.printed_target
        self.ridge = config.dmp.ridge

    def target(self, paths: Array, goal: ArrayLike, cutoff: float, padding: str = "odd") -> Array:
        """Forcing term (..., N, d) that reproduces recorded ``paths``, Eq. (7.21), without the factor g - x0."""
        smooth = low_pass(paths, cutoff, self.rate, padding, axis=-2)  # type: ignore[arg-type]
        velocity = self.duration * np.gradient(smooth, 1 / self.rate, axis=-2, edge_order=2)
        acceleration = self.duration * np.gradient(velocity, 1 / self.rate, axis=-2, edge_order=2)
        return self.system.forcing(smooth, velocity, acceleration, goal, self.printed_target)

    def fit(self, target: Array) -> Array:
        """Weights (n, d) of the kernels for a forcing term (N, d), Eq. (7.20)."""
        return ridge_weights(self.kernels.features(self.phases), target, self.ridge)

    def rollout(self, forcing: Array, start: ArrayLike, goal: ArrayLike, printed: bool = False) -> Array:
        """Movements (..., N, d) under forcing terms (..., N, d), Eq. (7.36); ``printed``: T X' = V' as in (7.33)."""
        step = 1 / (len(self.time) - 1)
        if printed:
            return self.system.solve_printed(forcing, step, start, goal, self.duration)
        return self.system.solve(forcing, step, start, goal)[0]


def enhancement(config: Config, kernels: GaussianKernels, draw: int | None = None) -> ExtendedKernels:
    """The kernels with ``groups`` of random enhancement nodes; fewer groups are a prefix, ``first(nodes * groups)``."""
    settings = config.enhancement
    rng = generator(config, f"enhancement nodes {settings.draw if draw is None else draw}")
    return ExtendedKernels.draw(
        kernels, settings.groups * settings.nodes, rng, settings.weight_std, settings.bias_range
    )


class Skills:
    """The ordinary skill and the reactive skills of every condition, learned from demonstrations (Steps 6.1 to 6.3)."""

    def __init__(self, config: Config, ordinary: Array, reactions: Array) -> None:
        self.config, self.reach = config, reach(config)
        self.primitive = Primitive(config, config.dmp.kernels)
        self.start, self.goal = self.reach.ends
        self.demonstrated = reactions.mean(axis=1)
        self.features = enhancement(config, self.primitive.kernels)
        target = self.target(ordinary).mean(axis=0)
        self.weights = self.primitive.fit(target)
        self.forcing = self.primitive.kernels.features(self.primitive.phases) @ self.weights
        self.reaction_targets = self.target(reactions).mean(axis=1) - self.forcing

    def target(self, paths: Array) -> Array:
        return self.primitive.target(paths, self.goal, self.config.dmp.cutoff)

    @cached_property
    def reactions(self) -> Array:
        """Reactive forcing terms Delta f^k (conditions, N, 3) in the frame of the path (along, left, up)."""
        style = self.config.style
        targets = self.reaction_targets @ self.reach.axes.T
        styles = Styles.separate(targets, style.rank, style.shared)
        weights = styles.fit(self.features, self.primitive.phases, self.config.enhancement.ridge)
        return self.features.blocks(self.primitive.phases).change @ weights

    def perform(self, reactions: ArrayLike = 0.0) -> Array:
        """Movements (..., N, 3) [cm] of the old task with reactions (..., N, 3) in the path's frame added."""
        added = np.asarray(reactions, float)
        forcing = self.forcing + (added @ self.reach.axes if added.ndim else added)
        return self.primitive.rollout(forcing, self.start, self.goal)


def fuzzy_system(config: Config) -> FuzzySystem:
    """The rule table; neighbouring sets of distance and of height are ``width_factor`` of their distance wide."""
    fuzzy, scene = config.fuzzy, config.scene
    distances = {c.labels[0]: c.distance for c in conditions(config)}
    width = {
        "distance": fuzzy.width_factor * abs(distances["far"] - distances["close"]),
        "height": fuzzy.width_factor * abs(scene.tall - scene.low),
    }
    sets = {
        "distance": {label: (distances[label], width["distance"]) for label in ("close", "far")},
        "height": {label: (scene[label], width["height"]) for label in ("low", "tall")},
        "direction": {label: (scene[label], fuzzy.direction_widths[label]) for label in ("left", "forward", "right")},
    }
    rules = [dict(zip(("distance", "height", "direction"), rule)) for rule in fuzzy.rules]
    try:
        return FuzzySystem(sets, rules, fuzzy.weights)
    except (TypeError, ValueError) as error:
        raise InputError(f"fuzzy.{error}") from error


class NewTask:
    """A task with other ends and another obstacle, to which the learned skills are carried over."""

    def __init__(self, config: Config, skills: Skills) -> None:
        self.config, self.skills, task = config, skills, config.task
        self.printed = printed_forms(task.printed, ("scaling", "kinematics"))
        self.reach = reach(config, "task")
        self.obstacle = Obstacle(task.obstacle, task.height, config.scene.cube)
        self.distance = float(np.hypot(*np.subtract(task.obstacle, task.start)))
        self.ratio = self.reach.length / skills.reach.length
        system = fuzzy_system(config)
        self.fuzzy = system.rescaled("distance", self.ratio) if task.scope == "rescaled" else system

    def scaling(self, vertical: float, lateral: float) -> Array:
        return path_scaling(self.skills.reach.axes, self.reach.axes, (self.ratio, lateral, vertical))

    @cached_property
    def forcing(self) -> Array:
        """The ordinary forcing term carried over: plane lengths scale with the task, heights do not."""
        if "scaling" in self.printed:
            return self.skills.forcing * self._axis_ratios()
        return self.skills.forcing @ self.scaling(1.0, self.ratio).T

    def _axis_ratios(self) -> Array:
        """(G - X0) / (g - x0) of (7.36) a coordinate; the vertical one is 0/0 and is taken as 1."""
        start, goal = self.reach.ends
        ratios = np.ones(3)
        ratios[:2] = (goal - start)[:2] / (self.skills.goal - self.skills.start)[:2]
        return ratios

    def reaction(self, direction: ArrayLike, height: ArrayLike | None = None) -> Array:
        """Fuzzy reactive forcing terms Delta f^F (..., N, 3) for directions (...), Eq. (7.35)."""
        blend = self.fuzzy.blend(
            self.skills.reactions,
            distance=self.distance,
            height=self.obstacle.height if height is None else height,
            direction=direction,
        )
        task = self.config.task
        if "scaling" in self.printed:
            return blend @ self.skills.reach.axes * self._axis_ratios()
        lateral, vertical = {"absolute": (1.0, 1.0), "all_axes": (self.ratio, self.ratio)}[task.reaction_scaling]
        # blend is in the frame of the path; S carries it there from the board's, so the old axes are the identity.
        return blend @ path_scaling(np.eye(3), self.reach.axes, (self.ratio, lateral, vertical)).T

    def perform(self, reaction: ArrayLike = 0.0) -> Array:
        """Generalised movements (..., N, 3) [cm], Eq. (7.36)."""
        forcing = self.forcing + np.asarray(reaction, float)
        return self.skills.primitive.rollout(forcing, *self.reach.ends, printed="kinematics" in self.printed)

    def clearance(self, paths: Array) -> Array:
        return self.obstacle.clearance(paths, self.config.scene.tool_radius)


def generalised_stiffness(config: Config, task: NewTask, traces: Array, endpoints: str) -> Array:
    """Stiffness (N,) for a new obstacle from the four bundles (distance, height), blended by rules without direction.

    traces (conditions, repetitions, N); ``endpoints``: start and end are the "average" of all bundles (as printed) or
    blended like the forcing ("fuzzy").
    """
    primitive = Primitive(config, config.dmp.stiffness_kernels)
    bundles = bundle_means(config, traces)
    rules = [{"distance": distance, "height": height} for distance, height in bundles]
    fuzzy = FuzzySystem(task.fuzzy.sets, rules)
    curves = np.array(list(bundles.values()))[..., None]
    targets = primitive.target(curves, curves[:, -1], config.dmp.stiffness_cutoff, "even")
    features = primitive.kernels.features(primitive.phases)
    forcing = features @ np.array([primitive.fit(target) for target in targets])
    inputs = {"distance": task.distance, "height": task.obstacle.height}
    start, goal = curves[:, 0].mean(axis=0), curves[:, -1].mean(axis=0)
    if endpoints == "fuzzy":
        start, goal = fuzzy.blend(curves[:, 0], **inputs), fuzzy.blend(curves[:, -1], **inputs)
    return primitive.rollout(fuzzy.blend(forcing, **inputs), start, goal)[:, 0]


def bundle_means(config: Config, traces: Array) -> dict[tuple[str, str], Array]:
    """Mean stiffness (N,) of each (distance, height): all directions and repetitions together."""
    keys = [condition.labels[:2] for condition in conditions(config)]
    return {
        key: np.mean([trace for k, trace in zip(keys, traces) if k == key], axis=(0, 1)) for key in dict.fromkeys(keys)
    }


def by_path(values: Array) -> Array:
    """Paths (k, N, 3) from a channel (N, 3 k)."""
    return np.moveaxis(values.reshape(len(values), -1, 3), 0, 1)
