"""The arm follows the crossing skills to nine goals without touching the obstacle (Sect. 5.5.3)."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter5 import crossing, pen
from dexrepro.control.contract import build
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording, changed
from dexrepro.humans.crossing import clearance, obstacle_boxes
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.robots.arm import Pose, Shape

RATE = 100.0


def simulate(config: Config, rng: Rng) -> Recording:
    hand = rng("demonstration")
    shown = {b: crossing.averaged(crossing.repetitions(b, config, hand), config) for b in crossing.HEIGHTS}
    skill = crossing.learn(shown, config, rng("features")).skills[config.blocks]
    duration, goal = config.arm.duration, crossing.goals(config)[config.goal]
    path = skill.rollout(config.arm.step, horizon=duration, time_constant=duration, goal=goal).position
    target = pen.reference(pen.over_table(path), config.arm.step)
    nominal = pen.model(config)
    centres = pen.node_centres(config, target, config.network.nodes, rng("nodes"))
    learner = pen.network(config, centres, target)
    recording = pen.track(config, target, build(config.law, model=nominal, network=learner), nominal)
    if config.picture:
        recording.images.update(_film(recording, config))
    return recording


def scene(config: Config) -> Any:
    """Arm, table, obstacle, start and goals, without a law."""
    world = pen.world(config, np.zeros(3))
    world.add_box(
        "table", (0.3, 0.4, 0.01), (0.15, 0.0, pen.HEIGHT - 0.006), colour=(0.8, 0.82, 0.85, 1), collides=False
    )
    for k, (low, high) in enumerate(obstacle_boxes(config.blocks)):
        corners = pen.over_table([low, high])
        size, centre = np.abs(corners[1] - corners[0]), corners.mean(axis=0)
        world.add_box(f"obstacle{k}", size, centre, colour=(0.85, 0.75, 0.55, 1), collides=False)
    places = [
        (np.array([-6.0, 0.0, 0.0]), (0.0, 0.62, 0.45, 1)),
        *((g, (0.9, 0.62, 0, 1)) for g in crossing.goals(config)),
    ]
    for k, (place, colour) in enumerate(places):
        disc = Shape("cylinder", (0.004, 0.002), Pose(tuple(pen.over_table(place).tolist())), colour)
        world.add_body(f"mark{k}", [disc], (0, 0, 0), collides=False)
    return world


CAMERA = Camera(target=(0.12, -0.01, -0.045), distance=0.42, yaw=68.0, pitch=-22.0, field_of_view=40.0)


def stage(world: World, recording: Recording, config: Config) -> Recording:
    recording.series["clearance"] = clearance(pen.from_table(recording["arm.tip"]), config.blocks)
    return recording


def _film(recording: Recording, config: Config) -> dict[str, Any]:
    """Pictures of the run at the configured instants."""
    with scene(config) as world:
        return {
            f"at{k}": world.snapshot(recording, time, camera=CAMERA, size=(640, 520))
            for k, time in enumerate(config.film)
        }


def measure(recording: Recording, config: Config) -> Metrics:
    tip = pen.from_table(recording["arm.tip"])
    end = tip[-1] - crossing.goals(config)[config.goal]
    quality = pen.quality(recording, config)
    return {
        "clearance": float(clearance(tip, config.blocks).min()),
        "end_error": 10 * float(np.linalg.norm(end)),
        **{name: quality[name] for name in ("bound_use", "tip_rms", "outside")},
    }


def crossings(config: Config) -> dict[tuple[int, int], str]:
    """The cases that differ in nothing but the stack and the goal, by these."""
    return {
        (case.blocks, case.goal): name
        for name, case in config.cases.items()
        if changed(case, config) <= {"blocks", "goal"}
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """The worst of the 18 crossings."""
    runs = [metrics[case] for case in crossings(config).values() if case in metrics]
    if not runs:
        return {}
    return {
        "least_clearance": min(values["clearance"] for values in runs),  # type: ignore[type-var]
        "largest_bound_use": max(values["bound_use"] for values in runs),  # type: ignore[type-var]
        "largest_tip_rms": max(values["tip_rms"] for values in runs),  # type: ignore[type-var]
        "largest_end_error": max(values["end_error"] for values in runs),  # type: ignore[type-var]
    }
