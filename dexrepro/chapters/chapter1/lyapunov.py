"""The Lyapunov argument of Section 1.4 and the stability of the law that can be built, in closed form.

Perfect tracking on the holding line, first case of Fig. 1.10. The ideal law is given the contact position z_d that
Eq. (1.31) replaces by z_A; its V must fall at every step. The law that can be built does not have that property, and it
needs a large enough estimator gain: N (1 - k beta) < L (L + k alpha) with N = Z.Z (Routh's condition).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter1.line import press
from dexrepro.control.holding import AutoregressiveHolding, Compliant
from dexrepro.control.passive_impedance import PassiveImpedance
from dexrepro.experiment import Config, Figure, Metrics, Recording

FIGURES = {
    "1.D": Figure(
        "Left: V of Eq. (1.34) on the ramp of case 1, steps of 0.1 ms, for the law that knows z_d, the law that can be "
        "built and the printed definition of e_f. Right: how the force error develops over 100 s for estimator gains L "
        "around the bound of Routh's condition. Neither is in the book.",
        "V falls at every step only for the ideal law; below an L of about 0.18 the force error grows.",
    )
}
RATE = 200.0


def simulate(config: Config, rng: Any) -> Recording:
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
    law = inner = _law(config, dt, error=config.error)
    if config.compliant:
        damper = PassiveImpedance(dt=dt, mass=config.mass, damping=config.damping, desired_force=config.desired_force)
        law = Compliant(law=inner, impedance=damper)  # type: ignore[assignment]
    law.reset(0.0)
    x, rows = 0.0, np.empty((n, 3))
    best = np.zeros(config.lags + 1)
    best[0] = config.ramp_speed
    for i in range(n):
        force = max(0.0, k * (partner[i] - x))
        rows[i] = (np.sum((inner.weights - best) ** 2), (inner.estimate - contact[i]) ** 2, force)
        velocity = damper.velocity if config.compliant else 0.0
        rows[i, 0] = (rows[i, 0] + rows[i, 1]) / (2 * config.adaptation)
        rows[i, 0] += 0.5 * config.mass * velocity**2 + (force - config.desired_force) ** 2 / (2 * k)
        x = float(law(x, force, contact[i]) if config.ideal else law(x, force))
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
    law = _law(config, dt, estimator_gain=gains)
    force = press(law, partner, stiffness, dt=dt, unilateral=False, batch=len(gains))["force"]
    error = np.abs(force - config.desired_force)
    blocks = error.reshape(10, n // 10, -1).max(axis=1)
    frame = pd.DataFrame(blocks, columns=[f"{gain:g}" for gain in gains])
    frame.insert(0, "time", config.long / 10 * (np.arange(10) + 0.5))
    return Recording(frames={"growth": frame}, steps=n)


def measure(recording: Recording, config: Config) -> Metrics:
    if config.study == "growth":
        frame = recording.frames["growth"]
        # From 30-40 s, when the partner has come to rest, to 90-100 s.
        result: Metrics = {
            f"growth_{column.replace('.', 'p')}": float(frame[column].iloc[9] / frame[column].iloc[3])
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


def draw(recordings: dict[str, Recording], metrics: Any, config: Config) -> dict[str, Any]:
    if not {"ideal", "built", "printed", "growth"} <= set(recordings):
        return {}
    from dexrepro.report import style

    figure, (left, right) = style.subplots(1, 2, height=2.4)
    for case, role in (("ideal", "book"), ("built", "rival"), ("printed", "printed")):
        recording = recordings[case]
        left.semilogy(recording.time, recording["lyapunov"], label=case, **style.LINES[role])
    left.set(xlabel="Time [s]", ylabel="$V$ [-]", ylim=(1e-2, 1e4), xlim=(0, 6))
    left.legend(loc="upper right")
    frame = recordings["growth"].frames["growth"]
    for column, role in zip(frame.columns[1:], ("printed", "extra1", "rival", "extra3", "plain", "book")):
        right.semilogy(frame["time"], frame[column], label=f"L = {column}/s", **style.LINES[role])
    right.set(xlabel="Time [s]", ylabel="Force error, largest\nof 10 s [N]", ylim=(1e-3, 1e3))
    right.legend(loc="upper right", ncols=3)
    share = 100 * (metrics["built"]["rising"] or 0)
    style.title(
        figure,
        f"$V$ falls at every step only if $z_d$ is known; the law as built lets it rise {share:.0f} % of the time",
    )
    return {"1.D": figure}
