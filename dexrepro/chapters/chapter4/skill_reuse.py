"""Learning four strokes and drawing an ellipse with what was learned, by growing and by fixed networks (Sect. 4.5)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter4 import two_link
from dexrepro.chapters.chapter4.measures import between, tracking
from dexrepro.chapters.chapter4.two_link import ELLIPSE, FROZEN, large
from dexrepro.experiment import Config, Figure, Metrics, Recording

ARM = "Two-link arm in PyBullet under the law's torque, gravity and 2 N at the tip. "
WEIGHTS = (
    ARM + "Weights of the Gaussians, one line a node, while the four strokes are learned one after another; above each "
    "panel how many exceed a tenth of the largest (joint 1). The book shows many small and few large weights."
)
FIGURES = {
    "4.1": Figure(
        "(a) The four strokes that are learned, (b) the ellipse drawn with what was learned, (c, d) inputs of the "
        "network in the plane of the virtual acceleration, with nodes (dots) and the threshold distance around them "
        "(circles); dashed orange: nodes added on the ellipse. The book sketches the principle.",
        "Nodes added on the ellipse lie along the transient at its start, outside the settled orbit.",
    ),
    "4.4": Figure(
        "The arm at the start of every run, rendered in its vertical plane, with strokes, ellipse (dashed), reach, "
        "gravity and the force field. The book draws the same arrangement.",
        "A two-link arm whose tip stands at the centre of an ellipse crossed by four strokes.",
    ),
    "4.5": Figure(
        ARM
        + "Above: 20 s of the ellipse from the centre, by fixed radial basis networks of two widths, a fuzzy network "
        "and the broad network, all after the same training and at equal effective gain. Below: the training of "
        "the broad network. The book compares one radial basis, one fuzzy and the broad network.",
        "The broad network and the fuzzy network follow the ellipse closely; the narrow radial basis network does not.",
    ),
    "4.6": Figure(
        ARM + "Tracking error on the ellipse after training, at equal effective gain; left 20 s, right the first 3 s. "
        "The initial error of 0.2 m takes 80 % of the bound. The book shows thresholds 20, 30 and 50 and one fixed "
        "network.",
        "All errors stay inside the shrinking bound; the narrow radial basis network oscillates most.",
    ),
    "4.7": Figure(
        ARM
        + "Number of nodes for three thresholds while four strokes are learned and the ellipse is drawn; below, the "
        "first half second of each run. The book shows counts that grow faster for smaller thresholds.",
        "Node counts step up at the first stroke and at the start of the ellipse and stay constant otherwise.",
    ),
    "4.8": Figure(WEIGHTS, "Weights for a threshold of 20 settle and ripple at the orbit's frequency."),
    "4.9": Figure(WEIGHTS, "Weights for a threshold of 30 settle and ripple at the orbit's frequency."),
    "4.10": Figure(WEIGHTS, "For a threshold of 50 a single node carries the whole estimate."),
}
TABLES = {"T4.A": "Ellipse after training: errors, oscillation, nodes and gain of every method"}
RATE = 50.0

scene = two_link.scene


def simulate(config: Config, rng: Any) -> Recording:
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
    network = config.law.keywords["network"]
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


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    from dexrepro.chapters.chapter4 import skill_figures as figures

    drawn: dict[str, Any] = {}
    finished = {case: recording for case, recording in recordings.items() if recording.status == "finished"}
    for identifier, case, threshold in (("4.8", "broad20", 20), ("4.9", "broad30", 30), ("4.10", "broad50", 50)):
        if case in finished and config.cases[case].training:
            drawn[identifier] = figures.weights(finished[case], metrics[case], threshold)
    if "broad20" not in finished or not config.cases["broad20"].training:
        return drawn
    drawn["4.1"] = figures.motions_and_nodes(finished["broad20"], config)
    if "arm" in finished["broad20"].images:
        drawn["4.4"] = figures.arm(finished["broad20"], config)
    drawn["4.5"] = figures.paths(finished, metrics, config)
    drawn["4.6"] = figures.errors(finished, metrics, config)
    drawn["4.7"] = figures.node_counts(finished, metrics, config)
    return drawn


COLUMNS = {
    "rmse_mm": "RMSE [mm]",
    "transient_rmse_mm": "RMSE 1-5 s [mm]",
    "steady_rmse_mm": "RMSE last half [mm]",
    "torque_increment_nm": "torque increment [N m per 10 ms]",
    "error_ripple_mm": "early error ripple [mm]",
    "nodes": "nodes",
    "max_usage": "largest share of the bound",
    "violations": "samples outside",
    "effective_gain": "effective gain",
}


def tabulate(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    rows = []
    for case, found in metrics.items():
        if case in config.cases:
            gain = "common" if case.startswith("common") or case == "broad20" else "equal effective"
            rows.append({"case": case, "gain": gain, **{label: found.get(name) for name, label in COLUMNS.items()}})
    return {"T4.A": pd.DataFrame(rows)}
