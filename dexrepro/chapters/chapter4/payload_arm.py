"""A Baxter arm whose gripper carries a loosely hanging payload (Sect. 4.6): scene, point-to-point motions, runs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from dexrepro.arrays import Image
from dexrepro.control.contract import Command, Law, build, report
from dexrepro.control.motion import Sampled, via_points
from dexrepro.experiment import Config, Recording
from dexrepro.networks import AdaptiveNetwork
from dexrepro.physics.drive import EndPointDrive, Limited
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.robots.baxter import baxter
from dexrepro.robots.inverse_kinematics import nearest

TRAINING = (0, 1)  # phases I and II; phase III has the numbers 2 to 10, one a trajectory
START_COLOUR, END_COLOUR = (0.90, 0.62, 0.0, 1.0), (0.0, 0.62, 0.45, 1.0)
VIEW = Camera(target=(0.42, -0.45, 0.15), distance=1.5, yaw=-60.0, pitch=-20.0)
EVERY = 2  # physics steps between recorded samples


def motions(config: Config) -> Iterator[tuple[int, Sampled]]:
    """The runs of a case: phases I and II if it trains, then the nine trajectories from A, B, C to D, E, F."""
    task = config.task
    if config.mode != "zero":
        for number, ends in zip(TRAINING, (task.starts, task.ends)):
            points = [task.home, *(point for end in ends for point in (end, task.home))]
            yield number, via_points(points, [task.training_time] * 2 * len(ends), config.step)
    pairs = [(start, end) for start in task.starts for end in task.ends][: task.trajectories]
    for number, (start, end) in enumerate(pairs, 2):
        yield number, via_points([task.home, start, end, end], task.times, config.step)


def scene(config: Config) -> World:
    """The right arm at rest with its end point at X_0 and the payload hanging from it."""
    world = World(step=config.step, perturbation=config.perturbation)
    arm = baxter("right")
    world.add_arm("arm", arm, position=nearest(arm, config.task.posture, config.task.home, task="position", settle=400))
    if config.payload:
        payload = config.payload
        world.hang("payload", "arm", payload.mass, payload.drop, radius=0.04, angular_damping=payload.angular_damping)
    if config.picture:
        points = [*config.task.starts, *config.task.ends]
        for name, point, colour in zip("ABCDEF", points, [START_COLOUR] * 3 + [END_COLOUR] * 3):
            world.add_sphere(name, 0.02, point, colour=colour, collides=False)
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    below = (0.0, 0.0, config.payload.drop if config.payload else 0.0)
    recording.series |= {"arm.position": recording["position"], "payload.pose": recording["tip"] - below}
    return recording


class Pilot:
    """Drives the arm with a law along a reference; the torques that hold the arm alone are added, as its maker does."""

    def __init__(self, law: Law, model: RigidBodyModel, compensate: bool, reference: Sampled) -> None:
        self.law, self.drive = law, EndPointDrive(law, reference, model)
        self.command = Limited(self.drive, support=model if compensate else None)

    def __call__(self, sense: Sense) -> Command:
        return self.command(sense)

    def state(self) -> tuple[float, ...]:
        """Error (3), usage (3), E, nodes, largest feature, |G|^2, for the columns of ``STATE``."""
        told = {**UNTOLD, **report(self.law)}
        network = told["nodes"], told["activation"], told["feature_energy"]
        return (*self.drive.error.tolist(), *told["usage"], told["share"], *network)


#: What a law is taken to report where it reports nothing.
UNTOLD: dict[str, Any] = {"usage": (math.nan,) * 3, "share": 1.0, "nodes": 0, "activation": 0.0, "feature_energy": 0.0}
STATE: dict[str, Any] = {"error": slice(0, 3), "usage": slice(3, 6), "share": 6, "nodes": 7, "activation": 8}
STATE["feature_energy"] = 9


def simulate(config: Config) -> Recording:
    """Phases I and II if the case trains, then phase III; each trajectory starts from the same knowledge."""
    model = RigidBodyModel(baxter("right"))
    network: AdaptiveNetwork | None = None
    if config.network is not None:
        network = config.network(gain=np.array(config.effective_gain) / config.feature_energy)
    law = build(config.law, model=model, network=network)
    parts, images, status, knowledge = [], {}, "finished", None
    for number, reference in motions(config):
        if network is not None and number not in TRAINING:
            if knowledge is None:
                knowledge = network.weights.copy(), network.basis.centres.copy()
            network.reset(None if config.mode == "nodes" else knowledge[0])
            network.basis.reset(knowledge[1])
            law.learning = config.mode != "frozen"
        pilot = Pilot(law, model, config.gravity_compensation, reference)
        with scene(config) as world:
            part = world.run(
                reference.duration,
                {"arm": pilot},
                probes={"state": pilot.state},
                record_every=EVERY,
                on_divergence="stop",
            )
            if config.picture and number < 3:
                images[f"phase{number + 1}"] = photograph(world, part, config.task.pictured[number])
        part.series["reference"] = reference.position[::EVERY][: len(part.time)]
        parts.append((number, part))
        if part.status != "finished":
            status = part.status
            break
    model.close()
    recording = joined(parts, config.step * EVERY)
    recording.images, recording.status = images, status
    return recording


def joined(parts: list[tuple[int, Recording]], step: float) -> Recording:
    """One recording of all runs, one after the other in ``time``; ``phase`` numbers them."""
    state = np.concatenate([part["state"] for _, part in parts])
    series = {name: state[:, columns] for name, columns in STATE.items()}
    for name, source in (("torque", "arm.torque"), ("position", "arm.position"), ("tip", "arm.tip")):
        series[name] = np.concatenate([part[source] for _, part in parts])
    series["reference"] = np.concatenate([part["reference"] for _, part in parts])
    series["phase"] = np.concatenate([np.full(len(part.time), number) for number, part in parts])
    return Recording(
        {"time": np.arange(len(state)) * step, **series},
        steps=sum(part.steps for _, part in parts),
        simulated=sum(part.simulated for _, part in parts),
    )


def photograph(world: World, part: Recording, time: float) -> Image:
    """The arm and its payload at an instant of a run."""
    k = min(int(np.searchsorted(part.time, time)), len(part.time) - 1)
    poses = {"payload": part["payload.pose"][k]} if "payload.pose" in part else {}
    return world.render({"arm": part["arm.position"][k]}, poses, camera=VIEW, size=(480, 480))
