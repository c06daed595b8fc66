"""Skills that cross a stack of one, two and three blocks, as learning and tracking experiments share them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from dexrepro.chapters.chapter5 import letters
from dexrepro.chapters.demonstrations import by_name, recorded
from dexrepro.experiment import Config
from dexrepro.humans.crossing import via_points
from dexrepro.humans.handwriting import hand_path, smoothed
from dexrepro.primitives import DMP, Demonstration, Scaling, extend

HEIGHTS = (1, 2, 3)


def repetitions(blocks: int, config: Config, rng: np.random.Generator) -> list[Any]:
    """Demonstrated paths (N, 3) [cm] over a number of blocks: the user's, or else synthetic ones."""
    hand, shape = config.hand, config.demonstration
    time = np.linspace(0.0, config.dmp.duration, config.dmp.samples)
    own = by_name(config.get("demonstrations"), HEIGHTS)
    if str(blocks) in own:
        paths = recorded(own[str(blocks)], shape.count, len(time), config, axes=3)
        return [(1 + config.perturbation) * smoothed(time, path, hand.cutoff) for path in paths]
    points = via_points(blocks, shape.clearance, shape.plateau) * (1 + config.perturbation)
    points[-1, 1:] += shape.end_offset
    jitter = np.array([shape.jitter, shape.sideways, shape.jitter])
    return [hand_path(points, time, jitter, hand.tremor, hand.cutoff, rng) for _ in range(shape.count)]


def averaged(paths: list[Any], config: Config) -> Demonstration:
    return Demonstration.of(np.linspace(0.0, config.dmp.duration, config.dmp.samples), np.mean(paths, axis=0))


@dataclass
class Skills:
    """Demonstrations and skills by number of blocks; ``steps`` by blocks and number of added features."""

    demonstrations: dict[int, Demonstration]
    skills: dict[int, DMP]
    steps: dict[tuple[int, int], DMP]


def learn(demonstrations: dict[int, Demonstration], config: Config, rng: np.random.Generator) -> Skills:
    """One block by a DMP, two from one and three from two by adding features."""
    training, counts = config.training, config.features.counts
    kernels = letters.kernels(config.kernels.count, config, None)
    skill = DMP.fit(
        demonstrations[1], kernels, letters.system(config), config.dmp.decay, _scaling(config),
        rest=training.rest, rcond=training.rcond,
    )  # fmt: skip
    skills, steps = {1: skill}, {}
    for blocks in HEIGHTS[1:]:
        features = letters.features(kernels, max(counts), config, rng, base=skill.features)
        steps[blocks, 0] = skill
        for m in counts:
            steps[blocks, m] = extend(
                skill, features.first(m), demonstrations[blocks], relearn_old=training.relearn_old,
                rest=training.rest, rcond=training.rcond,
            )  # fmt: skip
        skill = skills[blocks] = steps[blocks, counts[-1]]
    return Skills(demonstrations, skills, steps)


def _scaling(config: Config) -> Scaling:
    """A = g - x0 along x, the length of the movement across it, where start and goal agree; or g - x0 throughout."""
    if config.dmp.amplitude == "printed":
        return Scaling.goal(3)
    return Scaling(np.array([True, False, False]), np.full(3, 12.0))


def undefined(demonstrations: dict[int, Demonstration], config: Config) -> str:
    """Why the printed amplitude cannot be used: start and goal agree on an axis, up to rounding; "" where it can."""
    first = demonstrations[1]
    if config.dmp.amplitude != "printed" or (np.abs(first.goal - first.start) > 1e-6 * first.extent.max()).all():
        return ""
    return "not defined: the printed amplitude is zero where start and goal agree on an axis"


def goals(config: Config) -> Any:
    """The nine goals (9, 3) [cm]."""
    height = config.demonstration.end_offset if config.goals.z is None else config.goals.z
    return np.array([(x, y, height) for x in config.goals.x for y in config.goals.y])
