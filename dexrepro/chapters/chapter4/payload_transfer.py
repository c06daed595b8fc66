"""A Baxter arm learns to carry a loose payload and moves it along nine new trajectories (Sect. 4.6)."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.chapters.chapter4 import payload_arm
from dexrepro.chapters.chapter4.measures import rms
from dexrepro.experiment import Config, Figure, Metrics, Recording

FIGURES: dict[str, Figure] = {}
RATE = 50.0

scene = payload_arm.scene


def simulate(config: Config, rng: Any) -> Recording:
    return payload_arm.simulate(config)


def measure(recording: Recording, config: Config) -> Metrics:
    metrics: Metrics = {"diverged": int(recording.status != "finished")}
    phase, nodes = recording["phase"], recording["nodes"]
    step = recording.time[1] - recording.time[0]
    errors: list[float] = []
    rates: list[float] = []
    for number in np.unique(phase):
        now = phase == number
        error = 1e3 * recording["error"][now]
        if number in payload_arm.TRAINING:
            metrics[f"nodes_phase{number + 1:.0f}"] = int(nodes[now][-1])
            continue
        errors.append(rms(error))
        rates.append(rms(np.diff(error, axis=0) / step))
        metrics[f"trajectory{number - 1:.0f}_rmse_mm"] = errors[-1]
    late = phase > 1
    return metrics | {
        "rmse_mm": float(np.mean(errors)),
        "worst_rmse_mm": float(np.max(errors)),
        "oscillation_mm_s": float(np.mean(rates)),
        "max_usage": float(np.abs(recording["usage"][late]).max()),
        "violations": int(np.sum(np.abs(recording["usage"][late]).max(axis=1) >= 1.0)),
        "smallest_share": float(recording["share"].min()),
        "most_nodes": int(nodes.max()),
    }
