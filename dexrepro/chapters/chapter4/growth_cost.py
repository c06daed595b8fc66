"""What a node costs: memory, arithmetic and step time of growing and fixed networks against their size (Sect. 4.6)."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.networks import AdaptiveNetwork, Basis, Gaussians, GrowingGaussians, Lattice

FIGURES = {
    "4.A": Figure(
        "Cost of one control step (output and weight update, 14 inputs, 7 outputs) and reserved memory against the "
        "number of nodes, for a growing network with enhancement, a lattice evaluated as a product and the same "
        "lattice by the plain formula. Times are of the machine that made the figure. The book reports that a broad "
        "network of 72 nodes replaces one of 16384.",
        "Step time and memory grow in proportion to the nodes; a broad network of 72 nodes is far cheaper than 16384.",
    )
}
TABLES = {"T4.D": "Cost of one control step by network and number of nodes"}
RATE = 0.0

LABELS = {
    "growing": ("Growing, with enhancement", "book"),
    "lattice": ("Lattice as a product", "rival"),
    "plain": ("Lattice, plain formula", "plain"),
}


def simulate(config: Config, rng: Any) -> Recording:
    draw = rng("inputs")
    rows = []
    for nodes in config.nodes:
        basis = _basis(config, nodes, draw)
        network = AdaptiveNetwork(basis, config.outputs, gain=1.0, leakage=config.leakage, step=1e-3)
        inputs = draw.uniform(-1, 1, (config.repetitions, config.inputs))
        features = len(basis(inputs[0]))
        rows.append(
            {
                "nodes": nodes,
                "features": features,
                "memory_kb": (_size(network) + _size(basis)) / 1024,
                "exponentials": 2 * config.inputs if isinstance(basis, Lattice) else nodes,
                "multiplications": _multiplications(basis, nodes, features, config),
                "step_us": 1e6 * _fastest(network, inputs, np.ones(config.outputs)),
            }
        )
    return Recording(frames={"cost": pd.DataFrame(rows)}, steps=len(config.nodes) * config.repetitions)


def _basis(config: Config, nodes: int, rng: np.random.Generator) -> Basis:
    if config.kind == "growing":
        growing = GrowingGaussians(config.inputs, width=1.0, threshold=1e9, interval=10, max_nodes=nodes)
        growing.reset(rng.uniform(-1, 1, (nodes, config.inputs)))
        return growing
    levels = [[-1.0, 1.0]] * int(np.log2(nodes)) + [[0.0]] * (config.inputs - int(np.log2(nodes)))
    lattice = Lattice(levels, width=1.0)
    return lattice if config.kind == "lattice" else Gaussians(lattice.centres, width=1.0)


def _size(holder: Any) -> int:
    """Bytes of the arrays an object owns."""
    return sum(value.nbytes for value in vars(holder).values() if isinstance(value, np.ndarray) and value.base is None)


def _multiplications(basis: Basis, nodes: int, features: int, config: Config) -> int:
    """Features, output and update of one step (leakage included)."""
    of_features = nodes if isinstance(basis, Lattice) else nodes * (config.inputs + 1)
    return of_features + (3 if config.leakage else 2) * features * config.outputs


def _fastest(network: AdaptiveNetwork, inputs: Any, error: Any) -> float:
    """Shortest of the steps [s]: the one that the rest of the machine disturbed least."""
    best = np.inf
    for z in inputs:
        start = time.perf_counter()
        network.output(z, grow=True)
        network.adapt(error)
        best = min(best, time.perf_counter() - start)
    return float(best)


def measure(recording: Recording, config: Config) -> Metrics:
    cost = recording.frames["cost"].set_index("nodes")
    largest = cost.index[-1]
    return {
        **{f"{name}_72": float(cost[name][72]) for name in ("memory_kb", "multiplications") if 72 in cost.index},
        "memory_kb": float(cost.memory_kb[largest]),
        "multiplications": int(cost.multiplications[largest]),
        "exponentials": int(cost.exponentials[largest]),
        "memory_exponent": _exponent(cost.memory_kb),
        "multiplication_exponent": _exponent(cost.multiplications),
    }


def _exponent(cost: pd.Series) -> float:
    """Slope of the cost against the number of nodes on logarithmic axes."""
    return float(np.polyfit(np.log(cost.index.to_numpy(dtype=float)), np.log(cost.to_numpy(dtype=float)), 1)[0])


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    from dexrepro.report import style

    if set(recordings) < set(LABELS):
        return {}
    figure, (left, right) = style.subplots(1, 2, height=2.7)
    for case, (label, line) in LABELS.items():
        cost = recordings[case].frames["cost"]
        left.loglog(cost.nodes, cost.step_us, marker="o", markersize=3, label=label, **style.LINES[line])
        right.loglog(cost.nodes, cost.memory_kb, marker="o", markersize=3, **style.LINES[line])
    left.axhline(1e3 * config.period_ms, **style.LINES["reference"])
    left.annotate(
        f"control period {config.period_ms:g} ms", (90, 1e3 * config.period_ms), xytext=(0, -9), size=7,
        textcoords="offset points",
    )  # fmt: skip
    broad, fixed = 72, 2**config.inputs  # nodes printed in 4.6
    for axes, label in ((left, "Shortest step time [µs]"), (right, "Memory [kB]")):
        axes.set(xlabel="Nodes [-]", ylabel=label)
        for nodes in (broad, fixed):
            axes.axvline(nodes, color="#999999", linewidth=0.6, zorder=-5)
    places = ((broad, " the book's broad network", "left", 0.05), (fixed, "its fixed network ", "right", 0.14))
    for nodes, word, side, height in places:
        right.annotate(word, (nodes, height), xycoords=("data", "axes fraction"), size=6.5, ha=side)
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    small, large = (recordings[case].frames["cost"] for case in ("growing", "lattice"))
    ratio = float(large.step_us.iloc[-1] / small.step_us[small.nodes <= broad].iloc[-1])
    style.title(
        figure, f"A broad network of {broad} nodes takes its step {ratio:.0f} times faster than {fixed} fixed nodes"
    )
    return {"4.A": figure}


def tabulate(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    tables = [
        recordings[case].frames["cost"].assign(network=label)
        for case, (label, _) in LABELS.items()
        if case in recordings
    ]
    table = pd.concat(tables).rename(columns={"memory_kb": "memory [kB]", "step_us": "shortest step [µs]"})
    return {"T4.D": table[["network", *(name for name in table.columns if name != "network")]]}
