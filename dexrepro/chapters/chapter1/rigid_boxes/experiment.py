"""A rigid box of three sizes carried into a bin by two Baxter arms through friction (Task 4, Fig. 1.17).

Everything from approach to release: DFR comes, AFR is led by the potential field, the hand-over latch closes at first
contact, the force law holds, both arms lift, carry and let go. Contacts are PyBullet's, with friction, in three
dimensions. A case repeats the task from several start poses of the box.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter1.assistive import AssistiveFollower
from dexrepro.chapters.chapter1.pair import ALONG, FLIP, LEVEL, TABLE, add_arms, servos
from dexrepro.control.hand_over import ContactLatch
from dexrepro.control.potential_field import PotentialField
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.humans.operator import strides
from dexrepro.measures import binomial_interval, rms
from dexrepro.physics.plant import Sense
from dexrepro.physics.rendering import Camera
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.world import World
from dexrepro.robots.baxter import palm

RATE = 100.0
SIZES = ("small", "medium", "large")
VIEW = Camera(target=(0.5, -0.05, 0.22), distance=1.25, yaw=75.0, pitch=-22.0)
GRIPPED, LIFTED, CARRIED, RELEASED = 4.5, 6.0, 9.0, 9.6  # s
BIN = (0.62, 0.2)  # m, centre


def scene(config: Config, rng: Rng | None = None, offset: Any = (0.0, 0.0, 0.0)) -> World:
    """Two arms with palms, a box on a stand and a bin; ``offset``: x, y [m] and yaw [rad] of the box."""
    world = World(step=config.step, perturbation=config.perturbation)
    place = np.array(config.place)
    away = (0.5 * config.width + config.stand_off) * ALONG
    places = {"leader": place - away, "follower": place + away}
    add_arms(world, places, Sensor(force_noise=config.sensor_noise), rng, palm())
    sides = sorted({0.12, 0.20, 0.30} - {config.width})
    size = (sides[1], config.width, sides[0])
    centre = place + [offset[0], offset[1], 0.0]
    world.add_box(
        "box", size, centre, mass=config.mass, rpy=(0.0, 0.0, offset[2]), friction=config.friction / 0.5,
        colour=(0.80, 0.62, 0.40, 1.0), contactStiffness=config.contact_stiffness,
        contactDamping=config.contact_damping,
    )  # fmt: skip
    x, y, z = place
    world.add_box("stand", (0.16, 0.10, 0.02), (x, y, z - size[2] / 2 - 0.01), friction=1.0, colour=TABLE)
    _add_bin(world, z)
    return world


def _add_bin(world: World, height: float) -> None:
    """An open box whose rim is 0.16 m below ``height`` [m]."""
    (x, y), depth, wide, long, rim = BIN, 0.12, 0.40, 0.42, height - 0.16
    world.add_box("floor", (wide, long, 0.02), (x, y, rim - depth), colour=TABLE)
    for k, (dx, dy) in enumerate(((wide / 2, 0), (-wide / 2, 0), (0, long / 2), (0, -long / 2))):
        size = (0.01, long, depth) if dx else (wide, 0.01, depth)
        world.add_box(f"wall{k}", size, (x + dx, y + dy, rim - depth / 2), colour=(0.7, 0.75, 0.8, 1.0))


def leading(config: Config) -> tuple[Any, Any]:
    """DFR's end point (n, 3) [m] and how far both hands open (n,) [m], one row a control period."""
    dt = config.control_period
    t = dt * np.arange(round(config.duration / dt) + 1)
    profile = np.r_[0.0, strides(500)]

    def step(start: float, end: float) -> Any:
        return np.interp((t - start) / (end - start), np.linspace(0, 1, 501), profile)

    reach = config.stand_off + config.press
    along = -0.5 * config.width - config.stand_off + reach * step(0.3, 2.5)
    carry = (BIN[1] - config.place[1]) * step(LIFTED, CARRIED)
    opening = config.let_go * step(RELEASED, RELEASED + 0.6)
    position = np.array(config.place) + (along + carry - opening)[:, None] * ALONG
    position[:, 2] += config.lift * step(GRIPPED, LIFTED)
    return position, 2 * opening


def field_of(config: Config) -> PotentialField:
    """The field of Section 1.3.4 with distances that suit the box's width, as machine vision would give it."""
    half = 0.5 * config.width
    return PotentialField(
        ready_distance=half + 0.10, repulsion_range=half + 0.07, lower=half + 0.03, upper=half + 0.15, reach=1.8,
        gains=(0.002, 1.0, 1.0), compliance=0.03, max_step=0.003,
    )  # fmt: skip


def simulate(config: Config, rng: Rng) -> Recording:
    draws = rng("start poses")
    offsets = draws.uniform(-1, 1, (config.starts, 3)) * config.scatter
    recordings, rows = [], []
    images: dict[str, Any] = {}
    for k, offset in enumerate(offsets):
        pictures: dict[str, Any] = {}
        recording, row = _carry(config, rng, offset, pictures if k == 0 and config.photograph else None)
        recordings.append(recording)
        rows.append(row)
        images |= pictures
    first = recordings[0]
    series = {"time": first.time}
    for k, recording in enumerate(recordings):
        if len(recording.time) == len(first.time):
            series |= {f"{key}_{k}": recording[key] for key in ("force", "height", "phase")}
    series |= {name: first[name] for name in ("leader.position", "follower.position", "box.pose")}
    return Recording(
        series=series, frames={"runs": pd.DataFrame(rows)}, images=images, steps=sum(r.steps for r in recordings),
        simulated=sum(r.simulated for r in recordings),
    )  # fmt: skip


def _carry(config: Config, rng: Rng, offset: Any, pictures: dict[str, Any] | None) -> tuple[Recording, dict[str, Any]]:
    """The task once; the recording and what became of it."""
    dt = config.control_period
    path, opening = leading(config)
    with scene(config, rng, offset) as world:
        arms = servos(world, config)
        own = AssistiveFollower(
            arms["follower"], field_of(config), ContactLatch(**config.latch), config.law, speed_limit=config.speed_limit
        )
        own.reset(np.array(world.arm("follower").q), world.arm("follower").sense.tip)
        seen = np.array(config.place) + np.array([offset[0], offset[1], 0.0]) + np.array(config.camera_bias)

        def lead(sense: Sense) -> Any:
            return arms["leader"].go(sense, path[round(sense.time / dt)], LEVEL)

        def follow(sense: Sense) -> Any:
            k = round(sense.time / dt)
            own.opening = opening[k]
            return own.go(sense, path[k], ALONG, seen, LEVEL @ FLIP)

        def shoot(name: str) -> None:
            if pictures is not None:
                pictures[name] = world.render(camera=VIEW, size=(360, 280))

        recording = world.run(
            config.duration,
            controllers={"leader": lead, "follower": follow},
            control_period=dt,
            probes={"phase": lambda: float(own.phase)},
            events=[(GRIPPED, lambda: shoot("held")), (7.5, lambda: shoot("carried")),
                    (config.duration - 0.02, lambda: shoot("dropped"))] if pictures is not None else (),
            record_every=round(dt / config.step),
        )  # fmt: skip
    recording.series |= {
        "force": np.maximum(recording["follower.force"][:, 1], 0.0),
        "height": recording["box.pose"][:, 2],
        "phase": recording["phase"],
        "box": recording["box.pose"][:, :3],
        "middle": 0.5 * (recording["leader.tip"] + recording["follower.tip"]),
    }
    return recording, judge(recording, config)


def judge(recording: Recording, config: Config) -> dict[str, Any]:
    """Outcome of one run: whether the box got into the bin, how far it slipped, how steady the force was."""
    time, box = recording.time, recording["box"]
    held = recording.between(GRIPPED, min(RELEASED, time[-1]) - 0.1)
    relative = (box - recording["middle"])[held]
    slip = float(np.linalg.norm(relative - relative[0], axis=1).max()) if len(relative) else np.nan
    force = recording["force"][recording.between(GRIPPED - 0.5, min(RELEASED, time[-1]) - 0.1)]
    touching = force > 0.0
    end = box[-1]
    inside = abs(end[0] - BIN[0]) < 0.2 and abs(end[1] - BIN[1]) < 0.21 and end[2] < config.place[2] - 0.1
    moved = float(np.linalg.norm(end[:2] - box[0, :2]))
    return {
        "success": int(inside and moved > 0.3 and slip < 0.01),
        "inside": int(inside),
        "moved": moved,
        "slip": slip,
        "rmse": rms(force - config.desired_force),
        "bounces": int(np.sum(touching[:-1] & ~touching[1:])),
        "switches": int(np.sum(np.abs(np.diff(recording["phase"][time < RELEASED])))),
        "contact": float(time[np.argmax(recording["phase"] > 0)]),
    }


def measure(recording: Recording, config: Config) -> Metrics:
    runs = recording.frames["runs"]
    return {
        "successes": int(runs["success"].sum()),
        "runs": len(runs),
        "slip": float(runs["slip"].max()),
        "rmse": float(runs["rmse"].mean()),
        "bounces": int(runs["bounces"].sum()),
        "switches": int(runs["switches"].max()),
        "least_moved": float(runs["moved"].min()),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    sizes = [metrics[size] for size in SIZES if size in metrics]
    if not sizes:
        return {}
    wins, runs = sum(int(m["successes"] or 0) for m in sizes), sum(int(m["runs"] or 0) for m in sizes)
    low, high = binomial_interval(wins, runs)
    return {"success_share": wins / runs, "success_low": low, "success_high": high}
