"""The three networks that stand in for an arm's dynamics in task space: growing or on a fixed grid."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.networks import AdaptiveNetwork, Basis, GrowingGaussians, Lattice

KINDS = ("broad", "broad_plain", "fuzzy", "fuzzy_enhanced", "constant")
EVERYWHERE = 1e9  # m; so wide that a Gaussian is 1 wherever the arm is


def dynamics_networks(
    kind: str,
    axes: int,
    widths: Sequence[float],
    rates: Sequence[float],
    leakage: float,
    thresholds: Sequence[float],
    neighbours: int,
    placement: float,
    step: float,
    position_levels: Sequence[float] = (),
    velocity_levels: Sequence[float] = (),
    max_nodes: int = 300,
) -> tuple[AdaptiveNetwork, AdaptiveNetwork, AdaptiveNetwork]:
    """Networks for D (d^2 outputs of x), C (d^2 outputs of [x, x']) and G (d outputs of x), Eqs. (8.32) to (8.34).

    kind: "broad" grows nodes and enhances them with cos and sin, Eqs. (8.18) to (8.24); "broad_plain" grows without
    enhancement; "fuzzy" has Gaussians on the grid of the levels [m, m/s]; "fuzzy_enhanced" adds cos and sin to it;
    "constant" has one node that is 1 everywhere, which makes of each network a (leaky) integral of the error.
    D and G share one basis where width and threshold are the same, as the same inputs then give the same nodes.
    widths, rates (Gamma), thresholds (Theta; m, for C mixed with m/s): three numbers each, for D, C and G.
    leakage: beta [1/s]; neighbours, placement: m and beta_1 of Eqs. (8.19), (8.20); step: period of adaptation [s].
    """
    if kind not in KINDS:
        raise ValueError(f"kind of networks '{kind}' is none of {', '.join(KINDS)}")

    @cache
    def basis(dimension: int, width: float, threshold: float) -> Basis:
        if kind == "constant":
            return GrowingGaussians(dimension, width=EVERYWHERE, threshold=EVERYWHERE, enhanced=False)
        if kind.startswith("broad"):
            return GrowingGaussians(
                dimension,
                width=width,
                threshold=threshold,
                neighbours=neighbours,
                placement=placement,
                enhanced=kind == "broad",
                max_nodes=max_nodes,
            )
        levels = [position_levels] * axes + [velocity_levels] * (dimension - axes)
        grid = Lattice(levels, width)
        return grid if kind == "fuzzy" else EnhancedGrid(grid.centres, width)

    sizes = ((axes, axes**2), (2 * axes, axes**2), (axes, axes))
    inertia, coriolis, gravity = (
        AdaptiveNetwork(basis(dimension, width, threshold), outputs, gain=rate, leakage=leakage, step=step)
        for (dimension, outputs), width, threshold, rate in zip(sizes, widths, thresholds, rates, strict=True)
    )
    return inertia, coriolis, gravity


class EnhancedGrid(GrowingGaussians):
    """Gaussians with cos and sin at fixed centres (n, dimension): a growing basis that is full from the start."""

    def __init__(self, centres: Array, width: float) -> None:
        self._grid = centres
        super().__init__(centres.shape[1], width=width, threshold=np.inf, max_nodes=len(centres))

    def reset(self, centres: ArrayLike | None = None) -> None:
        """Back to the grid, whatever ``centres`` says."""
        super().reset(self._grid)
