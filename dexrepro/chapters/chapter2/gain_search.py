"""One search budget for every holding law, on the batched planar plant (ours, for Sect. 2.4.1.3)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter2.batch import controlled_by, simulate_runs
from dexrepro.experiment import Config, Metrics, Recording

TABLES = {"T2.G": "Gains found for each law: the best of equally many random candidates, beside the printed ones"}

RATES = ("rate_1", "rate_2", "rate_3", "rate_4")


def simulate(config: Config, rng: Any) -> Recording:
    """Run every candidate on both trajectories, with the regulation; candidate 0 is the default setting."""
    random, rows = rng("candidates"), []
    for law, ranges in config.ranges.items():
        for candidate in range(config.candidates + 1):
            gains: dict[str, float] = {}
            for name, (low, high) in ranges.items():
                drawn = float(low * (high / low) ** random.random())
                gains[name] = drawn if candidate else config.run.get(name, 1.0)
            setting = {name: value for name, value in gains.items() if name != "rates"}
            factor = gains.get("rates", 1.0)
            scaled = {name: factor * config.run[name] for name in RATES}
            for trajectory in (1, 2):
                row = {**config.run, **scaled, **setting, "trajectory": trajectory}
                labels = {"controller": law, "candidate": candidate, **{f"gain_{k}": v for k, v in gains.items()}}
                rows.append(controlled_by(law, row) | labels)
    runs = pd.DataFrame(rows)
    errors = simulate_runs(runs, config, edges=[0.0, config.settled, config.duration])
    runs["rmse"] = np.sqrt(errors["square_1"])
    kept = [str(name) for name in runs if str(name).startswith("gain_")]
    found = runs.groupby(["controller", "candidate"], sort=False)
    summary = found[kept].first().join(found["rmse"].agg(lambda values: np.sqrt(np.mean(np.square(values)))))
    steps = len(runs) * round(config.duration / config.step)
    return Recording(frames={"candidates": summary.reset_index()}, steps=steps)


def measure(recording: Recording, config: Config) -> Metrics:
    candidates, result = recording.frames["candidates"], Metrics()
    for law, rows in candidates.groupby("controller"):
        best = rows.iloc[int(np.argmin(rows["rmse"].fillna(np.inf)))]
        result[f"{law}_default"] = _number(rows.loc[rows["candidate"] == 0, "rmse"].iloc[0])
        result[f"{law}_best"] = _number(best["rmse"])
        result |= {f"{law}_{name}": _number(best[f"gain_{name}"]) for name in config.ranges[law]}
    return result


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config
) -> dict[str, pd.DataFrame]:
    found = metrics["all"]
    rows = [
        {
            "law": law,
            "candidates": config.candidates,
            "gains": "; ".join(f"{name} = {found[f'{law}_{name}']:.4g}" for name in ranges),
            "RMSE, default gains [N]": found[f"{law}_default"],
            "RMSE, best candidate [N]": found[f"{law}_best"],
        }
        for law, ranges in config.ranges.items()
    ]
    return {"T2.G": pd.DataFrame(rows)}


def _number(value: Any) -> float | None:
    return float(value) if np.isfinite(value) else None
