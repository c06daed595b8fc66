"""An arm, an object and a leader's path of your own, under any force or tracking law."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.own.blocks import NAME, NUMBER, PLACE, VECTOR, checked, vector
from dexrepro.chapters.own.drivers import driver
from dexrepro.chapters.own.paths import leader_path
from dexrepro.checks import is_number
from dexrepro.control.motion import Path
from dexrepro.errors import InputError, refused
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms
from dexrepro.physics.elements import Elastic, Ends, Push, TipForce
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import RigidBody
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.world import World
from dexrepro.robots.arm import Arm, Link, Pose
from dexrepro.robots.inverse_kinematics import Unreachable, solve
from dexrepro.robots.kinematics import forward

CHECKED = 25  # points of the path whose reach is checked
FAR = 5.0  # m; where an arm is sent by a file whose lengths are in another unit


def model(arm: Arm, gravity: Sequence[float], mass_error: float, key: str = "arm") -> RigidBodyModel:
    """What laws may know of the arm."""
    if not isinstance(arm, Arm):
        raise ValueError(f"scene.{key} is no arm: name one by its _target_, such as dexrepro.robots.urdf.from_urdf")
    if not is_number(mass_error):
        raise ValueError(str(refused("scene.model.mass_error", repr(mass_error), "be a number")))
    if not vector(gravity):
        raise ValueError(f"scene.gravity = {gravity} is not allowed: it must be three numbers")
    return RigidBodyModel(arm, gravity, mass_error)


def scene(config: Config, noise: np.random.Generator | None = None) -> World:
    """The arm, the leader, the objects and what else acts on the arm.

    The leader is an arm of its own, or else a small sphere that is carried along its path.
    noise: random numbers of the sensors, which are exact without.
    """
    given = {name: _blocks(config, name) for name in BLOCKS}
    checked(config.servo, "scene.servo", SERVO, SERVO)
    if not is_number(config.regulation):
        raise refused("scene.regulation", repr(config.regulation), "be a number")
    if not (config.desired_force is None or is_number(config.desired_force)):
        raise refused("scene.desired_force", repr(config.desired_force), "be a number, or null")
    if not isinstance(config.gravity_compensation, bool):
        raise refused("scene.gravity_compensation", config.gravity_compensation, "be true or false")
    world = World(step=config.step, gravity=config.gravity, perturbation=config.perturbation)
    path = leader_path(config)
    arm = loaded(config.arm, *given["payload"])
    sensor = Sensor(**given["sensor"][0]) if given["sensor"] and noise else Sensor()
    world.add_arm("arm", arm, start(config, path), contacts=bool(config.box), sensor=sensor, rng=noise)
    if config.leader_arm:
        world.add_arm("leader", config.leader_arm, start(leading(config), path))
    else:
        world.add_sphere("leader", 0.02, path(0.0).position.tolist(), colour=(0.84, 0.37, 0.0, 1.0), collides=False)
        world.add(_Carried(path))
    for number, object_ in enumerate(given["elastic"]):
        to = object_.pop("to", "leader")
        world.add(Elastic(f"object{number or ''}", ("arm", to), unilateral=True, **object_))
    for number, wall_ in enumerate(given["wall"]):
        world.add(TipForce(f"wall{number or ''}", "arm", wall(**wall_)))
    for number, push in enumerate(given["pushes"]):
        link, point = push.get("link"), tuple(push.get("point", (0.0, 0.0, 0.0)))
        names = [body.name for body in arm.links]
        if link is not None and link not in names:
            raise InputError(f"scene.pushes.{number}.link = {link} is not allowed: there are {', '.join(names)}")
        if not 0 <= push["start"] < config.duration:
            where, end = f"scene.pushes.{number}.start", f"{config.duration:g} s"
            if push["start"] < 0:
                raise refused(where, push["start"], f"be 0 or greater, and before the end at {end}")
            warnings.warn(
                f"{where} = {push['start']} comes after the end at {end}: there is no such push", stacklevel=2
            )
        force = pulse(push["force"], push["start"], push["duration"])
        world.add(Push("arm", force, link, point, f"push{number or ''}"))
    for box in given["box"]:
        if min(box["size"]) <= 0:
            raise refused("scene.box.size", box["size"], "be greater than 0")
        world.add_box("box", box.pop("size"), box.pop("position"), **box)
    return world


BLOCKS: dict[str, dict[str, str]] = {
    "elastic": {"stiffness": NUMBER, "rest_length": NUMBER, "damping": NUMBER, "to": PLACE},
    "wall": {"point": VECTOR, "normal": VECTOR, "stiffness": NUMBER, "damping": NUMBER},
    "pushes": {"force": VECTOR, "start": NUMBER, "duration": NUMBER, "link": NAME, "point": VECTOR},
    "payload": {"mass": NUMBER, "com": VECTOR},
    "box": {"size": VECTOR, "position": VECTOR, "mass": NUMBER, "friction": NUMBER},
    "sensor": {field.name: NUMBER for field in fields(Sensor)},
}
"""Keys of the blocks that may be given, one or a list of them, and what each holds."""
NEEDED = {"elastic": ("stiffness", "rest_length"), "wall": ("point", "normal", "stiffness"), "payload": ("mass",),
          "box": ("size", "position"),
          "pushes": ("force", "start", "duration"), "sensor": ()}  # fmt: skip
SERVO = {"frequency": NUMBER, "ik_gain": NUMBER, "rest_gain": NUMBER}


def _blocks(config: Config, name: str) -> list[dict[str, Any]]:
    """What the scene gives under a name. Raises InputError with key, value and what is allowed."""
    given = config.get(name) or []
    if not isinstance(given, list):
        return [checked(given, f"scene.{name}", BLOCKS[name], NEEDED[name])]
    if len(given) > 1 and name in ("payload", "sensor", "box"):
        raise InputError(f"scene.{name} is given {len(given)} times; it must be one")
    return [checked(block, f"scene.{name}.{k}", BLOCKS[name], NEEDED[name]) for k, block in enumerate(given)]


def loaded(arm: Arm, payload: Mapping[str, Any] | None = None) -> Arm:
    """The arm with a payload at its end point, a ball of 3 cm, which no model knows; com: its centre there [m]."""
    if payload is None:
        return arm
    mass, moment = payload["mass"], 0.4 * payload["mass"] * 0.03**2
    ball = Link("payload", mass, tuple(payload.get("com", (0.0, 0.0, 0.0))), (moment, 0.0, 0.0, moment, 0.0, moment))
    return replace(arm, fixed=(*arm.fixed, (arm.end, ball)), end=Pose())


def wall(
    point: Sequence[float], normal: Sequence[float], stiffness: float, damping: float = 0.0
) -> Callable[[float, Array, Array], Array]:
    """Force (3,) [N] of a flat wall on what is behind its ``point`` [m], seen along its outward ``normal``:
    k d - c d' along the normal, d the depth [m], never pulling."""
    length = float(np.linalg.norm(normal))
    if not length > 0:
        raise refused("scene.wall.normal", "[0, 0, 0]", "have a direction")
    place, out = np.array(point, dtype=float), np.array(normal, dtype=float) / length

    def law(_: float, position: Array, velocity: Array) -> Array:
        depth = float(out @ (place - position))
        return max(stiffness * depth - damping * float(out @ velocity), 0.0) * out if depth > 0 else 0.0 * out

    return law


def pulse(force: Sequence[float], start: float, duration: float) -> Callable[[float], Sequence[float]]:
    """A constant force (3,) [N] from a time on for a duration [s]."""
    return lambda time: force if start <= time < start + duration else (0.0, 0.0, 0.0)


def start(config: Config, path: Path) -> Array:
    """Joint angles (n,) [rad] that put the end point beside the leader.

    Raises InputError that names the point where the path, displaced by the offset, leaves the arm's reach.
    """
    arm, found, first = config.arm, config.start, None
    if not vector(config.offset):
        raise refused("scene.offset", config.offset, "be three numbers")
    offset = np.array(config.offset, dtype=float)
    if found is not None and not vector(found, arm.dof):
        raise refused("scene.start", found, f"be {arm.dof} joint angles, or null")
    for time in np.linspace(0.0, config.duration, CHECKED):
        place = path(time).position + offset
        where = f"({', '.join(f'{value:.3g}' for value in place)}) m of scene.leader + offset at {time:.3g} s"
        try:
            found = solve(arm, place, start=found, restarts=5)
        except Unreachable as error:
            far = config.leader.get("csv") and np.abs(place).max() > FAR
            remedy = "move scene.leader, scene.offset or what the arm stands on (its base)"
            remedy = "scene.leader={csv: {file: ..., unit: mm}} reads a file in mm" if far else remedy
            raise InputError(f"the point {where}: {error} [m]; {remedy}") from error
        height = forward(arm, found)[0][2]
        if abs(height - place[2]) > 1e-4:  # the inverse kinematics of a planar arm looks at x and y alone
            raise InputError(f"the point {where}: the arm stays at z = {height:g} m")
        first = found if first is None else first
    assert first is not None
    return first


class _Carried:
    """Moves the leader along its path, velocity included, so that what it holds feels it."""

    name = "path"

    def __init__(self, path: Path) -> None:
        self._path = path

    def bind(self, world: Ends) -> Callable[[float], None]:
        body = world.end("leader")
        assert isinstance(body, RigidBody)

        def apply(time: float) -> None:
            position, velocity, _ = self._path(time)
            body.place(tuple(position.tolist()))
            body.vx, body.vy, body.vz = velocity.tolist()

        return apply

    def channels(self) -> dict[str, float]:
        return {}


def leading(config: Config) -> Config:
    """The leader's arm in the place of the arm: on the path itself, under its own law, with an exact model."""
    arm, law = config.leader_arm, config.leader_law
    if getattr(law, "kind", getattr(getattr(law, "func", None), "kind", None)) not in ("joint", "end_point"):
        raise InputError(
            "scene.leader_law must name a law of kind joint or end_point, which takes the arm along its path"
        )
    try:
        exact = model(arm, config.gravity, 0.0, "leader_arm")
    except ValueError as error:
        raise InputError(str(error)) from error
    return Config({**config, "arm": arm, "law": law, "model": exact, "start": None, "offset": [0.0, 0.0, 0.0]})


def simulate(config: Config, rng: Rng) -> Recording:
    path, offset = leader_path(config), np.array(config.offset, dtype=float)
    with scene(config, rng("sensor") if config.get("sensor") else None) as world:
        controller, wanted = driver(config, path, np.array(world.arms["arm"].q))
        controllers, probes = {"arm": controller}, {"reference": lambda: wanted(world.time)}
        if config.leader_arm:
            controllers["leader"], _ = driver(leading(config), path, np.array(world.arms["leader"].q))
        else:
            probes["leader.pose"] = lambda: path(world.time).position
        length = np.linalg.norm(offset)
        recording = world.run(config.duration, controllers, probes=probes, on_divergence="stop")
    if config.leader_arm:
        recording.series["leader.pose"] = recording["leader.tip"]
    force = recording["arm.force"]
    recording.series["force_along"] = force @ offset / length if length else np.linalg.norm(force, axis=1)
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    force, torque, limits = recording["force_along"], np.abs(recording["arm.torque"]), config.arm.effort
    wanted = config.desired_force
    bounded = np.isfinite(limits).any()
    return {
        "rmse": rms(distance(recording, config)),
        "peak_distance": float(distance(recording, config).max()),
        "force_rmse": None if wanted is None else rms(force - wanted),
        "force_peak": float(np.abs(force).max()),
        "saturated": float((torque >= 0.999 * limits).any(axis=1).mean()) if bounded else None,
        "simulated": float(recording.simulated),
    }


def distance(recording: Recording, config: Config) -> Array:
    """How far the end point is from where leader and offset put it, (N,) [m]; of a planar arm in its plane."""
    gap = recording["arm.tip"] - recording["leader.pose"] - np.array(config.offset, dtype=float)
    result: Array = np.linalg.norm(gap, axis=1)
    return result
