"""The four constraint cases: does the Lyapunov function fall, with printed and with corrected terms (Sect. 6.3.2)?"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.primitives.barrier import (
    Constraint,
    Gains,
    case_two_value,
    closed_loop_rates,
    decay_in_error_coordinates,
    lyapunov_rate,
    printed_case_two_pull,
)

RATE = 200.0


def simulate(config: Config, rng: Rng) -> Recording:
    constraint = constraint_of(config)
    frames = {
        "states": _random_states(constraint, config, rng("states")),
        "edge": _edge_states(constraint, config, rng("edge")),
    }
    z1, z2 = np.array(config.start, float) + config.perturbation, np.zeros(len(config.start))
    z2[0] = config.start_rate
    if config.printed:
        first, second = _printed_flow(z1, z2, constraint, config)
        with np.errstate(invalid="ignore", divide="ignore"):
            value = constraint.value(first) + 0.5 * (second**2).sum(axis=1)
    else:
        steps = round(config.duration / config.step)
        first, second, value = decay_in_error_coordinates(z1, z2, constraint, _gains(config), 1.0, config.step, steps)
    time = config.step * np.arange(len(first))
    series = {"time": time, "error": first, "rate": second, "lyapunov": value}
    return Recording(series=series, frames=frames, steps=len(time), simulated=float(time[-1]))


def _gains(config: Config) -> Gains:
    return Gains(config.kz, config.dz, config.k2)


def constraint_of(config: Config) -> Constraint:
    return Constraint(config.inside, config.upper, config.lower)


def _random_states(constraint: Constraint, config: Config, rng: np.random.Generator) -> pd.DataFrame:
    """Allowed errors and velocity errors, with dV^c/dt by differences."""
    dimensions = 1 if config.lower is not None else 2
    z1 = rng.uniform(-1, 1, (40 * config.states, dimensions)) * (80.0 if config.inside else 300.0)
    z1 = z1[constraint.satisfied(z1)][: config.states]
    z2 = rng.normal(0, 100, z1.shape)
    z2[::4] *= 1e-3  # velocity errors near zero, where the barrier's pull decides
    return _rates(z1, z2, constraint, config, 1e-7)


def _edge_states(constraint: Constraint, config: Config, rng: np.random.Generator) -> pd.DataFrame:
    """The same for errors within a ten-thousandth of the bound that approach it."""
    dimensions = 1 if config.lower is not None else 2
    way = rng.normal(size=(config.states, dimensions))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    gap = 10 ** rng.uniform(-6, -4, (config.states, 1))
    bound = np.where(way > 0, config.upper, -config.lower) if config.lower is not None else float(config.upper)
    z1 = way * bound * ((1 - gap) if config.inside else 1 / (1 - gap)) ** 0.5
    z2 = z1 * (rng.uniform(1, 8, gap.shape) if config.inside else -rng.uniform(0.05, 1, gap.shape))
    return _rates(z1, z2, constraint, config, 1e-9)


def _rates(z1: Any, z2: Any, constraint: Constraint, config: Config, step: float) -> pd.DataFrame:
    """dV^c/dt by differences over ``step`` [s] at states, for both couplings g1: with k_n, and with k_2 alone in it."""
    frame = {f"z1_{i}": column for i, column in enumerate(z1.T)}
    for coupling in config.couplings:
        pull = printed_case_two_pull(z1, config.lower, config.upper) if config.printed else None
        rates = closed_loop_rates(z1, z2, constraint, _gains(config), coupling, pull)
        frame[f"rate_{coupling:.2g}"] = lyapunov_rate(z1, z2, *rates, constraint, step)
        unshared = -_gains(config).decay * z2
        frame[f"plain_{coupling:.2g}"] = lyapunov_rate(z1, z2, rates[0], unshared, constraint, step)
        frame[f"squares_{coupling:.2g}"] = _squares(z1, z2, constraint, _gains(config), coupling)
    return pd.DataFrame(frame)


def _squares(z1: Any, z2: Any, constraint: Constraint, gains: Gains, coupling: float) -> Array:
    """dV^c/dt as (6.21) and its counterparts for the other cases have it."""
    square = -constraint.pull(z1) - coupling * z2 / 2
    barrier = gains.position / gains.velocity * constraint.share(z1) * square**2
    return -(barrier.sum(axis=1) + gains.decay * (z2**2).sum(axis=1))


def _printed_flow(z1: Any, z2: Any, constraint: Constraint, config: Config) -> tuple[Any, Any]:
    """Explicit steps under (6.17) as printed, up to the instant the bound is hit."""
    first, second = [z1], [z2]
    for _ in range(round(config.duration / config.step)):
        pull = printed_case_two_pull(first[-1], config.lower, config.upper)
        rate1, rate2 = closed_loop_rates(first[-1], second[-1], constraint, _gains(config), 1.0, pull)
        first.append(first[-1] + config.step * rate1)
        second.append(second[-1] + config.step * rate2)
        if not constraint.satisfied(first[-1]):
            break
    return np.array(first), np.array(second)


def measure(recording: Recording, config: Config) -> Metrics:
    states, held = recording.frames["states"], constraint_of(config).satisfied(recording["error"])
    value = recording["lyapunov"]
    rates, scale = _scaled(states, "rate_")
    near, near_scale = _scaled(recording.frames["edge"], "rate_")
    plain, _ = _scaled(recording.frames["edge"], "plain_")
    metrics: Metrics = {
        "worst_rate": float((rates / scale).max()),
        "rising_states": int((rates > 1e-6 * scale).sum()),
        "rising_near_bound": int((near > 1e-6 * near_scale).sum()),
        "rising_without_share": int((plain > 1e-6 * near_scale).sum()),
        "v_rises": int((np.diff(value) > 1e-12 * value[:-1]).sum()) if held.all() else None,
        "end_error": float(np.linalg.norm(recording["error"][-1])),
        "hit_time": None if held.all() else float(recording.time[held.argmin()]),
    }
    if config.inside and config.lower is None:
        metrics |= {f"shrinking_{name}": _shrinking(config, name == "corrected") for name in ("printed", "corrected")}
    if not config.inside and config.lower is None:
        # z1^2 = z1(0)^2 + 2 (k_z / d_z) t for z2 = 0
        grown = np.sqrt(np.sum(np.square(config.start)) + 2 * config.kz / config.dz * recording.time[-1])
        metrics["growth_gap"] = float(metrics["end_error"] / grown - 1)
    if config.printed:
        metrics["same_sign_undefined"] = float(
            np.isnan(case_two_value(np.array(config.probes), *config.same_sign)).mean()
        )
    return metrics


def _scaled(states: pd.DataFrame, name: str) -> tuple[Any, Any]:
    """Rates of a name at states, and what they are compared with."""
    return states.filter(like=name).to_numpy(), 1 + np.abs(states.filter(like="squares_").to_numpy())


def _shrinking(config: Config, with_rate: bool) -> float:
    """Largest |e| - h [length] while the margin shrinks linearly, with and without the term -(e hdot/h)/g1."""
    start, end, duration = config.shrink
    step, e, worst = 1e-5, 0.8 * start, -np.inf
    for k in range(round(duration / step)):
        h = start + (end - start) * k * step / duration
        worst = max(worst, e - h)
        e += step * (-config.kz / config.dz * e + (with_rate * e * (end - start) / duration / h))
    return float(max(worst, e - end))
