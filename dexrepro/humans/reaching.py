"""A synthetic person who reaches over a small board and reacts to a cube stack on the way.

Lengths are in centimetres on the board: x and y in its plane, z up. Built into this generator, and therefore no
finding of whoever learns from it: left goes around, forward goes over, right goes around a low and over a tall obstacle
(so that forward and right overlap for a tall one); the reaction peaks where the obstacle stands and keeps the ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter1d
from scipy.optimize import brentq

from dexrepro.arrays import Array
from dexrepro.control.motion import minimum_jerk


def bump(phase: ArrayLike, peak: ArrayLike, sharpness: ArrayLike) -> Array:
    """A hump over the phase u in [0, 1]: zero at both ends, 1 at ``peak``, narrower for a larger ``sharpness``."""
    u, peak, sharpness = np.asarray(phase, float), np.asarray(peak, float), np.asarray(sharpness, float)
    return (u / peak) ** (sharpness * peak) * ((1 - u) / (1 - peak)) ** (sharpness * (1 - peak))


@dataclass(frozen=True)
class Reach:
    """A reach from ``start`` to ``goal`` (x, y) [cm] on the board."""

    start: Sequence[float]
    goal: Sequence[float]

    @property
    def ends(self) -> tuple[Array, Array]:
        """Start and goal as points (3,) [cm] on the board's surface."""
        return np.array([*self.start, 0.0]), np.array([*self.goal, 0.0])

    @property
    def length(self) -> float:
        """Distance from start to goal [cm]."""
        return float(np.hypot(self.goal[0] - self.start[0], self.goal[1] - self.start[1]))

    @property
    def axes(self) -> Array:
        """Path frame, rows (3, 3): along the straight line, to the left, up."""
        dx, dy = (self.goal[0] - self.start[0]) / self.length, (self.goal[1] - self.start[1]) / self.length
        return np.array([[dx, dy, 0.0], [-dy, dx, 0.0], [0.0, 0.0, 1.0]])

    def locate(self, point: Sequence[float]) -> tuple[float, float]:
        """Progress (share of the straight line) and lateral offset [cm, left positive] of a point (x, y) [cm]."""
        along, left = self.axes[:2, :2] @ (np.asarray(point, float)[:2] - np.asarray(self.start, float))
        return float(along / self.length), float(left)

    def moment(self, point: Sequence[float]) -> float:
        """Phase u at which a minimum-jerk reach passes a point (x, y) [cm]."""
        progress = self.locate(point)[0]
        return float(brentq(lambda u: float(minimum_jerk(u)) - progress, 0.0, 1.0))


@dataclass(frozen=True)
class Obstacle:
    """A stack of cubes on the board: centre of its foot (x, y), height and edge length [cm]."""

    position: Sequence[float]
    height: float
    side: float = 2.0

    def clearance(self, path: Array, tool_radius: float = 0.0) -> Array:
        """Smallest signed distance [cm] of a round tool to the stack along paths (..., samples, 3) [cm]."""
        half = np.array([self.side / 2, self.side / 2, self.height / 2])
        gap = np.abs(path - np.array([*self.position, self.height / 2])) - half
        outside = np.linalg.norm(np.maximum(gap, 0.0), axis=-1)
        return (outside + np.minimum(gap.max(axis=-1), 0.0)).min(axis=-1) - tool_radius


@dataclass(frozen=True)
class Reacher:
    """The person: how far and how reproducibly the reactions go.

    directions: the style variable of turning left, forward and right. lateral, lift: reaction [cm] beside the
    obstacle's centre and above the ordinary reach, one row a direction, one column a height of ``heights`` [cm];
    between them everything is linear. sharpness, along [cm]: of the reaction's hump and of its shift along the path.
    The variations are standard deviations: of the ordinary and of the reactive lift (relative), of the lateral reaction
    [cm], of the moment of reaction (phase); so are the slow wander and the sensor noise [cm].
    """

    directions: Sequence[float] = (0.0, 0.8, 1.0)
    heights: Sequence[float] = (2.0, 8.0)
    lateral: Sequence[Sequence[float]] = ((3.2, 3.4), (0.0, -0.6), (-3.0, -1.0))
    lift: Sequence[Sequence[float]] = ((1.5, 3.0), (4.0, 10.6), (1.5, 10.4))
    sharpness: Sequence[float] = (10.0, 10.0, 10.0)
    along: Sequence[float] = (0.0, 0.0, 0.0)
    tool_radius: float = 0.5
    ordinary_variation: float = 0.1
    lateral_variation: float = 0.30
    lift_variation: float = 0.04
    moment_variation: float = 0.012
    wander: float = 0.12
    sensor_noise: float = 0.01
    samples: int = 501
    wander_samples: float = 25.0

    @property
    def phase(self) -> Array:
        """The phase u of every sample, (samples,), from 0 to 1."""
        return np.linspace(0.0, 1.0, self.samples)

    def ordinary(self, reach: Reach, size: ArrayLike = 1.0) -> Array:
        """Undisturbed reaches (..., samples, 3) [cm]; ``size`` (...) scales their natural arc."""
        start, goal = reach.ends
        _, left, up = reach.axes
        straight = start + minimum_jerk(self.phase)[:, None] * (goal - start)
        arc = bump(self.phase, 0.5, 8.0)[:, None] * (up + 0.4 * left)
        return straight + np.asarray(size, float)[..., None, None] * arc

    def reaction(
        self,
        reach: Reach,
        obstacle: Obstacle,
        direction: float,
        aside: ArrayLike = 0.0,
        over: ArrayLike = 1.0,
        late: ArrayLike = 0.0,
    ) -> Array:
        """What a reaction adds to the ordinary reach, (..., samples, 3) [cm].

        ``aside`` [cm], ``over`` (factor) and ``late`` (phase), each (...), are this repetition's deviations.
        """
        aside, over, late = (np.asarray(value, float)[..., None] for value in (aside, over, late))
        lateral, lift = (self._amount(table, obstacle.height, direction) for table in (self.lateral, self.lift))
        sharpness, along = (np.interp(direction, self.directions, row) for row in (self.sharpness, self.along))
        moment = reach.moment(obstacle.position)
        hump = bump(self.phase, np.clip(moment + late, 0.1, 0.9), sharpness)
        parts = np.stack(
            [
                np.broadcast_to(along, hump.shape) * hump,
                (lateral + reach.locate(obstacle.position)[1] + aside) * hump,
                lift * over * hump,
            ],
            axis=-1,
        )
        return parts @ reach.axes

    def _amount(self, table: Sequence[Sequence[float]], height: float, direction: float) -> float:
        share = (height - self.heights[0]) / (self.heights[1] - self.heights[0])
        by_direction = [low + share * (high - low) for low, high in table]
        return float(np.interp(direction, self.directions, by_direction))

    def demonstrate_ordinary(self, reach: Reach, repetitions: int, rng: np.random.Generator) -> Array:
        """Recorded ordinary reaches, (repetitions, samples, 3) [cm]."""
        size = rng.normal(1.0, self.ordinary_variation, repetitions)
        return self.ordinary(reach, size) + self._noise(repetitions, rng)

    def demonstrate(
        self, reach: Reach, obstacle: Obstacle, direction: float, repetitions: int, rng: np.random.Generator
    ) -> Array:
        """Recorded reactions that clear the obstacle, (repetitions, samples, 3) [cm]; a collision is repeated.

        Raises RuntimeError when the person cannot pass the obstacle in this direction.
        """
        kept = np.empty((0, self.samples, 3))
        for _ in range(20):
            size = rng.normal(1.0, self.ordinary_variation, repetitions)
            aside = rng.normal(0.0, self.lateral_variation, repetitions)
            over = rng.normal(1.0, self.lift_variation, repetitions)
            late = rng.normal(0.0, self.moment_variation, repetitions)
            paths = self.ordinary(reach, size) + self.reaction(reach, obstacle, direction, aside, over, late)
            paths += self._noise(repetitions, rng)
            kept = np.concatenate([kept, paths[obstacle.clearance(paths, self.tool_radius) > 0]])
            if len(kept) >= repetitions:
                return kept[:repetitions]
        raise RuntimeError(f"the obstacle at {tuple(obstacle.position)} cm cannot be passed in direction {direction:g}")

    def _noise(self, repetitions: int, rng: np.random.Generator) -> Array:
        shape = (repetitions, self.samples, 3)
        slow = gaussian_filter1d(rng.standard_normal(shape), self.wander_samples, axis=1, mode="wrap")
        slow *= self.wander * np.sqrt(2 * np.sqrt(np.pi) * self.wander_samples)
        window = np.sin(np.pi * self.phase)[:, None] ** 2
        return slow * window + self.sensor_noise * rng.standard_normal(shape)
