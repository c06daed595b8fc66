"""What an arm's own sensors report: delayed, noisy, filtered tip force; quantised angles; filtered velocity."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np

from dexrepro.arrays import Array

Force = tuple[float, float, float]


@dataclass(frozen=True)
class Sensor:
    """Imperfections of an arm's sensors; the default is exact and immediate.

    force_noise: standard deviation of white noise on each force component [N], new at every control period;
    force_delay: whole control periods by which the force is late [s]; force_cutoff: corner of a first-order low-pass
    on the noisy force [Hz]. encoder_resolution: angles are rounded to its multiples [rad]; velocity_noise: standard
    deviation of white noise on joint velocities [rad/s]; velocity_cutoff: if given, velocities are the low-passed
    [Hz] difference of successive measured angles instead of the exact ones.
    """

    force_noise: float = 0.0
    force_delay: float = 0.0
    force_cutoff: float = math.inf
    encoder_resolution: float = 0.0
    velocity_noise: float = 0.0
    velocity_cutoff: float = math.inf

    @property
    def exact_force(self) -> bool:
        """Whether the force is reported as it is."""
        return self.force_noise == 0 and self.force_delay == 0 and math.isinf(self.force_cutoff)

    @property
    def exact_joints(self) -> bool:
        """Whether angles and rates are reported as they are."""
        return self.encoder_resolution == 0 and self.velocity_noise == 0 and math.isinf(self.velocity_cutoff)


def smoothing(cutoff: float, period: float) -> float:
    """Share of the new sample in a first-order low-pass with a corner [Hz] sampled every period [s]."""
    return 1.0 if math.isinf(cutoff) else 1.0 - math.exp(-2.0 * math.pi * cutoff * period)


class ForceChannel:
    """The force sensor of one arm, called once a control period with the true force (x, y, z) [N]."""

    def __init__(self, sensor: Sensor, period: float, rng: np.random.Generator | None) -> None:
        if sensor.force_noise and rng is None:
            raise ValueError("a noisy force sensor needs a random generator: add_arm(..., rng=rng('noise'))")
        self._noise, self._rng = sensor.force_noise, rng
        self._share = smoothing(sensor.force_cutoff, period)
        late = round(sensor.force_delay / period)
        self._queue: deque[Force] = deque([(0.0, 0.0, 0.0)] * late, maxlen=late + 1)
        self._value: Force | None = None

    def __call__(self, force: Force) -> Force:
        x, y, z = force
        if self._rng is not None and self._noise:
            noise, (a, b, c) = self._noise, self._rng.standard_normal(3).tolist()
            x, y, z = x + noise * a, y + noise * b, z + noise * c
        self._queue.append((x, y, z))
        x, y, z = self._queue[0]
        if self._value is not None:
            share, (a, b, c) = self._share, self._value
            x, y, z = a + share * (x - a), b + share * (y - b), c + share * (z - c)
        self._value = x, y, z
        return self._value


class JointChannel:
    """The joint sensors of one arm, called once a control period with true angles [rad] and velocities [rad/s]."""

    def __init__(self, sensor: Sensor, period: float, rng: np.random.Generator | None) -> None:
        if sensor.velocity_noise and rng is None:
            raise ValueError("noisy joint velocities need a random generator: add_arm(..., rng=rng('noise'))")
        self._sensor, self._period, self._rng = sensor, period, rng
        self._share = smoothing(sensor.velocity_cutoff, period)
        self._previous: Array | None = None
        self._velocity: Array | None = None

    def __call__(self, position: Array, velocity: Array) -> tuple[Array, Array]:
        grid = self._sensor.encoder_resolution
        if grid:
            position = grid * np.round(position / grid)
        if not math.isinf(self._sensor.velocity_cutoff):
            if self._previous is None or self._velocity is None:
                self._velocity = velocity
            else:
                difference = (position - self._previous) / self._period
                self._velocity = self._velocity + self._share * (difference - self._velocity)
            self._previous = position
            velocity = self._velocity
        if self._rng is not None and self._sensor.velocity_noise:
            velocity = velocity + self._sensor.velocity_noise * self._rng.standard_normal(len(velocity))
        return position, velocity
