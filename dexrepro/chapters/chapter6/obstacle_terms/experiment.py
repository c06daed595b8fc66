"""Coupling terms for obstacles compared: dead zone, non-point obstacles, noise and cost a step (Sect. 6.5)."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import pandas as pd
from scipy.signal import savgol_filter

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import learning, plane
from dexrepro.control.motion import minimum_jerk
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.primitives.constrained import Law, Reference, Skill, rollout
from dexrepro.primitives.coupling import Term, coupled_rollout, dynamic_potential, steering
from dexrepro.primitives.obstacles import Polygon, clearance

RATE = 0.0


def simulate(config: Config, rng: Rng) -> Recording:
    old, block = plane.obstacles(config)
    lesson = plane.teach(config, rng("demonstrations"))[0]
    movement = lesson.second.rollout(lesson.durations[1] / config.steps, horizon=lesson.durations[1])
    if config.method in ("constrained", "filter"):
        frames = _constrained(config, lesson, movement, rng("reference_noise"))
    else:
        frames = _steered(config, lesson, movement, block)
        frames["bars"], frames["points"] = _bars(config, config.bars.half_widths), _points(config)
        frames["tuned_bars"] = _tuned_bars(config)
    path = frames["path"].to_numpy()
    numbers = {
        "clearance": clearance(path, [block]),
        "clearance_all": clearance(path, [block, *old]),
        "goal_error": float(np.linalg.norm(path[-1] - lesson.second.goal)),
        **_operations(config, block),
    }
    frames["numbers"] = pd.DataFrame([numbers])
    return Recording(frames=frames, steps=config.steps)


def _term(method: str, obstacle: Polygon, strength: Any, decay: Any) -> Term:
    """Coupling term of a method for an obstacle; strength and decay: gamma, beta, or lambda, beta of [39]."""
    if method == "potential":
        each = obstacle if obstacle.vertices.ndim == 2 else Polygon(obstacle.vertices[:, None])  # for four probes
        return lambda k, x, v: dynamic_potential(x, v, each.closest, strength, decay)
    if method == "centroid":
        points = obstacle.centroid[..., None, :]
        return lambda k, x, v: steering(x, v, points, strength, decay)
    if method == "closest":
        return lambda k, x, v: steering(x, v, obstacle.closest(x)[..., None, :], strength, decay)
    if obstacle.vertices.ndim == 2:
        boundary = obstacle.boundary(30)
    else:
        boundary = np.stack([Polygon(vertices).boundary(30) for vertices in obstacle.vertices])
    return lambda k, x, v: steering(x, v, boundary, strength / 30, decay)


def _steered(config: Config, lesson: plane.Lesson, movement: Any, block: Polygon) -> dict[str, pd.DataFrame]:
    """Path past the triangle with standard parameters, and the grid of settings."""
    settings = np.array([(a, b) for a in config.grid.strength for b in config.grid.decay], float)
    runs = np.vstack([[config.strength, config.decay], settings])
    skill = learning.skill([lesson.second] * len(runs), [movement] * len(runs))
    strength, decay = runs[:, :1], runs[:, 1:]
    start = np.repeat(movement.position[:1], len(runs), axis=0)
    velocity = np.broadcast_to(lesson.second.time_constant * lesson.second.velocity, start.shape)
    term = _term(config.method, block, strength, decay)
    with np.errstate(all="ignore"):  # some settings of the grid diverge
        paths = coupled_rollout(skill, term, lesson.durations[1] / config.steps, start, velocity)
    rows = [
        {
            "strength": a,
            "decay": b,
            "clearance": clearance(paths[:, i + 1], [block]),
            "goal_error": float(np.linalg.norm(paths[-1, i + 1] - lesson.second.goal)),
        }
        for i, (a, b) in enumerate(settings)
    ]
    return {"path": pd.DataFrame(paths[:, 0], columns=["x", "y"]), "grid": pd.DataFrame(rows)}


def _constrained(
    config: Config, lesson: plane.Lesson, movement: Any, rng: np.random.Generator
) -> dict[str, pd.DataFrame]:
    """Constrained primitive, and the same about references that are known with noise (E.g. Sect. 6.5, point 3)."""
    clean, samples, _ = plane.spline_reference(config, movement)
    references = [clean]
    for sigma in config.reference_noise:
        noisy = samples + rng.normal(0, sigma, samples.shape) * np.r_[0, np.ones(len(samples) - 2), 0][:, None]
        at = np.linspace(movement.time[0], movement.time[-1], len(samples))
        references.append(plane.differentiable(at, savgol_filter(noisy, 11, 3, axis=0), movement.time))
    batch = learning.stack(references)
    skill = learning.skill([lesson.second] * len(references), [movement] * len(references))
    velocity = np.broadcast_to(lesson.second.time_constant * lesson.second.velocity, (len(references), 2))
    path = learning.constrained(skill, batch, config.cdmp, lesson.durations[1] / config.steps, velocity)
    old, block = plane.obstacles(config)
    rows = [
        {
            "sigma": sigma,
            "true_distance": float(np.linalg.norm(path.position[:, i] - clean.position, axis=1).max()),
            "clearance": clearance(path.position[:, i], [block, *old]),
        }
        for i, sigma in enumerate([0.0, *config.reference_noise])
    ]
    return {"path": pd.DataFrame(path.position[:, 0], columns=["x", "y"]), "noise": pd.DataFrame(rows)}


def _straight(config: Config, runs: int) -> tuple[Skill, Array, float]:
    """A straight 10 cm reach for some runs, their starts, and the step [s]."""
    time = np.linspace(0, config.reach_duration, 201)
    path = np.stack([10 * minimum_jerk(time / config.reach_duration), np.zeros_like(time)], axis=1)
    primitive = learning.learn(time, path, config.dmp)
    step = config.reach_duration / config.steps
    movement = primitive.rollout(step, horizon=config.reach_duration)
    return learning.skill([primitive] * runs, [movement] * runs), np.zeros((runs, 2)), step


def _points(config: Config) -> pd.DataFrame:
    """Smallest distance to a point obstacle amid a straight reach, over its sideways offset."""
    offsets = np.array(config.point_offsets, float)
    skill, start, step = _straight(config, len(offsets))
    points = np.stack([np.full_like(offsets, 5.0), offsets], axis=1)
    if config.method == "potential":
        term: Term = lambda k, x, v: dynamic_potential(  # noqa: E731
            x, v, lambda probe: np.broadcast_to(points[:, None], probe.shape), config.strength, config.decay
        )
    else:
        term = lambda k, x, v: steering(x, v, points[:, None], config.strength, config.decay)  # noqa: E731
    paths = coupled_rollout(skill, term, step, start, start)
    return pd.DataFrame({"offset": offsets, "distance": np.linalg.norm(paths - points, axis=-1).min(axis=0)})


def _bars(config: Config, widths: list[float], strength: float | None = None, decay: float | None = None) -> Any:
    """Clearance to bars across a straight reach and whether it passes them to its goal, for half-widths and offsets."""
    rows = [(w, o * w if o > 0.1 else o) for w in widths for o in config.bars.offsets]
    width, offset = np.array(rows, float).T
    thick = config.bars.thickness / 2
    corners = np.array([[-thick, -1], [thick, -1], [thick, 1], [-thick, 1]])
    vertices = np.array([5.0, 0.0]) + corners * np.stack([np.ones_like(width), width], axis=1)[:, None]
    vertices[..., 1] += offset[:, None]
    bars = Polygon(vertices)
    skill, start, step = _straight(config, len(rows))
    gains = [np.full((len(rows), 1), g) for g in (strength or config.strength, decay or config.decay)]
    with np.errstate(all="ignore"):  # some settings diverge
        paths = coupled_rollout(skill, _term(config.method, bars, *gains), step, start, start)
        missed = np.linalg.norm(paths[-1] - skill.goal, axis=-1)
        clear = bars.distance(paths).min(axis=0)
    passed = (clear > 0) & (missed < config.arrived)
    return pd.DataFrame({"half_width": width, "offset": offset, "clearance": clear, "passed": passed})


def _tuned_bars(config: Config) -> pd.DataFrame:
    """Wide bars passed, for every setting of the grid."""
    rows = []
    for strength in config.grid.strength:
        for decay in config.grid.decay:
            bars = _bars(config, config.bars.wide, strength, decay)
            passed = bars.groupby("half_width").passed.sum()
            rows += [(strength, decay, width, count) for width, count in passed.items()]
    return pd.DataFrame(rows, columns=["strength", "decay", "half_width", "passed"])


class _Counted(np.ndarray):
    """Array that counts the elements that arithmetic on it produces, choices among elements included."""

    operations = 0
    WORK: ClassVar[dict[Any, int]] = {np.linalg.norm: 2, np.where: 1, np.take_along_axis: 1}  # an element of the input

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        plain = [np.asarray(value) if isinstance(value, _Counted) else value for value in inputs]
        if "out" in options:
            options["out"] = tuple(np.asarray(value) for value in options["out"])
        result = getattr(ufunc, method)(*plain, **options)
        _Counted.operations += max([np.size(value) for value in (*plain, result)])
        return result.view(_Counted) if isinstance(result, np.ndarray) else result

    def __array_function__(self, function: Any, types: Any, args: Any, options: Any) -> Any:
        result = super().__array_function__(function, types, args, options)
        if function in self.WORK:
            _Counted.operations += self.WORK[function] * max(np.size(value) for value in (*args, result))
            result = np.asarray(result).view(_Counted)
        return result

    def argmin(self, *args: Any, **options: Any) -> Any:
        _Counted.operations += self.size
        return np.asarray(self).argmin(*args, **options)


SPLINE = 24
"""Operations of a cubic spline with two derivatives in the plane, by Horner's rule: the reference at an instant."""


def _operations(config: Config, block: Polygon) -> dict[str, int]:
    """Elementary operations of one step in the plane, counted on the running code.

    The constrained primitive needs its reference and, where its law does, a step of the unconstrained primitive too.
    ``operations_primitive``: of that step; ``operations_point``: of the potential about a single point.
    """
    x, v = np.array([9.0, 12.0]).view(_Counted), np.array([-2.0, 1.0]).view(_Counted)
    skill = Skill(np.zeros((2, 2)), np.array([5.0, 14.0]), 5.0, nominal=np.zeros((2, 2)))
    target = np.array([9.1, 12.1])
    reference = Reference(np.stack([target, target]), np.zeros((2, 2)), np.zeros((2, 2)))

    def constrained(law: Law) -> int:
        _Counted.operations = 0
        rate = config.cdmp.projection_rate if config.cdmp.projection else None
        rollout(skill, reference, learning.tube(config.cdmp, 0.5), learning.gains(config.cdmp), law, 1e-3, x, v, rate)
        return _Counted.operations

    def coupled(term: Term) -> int:
        _Counted.operations = 0
        coupled_rollout(skill, term, 1e-3, x, v)
        return _Counted.operations // 4  # the method evaluates the term four times a step

    alone = coupled(lambda k, x, v: np.zeros(2))
    if config.method in ("constrained", "filter"):
        nominal = alone if config.cdmp.law == "feedforward" else 0
        return {
            "operations": constrained(learning.law(config.cdmp)) + SPLINE + nominal,
            "operations_primitive": alone,
        }
    gains: tuple[Any, Any] = np.array([config.strength]), np.array([config.decay])
    counts = {"operations": coupled(_term(config.method, block, *gains)), "operations_primitive": alone}
    if config.method == "potential":
        counts["operations_point"] = coupled(
            lambda k, x, v: dynamic_potential(x, v, lambda probe: np.broadcast_to(target, probe.shape), *gains)
        )
    return counts


def measure(recording: Recording, config: Config) -> Metrics:
    metrics: Metrics = {str(name): float(value) for name, value in recording.frames["numbers"].iloc[0].items()}
    metrics |= {name: int(value or 0) for name, value in metrics.items() if name.startswith("operations")}
    if "noise" in recording.frames:
        noise = recording.frames["noise"]
        excess = noise.true_distance - config.cdmp.margin - 3 * noise.sigma
        return metrics | {"noise_excess": float(excess.max()), "noise_clearance": float(noise.clearance.min())}
    grid, points, bars = (recording.frames[name] for name in ("grid", "points", "bars"))
    arrived = grid[grid.goal_error < config.arrived]
    metrics |= {
        "tuned_clearance": float(arrived.clearance.max()) if len(arrived) else None,
        "settings_that_pass": int((arrived.clearance > 0).sum()),
        "aligned_distance": float(points.distance.iloc[0]),
        "nearly_aligned_distance": float(points.distance.iloc[1:].min()),
    }
    for width in config.bars.half_widths:
        metrics[f"bars_passed_{10 * width:.0f}mm"] = int(bars.passed[bars.half_width == width].sum())
    tuned = recording.frames["tuned_bars"]
    for width in config.bars.wide:
        metrics[f"bars_tuned_{10 * width:.0f}mm"] = int(tuned.passed[tuned.half_width == width].max())
    return metrics


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Response of the steering term to the heading: gamma phi exp(-beta phi), per unit of speed."""
    phi = np.linspace(1e-4, np.pi, 20000)
    response = config.strength * phi * np.exp(-config.decay * phi)
    at_rest = float(np.interp(0.01, phi, response))
    return {
        "steering_peak": float(response.max()),
        "steering_peak_at": float(phi[response.argmax()]),
        "steering_at_001": at_rest,
    }
