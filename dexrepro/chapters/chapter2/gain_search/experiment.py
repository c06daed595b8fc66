"""One search budget for every holding law, on the batched planar plant (ours, for Sect. 2.4.1.3)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2.batch import controlled_by, simulate_runs
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms

RATES = ("rate_1", "rate_2", "rate_3", "rate_4")


def simulate(config: Config, rng: Rng) -> Recording:
    """Run every candidate on both trajectories, each with its object; candidate 0 is the default setting."""
    rows = [
        controlled_by(law, {**config.run, **setting, "trajectory": trajectory, "object_stiffness": stiffness}) | labels
        for law, setting, labels in candidates(config, rng("candidates"))
        for trajectory, stiffness in zip((1, 2), config.stiffness)
    ]
    runs = pd.DataFrame(rows)
    errors = simulate_runs(runs, config, edges=[0.0, config.settled, config.duration])
    runs["rmse"] = np.sqrt(errors["square_1"])
    steps = len(runs) * round(config.duration / config.step)
    return Recording(frames={"candidates": summary(runs, config)}, steps=steps)


def candidates(
    config: Config, random: np.random.Generator
) -> Iterator[tuple[str, dict[str, float], dict[str, float | str]]]:
    """(law, changed settings, labels) of all candidates: log-uniform in the configured ranges, as many for each law."""
    for law, ranges in config.ranges.items():
        for candidate in range(config.candidates + 1):
            gains: dict[str, float] = {}
            for name, (low, high) in ranges.items():
                drawn = float(low * (high / low) ** random.random())
                gains[name] = drawn if candidate else config.run.get(name, 1.0)
            setting = {name: value for name, value in gains.items() if name != "rates"}
            setting |= {name: gains.get("rates", 1.0) * config.run[name] for name in RATES}
            labels: dict[str, float | str] = {"controller": law, "candidate": candidate}
            yield law, setting, labels | {f"gain_{name}": value for name, value in gains.items()}


def summary(runs: pd.DataFrame, config: Config) -> pd.DataFrame:
    """One row a candidate: its gains and the root mean square of its runs' errors [N]."""
    gains = [str(name) for name in runs if str(name).startswith("gain_")]
    found = runs.groupby(["controller", "candidate"], sort=False)
    errors = found["rmse"].agg(rms)
    return found[gains].first().join(errors).reset_index()


def measure(recording: Recording, config: Config) -> Metrics:
    result = Metrics()
    for law, rows in recording.frames["candidates"].groupby("controller"):
        best = rows.iloc[int(np.argmin(rows["rmse"].fillna(np.inf)))]
        result[f"{law}_default"] = _number(rows.loc[rows["candidate"] == 0, "rmse"].iloc[0])
        result[f"{law}_best"] = _number(best["rmse"])
        result |= {f"{law}_{name}": _number(best[f"gain_{name}"]) for name in config.ranges[law]}
    return result


def _number(value: Any) -> float | None:
    return float(value) if np.isfinite(value) else None
