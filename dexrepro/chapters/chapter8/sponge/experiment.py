"""A simulated Baxter arm presses a sponge and learns the optimal interaction with it; no model of arm or sponge."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import brentq

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter8 import learning_study
from dexrepro.chapters.chapter8.task import beyond, displaced
from dexrepro.control.contract import build, channels
from dexrepro.control.interaction_optimum import InteractionCost, InteractionModel, closed_form_gain, steady_fraction
from dexrepro.control.motion import Motion, Path
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.networks import GrowingGaussians
from dexrepro.physics.drive import EndPointDrive, Limited, Posture
from dexrepro.physics.elements import TipForce
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.robots.baxter import baxter

RATE = 50.0
VIEW = Camera(target=(0.45, -0.3, 0.27), distance=1.2, yaw=25.0, pitch=-15.0)
CLOSE = Camera(target=(0.77, -0.27, 0.09), distance=0.4, yaw=25.0, pitch=-4.0)


def scene(config: Config) -> World:
    """The right arm above a sponge, a spring and damper below its surface that never pulls; the box only shows it."""
    world = World(step=config.step, perturbation=config.perturbation)
    world.add_arm("arm", baxter("right"), config.start)
    surface, stiffness, damping = config.sponge.surface, config.sponge.stiffness, config.sponge.damping
    x, y = config.path.place
    world.add_box("sponge", (0.2, 0.2, surface), (x, y, surface / 2), colour=(0.95, 0.85, 0.3, 1.0), collides=False)

    def push(time: float, position: Any, velocity: Any) -> tuple[float, float, float]:
        depth = surface - position[2]
        return 0.0, 0.0, max(0.0, stiffness * depth - damping * velocity[2]) if depth > 0 else 0.0

    world.add(TipForce("sponge_force", on="arm", law=push))
    return world


def approach(settings: Any) -> Path:
    """The desired path of Eq. (8.48) over time [s]: straight down towards a height, exponentially."""
    x, y = settings.place
    depth, end = settings.descent, settings.end

    def motion(time: float) -> Motion[Array]:
        part = depth * math.exp(-time)
        return Motion(np.array((x, y, end + part)), np.array((0.0, 0.0, -part)), np.array((0.0, 0.0, part)))

    return motion


def simulate(config: Config, rng: Rng) -> Recording:
    interaction = config.interaction
    model, limits = RigidBodyModel(baxter("right")), np.array(config.torque_limits)
    law = build(config.law, model=model)
    # Gravity and the inertia that the posture needs are the arm's own, exact; the law knows neither.
    drive = EndPointDrive(
        law, approach(config.path), model, displaced=displaced(interaction, axis=2),
        posture=Posture(model, np.array(config.start), config.posture_stiffness),
    )  # fmt: skip
    with scene(config) as world:
        recording = world.run(
            config.duration,
            controllers={"arm": Limited(drive, limits, model if config.gravity_compensation else None)},
            control_period=config.control_period,
            probes={
                "reference": lambda: drive.desired.position,
                "path": lambda: drive.path.position,
                "error": lambda: drive.error,
                "gain": lambda: interaction.gain.gain,
                "phase": lambda: float(interaction.gain.phase),
                **channels(law, "nodes"),
            },
            stop=beyond(drive, config.bound),
            record_every=config.record_every,
            on_divergence="stop",
        )
        if config.pictures:
            staged = stage(world, recording, config)
            for k, t in enumerate(config.pictures):  # the whole arm first, then where it touches
                recording.images[f"at_{t:g}s"] = world.snapshot(staged, t, CLOSE if k else VIEW, (480, 400))
    gain: Any = interaction.gain
    if gain.learned is not None:
        truth = InteractionModel(config.sponge.stiffness, config.sponge.damping, config.exosystem)
        recording.frames["iterates"] = learning_study.iterates(gain, truth)
        if config.noise.draws:
            recording.frames["noise"] = learning_study.noise_study(
                gain, config.noise.draws, config.noise.force, config.noise.position, rng("noise")
            )
    return recording


def stage(world: World, recording: Recording, config: Config) -> Recording:
    """The box is shown as low as it is pressed."""
    surface = config.sponge.surface
    depth = np.maximum(0.0, surface - recording["arm.tip"][:, 2])
    place = np.broadcast_to([*config.path.place, surface / 2], (len(depth), 3))
    return Recording({**recording.series, "sponge.pose": place - depth[:, None] * [0.0, 0.0, 1.0]})


def measure(recording: Recording, config: Config) -> Metrics:
    force = recording["sponge_force.z"]
    contact = force > 0
    depth = 1e3 * np.maximum(config.sponge.surface - recording["arm.tip"][:, 2], 0.0)
    error = 1e3 * np.abs(recording["error"]).max(axis=0)
    finished = recording.status == "finished"
    used = float(np.max(error / (1e3 * np.array(config.bound))))
    last = recording.between(config.duration - 0.5)
    counts = np.zeros((len(recording.time), 1), int)  # a law that reports none has none
    if "nodes" in recording:
        counts = recording["nodes"].astype(int).reshape(len(counts), -1)
    settled = counts[recording.between(config.duration - 5.0)]
    metrics: Metrics = {f"max_error_{axis}": float(value) for axis, value in zip("xyz", error)}
    metrics |= {f"nodes_{name}": int(count) for name, count in zip("dcg", counts[-1])}
    metrics |= {
        "bound_used": used if finished else max(used, 1.0),  # it may pass the bound between two samples
        "stopped_at": None if finished else float(recording.time[-1]),
        "touched_at": float(recording.time[contact.argmax()]) if contact.any() else None,
        "peak_compression": float(depth.max()),
        "peak_force": float(force.max()),
        "peak_torque": float(np.abs(recording["arm.torque"]).max()),
        "final_compression": float(depth[last].mean()) if finished else None,
        "final_force": float(force[last].mean()) if finished else None,
        "late_growth": int(np.sum(settled[-1] - settled[0])) if finished else None,
        "gain_x": float(recording["gain"][-1, 0]),
        "gain_s": float(recording["gain"][-1, 1]),
    }
    if "iterates" in recording.frames:
        end = recording.frames["iterates"].iloc[-1]
        errors = [abs(end[f"next_{key}"] / end[f"optimal_{key}"] - 1.0) for key in "xs"]
        metrics |= {"gain_error": max(errors), "digits": -math.log10(max(errors)), "rank": int(end["rank"])}
        metrics |= {"iterations": len(recording.frames["iterates"])}
    if config.count_joint_inputs:
        metrics |= _joint_counts(recording, config)
    return metrics


def _joint_counts(recording: Recording, config: Config) -> Metrics:
    """How many nodes the same run would have made with joint angles and rates as inputs."""
    position, velocity = recording["arm.position"], recording["arm.velocity"]
    inputs = {"d": position, "c": np.hstack([position, velocity])}
    result: Metrics = {}
    for (name, path), network in zip(inputs.items(), config.law.networks):
        basis = GrowingGaussians(path.shape[1], width=network.basis.width, threshold=network.basis.threshold)
        for sample in path[::10]:
            basis(sample, grow=True)
        result[f"joint_nodes_{name}"] = basis.nodes
    return result


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Stiffness [N/m] below which the learned law compresses the sponge more than the wrong-model regulator."""
    if "lqr" not in metrics:
        return {}
    cost = InteractionCost(config.cost.tracking, config.cost.effort, config.cost.output)
    wrong = np.array([metrics["lqr"]["gain_x"], metrics["lqr"]["gain_s"]], float)

    def difference(stiffness: float) -> float:
        model = InteractionModel(stiffness, config.sponge.damping, config.exosystem)
        learned = steady_fraction(closed_form_gain(model, cost), stiffness, cost.output)
        return learned - steady_fraction(wrong, stiffness, cost.output)

    return {"crossing_stiffness": float(brentq(difference, 50.0, 5000.0))}
