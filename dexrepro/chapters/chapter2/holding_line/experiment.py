"""Keeping to the holding line: what the lateral regulation does for the holding force (Sect. 2.4.1.1)."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2 import planar_pair
from dexrepro.chapters.chapter2.measures import force_error, mean
from dexrepro.control.contract import build
from dexrepro.control.holding_reference import KnownMovement
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import rms

RATE = 50.0
SETTLED = 5.0  # s

scene = planar_pair.scene


def simulate(config: Config, rng: Rng) -> Recording:
    with scene(config) as world:
        partner = world.arm("leader")
        movement = KnownMovement(
            movement=lambda: (config.rest_length + partner.x, partner.vx), stiffness=config.stiffness, dt=config.step
        )
        return planar_pair.run(world, config, build(config.law, estimation=movement))


def measure(recording: Recording, config: Config) -> Metrics:
    late, force = recording.between(SETTLED), recording["object.force"]
    offset = np.abs(recording["follower.tip"][:, 1] - recording["leader.tip"][:, 1])
    length, without = config.rest_length - config.desired_force / config.stiffness, offset[late]
    stretched = np.hypot(length, without.mean()) if without.size else length
    return {
        "rmse": rms(force_error(recording, config.desired_force, SETTLED)),
        "mean_force": mean(force[late]),
        "predicted_force": config.stiffness * (config.rest_length - stretched),
        "mean_distance": mean(recording["object.length"][late]),
        "lost": mean((force[1:] <= 0).astype(float)),
        "largest_offset": float(without.max()) if without.size else None,
        "survived": recording.simulated,
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """What (2.8) gains of force error [N], and by how much the tips are farther apart than intended [mm]."""
    found: Metrics = {}
    intended = config.rest_length - config.desired_force / config.stiffness
    for case in ("case1", "case2", "aligned"):
        off, on = (metrics.get(f"{case}_{switch}", {}).get("rmse") for switch in ("without", "with"))
        if off is not None and on is not None:
            found[f"{case}_gain"] = off - on
        for name in (f"{case}_without", f"{case}_with"):
            distance = metrics.get(name, {}).get("mean_distance")
            if distance is not None:
                found[f"{name}_excess"] = 1e3 * (distance - intended)
    return found
