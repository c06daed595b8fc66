"""Four reaches through a fixed opening, with and without what keeps the arm near its centre (Sect. 3.5.2)."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter3 import reach
from dexrepro.chapters.chapter3.measures import add_distances, reach_metrics
from dexrepro.chapters.chapter3.scene import CAMERA, Touching, build, cutaway
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording

RATE = 50.0
REACHES = (1, 2, 3, 4)

scene = build
stage = cutaway


def simulate(config: Config, rng: Rng) -> Recording:
    centre = np.array(config.centre, dtype=float)
    with build(config) as world:
        recording = reach.run(world, config, lambda _: centre, Touching(world))
        if config.pictures:
            approach, insertion, _ = config.phases
            instants = {
                "start": 0.0,
                "centre": approach,
                "half": approach + insertion / 2,
                "target": sum(config.phases),
            }
            recording.images = {name: world.snapshot(recording, time, CAMERA) for name, time in instants.items()}
    add_distances(recording, config, centre)
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    return reach_metrics(recording, config)


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Over the reaches: the worst of the default, and how much larger Dis_R is without the null-space torque."""

    def values(prefix: str, metric: str) -> list[float]:
        cases = [metrics.get(f"{prefix}{n}", {}).get(metric) for n in REACHES]
        return [float(value) for value in cases if value is not None]

    result: Metrics = {}
    for name, (without, with_torque) in {"default": ("free", "reach"), "position": ("posfree", "pos")}.items():
        pairs = zip(values(without, "rcm_distance_final"), values(with_torque, "rcm_distance_final"))
        ratios = [(a + FLOOR) / (b + FLOOR) for a, b in pairs]
        result[f"{name}_ratio"] = min(ratios) if ratios else None
        result[f"{name}_ratio_mean"] = float(np.mean(ratios)) if ratios else None
    for metric in ("final_position_error", "rcm_distance_max"):
        found = values("reach", metric)
        result[f"worst_{metric}"] = max(found) if found else None
    return result


FLOOR = 1e-4  # m, what counts as no distance at all where distances are divided
