"""Settling of the error dynamics against the size of the first error, and the bound of Lemma 3.2 (Sect. 3.3.3)."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.control.fixed_time import secant, settling_bound
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.baxter import baxter, posture


def simulate(config: Config, rng: Rng) -> Recording:
    directions = rng("directions").standard_normal((config.directions, 7))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    plant = ErrorDynamics(config)
    first, second = config.first, config.second
    if config.tune:
        first, second = _tuned(plant, config, directions)
    rows = []
    for size, (number, direction) in itertools.product(config.errors, enumerate(directions)):
        error = size * direction + config.perturbation
        time, growth, torque = plant.settle(error, first, second)
        rows.append({"error": size, "direction": number, "time": time, "growth": growth, "torque": torque})
    recording = Recording(steps=plant.steps, simulated=plant.steps * config.step)
    recording.frames["settling"] = pd.DataFrame(rows)
    inertia = plant.largest_inertia(rng("postures"))
    recording.frames["laws"] = pd.DataFrame([{"k11": first[0], "k21": second[0], "inertia_max": inertia}])
    plant.model.close()
    return recording


class ErrorDynamics:
    """The errors of Eqs. (3.24)-(3.27) about the untucked arm when what the dynamics need is known exactly.

    de1/dt = e2 - k1(e1) e1, M de2/dt = -C e2 - e1 - k2(e2) e2; k(e) is the secant slope of the three terms. Steps are
    linearly implicit.
    """

    def __init__(self, config: Config) -> None:
        self.arm = baxter("right")
        self.model, self.home, self.config, self.steps = RigidBodyModel(self.arm), posture("right"), config, 0

    def settle(self, error: Array, first: Sequence[float], second: Sequence[float]) -> tuple[float, float, float]:
        """Time [s] until V' is below its bound (nan: not within the run), its growth in a step, largest
        torque [N m]."""
        config, model, h = self.config, self.model, self.config.step
        e1 = error.copy()
        e2 = secant(e1, first, *config.powers) * e1  # the arm is at rest, so e2 = -x_2d
        before, growth, torque = np.inf, -1.0, 0.0
        for k in range(round(config.duration / h)):
            slope, damping = secant(e1, first, *config.powers), secant(e2, second, *config.powers)
            q, dq = self.home + e1, e2 - slope * e1
            mass = model.mass_matrix(q)
            energy = 0.5 * float(e1 @ e1) + 0.5 * float(e2 @ mass @ e2)
            growth, before = max(growth, energy / before - 1.0), energy
            self.steps += 1
            if energy <= config.settled:
                return k * h, growth, torque
            torque = max(torque, float(np.abs(e1 + damping * e2).max()))
            e1 = (e1 + h * e2) / (1.0 + h * slope)
            e2 = self._advance(mass, e1, e2, damping, self._coriolis(q, dq, e2))
        return math.nan, growth, torque

    def _advance(self, mass: Array, e1: Array, e2: Array, damping: Array, coriolis: Array) -> Array:
        """e2 after a step; joints that would need more than the arm's torque limits get those, where they count."""
        h, push = self.config.step, mass @ e2 - self.config.step * coriolis
        over = np.zeros(len(e1), dtype=bool)
        torque = limit = np.array(self.arm.effort)
        while True:
            matrix = mass + h * np.diag(np.where(over, 0.0, damping))
            new: Array = np.linalg.solve(matrix, push - h * np.where(over, np.sign(torque) * limit, e1))
            if not self.config.limited:
                return new
            torque = np.where(over, torque, e1 + damping * new)
            beyond = over | (np.abs(torque) > limit)
            if (beyond == over).all():
                return new
            over = beyond

    def _coriolis(self, q: Array, dq: Array, e2: Array) -> Array:
        """C(q, dq) e2 (Christoffel's C) from the quadratic form c(v) = C(q, v) v."""
        gravity = self.model.gravity(q)
        both, one, other = (self.model.bias(q, v) - gravity for v in (dq + e2, dq, e2))
        return 0.5 * (both - one - other)

    def largest_inertia(self, rng: np.random.Generator) -> float:
        """Largest eigenvalue of M [kg m^2] over 2000 random postures within the joint limits."""
        postures = rng.uniform(self.arm.lower, self.arm.upper, (2000, 7))
        return float(np.linalg.eigvalsh(np.array([self.model.mass_matrix(q) for q in postures])).max())


def _tuned(plant: ErrorDynamics, config: Config, directions: Array) -> tuple[list[float], list[float]]:
    """K11 and K21 that settle soonest from 1 rad (two directions) with no more torque than the printed gains need.

    The torque is largest at the start, where |e1 + k2(e2) e2| says what K21 is allowed to be beside a K11.
    """
    errors, (k11, *powered), (_, *damped) = directions[:2], config.first, config.second
    allowed = config.allowed_torque
    limit = max(plant.settle(e, allowed.first, allowed.second)[2] for e in errors)
    best, found = np.inf, (config.first, config.second)
    for factor in config.sharing:
        first = [k11 * factor, *powered]
        e2 = secant(errors, first, *config.powers) * errors
        rest = secant(e2, [0.0, *damped], *config.powers)
        largest = float(np.min((limit - np.abs(errors)) / np.abs(e2) - rest))
        for share in config.used if largest > 0 else ():
            second = [largest * share, *damped]
            runs = [plant.settle(e, first, second) for e in errors]
            longest = float(np.max([run[0] for run in runs]))
            if max(run[2] for run in runs) <= limit * (1 + 1e-9) and longest < best:
                best, found = longest, (first, second)
    return found


def _known(time: float) -> float | None:
    return None if math.isnan(time) else time


def measure(recording: Recording, config: Config) -> Metrics:
    table, law = recording.frames["settling"], recording.frames["laws"].iloc[0]
    worst = {size: float(np.max(times.to_numpy())) for size, times in table.groupby("error")["time"]}
    metrics: Metrics = {f"settling_{size:g}".replace(".", "p"): _known(worst[size]) for size in config.errors}
    metrics["settling_max"] = _known(float(np.max(list(worst.values()))))
    metrics["growth"] = float(table.growth.max())
    metrics["torque_1"] = float(table[table.error == 1.0].torque.max())
    metrics["k11"], metrics["k21"] = float(law.k11), float(law.k21)
    metrics["inertia_max"] = float(law.inertia_max)
    if min(config.first[1:] + config.second[1:]) > 0 and not config.tune and not config.limited:
        constants: Any = dict(inertia=metrics["inertia_max"], joints=7, share=config.gamma)
        gains = (config.first, config.second, config.powers)
        metrics["bound"] = settling_bound(*gains, **constants)
        metrics["bound_printed"] = settling_bound(*gains, **constants, printed=True)
    return metrics
