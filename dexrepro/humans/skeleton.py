"""A person carrying a box with two hands, and what a depth camera reports of the arms.

Lengths in cm; x to the person's right, y forward, z up, origin between the shoulders. Joints are ordered as
``JOINTS``; arrays of positions have shape (..., 6, 3).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter1d

from dexrepro.arrays import Array
from dexrepro.control.motion import minimum_jerk

JOINTS = ("left_shoulder", "left_elbow", "left_wrist", "right_shoulder", "right_elbow", "right_wrist")
SIDES = np.array([-1.0, 1.0])  # left, right


@dataclass(frozen=True)
class Body:
    """Lengths [cm]: shoulder to elbow, elbow to wrist, half the shoulder width; the box is held at its two ends."""

    upper_arm: float = 22.0
    forearm: float = 28.0
    half_width: float = 20.0
    box_length: float = 33.0


def carry(
    u: ArrayLike,
    body: Body,
    centres: ArrayLike,
    instants: ArrayLike,
    yaw: float,
    twist: float,
    turning: tuple[float, float] = (0.25, 0.75),
    smoothing: float = 0.012,
) -> Array:
    """True joint positions (n, 6, 3) at normalised times u (n,).

    centres: box centres (k, 3) [cm] at normalised ``instants`` (k,), minimum jerk in between; yaw, twist: box and
    shoulders turn from this angle to its negative [rad] during ``turning``; smoothing: of the corners, share of time.
    """
    u, centres, instants = np.asarray(u, float), np.asarray(centres, float), np.asarray(instants, float)
    piece = np.clip(np.searchsorted(instants, u, side="right") - 1, 0, len(instants) - 2)
    progress = minimum_jerk((u - instants[piece]) / (instants[piece + 1] - instants[piece]))
    centre = centres[piece] + progress[:, None] * (centres[piece + 1] - centres[piece])
    centre = gaussian_filter1d(centre, smoothing * len(u), axis=0, mode="nearest")
    turn = 1 - 2 * minimum_jerk((u - turning[0]) / (turning[1] - turning[0]))
    wrists = centre[:, None] + SIDES[:, None] * body.box_length / 2 * _heading(yaw * turn)[:, None]
    shoulders = SIDES[:, None] * body.half_width * _heading(twist * turn)[:, None]
    elbows = np.stack([_elbow(shoulders[:, i], wrists[:, i], body, SIDES[i]) for i in (0, 1)], axis=1)
    return np.stack([shoulders, elbows, wrists], axis=2).reshape(len(u), 6, 3)


def _heading(angle: Array) -> Array:
    return np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)


def _elbow(shoulder: Array, wrist: Array, body: Body, side: float) -> Array:
    """Elbow at the given lengths from shoulder and wrist (n, 3), hanging down and a little outward."""
    axis = wrist - shoulder
    reach = np.linalg.norm(axis, axis=1, keepdims=True)
    if (reach >= body.upper_arm + body.forearm).any():
        raise ValueError(f"a wrist is {reach.max():.1f} cm from its shoulder, out of reach")
    axis = axis / reach
    along = (body.upper_arm**2 - body.forearm**2 + reach**2) / (2 * reach)
    pole = np.array([0.6 * side, -0.1, -1.0])
    down = pole - (axis @ pole)[:, None] * axis
    down /= np.linalg.norm(down, axis=1, keepdims=True)
    return shoulder + along * axis + np.sqrt(body.upper_arm**2 - along**2) * down


@dataclass(frozen=True)
class Occlusion:
    """A joint hidden for a while, and reported elsewhere: bias [cm] (3,) around a normalised instant, of a width."""

    centre: float
    width: float
    bias: Sequence[float]


@dataclass(frozen=True)
class DepthCamera:
    """Measurement of joint positions with noise, bursts and occlusion.

    noise: standard deviation [cm] of shoulders, elbows and wrists; occlusions by joint name, common to all
    demonstrations but for 10 % of amplitude and 0.01 of the instant; occlusion_gain scales them all; bursts: expected
    number of short disturbances of each elbow and wrist in a demonstration.
    """

    noise: tuple[float, float, float] = (1.0, 1.5, 2.0)
    occlusions: Mapping[str, Occlusion] | None = None
    occlusion_gain: float = 1.0
    bursts: float = 1.0

    def observe(self, truth: Array, count: int, rng: np.random.Generator) -> Array:
        """Measurements (count, n, 6, 3) of ``count`` demonstrations of joints (n, 6, 3) at equal steps of time."""
        samples = len(truth)
        u = np.linspace(0, 1, samples)
        std = np.tile(self.noise, 2)[:, None]
        slow = gaussian_filter1d(rng.normal(size=(count, samples, 6, 3)), 8, axis=1, mode="wrap")
        slow *= np.sqrt(2 * np.sqrt(np.pi) * 8)  # back to unit variance
        measured = truth + 0.9 * std * slow + 0.4 * std * rng.normal(size=slow.shape)
        for name, hidden in (self.occlusions or {}).items():
            gain = self.occlusion_gain * rng.normal(1, 0.1, count)
            centre = hidden.centre + rng.normal(0, 0.01, count)
            shape = np.exp(-0.5 * ((u - centre[:, None]) / hidden.width) ** 2)
            measured[:, :, JOINTS.index(name)] += (gain[:, None] * shape)[..., None] * np.asarray(hidden.bias)
        for joint in (1, 2, 4, 5):
            for demonstration in range(count):
                for _ in range(rng.poisson(self.bursts)):
                    instant, width = rng.uniform(0, 1), rng.uniform(0.01, 0.03)
                    size = rng.normal(0, 2 * self.noise[joint % 3], 3)
                    measured[demonstration, :, joint] += np.exp(-0.5 * ((u - instant) / width) ** 2)[:, None] * size
        return measured
