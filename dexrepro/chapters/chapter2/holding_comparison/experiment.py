"""Four holding laws compared: the eighteen simulations of Table 2.1 and what decides between them (Sect. 2.4.1.3)."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2 import planar_pair
from dexrepro.chapters.chapter2.measures import force_error, mean
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import rms

RATE = 50.0
SETTLED = 20.0  # s, the second period

scene = planar_pair.scene


def simulate(config: Config, rng: Rng) -> Recording:
    with scene(config) as world:
        return planar_pair.run(world, config, config.laws[config.controller] if config.law is None else config.law)


def measure(recording: Recording, config: Config) -> Metrics:
    desired, (low, high) = config.desired_force, config.follower.workspace
    reference, late = recording["reference"][:, 0], force_error(recording, desired, SETTLED)
    return {
        "rmse": rms(late),
        **{f"rmse_{start}": rms(force_error(recording, desired, start)) for start in (0, 5, 10)},
        "mean_error": mean(late),
        "largest_error": float(np.abs(late).max()) if late.size else None,
        "lost": mean((recording["object.force"] <= 0).astype(float)),
        "bounded": mean(((reference < low) | (reference > high)).astype(float)),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """What the regulation gains in groups 2 and 3, off minus on [N], mean over the laws both groups have.

    lead_1, lead_2: by how much the passive impedance errs more than the proposed law on either trajectory [N];
    integral_lead_1, integral_lead_2: the same of an integral force law in the proposed law's place; force_lead_1,
    force_lead_2: by how much a force controller errs more, both with tuned gains.
    """
    result: Metrics = {}
    for law, duels in {
        "lead": (("s8", "s4"), ("s14", "s10")),
        "integral_lead": (("integral_1", "s4"), ("integral_2", "s10")),
        "force_lead": (("tuned_impedance_1", "tuned_force_1"), ("tuned_impedance_2", "tuned_force_2")),
    }.items():
        for trajectory, (case, rival) in enumerate(duels, start=1):
            own, other = (metrics.get(name, {}).get("rmse") for name in (case, rival))
            if own is not None and other is not None:
                result[f"{law}_{trajectory}"] = other - own
    for group, pairs in {
        "group2": (("s11", "s12"), ("s13", "s14")),
        "group3": (("s15", "s16"), ("s17", "s18")),
    }.items():
        values = [[metrics.get(case, {}).get("rmse") for case in pair] for pair in pairs]
        if all(value is not None for pair in values for value in pair):
            result[f"{group}_gain"] = float(np.mean([off - on for off, on in values]))  # type: ignore[operator]
    return result
