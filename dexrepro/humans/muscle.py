"""Muscle stiffness of a reaching person, and its estimate from surface electromyography (EMG).

Built into this generator, and therefore no finding of whoever learns from it: stiffness rises when an obstacle comes
near, further for a taller one, earlier for a closer one, and equally for every direction of turning.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import uniform_filter1d
from scipy.signal import butter, sosfiltfilt
from scipy.special import expit

from dexrepro.arrays import Array
from dexrepro.humans.reaching import bump


def low_pass(
    signal: Array, cutoff: float, rate: float, padding: Literal["odd", "even"] = "odd", axis: int = -1
) -> Array:
    """Zero-phase second-order Butterworth filter; ``cutoff`` and sampling ``rate`` in [Hz].

    ``padding`` extends the edges: "odd" keeps the slope of a path, "even" suits a level, whose ends it does not bend.
    """
    sections = butter(2, cutoff, fs=rate, output="sos")
    padlen = int(min(rate / cutoff, signal.shape[axis] - 1))
    filtered: Array = sosfiltfilt(sections, signal, axis=axis, padtype=padding, padlen=padlen)
    return filtered


@dataclass(frozen=True)
class Muscle:
    """Normalised stiffness X^stf of the arm and the electrodes over it.

    rest: level without obstacle. swell: what the movement itself adds at its middle. rises: what an obstacle of each of
    ``heights`` [cm] adds, linear between. lead, spread: how much earlier than the passage the rise is half done, and
    its width (phase). channels, rate [Hz], window [s] and cutoff [Hz] belong to the EMG and its envelope.
    """

    rest: float = 0.030
    swell: float = 0.006
    heights: Sequence[float] = (2.0, 8.0)
    rises: Sequence[float] = (0.030, 0.080)
    lead: float = 0.10
    spread: float = 0.05
    channels: int = 8
    rate: float = 200.0
    window: float = 0.25
    cutoff: float = 2.0

    def stiffness(self, phase: ArrayLike, height: float = 0.0, moment: float | None = None) -> Array:
        """True X^stf at the phase u = t/T; ``moment`` is the phase at which the obstacle is passed (none: ordinary)."""
        u = np.asarray(phase, float)
        level = self.rest + self.swell * bump(u, 0.5, 6.0)
        if moment is None:
            return level
        share = (height - self.heights[0]) / (self.heights[1] - self.heights[0])
        rise = self.rises[0] + share * (self.rises[1] - self.rises[0])
        onset = moment - self.lead
        floor = expit(-onset / self.spread)
        return level + rise * (expit((u - onset) / self.spread) - floor) / (1 - floor)

    def record(self, stiffness: Array, rng: np.random.Generator) -> tuple[Array, float]:
        """EMG (channels, samples) of a contraction ``stiffness`` (samples,), and the channels' calibrated mean gain."""
        gains = rng.uniform(0.5, 1.5, self.channels)
        return gains[:, None] * stiffness * rng.standard_normal((self.channels, len(stiffness))), float(gains.mean())

    def estimate(self, emg: Array, gain: float) -> Array:
        """Stiffness (samples,) from EMG (channels, samples): mean rectified amplitude, moving average, low pass."""
        level = np.abs(emg).mean(axis=0) * np.sqrt(np.pi / 2) / gain
        level = uniform_filter1d(level, round(self.window * self.rate), mode="nearest")
        return low_pass(level, self.cutoff, self.rate, padding="even")

    def measure(
        self, duration: float, samples: int, rng: np.random.Generator, height: float = 0.0, moment: float | None = None
    ) -> Array:
        """One measured stiffness trace at ``samples`` equidistant instants of a reach of ``duration`` [s]."""
        phase = np.linspace(0.0, 1.0, round(duration * self.rate) + 1)
        trace = self.estimate(*self.record(self.stiffness(phase, height, moment), rng))
        return np.interp(np.linspace(0.0, 1.0, samples), phase, trace)
