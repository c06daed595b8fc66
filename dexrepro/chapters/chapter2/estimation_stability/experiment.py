"""Limits of the adaptation law: discrete step, Lyapunov function, and the reference it feeds (Sects. 2.3.2, 2.3.3)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.control.movement_estimation import MovementEstimation
from dexrepro.experiment import Config, Metrics, Recording

RATE = 50.0
BLOWN = 100.0  # N, a prediction error beyond this is a divergence


def simulate(config: Config, rng: Rng) -> Recording:
    return {"growing_regressor": _growing_regressor, "lyapunov": _lyapunov, "reference": _reference}[config.study](
        config
    )


def _growing_regressor(config: Config) -> Recording:
    """All rates c, absolute time, the partner on Traj. 1 and the force exactly the desired one."""
    law = _estimation(config, rates=(config.rate,) * 4)
    time, error = [], []
    for i in range(round(config.duration / config.step)):
        rest = config.rest_length + config.amplitude * math.sin(2 * math.pi / config.period * i * config.step)
        position = rest - config.desired_force / config.stiffness + config.perturbation
        law(position, config.desired_force)
        time.append(i * config.step)
        error.append(law.stiffness * (law.position - position) - config.desired_force)
        if abs(error[-1]) > BLOWN:
            break
    return Recording({"time": np.array(time), "error": np.array(error)}, steps=len(time))


def _lyapunov(config: Config) -> Recording:
    """Constant parameters: the true rest position is a polynomial; the follower wanders.

    The exact change of V in a step is that of Eqs. (2.20), (2.21) and what the square of an explicit step adds.
    """
    rates, truth = config.rates, (config.stiffness, *(config.stiffness * a for a in config.true_coefficients))
    law = _estimation(config, rates=rates)

    def value() -> float:
        estimate = (law.stiffness, *(law.stiffness * a for a in law.coefficients))
        return 0.5 * sum((e - t) ** 2 / g for e, t, g in zip(estimate, truth, rates))

    rows = []
    for i in range(round(config.duration / config.step)):
        t, before, stiffness, a = i * config.step, value(), law.stiffness, list(law.coefficients)
        powers = [t**j for j in range(3)]
        position = config.rest_length - 0.03 + 0.01 * math.sin(3 * t) + config.perturbation
        force = sum(k * p for k, p in zip(truth[1:], powers)) - truth[0] * position
        error = stiffness * (sum(c * p for c, p in zip(a, powers)) - position) - force
        load = rates[0] * position**2 + sum(g * p * p for g, p in zip(rates[1:], powers))
        law(position, force)
        rows.append((t, before, value() - before, -config.step * error**2 * (1 - config.step * load / 2)))
    names = ("time", "lyapunov", "change", "exact_change")
    series = dict(zip(names, np.array(rows).T))
    series["predicted_fall"] = series["exact_change"] - np.cumsum(series["exact_change"])
    return Recording(series, steps=len(rows))


def _reference(config: Config) -> Recording:
    """An exact arm of impedance (2.25) led by x_1,d of (2.31) with the true x_c and k_o, by the Runge-Kutta method."""
    (m, b, k), rate = config.impedance, 2 * math.pi / config.period
    stiffness, desired = config.stiffness, config.desired_force

    def rest(t: float) -> tuple[float, float, float]:
        s, c = config.amplitude * math.sin(rate * t), config.amplitude * math.cos(rate * t)
        return config.rest_length + s, rate * c, -rate * rate * s

    def slope(t: float, x: float, v: float) -> tuple[float, float]:
        x_c, velocity, acceleration = rest(t)
        target = (m * acceleration + b * velocity + k * x_c) / k - desired / stiffness
        error = stiffness * (x_c - x) - desired
        return v, (error - b * v - k * (x - target)) / m

    step, x, v = config.step, config.rest_length - 0.05 + config.perturbation, 0.0
    rows = []
    for i in range(round(config.duration / step)):
        t = i * step
        rows.append((t, stiffness * (rest(t)[0] - x) - desired))
        x, v = _runge_kutta(slope, t, x, v, step)
    return Recording(dict(zip(("time", "error"), np.array(rows).T)), steps=len(rows))


def _runge_kutta(
    slope: Callable[[float, float, float], tuple[float, float]], t: float, x: float, v: float, h: float
) -> tuple[float, float]:
    a = slope(t, x, v)
    b = slope(t + h / 2, x + h / 2 * a[0], v + h / 2 * a[1])
    c = slope(t + h / 2, x + h / 2 * b[0], v + h / 2 * b[1])
    d = slope(t + h, x + h * c[0], v + h * c[1])
    return x + h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]), v + h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])


def _estimation(config: Config, rates: Any) -> MovementEstimation:
    return MovementEstimation(
        stiffness=config.initial_stiffness, coefficients=config.coefficients, rates=rates, dt=config.step
    )


def measure(recording: Recording, config: Config) -> Metrics:
    if config.study == "growing_regressor":
        predicted = (2 / (config.step * config.rate)) ** 0.25
        return {
            "divergence_time": float(recording.time[-1]),
            "predicted_time": predicted,
            "relative_difference": float(abs(recording.time[-1] / predicted - 1)),
        }
    if config.study == "lyapunov":
        change, exact = recording["change"], recording["exact_change"]
        return {
            "largest_rise": float(change.max() / recording["lyapunov"][0]),
            "decrement_ratio": float(change.sum() / exact.sum()),
            "share_left": float((recording["lyapunov"][-1] + change[-1]) / recording["lyapunov"][0]),
        }
    return {"largest_error": float(np.abs(recording["error"][recording.between(5.0)]).max())}
