"""What barrier, switch, robust term and network each contribute, on the ellipse without training (Sects. 4.3, 4.5)."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter4 import two_link
from dexrepro.chapters.chapter4.measures import tracking
from dexrepro.control.contract import memory
from dexrepro.experiment import Config, Metrics, Recording

RATE = 50.0

scene = two_link.scene
stage = two_link.stage


def simulate(config: Config, rng: Rng) -> Recording:
    recording = two_link.simulate(config)
    recording.frames.clear()
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    metrics: Metrics = {"diverged": int(recording.status != "finished"), "time_s": float(recording.time[-1])}
    if recording.status != "finished":
        return metrics
    metrics |= tracking(recording.time, recording["error"], recording["usage"], recording["torque"])
    now = recording.between(config.task.duration - config.task.period)
    energy = float(recording["feature_energy"][now].mean())
    network = memory(config.law)
    return metrics | {
        "nodes": int(recording["nodes"][-1]),
        "smallest_share": float(recording["share"].min()),
        "settled_share": float(recording["share"][now].min()),
        "largest_input": float(recording["input_norm"].max()),
        "effective_gain": energy * float(np.mean(network.gain)) if network is not None else 0.0,
    }
