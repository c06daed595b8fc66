"""One Baxter arm among boxes: the learned path and the constrained one (Figs. 6.3-6.5)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter6 import arms, learning
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans import waypoints
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.primitives.constrained import Reference
from dexrepro.primitives.dmp import DMP, Trajectory
from dexrepro.primitives.obstacles import Polygon, clearance
from dexrepro.primitives.reference_path import arc, detour, differentiable
from dexrepro.robots.arm import Arm
from dexrepro.robots.baxter import baxter
from dexrepro.robots.inverse_kinematics import solve

RATE = 100.0
BOXES = ("first", "second", "new")
COLOURS = {"first": (0.95, 0.62, 0.20, 1.0), "second": (0.95, 0.62, 0.20, 1.0), "new": (0.20, 0.50, 0.80, 1.0)}
TOP = Camera(target=(0.43, -0.25, 0.0), distance=1.27, yaw=0.0, pitch=-89.99, field_of_view=45.0)
SIDE = Camera(target=(0.42, -0.3, 0.16), distance=1.4, yaw=40.0, pitch=-35.0, field_of_view=45.0)
DOWN = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])


def scene(config: Config) -> World:
    world = World(step=config.step, perturbation=config.perturbation)
    world.add_arm("arm", _arm(), np.array(config.posture), contacts=config.contacts)
    for name in BOXES:
        x, y = config.boxes[name]
        world.add_box(
            name, config.box_size, (x, y, config.height - 0.05 + config.box_size[2] / 2), colour=COLOURS[name]
        )
    return world


def _arm() -> Arm:
    return baxter("right")


def simulate(config: Config, rng: Rng) -> Recording:
    primitive = _learned(config, rng("demonstrations"))
    movement = primitive.rollout(config.step, horizon=config.duration)
    path, reference, projections = _path(config, primitive, movement)
    with scene(config) as world:
        run = _drive(config, world, movement.time, path / 100)
        images = {}
        for i, share in enumerate(config.pictures):
            index = min(int(share * len(run.time)), len(run.time) - 1)
            images[f"{i}_{run.time[index]:.1f}"] = world.render(
                {"arm": run["arm.position"][index]}, camera=SIDE, size=(540, 450)
            )
        if config.pictures:
            images["top"] = world.render({"arm": run["arm.position"][-1]}, camera=TOP, size=(700, 600))
    run.images = images
    at = np.minimum((run.time / config.step).round().astype(int), len(path) - 1)
    run.series |= {"desired": path[at] / 100, "reference": reference.position[at] / 100}
    run.series["projected"] = np.full(len(run.time), projections)
    return run


def _learned(config: Config, rng: np.random.Generator) -> DMP:
    """Primitive [cm] learned from the demonstrations."""
    d = config.demonstrations
    paces = config.duration * (1 + 0.08 * rng.normal(size=d.count))
    drawings = [waypoints.draw([np.array(d.waypoints, float)], [pace], rng, d.spread, d.tremor) for pace in paces]
    time, mean = waypoints.average([(w.time, w.position) for w in drawings])
    return learning.learn(time * config.duration / time[-1], mean, config.dmp)


def _path(config: Config, primitive: DMP, movement: Trajectory) -> tuple[Array, Reference, int]:
    """Path (n, 2) [cm] of the law, its reference round the new box, and the number of projected steps."""
    reference = _reference(config, movement)
    skill, batch = learning.skill([primitive], [movement]), learning.stack([reference])
    start = primitive.time_constant * np.broadcast_to(primitive.velocity, (1, 2))
    path = learning.constrained(skill, batch, config.cdmp, config.step, start)
    return path.position[:, 0], reference, int(path.projected.sum())


def _reference(config: Config, movement: Trajectory) -> Reference:
    """Detour on a circle about the new box, on the far or the near side of the torso."""
    centre, path = 100 * np.array(config.boxes["new"]), movement.position
    half_diagonal = 100 * np.hypot(*config.box_size[:2]) / 2
    radius = half_diagonal + 100 * config.clearance_radius + config.cdmp.margin + config.spare
    near = np.flatnonzero(np.linalg.norm(path - centre, axis=1) < radius + config.gap)
    leave, resume = int(near[0]), int(near[-1])
    start, end = (np.arctan2(*(path[i] - centre)[::-1]) for i in (leave, resume))
    trim = np.radians(config.trim)
    if config.detour_side == "near":
        around = arc(centre, radius, start - trim, end - 2 * np.pi + trim)
    else:
        around = arc(centre, radius, start + trim, end - trim)
    at, points = detour(movement.time, path, around, leave, resume)
    return differentiable(at, points, movement.time)


def _drive(config: Config, world: World, time: Array, path: Array) -> Recording:
    """Let the arm follow a path (n, 2) [m] at the tool's height, pointing down."""
    arm, model = _arm(), RigidBodyModel(_arm())
    every = round(1 / (config.ik_rate * config.step))
    points = np.column_stack([path, np.full(len(path), config.height)])[::every]
    start = solve(arm, points[0], DOWN, start=config.posture, task="axis", rest=config.posture, rest_gain=0.05)
    joints, error = arms.joint_path(arm, model, time[::every], points, DOWN, "axis", start, config.rest_gain)
    world.arm("arm").reset(joints(0.0) + config.perturbation)
    probes = {f"distance_{name}": lambda name=name: world.distance("arm", name, 0.6) for name in BOXES}
    if config.contacts:
        probes |= {f"contact_{name}": lambda name=name: world.contact_force("arm", name) for name in BOXES}
    controller = arms.follow(model, joints, config.law, config.step, config.duration)
    run = world.run(config.duration, {"arm": controller}, probes=probes, record_every=config.record_every)
    run.frames["ik"] = pd.DataFrame({"error": [error]})
    return run


def measure(recording: Recording, config: Config) -> Metrics:
    offset = np.linalg.norm(recording["arm.tip"][:, :2] - recording["desired"], axis=1)
    metrics: Metrics = {f"distance_{name}": float(recording[f"distance_{name}"].min()) for name in BOXES}
    hits = np.flatnonzero(recording["distance_new"] < 0)
    metrics |= {
        "first_hit": float(recording.time[hits[0]]) if hits.size else None,
        "path_to_new": _to_new(recording["desired"], config),
        "e_max": float(100 * np.linalg.norm(recording["desired"] - recording["reference"], axis=1).max()),
        "projections": int(recording["projected"][0]),
        "tracking_error": float(offset.max()),
        "goal_error": float(np.linalg.norm(recording["arm.tip"][-1, :2] - recording["reference"][-1])),
        "ik_error": float(recording.frames["ik"].error[0]),
    }
    if config.contacts:
        metrics["contact_peak"] = float(max(recording[f"contact_{name}"].max() for name in BOXES))
    return metrics


def _to_new(path: Array, config: Config) -> float:
    """Smallest distance of the tip's path to the new box in the plane [m]."""
    x, y = config.boxes["new"]
    half = np.array(config.box_size[:2]) / 2
    box = Polygon.rectangle((x - half[0], x + half[0]), (y - half[1], y + half[1]))
    return clearance(path, [box])
