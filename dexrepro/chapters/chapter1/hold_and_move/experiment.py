"""A soft object held and moved by two Baxter arms along three operator trajectories, Section 1.5.2.2.

The direct-teleoperated follower (DFR, right arm) obeys a synthetic operator; the assistive one (AFR, left arm) keeps
its distance by one of the compared laws at 100 Hz. The object is a 0.3 kg body between viscoelastic contacts with
friction, its stiffness and its filling shift. AFR knows the commands to its partner and its own noisy force sensor.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
from scipy import signal

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter1.hold_path import HoldPath, hold_path
from dexrepro.chapters.chapter1.pair import ALONG, BALL, FLIP, SIDES, TABLE, add_arms, joint_channels, servos
from dexrepro.chapters.chapter1.statements import TRIALS
from dexrepro.control.facing import facing
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import angle_between, last_outside, rms
from dexrepro.physics.drive import HoldingDrive
from dexrepro.physics.elements import TipForce
from dexrepro.physics.plant import Sense
from dexrepro.physics.rendering import Camera
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.soft_object import Cushion, SoftObject
from dexrepro.physics.world import World
from dexrepro.robots.kinematics import forward
from dexrepro.robots.rotations import quaternion_from_rotation, rotation_from_quaternion

RATE = 50.0
HELD = ("rmse_measured", "overshoot", "twist", "turned", "pointing", "lag", "slip")  # undefined once it has fallen
VIEW = Camera(target=(0.5, 0.0, 0.3), distance=1.45, yaw=75.0, pitch=-18.0)


def middle(config: Config) -> Any:
    """Centre of the object at the start [m]."""
    return np.array(config.place)


def scene(config: Config, rng: Rng | None = None) -> World:
    """Two arms that just touch an object on a table."""
    world = World(step=config.step, perturbation=config.perturbation)
    half = 0.5 * config.object.length * ALONG
    sensor = Sensor(force_noise=config.sensor.noise, force_delay=config.sensor.delay * config.control_period)
    add_arms(world, {"leader": middle(config) - half, "follower": middle(config) + half}, sensor, rng)
    radius = config.object.radius
    world.add_sphere("object", radius, middle(config), mass=config.object.mass, colour=BALL, angularDamping=0.2)
    x, y, z = middle(config)
    world.add_box("table", (0.5, 1.2, 0.04), (x + 0.05, y, z - radius - 0.02), colour=TABLE)
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    channels = {"time": recording.time, "object.pose": recording["object"], "force": recording["force"]}
    return Recording(channels | joint_channels(recording["joints"]))


def simulate(config: Config, rng: Rng) -> Recording:
    dt = config.control_period
    law = HoldingDrive(config.law, config.speed_limit * dt)
    images: dict[str, Any] = {}
    with scene(config, rng) as world:
        followers = servos(world, config)
        start = world.arm("leader").sense.tip
        path = hold_path(config, start, rng(f"trajectory {config.trajectory}"))
        rotations = path.rotation
        facings = rotation_from_quaternion(facing(quaternion_from_rotation(rotations)))
        contact = config.object.length
        _fill(world, config, rng)
        law.reset(0.0, 0.0)
        last = {"measured": 0.0}

        def lead(sense: Sense) -> Any:
            k = round(sense.time / dt)
            return followers["leader"].go(sense, path.position[k], rotations[k])

        def follow(sense: Sense) -> Any:
            k = round(sense.time / dt)
            axis = path.axis[k]
            distance = float((sense.tip - path.position[k]) @ axis)
            force = max(0.0, float(sense.force @ axis))
            last["measured"] = force
            reference = float(law(sense.time, distance - contact, force))
            target = path.position[k] + axis * (contact + reference)  # Eq. (1.33) from the first contact on
            return followers["follower"].go(sense, target, facings[k if config.facing else 0])

        recording = world.run(
            config.duration,
            controllers={"leader": lead, "follower": follow},
            control_period=dt,
            probes={"reference": lambda: law.reference, "measured": lambda: last["measured"]},
            stop=lambda _: "object dropped" if world.bodies["object"].z < middle(config)[2] - 0.3 else None,
            events=_photographs(world, path, images) if config.photograph else (),
            record_every=round(dt / config.step),
            on_divergence="stop",
        )
        _condense(recording, path, world, config)
    recording.images = images
    return recording


def _photographs(world: World, path: HoldPath, images: dict[str, Any]) -> list[tuple[float, Any]]:
    """Events that photograph the instants of Fig. 1.19."""
    at = path.phases
    instants = {
        "a": 0.0, "b": at["tilt"] - 0.5, "c": at["swing"] - 0.2, "d": 0.5 * (at["swing"] + at["level"]),
        "e": at["press"] - 0.2, "f": at["press"] + 2.5,
    }  # fmt: skip

    def shoot(name: str) -> None:
        images[name] = world.render(camera=VIEW, size=(480, 340))

    return [(round(when, 2), partial(shoot, name)) for name, when in instants.items()]


def _fill(world: World, config: Config, rng: Rng) -> None:
    """The object's contacts, its varying stiffness and the shifting of what it is filled with."""
    o, noise = config.object, rng("filling")
    parts = {key: o[key] for key in ("fast", "slow", "fast_time", "slow_time")}
    left, right = (Cushion(o.stiffness, config.step, **parts) for _ in range(2))
    phase = rng("stiffness phase").uniform(0, 2 * np.pi)
    swing, period = o.modulation, o.modulation_period

    def scale(time: float) -> float:
        return 1.0 + swing * math.sin(2 * math.pi * time / period + phase)

    world.add(
        SoftObject("grip", "object", ("leader", "follower"), (left, right), length=o.length, friction=o.friction,
                   shear=o.shear, shear_damping=o.shear_damping, scale=scale)
    )  # fmt: skip
    b, a = signal.butter(1, 0.5, fs=100.0)
    beans = signal.lfilter(b, a, noise.standard_normal((round(config.duration * 100) + 1, 3)), axis=0)
    beans *= o.shifting / beans.std()
    world.add(TipForce("filling", "object", lambda t, *_: beans[int(t * 100.0 + 1e-6)]))


def _condense(recording: Recording, path: HoldPath, world: World, config: Config) -> None:
    """Keep what is measured and drawn."""
    poses = {name: forward(world.arm(name).arm, recording[f"{name}.position"]) for name in SIDES}
    relative = np.swapaxes(poses["leader"][1], -1, -2) @ poses["follower"][1] @ FLIP
    n = len(recording.time)
    between = poses["follower"][0] - poses["leader"][0]
    recording.series = {
        "time": recording.time,
        "force": recording["grip.force_follower"],
        "measured": recording["measured"],
        "reference": recording["reference"],
        "distance": np.linalg.norm(between, axis=1),
        "partner": poses["leader"][0] - path.position[0],
        "tilt": path.tilt[:n],
        "lag": np.linalg.norm(poses["leader"][0] - path.position[:n], axis=1),
        # Turn of one tool against the other about the holding line.
        "twist": np.arctan2(relative[:, 1, 0], relative[:, 0, 0]),
        # Turn of one tool against the other about whatever axis.
        "turned": np.arccos(np.clip((np.trace(relative, axis1=1, axis2=2) - 1) / 2, -1, 1)),
        "pointing": angle_between(between, path.axis[:n]),
        "slip": recording["grip.slip"],
        "object": recording["object.pose"],
        "joints": np.hstack([recording[f"{name}.position"] for name in SIDES]),
    }


def measure(recording: Recording, config: Config) -> Metrics:
    time, force, desired = recording.time, recording["force"], config.desired_force
    late = recording.between(config.settled)
    if recording.status != "finished":
        # A dropped object has the worst score in every comparison, whenever it fell.
        return {"rmse": desired, "rise": config.duration, "settling": config.duration, "finished": 0} | dict.fromkeys(
            HELD
        )
    error = force - desired
    rise = np.flatnonzero(force >= 0.95 * desired)
    early = time < config.settled
    return {
        "rmse": rms(error[late]),
        "rmse_measured": rms((recording["measured"] - desired)[late]),
        "rise": float(time[rise[0]]) if len(rise) else config.duration,
        "overshoot": float(max(0.0, force[early].max() / desired - 1.0)),
        "settling": last_outside(time[early], error[early], 0.1 * desired),
        "twist": float(np.rad2deg(np.abs(recording["twist"] - recording["twist"][0]).max())),
        "turned": float(np.rad2deg(recording["turned"].max())),
        "pointing": float(np.rad2deg(recording["pointing"].max())),
        "lag": float(recording["lag"].max()),
        "slip": float(recording["slip"][-1]),
        "finished": 1,
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    ratios: Metrics = {}
    for other in ("passive", "fixed"):
        for trial in TRIALS:
            own, rival = (metrics.get(f"{trial}_{law}", {}).get("rmse") for law in ("proposed", other))
            if own and rival:
                ratios[f"{other}_ratio_{trial}"] = rival / own
    return ratios
