"""What a node costs: memory, arithmetic and step time of growing and fixed networks against their size (Sect. 4.6)."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.networks import AdaptiveNetwork, Basis, Gaussians, GrowingGaussians, Lattice

RATE = 0.0


def simulate(config: Config, rng: Rng) -> Recording:
    draw = rng("inputs")
    rows = []
    for nodes in config.nodes:
        basis = _basis(config, nodes, draw)
        network = AdaptiveNetwork(basis, config.outputs, gain=1.0, leakage=config.leakage, step=1e-3)
        inputs = draw.uniform(-1, 1, (config.repetitions, config.inputs))
        features = len(basis(inputs[0]))
        fastest = _fastest(network, inputs, np.ones(config.outputs))  # before memory, which a first step reserves
        rows.append(
            {
                "nodes": nodes,
                "features": features,
                "memory_kb": (_size(network) + _size(basis)) / 1024,
                "exponentials": 2 * config.inputs if isinstance(basis, Lattice) else nodes,
                "multiplications": _multiplications(basis, nodes, features, config),
                "step_us": 1e6 * fastest,
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
    """Bytes of the arrays an object holds, those seen by several views once."""
    arrays = [value for value in vars(holder).values() if isinstance(value, np.ndarray)]
    owners = [value if value.base is None else value.base for value in arrays]
    return sum({id(owner): owner.nbytes for owner in owners}.values())


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
