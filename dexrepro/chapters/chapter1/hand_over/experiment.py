"""From the potential field to force control at first contact, with and without a latch (Section 1.4).

The book says that contact force invalidates the field and initialises the force law. A light touch, a noisy sensor and
a bare comparison make that switch chatter; a latch that asks for three samples and opens below a smaller force
does not.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter1.assistive import AssistiveFollower
from dexrepro.chapters.chapter1.pair import ALONG, BALL, FLIP, LEVEL, TABLE, add_arms, servos
from dexrepro.control.hand_over import ContactLatch
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.operator import strides
from dexrepro.measures import rms
from dexrepro.physics.plant import Sense
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.soft_object import Cushion, SoftObject
from dexrepro.physics.world import World

RATE = 100.0
ARRIVED = 2.5  # s, DFR has reached the object


def scene(config: Config, rng: Rng | None = None) -> World:
    """A soft ball on a stand between the two arms."""
    world = World(step=config.step, perturbation=config.perturbation)
    place = np.array(config.place)
    away = {"leader": -config.leader_distance, "follower": config.radius + 0.10}
    places = {name: place + offset * ALONG for name, offset in away.items()}
    add_arms(world, places, Sensor(force_noise=config.sensor_noise), rng)
    world.add_sphere("object", config.radius, config.place, mass=config.mass, colour=BALL, angularDamping=0.2)
    world.add_box("stand", (0.2, 0.2, 0.02), place - [0.0, 0.0, config.radius + 0.01], friction=1.0, colour=TABLE)
    return world


def simulate(config: Config, rng: Rng) -> Recording:
    dt, cushion = config.control_period, config.cushion
    t = dt * np.arange(round(config.duration / dt) + 1)
    share = np.interp((t - 0.3) / (ARRIVED - 0.3), np.linspace(0, 1, 501), np.r_[0.0, strides(500)])
    reach = config.leader_distance - config.radius + config.touch
    path = np.array(config.place) + (reach * share - config.leader_distance)[:, None] * ALONG
    with scene(config, rng) as world:
        arms = servos(world, config)
        own = AssistiveFollower(
            arms["follower"], config.field, ContactLatch(**config.latch), config.law, speed_limit=config.speed_limit
        )
        own.reset(np.array(world.arm("follower").q), world.arm("follower").sense.tip)
        left, right = (Cushion(dt=config.step, **cushion) for _ in range(2))
        world.add(
            SoftObject("grip", "object", ("leader", "follower"), (left, right), length=2 * config.radius,
                       friction=config.friction, shear=config.shear, shear_damping=config.shear_damping,
                       scale=lambda _: 1.0)
        )  # fmt: skip
        body = world.bodies["object"]

        def follow(sense: Sense) -> Any:
            seen = np.array((body.x, body.y, body.z)) + config.camera_bias
            return own.go(sense, path[round(sense.time / dt)], ALONG, seen, LEVEL @ FLIP)

        recording = world.run(
            config.duration,
            controllers={
                "leader": lambda sense: arms["leader"].go(sense, path[round(sense.time / dt)], LEVEL),
                "follower": follow,
            },
            control_period=dt,
            probes={"phase": lambda: float(own.phase), "sensed": lambda: own.force},
            record_every=round(dt / config.step),
        )
    recording.series = {
        "time": recording.time,
        "force": recording["grip.force_follower"],
        "sensed": recording["sensed"],
        "phase": recording["phase"],
    }
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    phase, time = recording["phase"], recording.time
    late = recording.between(config.duration - 2.0)
    error = recording["force"][late] - config.desired_force
    return {
        "switches": int(np.sum(np.abs(np.diff(phase)))),
        "contact": float(time[np.argmax(phase > 0)]) if phase.any() else None,
        "holding_at_end": int(phase[-1]),
        "rmse": rms(error),
        "bias": float(error.mean()),
    }
