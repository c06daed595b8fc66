"""Function approximators that are linear in their weights: fixed, lattice, fuzzy and growing Gaussian features.

A basis turns an input into features; an :class:`AdaptiveNetwork` puts weights on them and learns::

    basis = GrowingGaussians(8, width=20, threshold=20, neighbours=3, placement=0.5, interval=10)
    network = AdaptiveNetwork(basis, outputs=2, gain=60, leakage=0.01, step=1e-3)
    estimate = network.output(z, grow=True)      # once a control period
    network.adapt(error)
"""

from dexrepro.networks.adaptive import AdaptiveNetwork
from dexrepro.networks.basis import Basis, Gaussians, Lattice
from dexrepro.networks.growing import GrowingGaussians

__all__ = ["AdaptiveNetwork", "Basis", "Gaussians", "GrowingGaussians", "Lattice"]
