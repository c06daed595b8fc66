"""The coupled primitives of other authors, running: obstacle, distance, internal force, surface (Table 6.1)."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import learning
from dexrepro.control.motion import minimum_jerk
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms
from dexrepro.primitives.coupling import Agents, SurfaceFollower, coupled_rollout, steering
from dexrepro.primitives.dmp import DMP
from dexrepro.primitives.kernels import phase

RATE = 100.0


def simulate(config: Config, rng: Rng) -> Recording:
    if config.system == "surface":
        series = _surface(config)
    elif config.system == "obstacle":
        series = _obstacle(config)
    else:
        series = _agents(config)
    return Recording(series=series, steps=len(series["time"]), simulated=float(series["time"][-1]))


def _reach(config: Config, duration: float, height: Any = 0.0) -> DMP:
    """Primitive of a 10 cm minimum-jerk reach over a height profile y(x)."""
    time = np.linspace(0, duration, 201)
    x = 10 * minimum_jerk(time / duration) + config.perturbation
    return learning.learn(
        time, np.stack([x, height(x) if callable(height) else np.full_like(x, height)], axis=1), config.dmp
    )


def _agents(config: Config) -> dict[str, Array]:
    """Two agents side by side; the second one is pushed away."""
    a, primitive = config.agents, _reach(config, 1.0)
    s = phase(np.linspace(0, 1, 400), 1.0, config.dmp.gamma)[::-1]
    table = primitive.features.features(s) @ primitive.weights

    def forcing(value: float) -> Array:
        f = np.array([np.interp(value, s, column) for column in table.T])
        return np.stack([f, f])

    def push(t: float) -> Array:
        active = a.push_from < t < a.push_until
        return np.array([[0.0, 0.0], [0.0, a.push if active else 0.0]])

    starts = np.array([[0.0, 0.0], [0.0, a.distance]])
    agents = Agents(config.coupling, a.distance, config.prediction, a.slowing, primitive.system, decay=config.dmp.gamma)
    paths = agents.rollout(forcing, starts, starts + [10.0, 0.0], push, config.step, 1.0)
    gap = np.linalg.norm(paths[:, 0] - paths[:, 1], axis=1) - a.distance
    missed = np.linalg.norm(paths[-1] - starts - [10.0, 0.0], axis=1).max()
    return {"time": config.step * np.arange(len(paths)), "error": gap, "goal_error": np.full(len(paths), missed)}


def _obstacle(config: Config) -> dict[str, Array]:
    primitive = _reach(config, 1.0)
    movement = primitive.rollout(config.step, horizon=1.0)
    point = np.array([[5.0, 0.1]])
    path = coupled_rollout(
        learning.skill([primitive], [movement]),
        lambda k, x, v: steering(x, v, point, config.coupling, 20 / np.pi),
        config.step, np.zeros((1, 2)), np.zeros((1, 2)),
    )[:, 0]  # fmt: skip
    missed = np.linalg.norm(path[-1] - primitive.goal)
    return {
        "time": movement.time,
        "error": np.linalg.norm(path - point, axis=1),
        "goal_error": np.full(len(path), missed),
    }


def _surface(config: Config) -> dict[str, Array]:
    """A tool learned on a flatter surface presses on a bump; positions in cm."""
    s, set_force = config.surface, config.surface.set_force

    def bump(x: Any, height: float) -> Any:
        return height * np.sin(np.pi * np.clip(x, 0, 10) / 10)

    primitive = _reach(config, 3.0, lambda x: bump(x, s.learned_height) - set_force / s.stiffness)
    step = 3.0 * config.step
    movement = primitive.rollout(step, horizon=3.0)
    batch = learning.skill([primitive], [movement])
    skill = learning.Skill(batch.forcing[:, 0], primitive.goal, 3.0, primitive.system)
    path, force = SurfaceFollower(config.coupling, config.prediction, set_force).rollout(
        skill, primitive.start, step, lambda x: float(bump(x, s.height)), s.stiffness
    )
    missed = np.abs(path[-1, 0] - primitive.goal[0])
    return {"time": movement.time, "error": force - set_force, "goal_error": np.full(len(path), missed)}


def measure(recording: Recording, config: Config) -> Metrics:
    error = recording["error"]
    late = error[len(error) // 5 :]
    size = {
        "surface": rms(late),
        "obstacle": float(error.min()),
    }.get(config.system, float(np.abs(error).max()))
    return {"size": size, "end_error": float(abs(error[-1])), "goal_error": float(recording["goal_error"][0])}
