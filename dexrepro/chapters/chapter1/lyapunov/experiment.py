"""The Lyapunov argument of Section 1.4 and the stability of the law that can be built, in closed form.

Perfect tracking on the holding line, first case of Fig. 1.10. The ideal law is given the contact position z_d that
Eq. (1.31) replaces by z_A; its V must fall at every step. The law that can be built does not have that property, and it
needs a large enough estimator gain for an error that never grows: N (1 - k beta) < L (L + k alpha) with N = Z.Z
(Routh's condition).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter1.line import at, press
from dexrepro.control.holding import AutoregressiveHolding, Compliant
from dexrepro.control.passive_impedance import PassiveImpedance
from dexrepro.experiment import Config, Metrics, Recording

RATE = 200.0


def simulate(config: Config, rng: Rng) -> Recording:
    return _growth(config) if config.study == "growth" else _candidate(config)


def _law(config: Config, dt: float, **changes: Any) -> AutoregressiveHolding:
    values = {"dt": dt, "desired_force": config.desired_force, "gain": config.gain, "lags": config.lags,
              "estimator_gain": config.estimator_gain, "adaptation": config.adaptation}  # fmt: skip
    return AutoregressiveHolding(**(values | changes))


def _candidate(config: Config) -> Recording:
    """V along a run, at every step."""
    dt, k = config.step, config.stiffness
    n = round(config.duration / dt)
    time = dt * np.arange(n)
    partner = config.ramp_speed * time
    contact = partner - config.desired_force / k
    law = inner = _law(config, dt, printed=config.printed)
    if config.compliant:
        damper = PassiveImpedance(dt=dt, mass=config.mass, damping=config.damping, desired_force=config.desired_force)
        law = Compliant(law=inner, impedance=damper)  # type: ignore[assignment]
    law.reset(at(0.0, 0.0))
    x, rows = 0.0, np.empty((n, 3))
    best = np.zeros(config.lags + 1)
    best[0] = config.ramp_speed
    for i in range(n):
        force = max(0.0, k * (partner[i] - x))
        rows[i] = (np.sum((inner.weights - best) ** 2), (inner.estimate - contact[i]) ** 2, force)
        velocity = damper.velocity if config.compliant else 0.0
        rows[i, 0] = (rows[i, 0] + rows[i, 1]) / (2 * config.adaptation)
        rows[i, 0] += 0.5 * config.mass * velocity**2 + (force - config.desired_force) ** 2 / (2 * k)
        known = (contact[i],) if config.ideal else ()
        x = float(law(at(x, force), *known))
        if abs(x) > config.guard:
            rows = rows[: i + 1]
            break
    kept = len(rows)
    return Recording(
        series={"time": time[:kept], "lyapunov": rows[:, 0], "error": rows[:, 2] - config.desired_force}, steps=kept
    )


def _growth(config: Config) -> Recording:
    """Largest force error in each 10 s for several estimator gains at once."""
    gains, dt = np.array(config.estimator_gains), config.coarse_step
    n = round(config.long / dt)
    partner = np.minimum(config.ramp_end, config.ramp_speed * dt * np.arange(n))
    stiffness = np.full(n, config.stiffness)
    law = _law(config, dt, estimator_gain=gains, printed=config.printed)
    with np.errstate(all="ignore"):  # a negative gain runs away
        force = press(law, partner, stiffness, dt=dt, unilateral=False, batch=len(gains))["force"]
    error = np.abs(force - config.desired_force)
    blocks = error.reshape(10, n // 10, -1).max(axis=1)
    frame = pd.DataFrame(blocks, columns=[f"{gain:g}" for gain in gains])
    frame.insert(0, "time", config.long / 10 * (np.arange(10) + 0.5))
    return Recording(frames={"growth": frame}, steps=n)


def measure(recording: Recording, config: Config) -> Metrics:
    if config.study == "growth":
        frame = recording.frames["growth"]
        # From the fourth tenth of the run, when the partner has come to rest, to the last.
        result: Metrics = {
            f"growth_{column.replace('.', 'p').replace('-', 'm')}": float(frame[column].iloc[9] / frame[column].iloc[3])
            for column in frame.columns[1:]
        }
        return result | {"bound": bound(config)}
    v = recording["lyapunov"]
    return {
        "rising": float(np.mean(np.diff(v) > 0)),
        "start": float(v[0]),
        "end": float(v[-1]),
        "steepest": float(np.max(np.diff(v)) / config.step),
        "finished": int(len(v) == round(config.duration / config.step)),
    }


def bound(config: Config) -> float:
    """Smallest stable L for N = 1: the root of L (L + k alpha) = 1 - k beta."""
    half = 0.5 * config.stiffness * config.gain
    return float(np.sqrt(half * half + 1.0 - config.stiffness * config.adaptation) - half)
