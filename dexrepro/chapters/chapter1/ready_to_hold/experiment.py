"""AFR follows a moving object, avoids it and assists when DFR comes, Sections 1.3.3, 1.3.4 (Task 3, Fig. 1.16).

Two simulated Baxter arms under torque. A person moves the object left and right, back and forth, up and down; then DFR
approaches, holds and rotates it. AFR sees the object through a camera (sampled, noisy, off-centre) and knows the
commands to DFR; its position comes from the potential field, its orientation from Eq. (1.14). Only the field is tested
here: there is no contact force that would end it.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter1.pair import ALONG, BALL, LEVEL, SIDES, add_arms, joint_channels, servos
from dexrepro.control.facing import facing
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.operator import strides
from dexrepro.measures import angle_between, rms
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.robots.kinematics import forward
from dexrepro.robots.rotations import quaternion_from_rotation, rotation_from_quaternion

RATE = 25.0
SHAKEN, APPROACH, HOLD, PITCHED = 18.0, 24.0, 30.0, 38.0  # s, ends of the phases
VIEW = Camera(target=(0.5, -0.06, 0.3), distance=1.45, yaw=75.0, pitch=-18.0)
INSTANTS = {"a": 1.5, "b": 7.5, "c": 13.5, "d": 21.0, "e": 25.0, "f": 32.0, "g": 40.0}


class Object:
    """A ball that is where ``path`` (n, 3) [m], one a control period, says; it feels nothing."""

    name = "mover"

    def __init__(self, body: Any, path: Any, period: float) -> None:
        self.body, self.path, self.period = body, path, period

    def bind(self, world: Any) -> Any:
        def apply(time: float) -> None:
            self.body.place(self.path[min(int(time / self.period + 1e-6), len(self.path) - 1)])

        return apply

    def channels(self) -> dict[str, float]:
        return {}


def scene(config: Config) -> World:
    """Two arms and the ball, AFR at the ready position."""
    world = World(step=config.step, perturbation=config.perturbation)
    away = {"leader": -config.leader_distance, "follower": config.start_offset}
    add_arms(world, {name: np.array(config.place) + offset * ALONG for name, offset in away.items()})
    world.add_sphere("object", config.radius, config.place, colour=BALL)
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    clearance = np.linalg.norm(recording["follower"] - recording["object"], axis=1) - config.radius
    return Recording({"time": recording.time, "object.pose": recording["object"], "clearance": clearance}
                     | joint_channels(recording["joints"]))  # fmt: skip


def script(config: Config) -> dict[str, Any]:
    """Object centre and DFR pose, one row a control period: centre, position (n, 3) [m], rotation (n, 3, 3)."""
    dt = config.control_period
    t = dt * np.arange(round(config.duration / dt) + 1)
    shake = np.zeros((len(t), 3))
    for k, axis in enumerate((1, 0, 2)):
        inside = (t >= 6.0 * k) & (t < 6.0 * (k + 1))
        shake[inside, axis] = config.shake[k] * np.sin(2 * np.pi * t[inside] / 6.0)
    done = np.clip((t - SHAKEN) / (APPROACH - SHAKEN), 0, 1)
    share = np.interp(done, np.linspace(0, 1, 501), np.r_[0.0, strides(500)])
    distance = config.leader_distance + (config.radius - config.leader_distance) * share
    rest = np.array(config.place)
    position = rest - distance[:, None] * ALONG
    yaw = np.deg2rad(config.yaw) * np.sin(2 * np.pi * np.maximum(t - HOLD, 0) / 8.0)
    pitch = np.deg2rad(config.pitch) * np.sin(2 * np.pi * np.maximum(t - PITCHED, 0) / 8.0)
    turns = Rotation.from_euler("zx", np.stack([yaw, pitch], axis=1)).as_matrix()
    rotation = turns @ LEVEL
    # Once held, the object goes along with DFR's tool.
    held = (t >= APPROACH)[:, None]
    centre = np.where(held, position + config.radius * rotation[:, :, 2], rest + shake)
    return {"time": t, "centre": centre, "position": position, "rotation": rotation}


def camera(config: Config, centre: Any, rng: np.random.Generator) -> Any:
    """What the camera says about the object's centre: mean of four noisy edge points, sampled and held, off-centre."""
    every = round(1.0 / (config.camera.rate * config.control_period))
    frames = centre[::every]
    edges = config.camera.noise * rng.standard_normal((4, len(frames), 3))
    seen = frames + edges.mean(axis=0) + np.array(config.camera.bias)
    return np.repeat(seen, every, axis=0)[: len(centre)]


def simulate(config: Config, rng: Rng) -> Recording:
    dt, field, plan = config.control_period, config.field, script(config)
    seen = camera(config, plan["centre"], rng("camera"))
    facings = rotation_from_quaternion(facing(quaternion_from_rotation(plan["rotation"])))
    axes = plan["rotation"][:, :, 2]
    images: dict[str, Any] = {}
    with scene(config) as world:
        followers = servos(world, config)
        world.add(Object(world.bodies["object"], plan["centre"], dt))
        field.reset(world.arm("follower").sense.tip)

        def lead(sense: Any) -> Any:
            k = round(sense.time / dt)
            return followers["leader"].go(sense, plan["position"][k], plan["rotation"][k])

        def follow(sense: Any) -> Any:
            k = round(sense.time / dt)
            target = field(plan["position"][k], axes[k], seen[k])
            return followers["follower"].go(sense, target, facings[k if config.facing else 0])

        def shoot(name: str) -> None:
            images[name] = world.render(camera=VIEW, size=(280, 230))

        recording = world.run(
            config.duration,
            controllers={"leader": lead, "follower": follow},
            control_period=dt,
            probes={
                "weights": lambda: field.active,
                "ready": lambda: field.points[1],
                "target": lambda: field.position,
            },
            events=[(at, partial(shoot, name)) for name, at in INSTANTS.items()] if config.photograph else (),
            record_every=round(dt / config.step),
        )
        recording.series = _condense(recording, plan, seen, world)
    if config.photograph:
        recording.frames["field"] = _field(config)
    recording.images = images
    return recording


def _condense(recording: Recording, plan: dict[str, Any], seen: Any, world: World) -> dict[str, Any]:
    poses = {name: forward(world.arm(name).arm, recording[f"{name}.position"]) for name in SIDES}
    n = len(recording.time)
    own, partner = poses["follower"], poses["leader"]
    return {
        "time": recording.time,
        "follower": own[0],
        "leader": partner[0],
        "object": plan["centre"][:n],
        "seen": seen[:n],
        "weights": recording["weights"],
        "ready": recording["ready"],
        "facing": angle_between(own[1][:, :, 2], -partner[1][:, :, 2]),
        "pointing": angle_between(own[1][:, :, 2], partner[0] - own[0]),
        "joints": np.hstack([recording[f"{name}.position"] for name in SIDES]),
    }


def _field(config: Config) -> pd.DataFrame:
    """Potential [J] on a grid of the holding plane for three distances of DFR [m]."""
    y, z = np.meshgrid(np.linspace(-0.2, 0.6, 81), np.linspace(-0.3, 0.3, 61))
    points = np.stack([np.zeros_like(y), y, z], axis=-1)
    axis = np.array([0.0, 1.0, 0.0])
    frames = []
    for distance in (0.38, 0.24, config.radius):
        # The measured object is off the holding line, as in the book's sketch.
        config.field.place(np.array([0.0, -distance, 0.0]), axis, np.array([0.0, 0.0, config.camera.bias[2]]))
        force = config.field.force(points)
        frame = pd.DataFrame({"y": y.ravel(), "z": z.ravel(), "potential": config.field.potential(points).ravel()})
        frame[["fy", "fz"]] = force[..., 1:].reshape(-1, 2)
        frame["distance"] = distance
        for k, point in enumerate(config.field.points):
            frame[f"p{k + 1}y"], frame[f"p{k + 1}z"] = point[1], point[2]
        frames.append(frame)
    return pd.concat(frames)


def measure(recording: Recording, config: Config) -> Metrics:
    time, radius = recording.time, config.radius
    clearance = np.linalg.norm(recording["follower"] - recording["object"], axis=1) - radius
    partner = np.linalg.norm(recording["leader"] - recording["object"], axis=1) - radius
    shaken, held = recording.between(0.5, SHAKEN), recording.between(APPROACH)
    lag = np.linalg.norm(recording["follower"] - recording["ready"], axis=1)
    result: Metrics = {
        "lag_rms": rms(lag[shaken]),
        "lag_most": float(lag[shaken].max()),
        "clearance": float(clearance[recording.between(0.0, APPROACH - 2.0)].min()),
        "own_contact": _first(time, clearance <= 0),
        "partner_contact": _first(time, partner <= 1e-3),
    }
    own, other = result["own_contact"], result["partner_contact"]
    result["own_before_partner"] = None if own is None or other is None else other - own
    if held.any():
        result |= {
            "facing": float(np.rad2deg(recording["facing"][held].max())),
            "pointing": float(np.rad2deg(recording["pointing"][held].max())),
        }
    if recording.between(HOLD).any():
        result["gap_spread"] = float(clearance[recording.between(HOLD)].std())
    return result


def _first(time: Any, happened: Any) -> float | None:
    return float(time[np.argmax(happened)]) if happened.any() else None
