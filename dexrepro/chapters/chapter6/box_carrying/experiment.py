"""Two Baxter arms carry a box by friction along the hand paths of experiment 2 (Fig. 6.12)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Image, Rng
from dexrepro.chapters.chapter6 import arms, bimanual
from dexrepro.control.motion import minimum_jerk
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.robots.arm import Arm, Shape
from dexrepro.robots.baxter import baxter, palm
from dexrepro.robots.inverse_kinematics import solve

RATE = 100.0
SIDES = ("left", "right")
FRONT = Camera(target=(0.62, 0.0, 0.12), distance=1.55, yaw=115.0, pitch=-25.0, field_of_view=42.0)
WOOD = (0.80, 0.65, 0.45, 1.0)


def scene(config: Config, place: tuple[float, float, float] = (0.6, 0.0, 0.0)) -> World:
    """Arms, table and the box on it at x, y [m] and yaw [rad]."""
    world = World(step=config.physics_step, perturbation=config.perturbation, iterations=config.iterations)
    for side in SIDES:
        world.add_arm(side, _arm(side), np.array(config.posture[side]), contacts=True)
    world.add_box("table", (0.9, 1.4, 0.04), (0.75, 0.0, -0.02), friction=config.table_friction)
    size = (config.box_depth, config.skeleton.box_length / 100, config.box_depth)
    x, y, yaw = place
    world.add_body(
        "box", [Shape("box", size, colour=WOOD)], (x, y, config.box_depth / 2), (0.0, 0.0, yaw), mass=config.box_mass,
        friction=config.friction, spinningFriction=0.01,
    )  # fmt: skip
    return world


def _arm(side: str) -> Arm:
    return baxter(side, palm())


def simulate(config: Config, rng: Rng) -> Recording:
    movement = bimanual.move(config, rng("measurement"))
    wrists = (movement.original if config.original else movement.joints)[:, 0, :, bimanual.WRIST]
    if not np.isfinite(wrists).all():
        return Recording(status=f"undefined from {movement.undefined_from:.2f} s")
    time, tips, turns, ends = _palm_path(config, movement.time, wrists)
    across = ends[0, 0] - ends[0, 1]
    place = (*ends[0].mean(axis=0)[:2], float(np.arctan2(-across[0], across[1])))
    with scene(config, place) as world:
        controllers = {}
        error = 0.0
        for i, side in enumerate(SIDES):
            model = RigidBodyModel(_arm(side))
            every = round(1 / (config.ik_rate * config.physics_step))
            start = solve(_arm(side), tips[0, i], turns[0, i], start=config.posture[side], task="pose")
            joints, left = arms.joint_path(
                _arm(side), model, time[::every], tips[::every, i], turns[::every, i], "pose", start, config.rest_gain
            )
            world.arm(side).reset(joints(0.0) + config.perturbation)
            controllers[side] = arms.follow(model, joints, config.law, config.physics_step, time[-1])
            error = max(error, left)
        middle = ends.mean(axis=1)

        def stop(now: float) -> str | None:
            body = world.bodies["box"]
            k = min(round(now / config.physics_step), len(middle) - 1)
            gap = np.linalg.norm(np.array((body.x, body.y, body.z)) - middle[k])
            return f"dropped by {now:.2f} s" if gap > config.given_up else None

        forces = {f"palm_{side}": lambda side=side: world.contact_force(side, "box") for side in SIDES}
        run = world.run(time[-1], controllers, probes=forces, stop=stop, record_every=config.record_every)
        run.images = _pictures(world, run, config)
    at = np.minimum((run.time / config.physics_step).round().astype(int), len(middle) - 1)
    run.series |= {"middle": middle[at], "reference_left": tips[at, 0], "reference_right": tips[at, 1]}
    run.frames["ik"] = pd.DataFrame({"error": [error], "projections": [sum(movement.projections.values())]})
    return run


def _palm_path(config: Config, time: Array, wrists: Array) -> tuple[Array, ...]:
    """Time (n,), palm tips (n, 2, 3) [m] and rotations (n, 2, 3, 3) with squeeze, and the box's ends (n, 2, 3) [m].

    A ramp from just clear of the box comes first. The person's frame is turned and shifted in front of the robot.
    """
    person = wrists / 100
    hands = np.stack([person[..., 1], -person[..., 0], person[..., 2]], axis=-1) + np.array(config.origin)
    fine = config.physics_step * np.arange(round(time[-1] / config.physics_step) + 1)
    hands = np.stack([[np.interp(fine, time, hands[:, i, a]) for a in range(3)] for i in (0, 1)]).transpose(2, 0, 1)
    inward = np.stack([hands[:, 1] - hands[:, 0], hands[:, 0] - hands[:, 1]], axis=1)
    inward /= np.linalg.norm(inward, axis=-1, keepdims=True)
    up = np.array([0.0, 0.0, 1.0]) - inward * inward[..., 2:]
    up /= np.linalg.norm(up, axis=-1, keepdims=True)
    turns = np.stack([up, np.cross(inward, up), inward], axis=-1)
    tips = hands + config.squeeze * inward
    steps = round(config.ramp / config.physics_step)
    middle = hands[0].mean(axis=0)
    clear = middle - inward[0] * (config.skeleton.box_length / 200 + 0.004)
    approach = clear + minimum_jerk(np.arange(steps) / steps)[:, None, None] * (tips[0] - clear)
    return (
        config.physics_step * np.arange(steps + len(fine)),
        np.concatenate([approach, tips]),
        np.concatenate([np.repeat(turns[:1], steps, axis=0), turns]),
        np.concatenate([np.repeat(hands[:1], steps, axis=0), hands]),
    )


def _pictures(world: World, run: Recording, config: Config) -> dict[str, Image]:
    images = {}
    for i, share in enumerate(config.pictures):
        k = int(share * (len(run.time) - 1))
        arms_at = {side: run[f"{side}.position"][k] for side in SIDES}
        images[f"{i}_{run.time[k]:.1f}"] = world.render(arms_at, {"box": run["box.pose"][k]}, FRONT, (360, 270))
    return images


def measure(recording: Recording, config: Config) -> Metrics:
    """Distances [cm] and forces [N] while the box is carried; undefined where there is no path to carry it along."""
    if "time" not in recording:
        return {"box_error_max": None, "min_palm_force": None, "carried": 0}
    gap = np.linalg.norm(recording["box.pose"][:, :3] - recording["middle"], axis=1)
    replay = recording.between(config.ramp)
    force = np.minimum(recording["palm_left"], recording["palm_right"])
    lost = np.flatnonzero(gap > config.lost)
    tracking = max(
        np.linalg.norm(recording[f"{side}.tip"] - recording[f"reference_{side}"], axis=1).max() for side in SIDES
    )
    return {
        "box_error_max": float(100 * gap[replay].max()),
        "min_palm_force": float(force[replay].min()),
        "lost_at": float(recording.time[lost[0]] - config.ramp) if lost.size else None,
        "carried": int(not lost.size),
        "tracking_error": float(100 * tracking),
        "ik_error": float(recording.frames["ik"].error[0]),
        "projections": int(recording.frames["ik"].projections[0]),
        "peak_torque_share": float(max(np.abs(recording[f"{s}.torque"] / _arm(s).effort).max() for s in SIDES)),
    }
