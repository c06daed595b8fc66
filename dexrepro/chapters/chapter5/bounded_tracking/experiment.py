"""The arm writes the learned letters while its joint errors stay inside a shrinking bound (Sects. 5.4, 5.5.2)."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter5 import letters, pen
from dexrepro.control.contract import build
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.primitives import DMP, extend
from dexrepro.robots.arm import Pose, Shape

RATE = 100.0
INK = (0.05, 0.1, 0.4, 1.0)
VIEW = Camera(target=(0.10, 0.0, -0.06), distance=0.36, yaw=125.0, pitch=-35.0, field_of_view=42.0)
WRITER = Camera(target=(0.155, 0.0, -0.09), distance=0.27, yaw=-125.0, pitch=-60.0, field_of_view=33.0)


def simulate(config: Config, rng: Rng) -> Recording:
    path = learned_path(config.hand.letter, config, rng)
    target = pen.reference(pen.on_paper(path), config.arm.step)
    nominal = pen.model(config)
    centres = pen.node_centres(config, target, config.network.nodes, rng("nodes"))
    learner = pen.network(config, centres, target) if config.network.enabled else None
    recording = pen.track(config, target, build(config.law, model=nominal, network=learner), nominal)
    if config.picture == config.hand.letter:
        recording.images["picture"] = _picture(recording, config)
    return recording


def learned_path(letter: str, config: Config, rng: Rng) -> Any:
    """What the primitives make of a letter [cm], at the arm's pace: an IDMP grown from the letter a, or a DMP."""
    hand, training = rng("demonstration"), config.training
    known, targets = letters.named("letters", config), letters.named("targets", config)
    for name in (letter, config.hand.base):
        letters.check_letter(name, known, config)
    shown = {name: letters.demonstration(name, config, hand) for name in known}
    kernels = letters.kernels(config.kernels.count, config, None)

    def fit(name: str) -> DMP:
        scaling, decay = letters.letter_scaling(config), config.dmp.decay
        options = {"rest": training.rest, "rcond": training.rcond}
        return DMP.fit(shown[name], kernels, letters.system(config), decay, scaling, **options)

    primitive = fit(config.hand.base if letter in targets else letter)
    if letter in targets:
        features = letters.features(kernels, config.features.count, config, rng("features"))
        options = {"rest": training.rest, "rcond": training.rcond, "relearn_old": training.relearn_old}
        primitive = extend(primitive, features, shown[letter], **options)
    duration = config.arm.duration
    return primitive.rollout(config.arm.step, horizon=duration, time_constant=duration).position


def scene(config: Config) -> Any:
    """The arm over its sheet of paper, without a law."""
    world = pen.world(config, np.zeros(3))
    world.add_box("paper", (0.07, 0.07, 0.001), (0.165, 0.0, pen.HEIGHT - 0.001), colour=(1, 1, 1, 1), collides=False)
    world.add_box(
        "table", (0.3, 0.3, 0.01), (0.12, 0.0, pen.HEIGHT - 0.008), colour=(0.8, 0.82, 0.85, 1), collides=False
    )
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    """Shows the ink: short strokes that wait below the table until the pen has made them."""
    tip = recording["arm.tip"]
    marks = np.linspace(0, len(tip) - 1, 33).astype(int)
    for k, (first, last) in enumerate(itertools.pairwise(marks)):
        beads = [Shape("box", (0.0013, 0.0013, 0.0006), Pose(tuple(tip[i])), INK) for i in range(first, last, 3)]
        world.add_body(f"ink{k}", beads, (0, 0, 0), collides=False)
        recording.series[f"ink{k}.pose"] = np.where(np.arange(len(tip)) < last, -1.0, 0.0)[:, None] * [0.0, 0.0, 1.0]
    return recording


def _picture(recording: Recording, config: Config) -> Any:
    """The arm at the end of its letter from the writer's side, the ink after the first transient as a chain of "
    "beads."""
    tip = recording["arm.tip"][recording.between(0.4)]
    tip = tip[:: max(1, len(tip) // 600)]
    ink = tuple(Shape("sphere", (0.0009,), Pose(tuple(point)), INK) for point in tip.tolist())
    with scene(config) as world:
        for first in range(0, len(ink), 16):
            world.add_body(f"ink{first}", ink[first : first + 16], (0, 0, 0), collides=False)
        return world.render({"arm": recording["arm.position"][-1]}, camera=WRITER, size=(900, 640))


def measure(recording: Recording, config: Config) -> Metrics:
    return pen.quality(recording, config)
