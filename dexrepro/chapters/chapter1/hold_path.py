"""The path along which an operator leads an object from the left to the right target, Section 1.5.2.2 (Fig. 1.19)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import signal

from dexrepro.arrays import Array
from dexrepro.humans.operator import Tremor, strides


@dataclass(frozen=True)
class HoldPath:
    """Commands to the teleoperated follower, one a control period.

    position (n, 3) [m] of its end point; axis (n, 3), the holding line from it to its partner; tilt (n,) [rad] of
    that line below the horizontal; phases: names and starts [s] of what the operator does.
    """

    position: Array
    axis: Array
    tilt: Array
    phases: dict[str, float]

    @property
    def rotation(self) -> Array:
        """Rotation matrices (n, 3, 3): z along the holding line, x down while the line is level."""
        c, s = np.cos(self.tilt), np.sin(self.tilt)
        zero, one = np.zeros_like(c), np.ones_like(c)
        x = np.stack([zero, -s, -c], axis=1)
        y = np.stack([-one, zero, zero], axis=1)
        return np.stack([x, y, self.axis], axis=2)


def _smooth(time: Array, start: float, duration: float) -> Array:
    """A minimum-jerk step from 0 to 1."""
    share = strides(1000)
    return np.interp((time - start) / duration, np.linspace(0, 1, 1001), np.r_[0.0, share])


def hold_path(config: Any, start: Array, rng: np.random.Generator) -> HoldPath:
    """The path of one trajectory: lift, left, tilt, swing along the line, level, right, down and press.

    start: where the end point touches the object [m], the holding line along y.
    """
    dt = config.control_period
    time = dt * np.arange(round(config.duration / dt) + 1)
    left, right = rng.uniform(*config.path.left), rng.uniform(*config.path.right)
    tilting = rng.uniform(9.0, 10.0)
    period, swing = rng.uniform(*config.path.period), rng.uniform(*config.path.swing)
    swinging = tilting + 2.0
    level = swinging + 4 * period
    moving = level + 2.0
    down = moving + 3.0
    tilt = config.path.tilt * (_smooth(time, tilting, 2.0) - _smooth(time, level, 2.0))
    fade = np.clip((time - swinging) / 0.8, 0, 1) * np.clip((level - time) / 0.8, 0, 1)
    along = swing * fade * np.sin(2 * np.pi * (time - swinging) / period)
    across = left * _smooth(time, 4.0, 3.0) - right * _smooth(time, moving, 3.0)
    height = config.path.lift * (_smooth(time, 1.5, 2.0) - _smooth(time, down, 1.5))
    height = height - config.path.press * _smooth(time, down + 1.5, 0.3)
    axis = np.stack([np.zeros_like(tilt), np.cos(tilt), -np.sin(tilt)], axis=1)
    # The line turns about the middle of the object that is held.
    pivot = start + config.path.pivot * np.array([0.0, 1.0, 0.0])
    middle = pivot + np.stack([np.zeros_like(time), across, height], axis=1) + along[:, None] * axis
    b, a = signal.butter(2, 1.0, fs=1.0 / dt)
    drift = signal.lfilter(b, a, rng.standard_normal((len(time), 3)), axis=0)
    drift *= config.path.drift / drift.std() * np.clip(time / 2.0, 0, 1)[:, None]
    shake = Tremor(config.path.tremor, rng, dt, 3)(len(time))
    phases = {
        "lift": 1.5, "left": 4.0, "tilt": tilting, "swing": swinging, "level": level, "right": moving, "press": down,
    }  # fmt: skip
    return HoldPath(middle - config.path.pivot * axis + drift + shake, axis, tilt, phases)
