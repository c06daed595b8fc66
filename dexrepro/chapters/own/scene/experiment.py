"""An arm, an object and a leader's path of your own, under any force or tracking law."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.own.drivers import driver
from dexrepro.chapters.own.paths import leader_path
from dexrepro.config import InputError
from dexrepro.control.motion import Path
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms
from dexrepro.physics.elements import Elastic, Ends
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import RigidBody
from dexrepro.physics.world import World
from dexrepro.robots.arm import Arm
from dexrepro.robots.inverse_kinematics import Unreachable, solve
from dexrepro.robots.kinematics import forward

CHECKED = 25  # points of the path whose reach is checked


def model(arm: Arm, gravity: Sequence[float], mass_error: float) -> RigidBodyModel:
    """What laws may know of the arm."""
    if not isinstance(arm, Arm):
        raise ValueError("scene.arm is no arm: name one by its _target_, such as dexrepro.robots.urdf.from_urdf")
    if not _vector(gravity):
        raise ValueError(f"scene.gravity = {gravity} is not allowed: it must be three numbers")
    return RigidBodyModel(arm, gravity, mass_error)


def _vector(value: Any, length: int = 3) -> bool:
    numbers = isinstance(value, list) and all(isinstance(item, int | float) for item in value)
    return numbers and len(value) == length


def scene(config: Config) -> World:
    """The arm, the leader as a small sphere that is carried along its path, and the objects."""
    world = World(step=config.step, gravity=config.gravity, perturbation=config.perturbation)
    path = leader_path(config)
    world.add_arm("arm", config.arm, start(config, path), contacts=bool(config.box))
    world.add_sphere("leader", 0.02, path(0.0).position.tolist(), colour=(0.84, 0.37, 0.0, 1.0), collides=False)
    world.add(_Carried(path))
    if config.elastic:
        world.add(Elastic("object", ("arm", "leader"), unilateral=True, **config.elastic))
    if config.box:
        box = dict(config.box)
        world.add_box("box", box.pop("size"), box.pop("position"), **box)
    return world


def start(config: Config, path: Path) -> Array:
    """Joint angles (n,) [rad] that put the end point beside the leader.

    Raises InputError that names the point where the path, displaced by the offset, leaves the arm's reach.
    """
    arm, found, first = config.arm, config.start, None
    if not _vector(config.offset):
        raise InputError(f"scene.offset = {config.offset} is not allowed: it must be three numbers")
    offset = np.array(config.offset, dtype=float)
    if found is not None and not _vector(found, arm.dof):
        raise InputError(f"scene.start = {found} is not allowed: it must be {arm.dof} joint angles, or null")
    for time in np.linspace(0.0, config.duration, CHECKED):
        place = path(time).position + offset
        where = f"({', '.join(f'{value:.3g}' for value in place)}) m of scene.leader + offset at {time:.3g} s"
        try:
            found = solve(arm, place, start=found, restarts=5)
        except Unreachable as error:
            raise InputError(f"the point {where}: {error}") from error
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


def simulate(config: Config, rng: Rng) -> Recording:
    path, offset = leader_path(config), np.array(config.offset, dtype=float)
    with scene(config) as world:
        controller, wanted = driver(config, path, np.array(world.arms["arm"].q))
        length = np.linalg.norm(offset)
        recording = world.run(
            config.duration,
            {"arm": controller},
            probes={"leader.pose": lambda: path(world.time).position, "reference": lambda: wanted(world.time)},
            on_divergence="stop",
        )
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
