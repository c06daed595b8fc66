"""One letter turns into four others on shared features (Sect. 5.5.2)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter5 import letters
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms_distance
from dexrepro.primitives import DMP, Demonstration, extend_styles, interpolate, original

PAIRS = (("w", "z"), ("k", "l"))


def simulate(config: Config, rng: Rng) -> Recording:
    hand, generator = rng("demonstration"), rng("features")
    own = config.demonstrations or {}
    names = (config.hand.base, *config.hand.targets)
    shown = {name: letters.demonstrations(name, own.get(name), 1, config, hand)[0] for name in names}
    taught = {name: letters.taught(demonstration, config) for name, demonstration in shown.items()}
    rows, kept = [], {}  # type: list[Any], dict[tuple[str, int], DMP]
    for draw in range(config.features.draws):
        learned = _learn(taught, config, generator)
        for (letter, m), primitive in learned.items():
            path = letters.rollout(primitive, config)
            target, base = (rms_distance(path, shown[name].position) for name in (letter, config.hand.base))
            back = np.abs(letters.rollout(original(primitive), config) - letters.rollout(learned[letter, 0], config))
            nearest = min(config.hand.targets, key=lambda name: rms_distance(path, shown[name].position))
            others = min(rms_distance(path, shown[name].position) for name in shown if name != letter)
            rows.append((draw, letter, m, target, base, nearest == letter, others, back.max()))
        kept = kept or learned
    columns = ["draw", "letter", "m", "target", "base", "nearest", "others", "recovery"]
    paths = [_frame(letters.rollout(p, config), letter=letter, m=m) for (letter, m), p in kept.items()]
    demonstrations = [_frame(d.position, letter=name, m=-1) for name, d in shown.items()]
    return Recording(
        frames={
            "errors": pd.DataFrame(rows, columns=columns),
            "paths": pd.concat(demonstrations + paths, ignore_index=True),
            "mixtures": _mixtures(kept, config),
        },
        steps=len(rows) * config.dmp.samples,
    )


def _learn(shown: dict[str, Demonstration], config: Config, rng: np.random.Generator) -> dict[tuple[str, int], DMP]:
    """Primitives by target letter and number of added features; 0 stands for one feature without weight."""
    training = config.training
    kernels = letters.kernels(config.kernels.count, config, None)
    base = DMP.fit(
        shown[config.hand.base], kernels, letters.system(config), config.dmp.decay, letters.letter_scaling(config),
        rest=training.rest, rcond=training.rcond,
    )  # fmt: skip
    features = letters.features(kernels, max(config.features.counts), config, rng)
    learned = {}
    for m in (0, *config.features.counts):
        styles = extend_styles(
            base, features.first(m), [shown[name] for name in config.hand.targets],
            relearn_old=training.relearn_old and m > 0, rest=training.rest, rcond=training.rcond,
            update=training.solution if m else "exact",
        )  # fmt: skip
        learned.update({(name, m): style for name, style in zip(config.hand.targets, styles)})
    return learned


def _mixtures(learned: dict[tuple[str, int], DMP], config: Config) -> pd.DataFrame:
    most, parts = max(config.features.counts), []
    for first, second in PAIRS:
        one, two = learned[first, most], learned[second, most]
        ends = letters.rollout(one, config), letters.rollout(two, config)
        for share in config.interpolation:
            path = letters.rollout(interpolate(one, two, share), config)
            gap = np.abs(path - share * ends[0] - (1 - share) * ends[1]).max()
            parts.append(_frame(path, pair=first + second, share=share, gap=gap))
    return pd.concat(parts, ignore_index=True)


def _frame(path: Any, **columns: Any) -> pd.DataFrame:
    """Every fifth point of a path."""
    return pd.DataFrame({**columns, "x": path[::5, 0], "y": path[::5, 1]})


def measure(recording: Recording, config: Config) -> Metrics:
    errors, counts = recording.frames["errors"], config.features.counts
    metrics: Metrics = {}
    for letter in config.hand.targets:
        part = errors[errors.letter == letter]
        target = part.pivot(index="draw", columns="m", values="target")
        base = part.pivot(index="draw", columns="m", values="base")
        last = part[part.m == counts[-1]]
        metrics[f"{letter}.start"] = float(target[0].median())
        metrics[f"{letter}.after5"] = float(target[counts[0]].median())
        metrics[f"{letter}.after15"] = float((target[15] / target[0]).median()) if 15 in counts else None
        metrics[f"{letter}.final"] = float(target[counts[-1]].median())
        metrics[f"{letter}.first_step"] = float((target[counts[0]] / target[0]).min())
        metrics[f"{letter}.approaches"] = float(np.mean(np.diff(target, axis=1).max(axis=1) <= 0))
        metrics[f"{letter}.leaves_base"] = float(np.mean(np.diff(base, axis=1).min(axis=1) >= 0))
        metrics[f"{letter}.distinct"] = float(np.mean(last.nearest))
        metrics[f"{letter}.margin"] = float((last.others / last.target).median())
    # Identities up to rounding, which weights of 1e8 and more amplify: 1 if they hold.
    metrics["recovered"] = float(errors.recovery.max() < 1e-6)
    metrics["mixed_pointwise"] = float(recording.frames["mixtures"].gap.max() < 1e-4)
    return metrics
