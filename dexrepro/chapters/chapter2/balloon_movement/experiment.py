"""Holding a balloon while the partner moves along a line and a circle, on Baxter (Sect. 2.4.2.2)."""

from __future__ import annotations

import math

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2 import balloon_pair
from dexrepro.chapters.chapter2.measures import Array, force_error
from dexrepro.control.motion import quintic
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import rms

RATE = 20.0

scene = balloon_pair.scene
stage = balloon_pair.stage


def simulate(config: Config, rng: Rng) -> Recording:
    config = Config({**config, "law": config.laws[config.controller] if config.law is None else config.law})
    tremor = Tremor(config.path.tremor, rng("tremor"))
    return balloon_pair.run(config, rng, lambda t: path(config.path, t) + tremor(t))


def path(shape: Config, time: float) -> Array:
    """Displacement (3,) [m] of the leader's gripper: minimum jerk along a line, then laps of a circle across x."""
    share, _ = quintic(time - shape.line_start, shape.line_end - shape.line_start)
    radius, (x, y, z) = shape.radius, shape.line
    angle = 2 * math.pi * shape.laps * _eased((time - shape.circle_start) / (shape.laps * shape.period), shape.ramp)
    return np.array((share * x, share * y + radius * math.sin(angle), share * z + radius * (1 - math.cos(angle))))


def _eased(share: float, ramp: float) -> float:
    """Progress 0 ... 1 at a speed that rises and falls linearly over a share of the time at either end."""
    share, speed = min(max(share, 0.0), 1.0), 1 / (1 - ramp)
    if share < ramp:
        return speed * share * share / (2 * ramp)
    if share > 1 - ramp:
        return 1 - speed * (1 - share) ** 2 / (2 * ramp)
    return speed * (share - ramp / 2)


class Tremor:
    """Physiological tremor of a hand, 1 to 3 Hz: displacement (3,) [m] of a given root mean square per axis."""

    def __init__(self, size: float, random: np.random.Generator, count: int = 8) -> None:
        self._rates = 2 * math.pi * random.uniform(1.0, 3.0, count)
        self._phases = random.uniform(0, 2 * math.pi, (3, count))
        self._amplitude = size * math.sqrt(2 / count)

    def __call__(self, time: float) -> Array:
        return self._amplitude * np.sin(self._rates * time + self._phases).sum(axis=1)


def measure(recording: Recording, config: Config) -> Metrics:
    shape, desired = config.path, config.desired_force
    circle = recording.between(shape.circle_start)
    distance = np.linalg.norm(recording["follower.tip"] - recording["leader.tip"], axis=1)
    return {
        "rmse_line": rms(force_error(recording, desired, 12.0, shape.circle_start)),
        "rmse_circle": rms(force_error(recording, desired, shape.circle_start)),
        "distance_spread": float(distance[circle].std()) if circle.any() else None,
        "mean_error_circle": float(force_error(recording, desired, shape.circle_start).mean())
        if circle.any()
        else None,
        "largest_torque": float(np.abs(recording["follower.torque"]).max()),
        "held": float(recording.time[-1]),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """By how much a law's force error exceeds the proposed law's, on the line and on the circle [N]."""
    result: Metrics = {}
    rivals = {"force": "force", "passive": "passive", "lead": "no_impedance"}
    tuned = {name: name for name in ("tuned_force", "tuned_passive")}
    for own, others in (("proposed", rivals), ("tuned_proposed", tuned)):
        for name, case in others.items():
            for phase in ("line", "circle"):
                pair = [metrics.get(one, {}).get(f"rmse_{phase}") for one in (case, own)]
                if pair[0] is not None and pair[1] is not None:
                    result[f"{name}_excess_{phase}"] = pair[0] - pair[1]
    return result
