"""Two followers and an object reduced to the holding line: fast, batched plants for sweeps and for tests.

Coordinates of ``press`` are those of Section 1.5.1: displacements from the first contact along x, partner at x_D(t).
Those of ``carry`` are the distance between the followers, as in Eq. (1.33).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.control.contract import Measured
from dexrepro.physics.soft_object import Cushion


def at(position: Any, force: Any) -> Measured[Any]:
    """What a holding law that needs neither time nor velocity is told: displacement [m] and force [N]."""
    return Measured(math.nan, position, math.nan, force)


def press(
    law: Any, partner: Array, stiffness: Array, *, dt: float, lag: Array | float = 0.0, origin: Array | float = 0.0,
    unilateral: bool = True, target: Array | None = None, guard: float = 1e6, batch: int = 1,
) -> dict[str, Array]:  # fmt: skip
    """Press a spring of ``stiffness`` (n, [batch]) [N/m] between a partner at ``partner`` (n,) [m] and the follower.

    lag: time constant of the follower's position [s]; origin: where the law's coordinate has its zero [m].
    target: contact position (n, [batch]) [m] given to the law; see ``AutoregressiveHolding``. A run whose position
    leaves ``guard`` is held there. Returns ``force`` [N] and ``position`` [m], shape (n, batch).
    """
    n = len(partner)
    force, position = np.empty((n, batch)), np.empty((n, batch))
    x = np.zeros(batch)
    law.reset(at(x + origin, 0.0))
    share = dt / np.maximum(np.asarray(lag, float) + dt, dt)
    for k in range(n):
        f = stiffness[k] * (partner[k] - x)
        f = np.maximum(f, 0.0) if unilateral else f
        force[k], position[k] = f, x
        known = () if target is None else (target[k] + origin,)
        command = law(at(x + origin, f), *known)
        x = np.minimum(np.maximum(x + share * (command - origin - x), -guard), guard)
    return {"force": force, "position": position}


def carry(
    law: Any, scene: dict[str, Array], cushions: tuple[Cushion, Cushion], *, mass: Any, length: float, period: int,
    dt: float, lag: Array | float, noise: Array, delay: Array | int = 0, speed: float = 0.3, batch: int = 1,
) -> Array:  # fmt: skip
    """Carry an object of ``mass`` [kg] between two followers that lag behind their commands; force on AFR (n, batch).

    scene: ``partner`` command of the teleoperated follower [m], ``weight`` on the object along the line [N] and
        ``scale`` of the elastic stiffness [-], each (n,), sampled every dt [s]; length: free length of the object [m].
    period: samples a control period; noise: of the force sensor at each control sample [N]; delay: control periods
    by which the measured force is late. Commands are interpolated linearly between control samples.
    """
    n = len(scene["partner"])
    share = dt / (np.asarray(lag, float) + dt)
    zero = np.zeros(batch)
    leader, follower, start, command = zero, zero, zero, zero
    body, rate, force = zero, zero, np.empty((n, batch))
    velocity = zero
    sensed, columns = np.zeros((n // period + 2, batch)), np.arange(batch)
    late = np.broadcast_to(delay, batch)
    law.reset(at(zero, 0.0))
    for k in range(n):
        if k % period == 0:
            sample = k // period
            sensed[sample] = force[k - 1] + noise[sample] if k else zero
            start = command
            wanted = law(at(start, sensed[np.maximum(sample - late, 0), columns]))
            command = start + np.clip(wanted - start, -speed * dt * period, speed * dt * period)
        step = (k % period + 1) / period
        goal = start + step * (command - start)
        before = velocity
        velocity = share * (scene["partner"][k] - leader) / dt
        leader = leader + dt * velocity
        follower = follower + share * (scene["partner"][k] + goal - follower)
        left = cushions[0].force(length / 2 - (length / 2 + body), scene["scale"][k])
        right = cushions[1].force(length / 2 + body - (follower - leader) - length / 2, scene["scale"][k])
        force[k] = right
        rate = rate + dt * ((left - right + scene["weight"][k]) / mass - (velocity - before) / dt)
        body = body + dt * rate
    return force
