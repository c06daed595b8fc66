"""Learning four strokes and drawing an ellipse with what was learned, by growing and by fixed networks (Sect. 4.5)."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter4 import two_link
from dexrepro.chapters.chapter4.measures import between, tracking
from dexrepro.chapters.chapter4.two_link import ELLIPSE, FROZEN, large
from dexrepro.control.contract import memory
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording

RATE = 50.0
STROKES = {2: "alone45", 3: "alone90", 4: "alone135"}  # by their number, the case in which each is learned alone

scene = two_link.scene
stage = two_link.stage


def simulate(config: Config, rng: Rng) -> Recording:
    return two_link.simulate(config)


def measure(recording: Recording, config: Config) -> Metrics:
    metrics: Metrics = {"diverged": int(recording.status != "finished")}
    for number in np.unique(recording["segment"]):
        now = recording["segment"] == number
        time = recording.time[now] - recording.time[now][0]
        found = tracking(time, recording["error"][now], recording["usage"][now], recording["torque"][now])
        if number == ELLIPSE:
            metrics |= found
        elif number == FROZEN:
            metrics["frozen_steady_rmse_mm"] = found["steady_rmse_mm"]
        else:
            metrics[f"stroke{number + 1:.0f}_rmse_mm"] = found["rmse_mm"]
    return metrics | _network(recording, config)


def _network(recording: Recording, config: Config) -> Metrics:
    network = memory(config.law)
    segment, nodes = recording["segment"], recording["nodes"]
    now = segment == ELLIPSE
    if network is None or not now.any():
        return {}
    time, count = recording.time[now] - recording.time[now][0], nodes[now]
    added = np.flatnonzero(np.diff(count)) + 1
    last_period = between(time, config.task.duration - config.task.period, config.task.duration)
    energy = float(recording["feature_energy"][now][last_period].mean())
    settled = recording.frames["settled"].iloc[0]
    metrics: Metrics = {
        "nodes": int(count[-1]),
        "feature_energy": energy,
        "effective_gain": float(np.mean(network.gain)) * energy,
        "smallest_share": float(recording["share"][now].min()),
        "settled_input": float(recording["input_norm"][now][last_period].max()),
        "weight_drift": settled["drift"],
        "weight_ripple": settled["ripple"],
        "large_weights": int(settled["large"]),
        "large_weight_share": settled["large"] / settled["nodes"],
        "very_large_weight_share": settled["very_large"] / settled["nodes"],
    }
    if "weights" in recording.frames:
        trained = nodes[segment < ELLIPSE]
        metrics["nodes_trained"] = int(trained[-1]) if len(trained) else 0
        metrics["last_node_s"] = float(time[added[-1]]) if len(added) else 0.0
        metrics["global_weight_ratio"] = settled["global"]
        metrics |= _strokes(recording)
    return metrics


def _strokes(recording: Recording) -> Metrics:
    """Nodes after each stroke, and how many of their weights for joint 1 exceed a tenth of the largest."""
    frame = recording.frames["weights"]
    metrics: Metrics = {}
    columns = [name for name in frame.columns if name.startswith("joint1_")]
    for number in range(ELLIPSE):
        last = frame.loc[frame["segment"] == number, columns].tail(1).dropna(axis=1)
        if len(last):
            metrics[f"stroke{number + 1}_nodes"] = last.shape[1]
            metrics[f"stroke{number + 1}_large_weights"] = large(last.to_numpy()[0])
    return metrics


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """What share of what reuse gains the nodes alone give, without their weights.

    nodes_share_strokes: of the sum of the errors of strokes two to four, against those learned alone;
    nodes_share_ellipse: of the ellipse's error, against the ellipse learned from nothing.
    """
    alone = {f"stroke{n}_rmse_mm": (case, "stroke1_rmse_mm") for n, case in STROKES.items()}
    found = {
        "nodes_share_strokes": _share(metrics, alone),
        "nodes_share_ellipse": _share(metrics, {"rmse_mm": ("zero20", "rmse_mm")}),
    }
    return {name: value for name, value in found.items() if value is not None}


def _share(metrics: AllMetrics, rivals: dict[str, tuple[str, str]]) -> float | None:
    """Gain of the nodes over that of all; rivals: (case, metric) without reuse, by the metric with it."""
    sums = [0.0, 0.0, 0.0]
    for name, rival in rivals.items():
        for k, (case, metric) in enumerate((rival, ("nodes20", name), ("broad20", name))):
            value = metrics.get(case, {}).get(metric)
            if value is None:
                return None
            sums[k] += value
    without, nodes, whole = sums
    return (without - nodes) / (without - whole) if without != whole else None
