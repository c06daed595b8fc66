"""How well DMP, DMP+ and IDMP with the same random kernels repeat a handwritten letter (Sect. 5.5.1)."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter5 import letters
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.primitives import DMP, Demonstration, GaussianKernels, TruncatedKernels, extend

METHODS = {"dmp": "DMP", "dmp_plus": "DMP+", "idmp": "IDMP"}


def simulate(config: Config, rng: Rng) -> Recording:
    hand, generator, rivals, rows, runs = rng("demonstration"), rng("kernels"), rng("rivals"), [], []
    written = letters.demonstrations(config.hand.letter, config.demonstrations, config.kernels.draws, config, hand)
    for count in config.kernels.counts:
        for draw, demonstration in enumerate(written):
            taught = letters.taught(demonstration, config)
            for method, primitive in _learn(count, taught, config, generator, rivals).items():
                errors, path = _errors(primitive, demonstration, config)
                rows.append((count, draw, method, *errors))
                runs.append((demonstration.position, path))
    draws = pd.DataFrame(rows, columns=["kernels", "draw", "method", "mse", "after", "limit", "weight"])
    return Recording(
        frames={"draws": draws, "paths": _typical_paths(draws, runs, config)},
        steps=len(rows) * config.dmp.samples,
    )


def _learn(
    count: int, taught: Demonstration, config: Config, rng: np.random.Generator, rivals: np.random.Generator
) -> dict[str, DMP]:
    """Every method on one draw of kernels; the baselines of equal size draw more kernels from the same law.

    dmp_equal and dmp_plus_equal have as many free parameters as the largest IDMP, dmp_double as many as the DMP+, and
    dmp_fixed as many as the largest IDMP on the fewest kernels, whatever the number of initial ones.
    """
    largest, training = max(config.features.counts), config.training
    kernels = letters.kernels(count, config, rng)
    features = letters.features(kernels, largest, config, rng)
    size = 2 * count + largest  # free parameters of the largest IDMP
    same, half = letters.kernels(size, config, rng), letters.kernels(size // 2, config, rng)
    base = _fit(kernels, taught, config)
    learned = {"dmp": base, "dmp_plus": _fit(_truncated(kernels, config), taught, config, training.dmp_plus_estimator)}
    if config.equal_size:
        learned["dmp_local"] = _fit(kernels, taught, config, "lwr")
        learned["dmp_equal"] = _fit(same, taught, config)
        learned["dmp_plus_equal"] = _fit(_truncated(half, config), taught, config)
        learned["dmp_double"] = _fit(letters.kernels(2 * count, config, rivals), taught, config)
        fewest = 2 * min(config.kernels.counts) + largest
        learned["dmp_fixed"] = _fit(letters.kernels(fewest, config, rivals), taught, config)
    options = {"update": training.solution, **{key: training[key] for key in ("rest", "rcond", "ridge")}}
    for m in config.features.counts:
        learned[f"idmp{m}"] = extend(base, features.first(m), taught, **options)
    return learned


def _truncated(kernels: GaussianKernels, config: Config) -> TruncatedKernels:
    return TruncatedKernels(kernels, config.dmp_plus.reach, config.dmp_plus.two_sided)


def _fit(features: Any, taught: Demonstration, config: Config, estimator: Any = "least_squares") -> DMP:
    scaling, training = letters.letter_scaling(config), config.training
    options = {key: training[key] for key in ("rest", "rcond", "ridge")}
    return DMP.fit(taught, features, letters.system(config), config.dmp.decay, scaling, estimator=estimator, **options)


def _errors(primitive: DMP, demonstration: Demonstration, config: Config) -> tuple[tuple[Any, ...], Any]:
    """Mean squared error, largest distance from the goal within T/2 after T, that at 10 T, largest weight; the path."""
    count, duration = config.dmp.samples, config.dmp.duration
    path = letters.rollout(primitive, config, horizon=1.5 * duration)
    late = primitive.rollout(duration / 100, horizon=10 * duration).position[-1]
    distance = np.linalg.norm(path[count - 1 :] - primitive.goal, axis=1)
    error = letters.squared_error(path[:count], demonstration.position)
    weight = np.abs(primitive.weights).max()
    return (error, distance.max(), np.linalg.norm(late - primitive.goal), weight), path[:count]


def _typical_paths(draws: pd.DataFrame, runs: list[Any], config: Config) -> pd.DataFrame:
    """Letter and paths of the three methods for the draw whose DMP has the median error, every fourth sample."""
    parts = []
    for count in config.kernels.counts:
        plain = draws[(draws.kernels == count) & (draws.method == "dmp")].sort_values("mse")
        typical = plain.draw.iloc[len(plain) // 2]
        for method in METHODS:
            key = f"idmp{max(config.features.counts)}" if method == "idmp" else method
            row = draws[(draws.kernels == count) & (draws.draw == typical) & (draws.method == key)]
            (x_d, y_d), (x, y) = (path[::4].T for path in runs[row.index[0]])
            columns = {
                "kernels": count,
                "method": method,
                "mse": row.mse.iloc[0],
                "x": x,
                "y": y,
                "x_d": x_d,
                "y_d": y_d,
            }
            parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def measure(recording: Recording, config: Config) -> Metrics:
    draws, metrics = recording.frames["draws"], Metrics()
    by_count = {}
    best = f"idmp{max(config.features.counts)}"
    for count in config.kernels.counts:
        part = draws[draws.kernels == count]
        errors = by_count[count] = part.pivot(index="draw", columns="method", values="mse")
        for method in errors:
            metrics[f"n{count}.{method}.mse"] = float(errors[method].median())
            metrics[f"n{count}.{method}.mse_q90"] = float(errors[method].quantile(0.9))
            if method.startswith("idmp") or method == "dmp_equal":
                metrics[f"n{count}.{method}.beats_dmp_plus"] = _share(errors[method] < errors.dmp_plus)
                metrics[f"n{count}.{method}.ratio"] = float((errors[method] / errors.dmp_plus).median())
            if method.startswith("idmp"):
                ordered = (errors[method] < errors.dmp_plus) & (errors.dmp_plus < errors.dmp)
                metrics[f"n{count}.{method}.ordered"] = _share(ordered)
        for method in ("dmp", "dmp_plus", best):
            chosen = part[part.method == method]
            metrics[f"n{count}.{method}.after"] = float(chosen.after.median())
            metrics[f"n{count}.{method}.limit"] = max(float(chosen.limit.max()), 1e-9)  # below is rounding
        metrics[f"n{count}.dmp_plus.beats_dmp"] = _share(errors.dmp_plus < errors.dmp)
        metrics[f"n{count}.ordered"] = metrics[f"n{count}.{best}.ordered"]
        metrics[f"n{count}.dmp_plus.ratio"] = float((errors.dmp_plus / errors.dmp).median())
        if config.equal_size:
            metrics[f"n{count}.dmp_double.ratio"] = float((errors.dmp_double / errors.dmp).median())
            metrics[f"n{count}.{best}.beats_dmp_equal"] = _share(errors[best] < errors.dmp_equal)
            metrics[f"n{count}.{best}.beats_dmp_plus_equal"] = _share(errors[best] < errors.dmp_plus_equal)
            ordered = (errors[best] < errors.dmp_plus_equal) & (errors.dmp_plus_equal < errors.dmp_equal)
            metrics[f"n{count}.ordered_equal"] = _share(ordered)
    few, many = by_count[min(by_count)], by_count[max(by_count)]
    for method in few:
        if len(by_count) > 1:
            metrics[f"{method}.improves"] = _share(many[method] < few[method])
        # The same comparison of every draw with the next one of as many kernels: what chance gives.
        metrics[f"{method}.improves_by_chance"] = _share(np.roll(few[method], 1) < few[method])
    return metrics


def _share(holds: Any) -> float:
    return float(np.mean(holds))


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Whether the IDMP's median error falls with every step in m, and how far below the DMP+ it ends."""
    default, result = metrics.get("default", {}), {}
    for count in config.kernels.counts:
        medians = [default.get(f"n{count}.idmp{m}.mse") for m in config.features.counts]
        if len(medians) > 1 and all(value is not None for value in medians):
            steps = [after / before for before, after in pairwise(medians)]  # type: ignore[operator]
            result[f"largest_step_n{count}"] = max(steps)
    return result
