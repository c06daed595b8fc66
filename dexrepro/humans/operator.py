"""A synthetic operator whose hand drives a tool through a scaled mapping.

The hand moves in discrete minimum-jerk submovements (Flash & Hogan 1985) whose number is decided by visual correction
(Meyer et al. 1988) and whose duration follows Fitts' law (Fitts 1954). The end point of a submovement scatters in
proportion to its amplitude, more along than across (Harris & Wolpert 1998; van Beers et al. 2004), plus a part that
does not depend on amplitude. Physiological tremor of 8-12 Hz rides on everything (Elble & Koller 1990). Forearm roll
is comfortable within about +-40 degrees of the neutral posture and ends near 80 degrees, beyond which the shoulder has
to help (Boone & Azen 1979; Morrey et al. 1981). One set of traits serves every mapping.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import signal

from dexrepro.arrays import Array
from dexrepro.control.motion import minimum_jerk
from dexrepro.control.pose_transformation import scaled_path

COMFORTABLE_ROLL = np.deg2rad(40.0)
FOREARM_ROLL = np.deg2rad(80.0)
FITTS_INTERCEPT, FITTS_SLOPE, FITTS_WIDTH = 0.25, 0.12, 0.01  # s, s a bit, m
ROLL_SPEED = np.deg2rad(90.0)  # mean speed of a turn of the forearm [rad/s]


@dataclass(frozen=True)
class Operator:
    """Traits of one person.

    along, across: scatter of a submovement's end per amplitude [-]; scatter: its constant part [m].
    tremor: RMS per axis [m]; vision: error with which a distance is seen [m], per axis.
    tolerance: distance at which the target counts as reached [m]; patience: when the person stops correcting [s].
    reaction: time from seeing to moving [s].
    """

    along: float
    across: float
    scatter: float
    tremor: float
    vision: float
    tolerance: float
    patience: float
    reaction: float

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Operator:
        """A person from a population of young adults."""
        return cls(
            along=rng.uniform(0.05, 0.12),
            across=rng.uniform(0.02, 0.06),
            scatter=rng.uniform(2e-4, 6e-4),
            tremor=2.5e-4 * np.exp(0.35 * rng.standard_normal()),
            vision=rng.uniform(5e-4, 1.5e-3),
            tolerance=rng.uniform(2e-3, 4e-3),
            patience=rng.uniform(3.0, 6.0),
            reaction=rng.uniform(0.18, 0.28),
        )


def strides(samples: int) -> Array:
    """Share of a minimum-jerk movement done after each of ``samples`` equal steps, from just above 0 to 1."""
    return minimum_jerk(np.arange(1, samples + 1) / samples)


class Tremor:
    """Band-limited (8-12 Hz) noise of a given RMS, continued from call to call."""

    def __init__(self, rms: float, rng: np.random.Generator, dt: float, axes: int) -> None:
        self.b, self.a = signal.butter(2, (8.0, 12.0), "bandpass", fs=1.0 / dt)
        impulse = signal.lfilter(self.b, self.a, np.r_[1.0, np.zeros(int(5.0 / dt))])
        self.gain, self.rng = rms / np.sqrt(np.sum(impulse**2)), rng
        self.state = np.zeros((4, axes))
        self(int(1.0 / dt))

    def __call__(self, samples: int) -> Array:
        """The next ``samples`` displacements [m], shape (samples, axes)."""
        white = self.gain * self.rng.standard_normal((samples, self.state.shape[1]))
        path, self.state = signal.lfilter(self.b, self.a, white, axis=0, zi=self.state)
        return path


class Hand:
    """The hand of an operator on the leader and the tool that it drives.

    scaling: hand speed [m/s] -> scale [-], as in ``control.pose_transformation``; dt: sampling time [s].
    cutoff: of a low-pass of the hand's velocity before it sets the scale [Hz]; None takes it as it is.
    tool: position at the start [m], shape (3,). ``record`` holds the whole history once something has moved.
    """

    def __init__(
        self,
        operator: Operator,
        scaling: Callable[[Array], Array],
        rng: np.random.Generator,
        *,
        dt: float = 0.01,
        tool: Array,
        cutoff: float | None = None,
    ) -> None:
        self.operator, self.scaling, self.dt, self.cutoff = operator, scaling, dt, cutoff
        noise, shake = rng.spawn(2)
        self.rng, self.tremor = noise, Tremor(operator.tremor, shake, dt, 3)
        self.centre, self.hand, self.tool = np.zeros(3), self.tremor(1)[0], np.array(tool, float)
        self.roll, self.tool_roll = 0.0, 0.0
        self.samples, self.submovements, self.clutches = 0, 0, 0
        self._smoothing = np.zeros((1, 3))
        self.parts: list[tuple[Array, Array, Array, Array, Array]] = []
        self._speeds = np.linspace(0.0, 3.0, 301)
        profile = np.diff(strides(100), prepend=0.0)
        self._tool_speeds = (self.scaling(self._speeds[:, None] * profile * 100) * profile).sum(1) * self._speeds

    @property
    def time(self) -> float:
        """Time that has passed [s]."""
        return self.samples * self.dt

    def record(self) -> dict[str, Array]:
        """Histories of ``hand`` and ``tool`` [m], ``scale`` [-], ``roll`` and ``tool_roll`` [rad], and ``time`` [s]."""
        names = ("hand", "tool", "scale", "roll", "tool_roll")
        history = {name: np.concatenate(part) for name, part in zip(names, zip(*self.parts))}
        return history | {"time": self.dt * np.arange(1, self.samples + 1)}

    def _advance(self, path: Array, roll: Array, engaged: bool = True) -> None:
        """Append the intended path of the hand and its roll; the tool follows while the leader is engaged."""
        hand = path + self.tremor(len(path))
        moved, scale = self._moved(np.vstack([self.hand, hand]))
        tool = self.tool + (moved[1:] if engaged else np.zeros_like(hand))
        tool_roll = self.tool_roll + (roll - self.roll if engaged else np.zeros_like(roll))
        self.parts.append((hand, tool, scale[1:], roll, tool_roll))
        self.hand, self.tool, self.roll, self.tool_roll = hand[-1], tool[-1], float(roll[-1]), float(tool_roll[-1])
        self.centre, self.samples = path[-1], self.samples + len(path)

    def _moved(self, hand: Array) -> tuple[Array, Array]:
        """Displacement of the tool [m] and scale along a path of the hand (n, 3) [m]."""
        if self.cutoff is None:
            return scaled_path(hand, self.scaling, self.dt)
        share = 1.0 - math.exp(-2 * math.pi * self.cutoff * self.dt)
        steps = np.diff(hand, axis=0)
        smooth, self._smoothing = signal.lfilter([share], [1.0, share - 1.0], steps, axis=0, zi=self._smoothing)
        scale = self.scaling(np.linalg.norm(smooth, axis=1) / self.dt)
        return np.cumsum(np.vstack([np.zeros(3), scale[:, None] * steps]), axis=0), np.r_[scale[0], scale]

    def _hold(self, duration: float) -> tuple[int, Array, Array]:
        samples = max(1, round(duration / self.dt))
        return samples, np.repeat(self.centre[None], samples, 0), np.full(samples, self.roll)

    def wait(self, duration: float) -> None:
        """Hold still for a duration [s], but for the tremor."""
        _, path, roll = self._hold(duration)
        self._advance(path, roll)

    def amplitude(self, distance: float, duration: float) -> float:
        """Hand amplitude [m] of a submovement that takes the tool ``distance`` [m] far: a well trained inverse."""
        return duration * float(np.interp(distance / duration, self._tool_speeds, self._speeds))

    def submove(self, displacement: Array, duration: float | None = None) -> None:
        """One submovement meant to take the tool by ``displacement`` [m], shape (3,)."""
        distance = float(np.linalg.norm(displacement))
        if duration is None:
            duration = FITTS_INTERCEPT + FITTS_SLOPE * np.log2(1.0 + distance / FITTS_WIDTH)
        samples, path, roll = self._hold(duration)
        size = self.amplitude(distance, samples * self.dt)
        direction = displacement / max(distance, 1e-12)
        noise = self.rng.standard_normal((2, 3))
        across = noise[0] - direction * (noise[0] @ direction)
        along = direction * (noise[0] @ direction)
        end = size * (direction + self.operator.along * along + self.operator.across * across)
        end = end + self.operator.scatter * noise[1]
        self.submovements += 1
        self._advance(path + strides(samples)[:, None] * end, roll)

    def reach(self, target: Array, axes: tuple[int, ...] = (0, 1, 2)) -> None:
        """Bring the tool to ``target`` [m] by submovements and visual correction along ``axes``."""
        mask = np.isin(np.arange(3), axes).astype(float)
        start = self.time
        while True:
            self.wait(self.operator.reaction)
            seen = mask * (target - self.tool + self.operator.vision * self.rng.standard_normal(3))
            if np.linalg.norm(seen) < self.operator.tolerance or self.time - start > self.operator.patience:
                return
            self.submove(seen)

    def turn(self, angle: float) -> None:
        """Turn the tool by ``angle`` [rad] in one go."""
        samples, path, roll = self._hold(abs(angle) / ROLL_SPEED)
        self._advance(path, roll + strides(samples) * angle * (1 + self.operator.along * self.rng.normal()))

    def clutch(self, centre: Array | None = None, roll: float | None = None, duration: float = 0.6) -> None:
        """Let go of the tool, bring the hand to ``centre`` [m] and ``roll`` [rad], and fix them together anew."""
        samples, path, rolls = self._hold(duration + self.operator.reaction)
        share = strides(samples)
        if centre is not None:
            path = path + share[:, None] * (centre - self.centre)
        if roll is not None:
            rolls = rolls + share * (roll - self.roll)
        self.clutches += 1
        self._advance(path, rolls, engaged=False)
