"""The desktop arm carries a cube along the generalised path under time-delay estimation and muscle-like impedance."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter7 import desk
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.physics.elements import Push
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.pen_arm import pen_arm

RATE = 100.0
PICTURES = {"a": 0.5, "b": 2.7, "c": 3.2, "d": 3.6, "e": 4.1, "f": 6.5}

scene = desk.scene


def stage(world: World, recording: Recording, config: Config) -> Recording:
    """The cube lies at its start, in the gripper from picking to release, then where it was put down."""
    time, tip = recording.time, recording["arm.tip"]
    pick, release = np.searchsorted(time, [config.pick, config.release])
    recording.series["cube.pose"] = tip[np.clip(np.arange(len(time)), pick, release)]
    recording.series["tracking"] = tip - recording["planned"]
    return recording


def simulate(config: Config, rng: Rng) -> Recording:
    _, reference = desk.planned(config)
    with desk.build(config, reference.tip[0]) as world:
        if config.jump_force:
            world.add(jumps(config))
        recording = desk.run(config, reference, world, events=desk.payload_events(world, config))
    model = RigidBodyModel(pen_arm())
    recording.series["modelled"] = np.array([model.gravity(q) for q in recording["arm.position"]])
    if config.pictures:
        recording.images = pictures(config, recording)
    return recording


def pictures(config: Config, recording: Recording) -> dict[str, Any]:
    """The scene at the instants of Fig. 7.10; the cube is in the gripper from picking to release."""
    index = {name: int(np.searchsorted(recording.time, instant)) for name, instant in PICTURES.items()}
    with scene(config) as world:
        angles = {name: recording["arm.position"][k] for name, k in index.items()}
        return desk.photographs(world, angles, {name: recording["arm.tip"][k] for name, k in index.items()})


def jumps(config: Config) -> Push:
    """A force on the tip along y that jumps between +- ``jump_force`` [N] every 0.1 s."""
    return Push("arm", lambda t: (0.0, config.jump_force * (1 if t % 0.2 < 0.1 else -1), 0.0))


def measure(recording: Recording, config: Config) -> Metrics:
    return dict(desk.tracking_metrics(recording, config))
