"""Phase, Gaussian kernels and the features that a forcing term is linear in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array


def phase(time: ArrayLike, time_constant: float, decay: float) -> Array:
    """Canonical system in closed form: s = exp(-decay t / tau); Eq. (5.2), where the decay is called o."""
    return np.exp(-decay / time_constant * np.asarray(time, dtype=float))


class FeatureMap(Protocol):
    """Anything that a forcing term can be linear in: phases (N,) to features (..., N, p)."""

    @property
    def count(self) -> int:
        """Number of features p."""

    def features(self, phases: Array) -> Array:
        """Features (..., N, p) at phases (N,)."""


@dataclass(frozen=True)
class GaussianKernels:
    """phi_i(s) = exp(-h_i (s - c_i)^2); Eq. (5.3).

    centres: c_i, (..., n); sharpness: h_i = 1 / (2 std^2), (..., n). Leading axes are a batch (draws, say).
    """

    centres: Array
    sharpness: Array

    @classmethod
    def spaced(cls, count: int, decay: float, overlap: float = 0.5, phases: ArrayLike | None = None) -> GaussianKernels:
        """Kernels equally spaced in time: c_i = exp(-decay i / (count - 1)), h_i = overlap / (c_{i+1} - c_i)^2.

        phases: centres of one's own instead (decreasing).
        """
        centres = np.exp(-decay * np.linspace(0, 1, count)) if phases is None else np.asarray(phases, dtype=float)
        gaps = np.diff(centres)
        return cls(centres, overlap / np.append(gaps, gaps[-1]) ** 2)

    @classmethod
    def with_widths(cls, times: ArrayLike, decay: float, width: ArrayLike) -> GaussianKernels:
        """Kernels centred at normalised ``times`` (..., n) in [0, 1] that are ``width`` (..., n) wide in time.

        A kernel's standard deviation in s is c_i decay width_i: the same width in time wherever it sits.
        """
        centres = np.exp(-decay * np.asarray(times, dtype=float))
        return cls(centres, 0.5 / (centres * decay * np.asarray(width)) ** 2)

    @property
    def count(self) -> int:
        return self.centres.shape[-1]

    @property
    def deviations(self) -> Array:
        """Standard deviations in s, (..., n)."""
        return np.sqrt(0.5 / self.sharpness)

    def exponents(self, phases: Array) -> Array:
        """log phi, (..., n, N): one row a kernel, the layout in which everything here is fastest."""
        distance = phases - self.centres[..., None]
        np.square(distance, out=distance)
        distance *= -self.sharpness[..., None]
        return distance

    def activations(self, phases: Array) -> Array:
        """phi, (..., N, n)."""
        exponents = self.exponents(phases)
        return np.exp(exponents, out=exponents).swapaxes(-1, -2)

    def features(self, phases: Array) -> Array:
        """psi_i = s phi_i / sum phi, (..., N, n); they sum to s, Eq. (5.7), even where every phi underflows."""
        psi = self.exponents(phases)
        psi -= psi.max(axis=-2, keepdims=True)
        np.exp(psi, out=psi)
        psi *= (phases / psi.sum(axis=-2))[..., None, :]
        return psi.swapaxes(-1, -2)


@dataclass(frozen=True)
class TruncatedKernels:
    """Features of DMP+: f = sum psi~_i (w_i s + b_i) / sum psi~_i, weights [w; b].

    A kernel is cut off where the phase has passed its centre by ``reach`` standard deviations, with ``two_sided`` also
    where it has not come that near. Where no kernel is alive every feature is 0.
    """

    kernels: GaussianKernels
    reach: float = 3.0
    two_sided: bool = False

    @property
    def count(self) -> int:
        return 2 * self.kernels.count

    def features(self, phases: Array) -> Array:
        """[psi~ s | psi~] / sum psi~, (..., N, 2 n)."""
        exponents = self.kernels.exponents(phases)
        offset = phases - self.kernels.centres[..., None]
        reach = self.reach * self.kernels.deviations[..., None]
        dead = (np.abs(offset) > reach) if self.two_sided else (offset < -reach)
        exponents[dead] = -np.inf
        largest = exponents.max(axis=-2, keepdims=True)
        psi = np.exp(exponents - np.where(np.isfinite(largest), largest, 0.0))
        total = psi.sum(axis=-2, keepdims=True)
        psi /= np.where(total > 0, total, 1.0)
        return np.concatenate([psi * phases, psi], axis=-2).swapaxes(-1, -2)
