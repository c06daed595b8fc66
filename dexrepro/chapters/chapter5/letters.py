"""Demonstrated letters and random kernels, as the learning experiments of the chapter share them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from dexrepro.chapters.demonstrations import recorded
from dexrepro.errors import refused
from dexrepro.experiment import Config
from dexrepro.humans.handwriting import LETTERS, smoothed, write
from dexrepro.primitives import DMP, Demonstration, ExtendedKernels, GaussianKernels, Scaling, SpringDamper


def check_letter(letter: Any, there: Iterable[str], config: Config) -> None:
    """Refuse a letter that is not there, by the key of the hand that names it."""
    if letter not in (there := [*there]):
        of = {key: value if isinstance(value, list) else [value] for key, value in config.hand.items()}
        keys = [key for key, value in of.items() if letter in value or letter == value]
        raise refused(f"hand.{keys[-1]}", letter, f"be one of {', '.join(map(str, there))}")


def named(key: str, config: Config, least: int = 0) -> list[str]:
    """Letters of the hand under a key. Raises InputError for what is no list of ``least`` letters or more."""
    value = config.hand[key]
    if not isinstance(value, list | str) or not all(isinstance(name, str) for name in value) or len(value) < least:
        raise refused(f"hand.{key}", value, "be a list of letters")
    return [*value]


def demonstration(letter: str, config: Config, rng: np.random.Generator) -> Demonstration:
    """One handwritten letter [cm]; the size is moved by the configured perturbation."""
    hand = config.hand
    check_letter(letter, LETTERS, config)
    time = np.linspace(0.0, config.dmp.duration, config.dmp.samples)
    size = hand.size * (1 + config.perturbation)
    return Demonstration.of(time, write(letter, time, size, hand.jitter, hand.tremor, hand.cutoff, rng))


def demonstrations(
    letter: str, files: Any, count: int, config: Config, rng: np.random.Generator
) -> list[Demonstration]:
    """``count`` repetitions of a letter [cm]: the user's files, smoothed as any recording, or else synthetic ones."""
    if not files:
        return [demonstration(letter, config, rng) for _ in range(count)]
    time = np.linspace(0.0, config.dmp.duration, config.dmp.samples)
    paths = recorded(files, count, config.dmp.samples, config, axes=2)
    return [Demonstration.of(time, (1 + config.perturbation) * smoothed(time, p, config.hand.cutoff)) for p in paths]


def taught(demonstration: Demonstration, config: Config) -> Demonstration:
    """What a primitive learns from: with the printed sign of D v, Eq. (5.5), the same path at negated velocity."""
    return replace(demonstration, velocity=(-1 if config.training.printed else 1) * demonstration.velocity)


def letter_scaling(config: Config) -> Scaling:
    """A = the letter's size on every axis: letters start and end at nearly the same height."""
    return Scaling(np.zeros(2, dtype=bool), np.full(2, float(config.hand.size)))


def system(config: Config) -> SpringDamper:
    return SpringDamper(config.dmp.stiffness, config.dmp.damping)


def kernels(count: int, config: Config, rng: np.random.Generator | None) -> GaussianKernels:
    """Equally spaced kernels, or, with a generator, random centres and widths."""
    settings = config.kernels
    if rng is None:
        return GaussianKernels.with_widths(np.linspace(0, 1, count), config.dmp.decay, settings.width / count)
    places, (low, high) = np.sort(rng.uniform(size=count)), settings.width_range
    widths = rng.uniform(low, high, size=count) / count
    if settings.placement == "random_phase":
        last = np.exp(-config.dmp.decay)
        places = np.sort(-np.log(last + (1 - last) * places) / config.dmp.decay)
    return GaussianKernels.with_widths(places, config.dmp.decay, widths)


def features(initial: GaussianKernels, count: int, config: Config, rng: np.random.Generator, **options: Any) -> Any:
    settings = config.features
    return ExtendedKernels.draw(initial, count, rng, settings.weight_std, settings.bias_range, **options)


def squared_error(path: Any, wanted: Any) -> float:
    """Mean squared distance [cm^2] of two paths (N, d)."""
    return float(np.mean(np.sum((path - wanted) ** 2, axis=-1)))


def rollout(primitive: DMP, config: Config, **options: Any) -> Any:
    """Path (..., N, d) at the demonstration's instants."""
    return primitive.rollout(config.dmp.duration / (config.dmp.samples - 1), **options).position
