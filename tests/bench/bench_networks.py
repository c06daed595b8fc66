"""Time of one control step of the networks of Sect. 4.6: 14 inputs, 7 outputs."""

import numpy as np
import pytest

from dexrepro.networks import AdaptiveNetwork, Gaussians, GrowingGaussians, Lattice

LEVELS = [[-1.0, 1.0]] * 14


def broad():
    basis = GrowingGaussians(14, width=1.0, threshold=1e9, max_nodes=72)
    basis.reset(np.random.default_rng(0).uniform(-1, 1, (72, 14)))
    return basis


BASES = {
    "broad, 72 nodes": broad,
    "lattice, 16384 nodes": lambda: Lattice(LEVELS, 1.0),
    "plain formula, 16384 nodes": lambda: Gaussians(Lattice(LEVELS, 1.0).centres, 1.0),
}


@pytest.mark.parametrize("name", BASES)
def test_control_step(benchmark, name):
    network = AdaptiveNetwork(BASES[name](), 7, gain=1.0, leakage=0.01, step=1e-3)
    z, error = np.full(14, 0.3), np.ones(7)

    def step():
        network.output(z, grow=True)
        network.adapt(error)

    benchmark(step)
