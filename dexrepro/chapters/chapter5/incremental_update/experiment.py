"""The mechanism of the incremental update: features, the lemma on pseudo-inverses and its cost (Sect. 5.3.1)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from scipy.special import expit

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter5 import letters
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.primitives import (
    DMP,
    GaussianKernels,
    GrowingRegression,
    TruncatedKernels,
    extended_pseudo_inverse,
    forcing_target,
    least_squares,
    phase,
)

KINDS = ("independent", "dependent", "mixed")


def simulate(config: Config, rng: Rng) -> Recording:
    return PARTS[config.part](config, rng)


def _mechanism(config: Config, rng: Rng) -> Recording:
    kernels = letters.kernels(config.kernels.count, config, None)
    features = letters.features(kernels, config.features.count, config, rng("features"))
    instants = np.linspace(0, config.dmp.duration, config.dmp.samples)
    s = phase(instants, config.dmp.duration, config.dmp.decay)
    blocks, activations = features.blocks(s), kernels.activations(s)
    eta = expit(activations @ features.input_weights + features.biases)
    names = {"kernels": activations, "features": eta, "share": blocks.share, "old": blocks.kernels}
    change = blocks.change
    names |= {"modified": change[:, : kernels.count], "new": change[:, kernels.count :], "phase": s[:, None]}
    frame = pd.DataFrame({f"{key}{j}": column for key, values in names.items() for j, column in enumerate(values.T)})
    return Recording(series={"time": instants}, frames={"blocks": frame}, steps=len(instants))


def _lemma(config: Config, rng: Rng) -> Recording:
    """Random matrices that gain columns: independent, dependent, or two of each; three readings of the lemma."""
    generator, rows = rng("matrices"), []
    for draw in range(config.lemma.draws):
        matrix = generator.standard_normal((config.lemma.rows, config.lemma.columns)) + config.perturbation
        inverse = np.linalg.pinv(matrix)
        for kind in KINDS:
            added = _columns(matrix, kind, config.lemma.added, generator)
            truth = np.linalg.pinv(np.concatenate([matrix, added], axis=1))
            target = generator.standard_normal((config.lemma.rows, 2))
            for reading, update in READINGS.items():
                found = update(matrix, inverse, added)
                error = np.linalg.norm(found - truth) / np.linalg.norm(truth)
                fit = np.concatenate([matrix, added], axis=1) @ ((found - truth) @ target)
                rows.append((draw, kind, reading, error, np.linalg.norm(fit) / np.linalg.norm(target)))
    columns = ["draw", "kind", "reading", "error", "fit"]
    return Recording(frames={"lemma": pd.DataFrame(rows, columns=columns)}, steps=len(rows))


def _columns(matrix: Any, kind: str, added: int, rng: np.random.Generator) -> Any:
    """Columns outside the range of the matrix, inside it, or half and half."""
    columns = rng.standard_normal((len(matrix), added))
    inside = {"independent": 0, "dependent": added, "mixed": added // 2}[kind]
    columns[:, :inside] = matrix @ rng.standard_normal((matrix.shape[1], inside))
    return columns


def _printed(matrix: Any, inverse: Any, columns: Any, scalar: bool = False) -> Any:
    """Eq. (5.9) as printed: b = c^+ where c is not 0, else (1 + d^T d)^-1 d^T A^+, the 1 as identity or literally."""
    d = inverse @ columns
    c = columns - matrix @ d
    if np.linalg.norm(c) > 1e-9 * np.linalg.norm(columns):
        b = np.linalg.pinv(c, rcond=1e-9)
    else:
        b = np.linalg.solve((1.0 if scalar else np.eye(d.shape[1])) + d.T @ d, d.T @ inverse)
    return np.concatenate([inverse - d @ b, b])


READINGS: dict[str, Callable[[Any, Any, Any], Any]] = {
    "completed": extended_pseudo_inverse,
    "printed": _printed,
    "scalar": partial(_printed, scalar=True),
}


def _activations(config: Config, rng: Rng) -> Recording:
    """Other maps than the sigmoid in (5.11): does sum phi + sum eta, which divides everything, change its sign?"""
    kernels = letters.kernels(config.kernels.count, config, None)
    s = phase(np.linspace(0, config.dmp.duration, config.dmp.samples), config.dmp.duration, config.dmp.decay)
    generator, rows = rng("features"), []
    for draw in range(config.lemma.draws):
        features = letters.features(kernels, config.features.added, config, generator)
        activations = kernels.activations(s)
        inner = activations @ features.input_weights + features.biases
        for name, function in MAPS.items():
            total = activations.sum(axis=1) + function(inner).sum(axis=1)
            rows.append((draw, name, total.min() < 0 < total.max(), np.abs(total).min()))
    columns = ["draw", "map", "changes_sign", "least"]
    return Recording(frames={"maps": pd.DataFrame(rows, columns=columns)}, steps=len(rows))


MAPS: dict[str, Callable[[Any], Any]] = {"sigmoid": expit, "tanh": np.tanh, "sin": np.sin}


def _drift(config: Config, rng: Rng) -> Recording:
    """A letter's forcing on features that are appended five at a time: does the update keep up with solving anew?

    The features are taken without their common denominator, so that appending one changes no other; the target is
    multiplied by it instead.
    """
    demonstration = letters.demonstration(config.hand.letter, config, rng("demonstration"))
    demonstration = demonstration.with_rest(config.training.rest)
    s = phase(demonstration.time, config.dmp.duration, config.dmp.decay)[:, None]
    target = forcing_target(demonstration, letters.system(config), config.dmp.duration, demonstration.goal)
    rows = []
    for count in config.kernels.counts:
        kernels = letters.kernels(count, config, None)
        features = letters.features(kernels, config.features.added, config, rng(f"features{count}"))
        activations = kernels.activations(s[:, 0])
        eta = expit(activations @ features.input_weights + features.biases)
        regression = GrowingRegression(s * activations)
        for m in range(config.features.block, config.features.added + 1, config.features.block):
            regression.append(s * eta[:, m - config.features.block : m])
            total = (activations.sum(axis=1) + eta[:, :m].sum(axis=1))[:, None]
            anew = least_squares(regression.matrix, target * total)
            gap = regression.matrix @ (regression.weights(target * total) - anew) / total
            rows.append((count, m, np.linalg.norm(gap) / np.linalg.norm(target)))
    return Recording(frames={"drift": pd.DataFrame(rows, columns=["kernels", "m", "gap"])}, steps=len(rows))


def _cost(config: Config, rng: Rng) -> Recording:
    """Multiplications for five more columns, by updating and by solving anew."""
    samples, step, generator, rows = round(1.5 * config.dmp.samples), config.features.block, rng("matrices"), []
    target = generator.standard_normal((samples, 2))
    for count in range(config.lemma.most // 10, config.lemma.most + 1, config.lemma.most // 10):
        regression = GrowingRegression(generator.standard_normal((samples, count)))
        regression.append(generator.standard_normal((samples, step)))
        weights, anew = regression.weights(target), least_squares(regression.matrix, target)
        operations = update_operations(samples, count, step), solve_operations(samples, count + step)
        rows.append((count, np.abs(weights - anew).max() / np.abs(anew).max(), *operations))
    columns = ["features", "difference", "update", "anew"]
    return Recording(frames={"cost": pd.DataFrame(rows, columns=columns)}, steps=len(rows))


def _search(config: Config, rng: Rng) -> Recording:
    """A letter learned by DMP+, and by trial: a cross-entropy search over the weights of a plain DMP.

    The search is helped: its kernels are equally spaced, as many as it takes to be well conditioned, and it is told the
    size of the best weights. A rollout is one product with the primitive's responses.
    """
    settings, scaling = config.search, letters.letter_scaling(config)
    shown = letters.demonstration(config.hand.letter, config, rng("demonstration"))

    def fit(features: GaussianKernels | TruncatedKernels) -> DMP:
        options = {"rest": config.training.rest, "rcond": config.training.rcond}
        taught = letters.taught(shown, config)
        return DMP.fit(taught, features, letters.system(config), config.dmp.decay, scaling, **options)

    few, many = (letters.kernels(count, config, None) for count in (config.kernels.count, settings.kernels))
    plus, plain = fit(TruncatedKernels(few, config.dmp_plus.reach, config.dmp_plus.two_sided)), fit(many)
    fitted = [letters.squared_error(letters.rollout(p, config), shown.position) for p in (plus, fit(few), plain)]
    step, generator = config.dmp.duration / (config.dmp.samples - 1), rng("trials")
    responses, amplitude = plain.propagator(step), scaling.amplitude(plain.start, plain.goal)
    mean = np.zeros_like(plain.weights)
    spread = np.full_like(mean, np.sqrt(np.mean(plain.weights**2)))
    rows, rollouts = [], 0
    for _ in range(settings.generations):
        trials = mean + spread * generator.standard_normal((settings.population, *mean.shape))
        paths = responses.position(trials * amplitude, np.tile(plain.start, (settings.population, 1)), plain.goal)
        errors = np.mean(np.sum((paths - shown.position) ** 2, axis=-1), axis=-1)
        best = trials[np.argsort(errors)[: settings.elite]]
        mean, spread = best.mean(axis=0), best.std(axis=0)
        rollouts += settings.population
        rows.append((rollouts, errors.min(), *fitted))
    columns = ["rollouts", "error", "dmp_plus", "dmp", "plain"]
    return Recording(frames={"search": pd.DataFrame(rows, columns=columns)}, steps=rollouts)


PARTS = {
    "search": _search,
    "mechanism": _mechanism,
    "activations": _activations,
    "lemma": _lemma,
    "drift": _drift,
    "cost": _cost,
}


LOST = 1e-2  # of the target: repeated updates no longer give the solution


def update_operations(rows: int, columns: int, added: int) -> int:
    """Multiplications of the block update: four products of A or A^+ with m columns, d b, and the SVD of c."""
    return 5 * rows * columns * added + 6 * rows * added**2


def solve_operations(rows: int, columns: int) -> int:
    """Multiplications of a least-squares solution by QR and the SVD of R."""
    return rows * columns**2 + 9 * columns**3


def measure(recording: Recording, config: Config) -> Metrics:
    ((part, frame),) = recording.frames.items()
    return _measure_search(frame, config) if part == "search" else MEASURES[part](frame)


def _measure_lemma(frame: pd.DataFrame) -> Metrics:
    worst = frame.groupby(["kind", "reading"])[["error", "fit"]].max()
    return {
        f"{kind}.{reading}.{name}": max(float(worst[name][kind, reading]), 1e-9)  # below is rounding
        for kind, reading in worst.index
        for name in worst
    }


def _measure_maps(frame: pd.DataFrame) -> Metrics:
    metrics: Metrics = {}
    for name, part in frame.groupby("map"):
        metrics[f"{name}.changes_sign"] = float(part.changes_sign.mean())
        metrics[f"{name}.least"] = float(part.least.min())
    return metrics


def _measure_drift(frame: pd.DataFrame) -> Metrics:
    """Whether update and solution anew end further apart than ``LOST``.

    The gap itself is amplified rounding: from one feature to the next it grows tenfold, on each machine another way.
    """
    return {f"n{count}.lost": int(part.gap.iloc[-1] > LOST) for count, part in frame.groupby("kernels")}


def _measure_cost(frame: pd.DataFrame) -> Metrics:
    ratio = frame.anew / frame["update"]
    worst = max(float(frame.difference.max()), 1e-9)
    return {"difference": worst, "saving_first": float(ratio.iloc[0]), "saving_last": float(ratio.iloc[-1])}


def _measure_mechanism(frame: pd.DataFrame) -> Metrics:
    blocks = {
        name: frame.filter(regex=rf"^{name}\d+$").to_numpy()
        for name in ("share", "old", "modified", "new", "phase", "kernels")
    }
    s, share = blocks["phase"][:, 0], blocks["share"][:, 0]
    total = blocks["old"].sum(axis=1) + blocks["modified"].sum(axis=1) + blocks["new"].sum(axis=1)
    printed = blocks["old"].sum(axis=1) + blocks["modified"].sum(axis=1) + s * blocks["new"].sum(axis=1)
    return {
        "sum_to_phase": float(np.abs(total - s).max() < 1e-12),
        "printed_miss": float(np.abs(printed - s).max()),
        "share_low": float(share.min()),
        "share_high": float(share.max()),
    }


def _measure_search(frame: pd.DataFrame, config: Config) -> Metrics:
    samples, last = config.dmp.samples, frame.iloc[-1]
    rows = round((1 + config.training.rest) * samples)
    trial = samples * config.search.kernels * 2
    return {
        "error": float(frame.error.min()),
        "error_dmp_plus": float(last.dmp_plus),
        "error_dmp": float(last.dmp),
        "error_least_squares": float(last.plain),
        "rollouts": int(last.rollouts),
        "operations": int(last.rollouts) * trial,
        "operations_trial": trial,
        "operations_dmp_plus": solve_operations(rows, 2 * config.kernels.count),
        "operations_dmp": solve_operations(rows, config.kernels.count),
    }


MEASURES = {
    "blocks": _measure_mechanism,
    "maps": _measure_maps,
    "lemma": _measure_lemma,
    "drift": _measure_drift,
    "cost": _measure_cost,
}
