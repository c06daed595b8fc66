"""Which choices of ours decide a verdict of Table 2.1: one change at a time, on the batched planar plant."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2.batch import simulate_runs, table_rows
from dexrepro.chapters.chapter2.holding_comparison import experiment as holding_comparison
from dexrepro.chapters.chapter2.holding_comparison.claims import CLAIMS
from dexrepro.experiment import Config, Metrics, Recording

JUDGED = ("C2.12", "C2.13", "C2.14", "C2.15", "C2.17", "C2.18", "C2.19")
STARTS = (0, 5, 10, 20)
DIVERGED = 1e3  # N, stands for the error of a run that diverged
ESTIMATING = ("no_impedance", "impedance")


def simulate(config: Config, rng: Rng) -> Recording:
    """All variants in one batch; runs that a variant cannot change are those of the default."""
    rows: list[dict[str, Any]] = []
    for name, changes in {"default": {}, **config.variants}.items():
        setting = {**config.run, **changes}
        rows += [row | {"variant": name} for row in table_rows(setting, _touched(changes))]
    runs = pd.DataFrame(rows)
    errors = simulate_runs(runs, config, edges=[*map(float, STARTS), config.duration], noise=rng("force noise"))
    lengths = np.diff([*STARTS, config.duration])
    kept = runs[["variant", "run"]].copy()
    for k, start in enumerate(STARTS):
        squares = sum(errors[f"square_{j}"] * lengths[j] for j in range(k, len(STARTS)))
        kept[f"rmse_{start}"] = np.sqrt(squares / sum(lengths[k:]))
    return Recording(frames={"errors": kept}, steps=len(runs) * round(config.duration / config.step))


def _touched(changes: Mapping[str, Any]) -> tuple[str, ...] | None:
    """Controllers whose runs a variant of the law can change; None for all."""
    if not changes or set(changes) & set(PLANT):
        return None
    return ("force",) if any("force" in name for name in changes) else ESTIMATING


PLANT = (
    "object_stiffness", "rest_length", "unilateral", "kp_scale", "kd_scale", "velocity_reference", "compensation",
    "gravity", "noise", "regulation",
)  # fmt: skip


def measure(recording: Recording, config: Config) -> Metrics:
    """For each variant, how many verdicts differ from the default's."""
    margins = margins_of(recording.frames["errors"])
    default = margins["default"]
    return {
        f"{name}_flips": sum(flipped_claims(default[claim], margin) for claim, margin in found.items())
        for name, found in margins.items()
        if name != "default"
    }


def flipped_claims(default: float | None, margin: float | None) -> bool:
    return default is not None and margin is not None and (margin > 0) != (default > 0)


def margins_of(errors: pd.DataFrame) -> dict[str, dict[str, float | None]]:
    """Margins of the judged claims by variant; the default also over other parts of the run."""
    table = errors.set_index(["variant", "run"]).fillna(DIVERGED)
    variants = {str(name): pd.DataFrame(table.loc[name]) for name in dict.fromkeys(errors["variant"])}
    base = variants["default"]
    variants = {name: values.combine_first(base) for name, values in variants.items()}
    result = {name: _judge(values, 20) for name, values in variants.items()}
    return result | {f"window_{start}_to_40": _judge(base, start) for start in STARTS[:-1]}


def _judge(values: pd.DataFrame, start: int) -> dict[str, float | None]:
    metrics: dict[str, Metrics] = {
        str(run): {"rmse": row[f"rmse_{start}"], **{f"rmse_{s}": row[f"rmse_{s}"] for s in STARTS}}
        for run, row in values.iterrows()
    }
    flat: Metrics = {f".{run}.{name}": v for run, row in metrics.items() for name, v in row.items()}
    summary = holding_comparison.summarise(metrics, Config())
    flat |= {f".{name}": value for name, value in summary.items()}
    found = {claim.id: claim.predicate for claim in CLAIMS if claim.id in JUDGED and claim.predicate}
    return {claim: predicate.margin(flat) for claim, predicate in found.items()}
