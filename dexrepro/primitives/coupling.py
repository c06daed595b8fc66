"""Coupling terms of other authors for obstacles, partners and surfaces (Table 6.1).

[16] Hoffmann et al. steer around points, [39] Park et al. descend a dynamic potential, [20] Umlauft et al. and [19]
Gams et al. hold the distance of two agents, [17] follows a surface with a force. v is tau dx/dt throughout.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from dexrepro.arrays import Array
from dexrepro.primitives.constrained import CRITICAL, Skill
from dexrepro.primitives.transformation import Integrator, SpringDamper, Step, runge_kutta, semi_implicit

Term = Callable[[int, Array, Array], Array]


def steering(position: Array, velocity: Array, points: Array, strength: float | Array, decay: float | Array) -> Array:
    """[16]: p = gamma R v phi exp(-beta phi), summed over obstacle points, in the plane.

    phi is the angle between the direction to the point and v; R turns v by 90 degrees, away from the point. A heading
    exactly at the point has no side: p = 0. position, velocity: (..., 2); points: (..., m, 2); strength, decay: gamma
    and beta, broadcast with (..., m).
    """
    to = points - position[..., None, :]
    v = velocity[..., None, :]
    cross = to[..., 0] * v[..., 1] - to[..., 1] * v[..., 0]
    angle = np.arctan2(np.abs(cross), (to * v).sum(-1))
    size = (np.sign(cross) * strength * angle * np.exp(-decay * angle)).sum(-1)
    return size[..., None] * np.stack([-velocity[..., 1], velocity[..., 0]], axis=-1)


def dynamic_potential(
    position: Array,
    velocity: Array,
    closest: Callable[[Array], Array],
    strength: float,
    power: float,
    step: float = 1e-5,
) -> Array:
    """[39]: minus the gradient of lambda (-cos theta)^beta |v| / distance, theta from v to the way off the obstacle.

    position, velocity: (..., 2); closest: closest obstacle point of positions, same shape. The gradient is numerical,
    because the closest point moves along with the position.
    """
    shifts = step * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    probes = position[..., None, :] + shifts
    away = probes - closest(probes)
    distance = np.linalg.norm(away, axis=-1)
    speed = np.linalg.norm(velocity, axis=-1)[..., None]
    approach = np.maximum(-(away @ velocity[..., None])[..., 0] / (distance * speed + 1e-300), 0)
    level = strength * approach**power * speed / (distance + 1e-300)
    return np.stack([level[..., 1] - level[..., 0], level[..., 3] - level[..., 2]], axis=-1) / (2 * step)


def coupled_rollout(
    skill: Skill, term: Term, dt: float, position: Array, velocity: Array, integrator: Integrator = runge_kutta
) -> Array:
    """Path (n, ..., d) of a primitive with a term(k, x, v) added to tau dv/dt; dt: step [s]."""
    x, v = np.array(position, float, subok=True), np.array(velocity, float, subok=True)
    path = np.empty((len(skill.forcing), *x.shape))
    for k in range(len(path)):
        path[k] = x
        if k < len(path) - 1:
            x, v = integrator(skill.step(k, partial(term, k)), x, v, dt)
    return path


@dataclass(frozen=True)
class Agents:
    """Two primitives whose distance is held by a velocity coupling; [20] with ``prediction`` 0, else [19].

    tau dv/dt = primitive + c2 dC/dt, tau dx/dt = v + C with C = -k n (|x_i - x_j| - d) along the line n between the
    agents, opposite on the two. slowing: eta of [20], by which the phase waits for an agent off its distance.
    """

    coupling: float
    distance: float
    prediction: float = 0.0
    slowing: float = 0.0
    system: SpringDamper = CRITICAL
    decay: float = 0.7

    def rollout(
        self,
        forcing: Callable[[float], Array],
        starts: Array,
        goals: Array,
        push: Callable[[float], Array],
        dt: float,
        duration: float,
    ) -> Array:
        """Paths (n, 2, d) for tau = 1 s; forcing(s): (2, d) of both agents; push(t): added to their dv/dt, (2, d)."""
        goals = np.asarray(goals, dtype=float)
        x, v, s = np.array(starts, float), np.zeros_like(np.asarray(starts, float)), np.ones(2)
        previous = self._pull(x)
        path = [x]
        for k in range(round(duration / dt)):
            pull = self._pull(x)
            forces = np.stack([forcing(s[i])[i] for i in (0, 1)])
            forces = forces + self.prediction * (pull - previous) / dt + push(k * dt)
            x, v = semi_implicit(Step(self.system, goals, 1.0, (forces, forces), drift=pull), x, v, dt)
            s = s - dt * self.decay * s / (1 + self.slowing * (pull**2).sum(1) / max(self.coupling, 1e-9) ** 2)
            previous = pull
            path.append(x)
        return np.array(path)

    def _pull(self, x: Array) -> Array:
        gap = x[0] - x[1]
        distance = np.linalg.norm(gap)
        pull = -self.coupling * gap / distance * (distance - self.distance)
        return np.stack([pull, -pull])


@dataclass(frozen=True)
class SurfaceFollower:
    """[17]: the acceleration normal to a surface is corrected by a PI law on the contact force [N]."""

    proportional: float
    integral: float
    set_force: float

    def rollout(
        self, skill: Skill, position: Array, dt: float, surface: Callable[[float], float], stiffness: float
    ) -> tuple[Array, Array]:
        """Path (n, 2) and contact force (n,) [N]; surface(x): height; stiffness: of the contact [N/length]."""
        x, v, total = np.array(position, float), np.zeros(2), 0.0
        path, forces = [], []
        for k in range(len(skill.forcing)):
            force = stiffness * max(surface(x[0]) - x[1], 0.0)
            path.append(x)
            forces.append(force)
            error = force - self.set_force
            total += error * dt
            correction = np.array([0.0, self.proportional * error + self.integral * total])
            forcing = skill.forcing[k] + correction
            x, v = semi_implicit(Step(skill.system, skill.goal, skill.time_constant, (forcing, forcing)), x, v, dt)
        return np.array(path), np.array(forces)
