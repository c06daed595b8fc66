"""Dynamic movement primitives: learned from a demonstration, rolled out whole or step by step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array, Mask

from .demonstration import Demonstration
from .kernels import FeatureMap, GaussianKernels, TruncatedKernels, phase
from .regression import least_squares, locally_weighted, locally_weighted_affine
from .transformation import SpringDamper


@dataclass(frozen=True)
class Scaling:
    """Amplitude A of the forcing term: g - x0 on the axes ``follows_goal``, the constant ``size`` on the others; (d,).

    Eq. (5.1) has A = g - x0 on every axis, which blows up where start and goal nearly agree.
    """

    follows_goal: Mask
    size: Array

    @classmethod
    def none(cls, dimensions: int) -> Scaling:
        """A = 1: the forcing term has the unit of the path."""
        return cls(np.zeros(dimensions, dtype=bool), np.ones(dimensions))

    @classmethod
    def goal(cls, dimensions: int) -> Scaling:
        """A = g - x0, as printed."""
        return cls(np.ones(dimensions, dtype=bool), np.ones(dimensions))

    @classmethod
    def guarded(cls, demonstration: Demonstration, threshold: float = 0.2) -> Scaling:
        """A = g - x0 on axes where that exceeds ``threshold`` of the demonstration's largest range, else that range."""
        largest = demonstration.extent.max()
        reach = np.abs(demonstration.goal - demonstration.start)
        return cls(reach > threshold * largest, np.full(reach.shape, largest))

    @classmethod
    def extent(cls, demonstration: Demonstration) -> Scaling:
        """A = the largest range of the demonstration, whatever the goal."""
        extent = demonstration.extent
        return cls(np.zeros(extent.shape, dtype=bool), np.full(extent.shape, extent.max()))

    def amplitude(self, start: ArrayLike, goal: ArrayLike) -> Array:
        """A for movements from ``start`` to ``goal`` (..., d)."""
        return np.where(self.follows_goal, np.subtract(goal, start), self.size)


class Trajectory(NamedTuple):
    """time (N,) [s]; position, velocity, acceleration (..., N, d), in units, units/s, units/s^2."""

    time: Array
    position: Array
    velocity: Array
    acceleration: Array


class Propagator(NamedTuple):
    """Responses of a primitive on a time grid; movements are linear in them, so a rollout is one matrix product.

    position_of_weights, velocity_of_weights: (N, p), response to each feature as forcing (velocity in units/s);
    position_of_start, velocity_of_start: (N,), free response to a unit offset x0 - g.
    """

    time: Array
    position_of_weights: Array
    velocity_of_weights: Array
    position_of_start: Array
    velocity_of_start: Array

    def position(self, weights: Array, start: ArrayLike, goal: ArrayLike) -> Array:
        """Positions (..., N, d) for weights times amplitude (..., p, d), starts and goals (..., d); from rest."""
        offset = np.asarray(start, dtype=float) - goal
        free = self.position_of_start[:, None] * offset[..., None, :]
        free += self.position_of_weights @ weights
        free += np.asarray(goal)[..., None, :]
        return free

    def velocity(self, weights: Array, start: ArrayLike, goal: ArrayLike) -> Array:
        """Velocities (..., N, d) [units/s] of the same movements."""
        offset = np.asarray(start, dtype=float) - goal
        return self.velocity_of_weights @ weights + self.velocity_of_start[:, None] * offset[..., None, :]


@dataclass(frozen=True)
class DMP:
    """A movement primitive: tau v' = K (g - x) - D v + A f(s), tau x' = v, f = features(s) @ weights; Eqs. (5.1)-(5.3).

    features: kernels, or any other map of phases (N,) to features (N, p); weights: (p, d); start, goal: x0 and g, (d,);
    time_constant: tau [s]; decay: rate o of the phase s = exp(-o t / tau); velocity: initial dx/dt [units/s], (d,).
    """

    features: FeatureMap
    weights: Array
    start: Array
    goal: Array
    system: SpringDamper
    scaling: Scaling
    time_constant: float
    decay: float
    velocity: Array | float = 0.0

    @classmethod
    def fit(
        cls,
        demonstration: Demonstration,
        features: FeatureMap,
        system: SpringDamper,
        decay: float,
        scaling: Scaling | None = None,
        time_constant: float | None = None,
        rest: float = 0.0,
        estimator: Literal["least_squares", "lwr"] = "least_squares",
        rcond: float = 1e-10,
        ridge: float = 0.0,
    ) -> DMP:
        """Learn the weights from one demonstration.

        scaling: None means A = 1; time_constant: tau [s], the demonstration's duration unless given;
        rest: share of the duration for which the training data stay at the goal afterwards, so that the forcing term is
        also learned to vanish there; estimator "lwr": locally weighted regression, for the plain kernels and for DMP+.
        """
        scaling = Scaling.none(demonstration.position.shape[1]) if scaling is None else scaling
        tau = demonstration.duration if time_constant is None else time_constant
        start, goal = demonstration.start, demonstration.goal
        samples = demonstration.with_rest(rest) if rest > 0 else demonstration
        phases = phase(samples.time - samples.time[0], tau, decay)
        target = forcing_target(samples, system, tau, goal) / _nonzero(scaling.amplitude(start, goal))
        if estimator == "lwr":
            weights = _local_weights(features, phases, target)
        else:
            weights = least_squares(features.features(phases), target, rcond, ridge)
        return cls(features, weights, start, goal, system, scaling, tau, decay, samples.velocity[0])

    def forcing(self, time: ArrayLike) -> Array:
        """f(s(t)) without amplitude, (N, d), at the instants ``time`` (N,) [s]."""
        return self.features.features(phase(time, self.time_constant, self.decay)) @ self.weights

    def rollout(
        self,
        step: float,
        horizon: float | None = None,
        start: ArrayLike | None = None,
        goal: ArrayLike | None = None,
        time_constant: float | None = None,
        extra_forcing: ArrayLike = 0.0,
    ) -> Trajectory:
        """The whole movement, exact for a forcing linear between samples.

        step: [s]; horizon: last instant [s], tau unless given; start, goal: (..., d), leading axes are a batch;
        time_constant: another tau [s] stretches time; extra_forcing: (..., N, d), added to A f (a coupling known
        beforehand).
        """
        tau = self.time_constant if time_constant is None else time_constant
        time = step * np.arange(round((tau if horizon is None else horizon) / step) + 1, dtype=float)
        start = self.start if start is None else np.asarray(start, dtype=float)
        goal = self.goal if goal is None else np.asarray(goal, dtype=float)
        f = self.features.features(phase(time, tau, self.decay)) @ self.weights
        forcing = f * self.scaling.amplitude(start, goal)[..., None, :] + np.asarray(extra_forcing)
        velocity = self.time_constant * np.asarray(self.velocity)  # tau dx/dt, kept when time is stretched
        position, scaled = self.system.solve(forcing, step / tau, start, goal, velocity)
        acceleration = self.system.acceleration(position, scaled, goal[..., None, :], forcing)
        return Trajectory(time, position, scaled / tau, acceleration / tau**2)

    def propagator(self, step: float, horizon: float | None = None) -> Propagator:
        """Responses on a grid, to be kept for many rollouts (goals, starts, weights) that begin at rest."""
        tau = self.time_constant
        time = step * np.arange(round((tau if horizon is None else horizon) / step) + 1, dtype=float)
        psi = self.features.features(phase(time, tau, self.decay))
        forcing = np.concatenate([psi, np.zeros((len(time), 1))], axis=1)
        position, velocity = self.system.solve(forcing, step / tau, np.append(np.zeros(psi.shape[1]), 1.0))
        velocity /= tau
        return Propagator(time, position[:, :-1], velocity[:, :-1], position[:, -1], velocity[:, -1])

    def online(self, step: float, start: ArrayLike | None = None, goal: ArrayLike | None = None) -> OnlineDMP:
        """The same movement one step at a time, open to perturbations."""
        return OnlineDMP(self, step, self.start if start is None else start, self.goal if goal is None else goal)


class OnlineDMP:
    """A primitive that advances step by step; without coupling it reproduces ``DMP.rollout`` to rounding.

    time [s]; position (d,) and velocity [units/s] may be overwritten between steps (a perturbation), and so may goal.
    """

    def __init__(self, primitive: DMP, step: float, start: ArrayLike, goal: ArrayLike) -> None:
        self.primitive = primitive
        self.dt = step
        self.goal = np.asarray(goal, dtype=float)
        self.position = np.asarray(start, dtype=float)
        self.velocity: Array = np.broadcast_to(np.asarray(primitive.velocity, dtype=float), self.position.shape)
        self.amplitude = primitive.scaling.amplitude(self.position, self.goal)
        self.index = 0
        self.forcing = self.amplitude * primitive.forcing([0.0])[0]

    @property
    def time(self) -> float:
        """Time that has passed [s]."""
        return self.index * self.dt

    @property
    def acceleration(self) -> Array:
        """The primitive's own d2x/dt2 at the present state [units/s^2]."""
        p = self.primitive
        scaled = p.time_constant * self.velocity
        return p.system.acceleration(self.position, scaled, self.goal, self.forcing) / p.time_constant**2

    def step(self, coupling: ArrayLike = 0.0) -> tuple[Array, Array]:
        """Advance one step with ``coupling`` (d,) added to A f, constant meanwhile; position and velocity there."""
        p = self.primitive
        self.index += 1
        following = self.amplitude * p.forcing([self.time])[0]
        self.position, scaled = p.system.step(
            self.position,
            p.time_constant * self.velocity,
            self.goal,
            self.forcing + coupling,
            following + coupling,
            self.dt / p.time_constant,
        )
        self.velocity = scaled / p.time_constant
        self.forcing = following
        return self.position, self.velocity


def forcing_target(demonstration: Demonstration, system: SpringDamper, time_constant: float, goal: ArrayLike) -> Array:
    """A f that reproduces a demonstration exactly, (N, d); Eq. (5.5) with the sign of D v corrected."""
    return system.forcing(
        demonstration.position,
        time_constant * demonstration.velocity,
        time_constant**2 * demonstration.acceleration,
        goal,
    )


def _local_weights(features: FeatureMap, phases: Array, target: Array) -> Array:
    if isinstance(features, GaussianKernels):
        return locally_weighted(features, phases, target)
    if isinstance(features, TruncatedKernels):
        return locally_weighted_affine(features, phases, target)
    raise TypeError("locally weighted regression needs Gaussian kernels: use least squares instead")


def _nonzero(amplitude: Array) -> Array:
    if np.any(amplitude == 0):
        raise ValueError(
            "start and goal agree on an axis, where the forcing term is scaled by their difference: use Scaling.guarded"
        )
    return amplitude
