"""What the barrier contributes: its share of the gain, and sweeps of k_2, margin and time step (ours)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import learning, plane
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.primitives.barrier import Constraint, gain
from dexrepro.primitives.constrained import Path, rollout

RATE = 0.0


def simulate(config: Config, rng: Rng) -> Recording:
    lesson = plane.teach(config, rng("demonstrations"))[0]
    primitive, duration = lesson.second, float(lesson.durations[1])

    def largest(step: float, decay: Any, margin: Any, **options: Any) -> tuple[Array, Array]:
        """Largest distance, and whether the run stayed defined, for arrays of gains or margins (runs, 1)."""
        decay, margin = np.asarray(decay, float), np.asarray(margin, float)
        with np.errstate(over="ignore", invalid="ignore"):  # explicit steps may diverge
            path = _run(config, primitive, duration, step, decay, margin, **options)
        return np.nanmax(path.distance, axis=0), np.asarray(path.defined.all(axis=0))

    column = lambda values: np.array(values, float)[:, None]  # noqa: E731
    s, c = config.sweep, config.cdmp
    frames = {}
    wide = np.full((len(s.k2), 1), c.margin)
    tracked, _ = largest(config.step, column(s.k2), wide, weight="off")
    _, inside = largest(config.step, column(s.k2), wide)
    coarse, _ = largest(duration / s.points, column(s.k2), wide, weight="off", explicit=True)
    frames["k2"] = pd.DataFrame({"k2": s.k2, "e_max": tracked, "defined": inside, "coarse": coarse})
    far, defined = largest(config.step, np.full((len(s.margin), 1), c.k2), column(s.margin))
    frames["margin"] = pd.DataFrame({"margin": s.margin, "e_max": far, "defined": defined})
    steps = [largest(step, [[c.k2]], [[c.margin]]) for step in s.step]
    frames["step"] = pd.DataFrame(
        {"step": s.step, "e_max": [e[0] for e, _ in steps], "defined": [d[0] for _, d in steps]}
    )
    frames["share"] = _shares(config, duration)
    return Recording(frames=frames, steps=2 * round(duration / config.step))


def _run(
    config: Config, primitive: Any, duration: float, step: float, decay: Array, margin: Array,
    weight: str | None = None, explicit: bool = False,
) -> Path:  # fmt: skip
    (movement,) = learning.nominal([primitive], np.array([duration]), round(duration / step))
    skill = learning.skill([primitive], [movement])
    reference = learning.stack([plane.spline_reference(config, movement)[0]])
    constraint = learning.tube(Config({**config.cdmp, "weight": weight or config.cdmp.weight}), margin)
    gains = replace(learning.gains(config.cdmp), decay=decay)
    runs = len(margin)
    start = np.repeat(reference.position[0], runs, axis=0)
    velocity = np.broadcast_to(primitive.time_constant * primitive.velocity, start.shape)
    return rollout(
        skill,
        reference,
        constraint,
        gains,
        learning.law(config.cdmp),
        duration / len(movement.time[1:]),
        start,
        velocity,
        explicit=explicit,
    )


def _shares(config: Config, duration: float) -> pd.DataFrame:
    """Share of the barrier in k_n over 1 - (e/h)^2, for both weights."""
    tau = duration if config.dmp.tau is None else config.dmp.tau
    gap = np.logspace(-9, 0, 181)
    bound = config.cdmp.kz * config.cdmp.margin
    z1 = bound * np.sqrt(1 - gap)[:, None]
    frame = {"gap": gap}
    for name, weight in (("one", 1.0), ("h2", bound**2)):
        gains = learning.gains(config.cdmp)
        total = gain(z1, Constraint(True, bound, weight=weight), gains, 1 / tau)[:, 0]
        frame[name] = 1 - config.cdmp.k2 / gains.velocity / total
    return pd.DataFrame(frame)


def measure(recording: Recording, config: Config) -> Metrics:
    k2, margin, step, share = (recording.frames[name] for name in ("k2", "margin", "step", "share"))
    slope = np.polyfit(np.log(k2["k2"]), np.log(k2.e_max), 1)[0]
    kept, coarse = k2["k2"][k2.defined.astype(bool)], k2.coarse.to_numpy()
    crossed = margin.margin[~margin.defined.astype(bool)]
    metrics: Metrics = {
        "k2_slope": float(slope),
        "k2_kept_from": float(kept.min()) if len(kept) else None,
        "coarse_decades": float(np.log10(coarse[-1] / np.interp(config.cdmp.k2, k2["k2"], coarse))),
        "e_max_k2_low": float(k2.e_max.iloc[0]),
        "e_max_k2_high": float(k2.e_max.iloc[-1]),
        "widest_crossed_margin": float(crossed.max()) if len(crossed) else 0.0,
        "step_spread": float(np.ptp(step.e_max) / step.e_max.mean()),
    }
    for name in ("one", "h2"):
        metrics[f"share_centre_{name}"] = float(share[name].iloc[-1])
        # Where barrier and k_2 contribute alike: share 1/2.
        metrics[f"half_gap_{name}"] = float(np.exp(np.interp(-0.5, -share[name], np.log(share.gap))))
    return metrics
