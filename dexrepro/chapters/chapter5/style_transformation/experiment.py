"""One letter turns into four others on shared features (Sect. 5.5.2)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter5 import letters
from dexrepro.chapters.demonstrations import by_name
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms_distance
from dexrepro.primitives import DMP, Demonstration, ExtendedKernels, extend, extend_styles, interpolate, original

EARLY, LATE = ("z", "k"), ("w", "l")  # which letters are said to arrive early, and which gradually


def simulate(config: Config, rng: Rng) -> Recording:
    hand, generator, second = rng("demonstration"), rng("features"), rng("refinement")
    rows, kept = [], {}  # type: list[Any], dict[tuple[str, int], DMP]
    for draw in range(config.features.draws):
        if draw == 0 or config.hand.redrawn:
            shown = _demonstrations(config, hand)
            taught = {name: letters.taught(demonstration, config) for name, demonstration in shown.items()}
        learned, features = _learn(taught, config, generator)
        further = letters.features(features.kernels, config.features.refined, config, second, base=features)
        for (letter, m), primitive in learned.items():
            path, refined, again = letters.rollout(primitive, config), None, None
            target, base = (rms_distance(path, shown[name].position) for name in (letter, config.hand.base))
            back = np.abs(letters.rollout(original(primitive), config) - letters.rollout(learned[letter, 0], config))
            nearest = min(config.hand.targets, key=lambda name: rms_distance(path, shown[name].position))
            others = min(rms_distance(path, shown[name].position) for name in shown if name != letter)
            if m == max(config.features.counts):
                refined, again = (
                    _refined(primitive, more, taught[letter], shown[letter], config)
                    for more in (further, replace(features, base=features))
                )
            rows.append((draw, letter, m, target, base, nearest == letter, others, back.max(), refined, again))
        if not kept:
            kept, first = learned, shown
    columns = ["draw", "letter", "m", "target", "base", "nearest", "others", "recovery", "refined", "again"]
    paths = [_frame(letters.rollout(p, config), letter=letter, m=m) for (letter, m), p in kept.items()]
    demonstrations = [_frame(d.position, letter=name, m=-1) for name, d in first.items()]
    return Recording(
        frames={
            "errors": pd.DataFrame(rows, columns=columns),
            "paths": pd.concat(demonstrations + paths, ignore_index=True),
            "mixtures": _mixtures(kept, config),
        },
        steps=len(rows) * config.dmp.samples,
    )


def _demonstrations(config: Config, hand: np.random.Generator) -> dict[str, Demonstration]:
    names = (config.hand.base, *letters.named("targets", config, least=1))
    own = by_name(config.demonstrations, names)
    return {name: letters.demonstrations(name, own.get(str(name)), 1, config, hand)[0] for name in names}


def _refined(
    style: DMP, features: ExtendedKernels, taught: Demonstration, shown: Demonstration, config: Config
) -> float:
    """Distance [cm] of a style from its letter after a second stage of features for it alone."""
    training = config.training
    again = extend(style, features, taught, relearn_old=False, rest=training.rest, rcond=training.rcond)
    return float(rms_distance(letters.rollout(again, config), shown.position))


def _learn(
    shown: dict[str, Demonstration], config: Config, rng: np.random.Generator
) -> tuple[dict[tuple[str, int], DMP], ExtendedKernels]:
    """Primitives by target letter and number of added features, 0 for one feature without weight; all features."""
    training = config.training
    kernels = letters.kernels(config.kernels.count, config, None)
    base = DMP.fit(
        shown[config.hand.base], kernels, letters.system(config), config.dmp.decay, letters.letter_scaling(config),
        rest=training.rest, rcond=training.rcond,
    )  # fmt: skip
    features = letters.features(kernels, max(config.features.counts), config, rng)
    learned, most = {}, max(config.features.counts)
    for m in (0, *config.features.counts):
        styles = extend_styles(
            base, features if m == most else features.first(m), [shown[name] for name in config.hand.targets],
            relearn_old=training.relearn_old and m > 0, rest=training.rest, rcond=training.rcond,
            update=training.solution if m else "exact",
        )  # fmt: skip
        learned.update({(name, m): style for name, style in zip(config.hand.targets, styles)})
    return learned, features


def _mixtures(learned: dict[tuple[str, int], DMP], config: Config) -> pd.DataFrame:
    most, parts, names = max(config.features.counts), [], config.hand.targets
    for first, second in zip(names[::2], names[1::2]):
        one, two = learned[first, most], learned[second, most]
        ends = letters.rollout(one, config), letters.rollout(two, config)
        for share in config.interpolation:
            path = letters.rollout(interpolate(one, two, share), config)
            gap = np.abs(path - share * ends[0] - (1 - share) * ends[1]).max()
            parts.append(_frame(path, pair=first + second, share=share, gap=gap))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=["pair", "share", "gap", "x", "y"])


def _frame(path: Any, **columns: Any) -> pd.DataFrame:
    """Every fifth point of a path."""
    return pd.DataFrame({**columns, "x": path[::5, 0], "y": path[::5, 1]})


def measure(recording: Recording, config: Config) -> Metrics:
    errors, counts = recording.frames["errors"], config.features.counts
    metrics: Metrics = {}
    halfway = {}
    for letter in config.hand.targets:
        part = errors[errors.letter == letter]
        target = part.pivot(index="draw", columns="m", values="target")
        base = part.pivot(index="draw", columns="m", values="base")
        first, last = part[part.m == counts[0]], part[part.m == counts[-1]]
        metrics[f"{letter}.start"] = float(target[0].median())
        metrics[f"{letter}.after5"] = float(target[counts[0]].median())
        if 15 in counts:
            halfway[letter] = target[15] / target[0]
        metrics[f"{letter}.after15"] = float(halfway[letter].median()) if 15 in counts else None
        metrics[f"{letter}.final"] = float(target[counts[-1]].median())
        metrics[f"{letter}.first_step"] = float((target[counts[0]] / target[0]).min())
        metrics[f"{letter}.approaches"] = float(np.mean(np.diff(target, axis=1).max(axis=1) <= 0))
        metrics[f"{letter}.leaves_base"] = float(np.mean(np.diff(base, axis=1).min(axis=1) >= 0))
        for name, some in (("", last), ("_first", first)):
            metrics[f"{letter}.distinct{name}"] = float(np.mean(some.nearest))
            metrics[f"{letter}.margin{name}"] = float((some.others / some.target).median())
        for name in ("refined", "again"):
            metrics[f"{letter}.{name}"] = float((last[name].astype(float) / last.target).median())
    if set(EARLY + LATE) <= set(halfway):
        early, late = (np.stack([halfway[name] for name in names]) for names in (EARLY, LATE))
        metrics["early_order"] = float(np.mean(early.max(axis=0) < late.min(axis=0)))
    # Identities up to rounding, which weights of 1e8 and more amplify: 1 if they hold.
    metrics["recovered"] = float(errors.recovery.max() < 1e-6)
    mixtures = recording.frames["mixtures"]
    metrics["mixed_pointwise"] = float(mixtures.gap.max() < 1e-4) if len(mixtures) else None
    return metrics
