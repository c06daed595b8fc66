"""Two hands carry a box: link lengths and hand distance restored from noisy skeletons (Figs. 6.6-6.11)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import bimanual
from dexrepro.experiment import Config, Metrics, Recording

RATE = 25.0
SIDES = ("left", "right")


def simulate(config: Config, rng: Rng) -> Recording:
    movement = bimanual.move(config, rng("measurement"))
    n = len(movement.time)
    spread, summary = _spread(movement)
    rows = [_row(movement, group, config) for group in range(config.skeleton.groups)]
    series = {
        "time": movement.time,
        "truth": movement.truth.reshape(n, -1),
        "original": movement.original[:, 0].reshape(n, -1),
        "joints": movement.joints[:, 0].reshape(n, -1),
    }
    frames = {
        "groups": pd.DataFrame(rows),
        "spread": spread,
        "percentiles": summary,
        "projections": pd.DataFrame(list(movement.projections.items()), columns=["track", "steps"]),
    }
    status = "finished" if movement.undefined_from is None else f"undefined from {movement.undefined_from:.2f} s"
    return Recording(series=series, frames=frames, steps=5 * n, simulated=float(movement.time[-1]), status=status)


def _spread(movement: bimanual.Movement) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Distance to the median over time (group 0) and its 95th percentile in every group."""
    distance = np.linalg.norm(movement.measured - np.median(movement.measured, axis=1, keepdims=True), axis=-1)
    columns: dict[str, Array] = {"u": np.linspace(0, 1, distance.shape[2])}
    percentiles = {}
    for index in range(6):
        name = f"{('shoulder', 'elbow', 'wrist')[index % 3]}_{SIDES[index // 3]}"
        columns[f"{name}_low"] = distance[0, :, :, index].min(axis=0)
        columns[f"{name}_high"] = distance[0, :, :, index].max(axis=0)
        percentiles[name] = np.percentile(distance[:, :, :, index], 95, axis=(1, 2))
    return pd.DataFrame(columns), pd.DataFrame(percentiles)


def _row(movement: bimanual.Movement, group: int, config: Config) -> dict[str, float]:
    """Ranges of lengths and errors to the truth of one group [cm]."""
    s, row = config.skeleton, {}
    nominal = {"se": s.upper_arm, "ew": s.forearm, "hands": s.box_length}
    for kind, joints in (("original", movement.original[:, group]), ("constrained", movement.joints[:, group])):
        found = bimanual.lengths(joints)
        for link in ("se", "ew"):
            for name, values in zip(SIDES, found[link].T):
                row[f"{link}_{name}_{kind}_low"], row[f"{link}_{name}_{kind}_high"] = values.min(), values.max()
        row[f"hands_{kind}_low"], row[f"hands_{kind}_high"] = found["hands"].min(), found["hands"].max()
        row[f"length_error_{kind}"] = max(np.abs(found[k] - nominal[k]).max() for k in ("se", "ew"))
        row[f"hands_error_{kind}"] = np.abs(found["hands"] - nominal["hands"]).max()
        rmse = np.sqrt(((joints - movement.truth) ** 2).sum(axis=-1).mean(axis=0))
        for side in (0, 1):
            for joint, part in enumerate(("shoulder", "elbow", "wrist")):
                row[f"rmse_{part}_{SIDES[side]}_{kind}"] = rmse[side, joint]
    row["moved"] = np.linalg.norm(movement.joints[:, group] - movement.original[:, group], axis=-1).max()
    return row


def measure(recording: Recording, config: Config) -> Metrics:
    groups, percentiles = recording.frames["groups"], recording.frames["percentiles"]
    first = groups.iloc[0]
    metrics: Metrics = {
        name: float(first[name]) for name in groups.columns if name.endswith(("_low", "_high")) and "rmse" not in name
    }
    for name in groups.columns:
        if name.startswith(("length_error", "hands_error", "rmse", "moved")):
            metrics[name] = float(groups[name].max())
    for link in ("se_left", "ew_left", "se_right", "ew_right", "hands"):
        for kind in ("original", "constrained"):
            width = groups[f"{link}_{kind}_high"] - groups[f"{link}_{kind}_low"]
            metrics[f"{link}_width_{kind}"] = float(width.min() if kind == "original" else width.max())
    ratio = percentiles.filter(like="wrist").mean(axis=1) / percentiles.filter(like="shoulder").mean(axis=1)
    metrics |= {"spread_ratio_low": float(ratio.min()), "spread_ratio_high": float(ratio.max())}
    metrics["projections"] = int(recording.frames["projections"].steps.sum())
    every = {kind: groups.filter(regex=f"^rmse_.*_{kind}$").pow(2).mean(axis=1) for kind in ("original", "constrained")}
    metrics["rmse_ratio_all"] = float((every["constrained"] / every["original"]).pow(0.5).max(skipna=False))
    for name in ("shoulder", "elbow", "wrist"):
        for side in SIDES:
            before, after = (groups[f"rmse_{name}_{side}_{kind}"] for kind in ("original", "constrained"))
            metrics[f"rmse_ratio_{name}_{side}"] = float((after / before).max())
    metrics["undefined"] = int(recording.status != "finished")
    return {name: value if value is not None and np.isfinite(value) else None for name, value in metrics.items()}
