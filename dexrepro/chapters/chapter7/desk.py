"""The desktop arm over the board: its scene, its reference from a generalised skill, its run under a control law.

Board coordinates are in cm, the robot's in m.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from dexrepro.arrays import Array, Image
from dexrepro.chapters.chapter7 import skills
from dexrepro.control import contract
from dexrepro.control.motion import Sampled
from dexrepro.experiment import Config, Recording
from dexrepro.humans.reaching import Obstacle
from dexrepro.measures import rms
from dexrepro.physics.drive import JointDrive
from dexrepro.physics.elements import JointLoad, joint_friction
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.rendering import Camera
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.world import World
from dexrepro.robots.arm import Pose, Shape
from dexrepro.robots.pen_arm import DARK, gripper, pen_arm, pen_arm_angles, pen_arm_tip

BOARD = (0.13, 0.21)  # m, depth and width; printed in Sect. 7.4
CUBE = 0.018  # m, edge of the carried cube
MIDDLE = (11.15, 4.5)  # cm, of the demonstrated reach, before the arm
WIDE = Camera(target=(0.14, 0.0, -0.02), distance=0.42, yaw=62.0, pitch=-20.0)
JAWS = tuple(Shape("box", (0.022, 0.004, 0.016), Pose((-0.002, side, 0.0)), DARK) for side in (-0.012, 0.012))
CAMERA = Camera(target=(0.14, 0.0, -0.045), distance=0.33, yaw=62.0, pitch=-24.0)
WOOD, BLUE = (0.93, 0.87, 0.72, 1.0), (0.0, 0.45, 0.70, 1.0)
RED, GREEN = (0.84, 0.37, 0.0, 1.0), (0.0, 0.62, 0.45, 1.0)


def to_robot(points: Array) -> Array:
    """Board coordinates (..., 3) [cm] in the robot's frame [m]: its x is the board's y, its y points left."""
    return np.stack([0.09 + points[..., 1] / 100, (10.5 - points[..., 0]) / 100, -0.10 + points[..., 2] / 100], axis=-1)


def to_board(points: Array) -> Array:
    """Points (..., 3) [m] of the robot's frame in board coordinates [cm]."""
    return np.stack(
        [10.5 - 100 * points[..., 1], 100 * (points[..., 0] - 0.09), 100 * (points[..., 2] + 0.10)], axis=-1
    )


def before_arm(points: Array, config: Config) -> Array:
    """Board coordinates (..., 3) [cm] as the arm has them that stands where it has the reach before it."""
    shift = np.mean([config.scene.start, config.scene.goal], axis=0) - MIDDLE
    return points - np.append(shift, 0.0)


class Reference(Sampled):
    """What the joints are to do every control period, with the ``tip`` (N, 3) [m] and the ``stiffness`` (N,) [-].

    Follows a path (M, 3) [cm] of the movement primitive with the muscle's stiffness (M,); still before and after it.
    """

    def __init__(self, path: Array, stiffness: Array, config: Config) -> None:
        period, hold, duration = config.control_period, config.hold, config.demonstration.duration
        time = np.arange(round((duration + 2 * hold) / period) + 1) * period
        phase = np.clip(time - hold, 0.0, duration)
        samples = np.linspace(0.0, duration, len(path))
        tip = CubicSpline(samples, to_robot(path))(phase)
        position = gaussian_filter1d(pen_arm_angles(tip), config.reference_smoothing / period, axis=0, mode="nearest")
        velocity = np.gradient(position, period, axis=0)
        super().__init__(period, position, velocity, np.gradient(velocity, period, axis=0))
        self.tip, self.stiffness = pen_arm_tip(position), np.interp(phase, samples, stiffness)


def planned(config: Config) -> tuple[skills.NewTask, Reference]:
    """The generalised skill of the chosen direction as a reference for the arm."""
    ordinary, reactions = skills.demonstrate(config)
    task = skills.NewTask(config, skills.Skills(config, ordinary, reactions))
    _, traces = skills.measure_stiffness(config)
    stiffness = skills.generalised_stiffness(config, task, traces, "average")
    path = task.perform(task.reaction(config.task.direction))
    return task, Reference(path, stiffness, config)


def scene(config: Config) -> World:
    """Arm with gripper, board, cube stack and the cube to carry, at the start of the task."""
    world = build(config, to_robot(np.array([*config.task.start, 0.0])))
    furnish(world, Obstacle(config.task.obstacle, config.task.height, config.scene.cube))
    return world


def build(config: Config, start: Array, contacts: bool = False) -> World:
    """The arm alone, its tip at ``start`` [m], with the friction and the gripper that its model does not know."""
    world = World(step=config.physics_step, perturbation=config.perturbation)
    jaws = () if contacts else JAWS  # what touches is the rounded end of the forearm
    arm = pen_arm(replace(gripper(config.arm.gripper_mass), shapes=jaws), effort=config.torque_limit)
    angles = pen_arm_angles(start) - np.asarray(config.initial_error)
    world.add_arm("arm", arm, angles, contacts=contacts, sensor=Sensor(**(config.sensor or {})))
    world.add(JointLoad("arm", joint_friction(config.arm.viscous, config.arm.coulomb)))
    return world


def demonstration_scene(config: Config) -> World:
    """The arm with a finger handle that a person moves past the tall stack at the far place."""
    handle = replace(gripper(), name="handle", shapes=(Shape("cylinder", (0.012, 0.01), colour=DARK),))
    world = World(gravity=(0.0, 0.0, 0.0))
    places = {name: before_arm(np.array([*config.scene[name], 0.0]), config) for name in ("start", "goal", "far")}
    world.add_arm("arm", pen_arm(handle), pen_arm_angles(to_robot(places["start"])))
    furnish(world, Obstacle(places["far"][:2].tolist(), config.scene.tall, config.scene.cube), cube=False)
    for name in ("start", "goal"):
        x, y, _ = to_robot(places[name])
        world.add_body(name, [Shape("cylinder", (0.006, 0.001), colour=BLUE)], (x, y, -0.1095), collides=False)
    return world


def furnish(world: World, obstacle: Obstacle, cube: bool = True) -> None:
    """Board, stack and carried cube, for pictures; the board lies a tool's radius below the points of the paths."""
    world.add_box("board", (*BOARD, 0.004), (0.09 + BOARD[0] / 2, 0.0, -0.112), colour=WOOD, collides=False)
    if cube:
        world.add_box("cube", (CUBE,) * 3, (0.0, 0.0, 0.0), colour=RED, collides=False)
    add_stack(world, obstacle, collides=False)


def add_stack(world: World, obstacle: Obstacle, **contact: Any) -> None:
    """The cube stack (position and height in cm) as a static body."""
    x, y, _ = to_robot(np.array([*obstacle.position, 0.0]))
    side, height = obstacle.side / 100, obstacle.height / 100 + 0.01
    world.add_box("stack", (side, side, height), (x, y, -0.11 + height / 2), colour=GREEN, **contact)


def photographs(
    world: World, positions: dict[str, Array], cube: dict[str, Array] | None = None, camera: Camera = CAMERA
) -> dict[str, Image]:
    """Pictures, by name, with the arm at joint angles and the cube, if any, at points [m] of the robot's frame."""
    return {
        name: world.render({"arm": angles}, {"cube": cube[name]} if cube else None, camera, (420, 320))
        for name, angles in positions.items()
    }


def run(config: Config, reference: Reference, world: World, **options: Any) -> Recording:
    """Follow a reference; channels ``planned`` (tip, m), ``reference`` (angles) and, if the law reports them,
    ``filtered_error`` r and ``impedance`` K_imp.

    The run ends with a status when a joint turns faster than 200 rad/s.
    """
    model = RigidBodyModel(pen_arm(gripper(config.arm.model_gripper_mass) if config.arm.model_gripper_mass else None))
    stiffness = reference.stiffness.tolist()
    law = contract.build(config.law, model=model, stiffness=lambda time: stiffness[reference.index(time)])
    arm = world.arm("arm")

    def stop(time: float) -> str | None:
        return f"diverged at {time:.3f} s" if max(map(abs, arm.dq)) > 200 else None

    probes = {
        "reference": lambda: reference(world.time).position,
        "planned": lambda: reference.tip[reference.index(world.time)],
    } | contract.channels(law, "filtered_error", "impedance")
    recording = world.run(
        (len(reference) - 1) * reference.dt,
        {"arm": JointDrive(law, reference)},
        control_period=config.control_period,
        probes=probes | options.pop("probes", {}),
        stop=stop,
        record_every=round(config.control_period / config.physics_step),
        on_divergence="stop",
        **options,
    )
    index = np.minimum(np.round(recording.time / config.control_period).astype(int), len(reference) - 1)
    recording.series["stiffness"] = reference.stiffness[index]
    return recording


def payload_events(world: World, config: Config) -> list[tuple[float, Any]]:
    """Pick the cube up and put it down: the gripper's mass changes."""
    empty = config.arm.gripper_mass
    return [
        (config.pick, lambda: world.set_mass("arm", "gripper", empty + config.arm.payload_mass)),
        (config.release, lambda: world.set_mass("arm", "gripper", empty)),
    ]


def tip_error(recording: Recording) -> Array:
    """Distance [mm] of the tip from the plan."""
    return 1e3 * np.linalg.norm(recording["arm.tip"] - recording["planned"], axis=1)


def tracking_metrics(recording: Recording, config: Config) -> dict[str, float | None]:
    """Error [mm] and torque of a run that finished; when a run diverged, only when [s]."""
    diverged = float(recording.time[-1]) if recording.status != "finished" else None
    error = tip_error(recording)
    torque = recording["arm.torque"]
    names = ("rms_error", "largest_error", "largest_torque", "torque_travel")
    values = (
        rms(error),
        float(error.max()),
        float(np.abs(torque).max()),
        float(np.abs(np.diff(torque, axis=0)).sum(axis=0).mean()),
    )
    finished = {"finished": int(diverged is None), "diverged_at": diverged}
    return dict(zip(names, values if diverged is None else (None,) * 4)) | finished
