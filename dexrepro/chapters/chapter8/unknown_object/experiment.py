"""The same arm meets an object it knows nothing of and learns the optimal interaction with it during contact."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dexrepro.arrays import Mask, Rng
from dexrepro.chapters.chapter8 import learning_study
from dexrepro.chapters.chapter8.task import beyond, circle, displaced, two_link
from dexrepro.control.contract import build
from dexrepro.control.impedance_learning import TRANSFERRING, InteractionLaw
from dexrepro.control.interaction_optimum import InteractionModel, steady_cost, steady_fraction
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.physics.drive import EndPointDrive
from dexrepro.physics.elements import TipForce
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.two_link import TwoLink

RATE = 100.0


def scene(config: Config) -> World:
    """The arm in a vertical plane and an object whose surface is the plane x = surface, frictionless along y."""
    world = World(step=config.step, gravity=(0.0, -config.gravity, 0.0), perturbation=config.perturbation)
    start = circle(config.path)(0.0).position if config.start is None else np.array(config.start)
    world.add_arm("arm", two_link(config.arm), TwoLink(config.arm.lengths).inverse(start, config.arm.elbow))
    stiffness, damping, surface = config.object.stiffness, config.object.damping, config.object.surface

    def push(time: float, position: Any, velocity: Any) -> tuple[float, float, float]:
        depth = position[0] - surface
        return (-(damping * velocity[0] + stiffness * depth) if depth > 0 else 0.0), 0.0, 0.0

    world.add(TipForce("object", on="arm", law=push))
    return world


def simulate(config: Config, rng: Rng) -> Recording:
    model = RigidBodyModel(two_link(config.arm), (0.0, -config.gravity, 0.0))
    interaction: InteractionLaw = config.interaction
    law = build(config.law, model=model)
    drive = EndPointDrive(law, circle(config.path), model, displaced=displaced(interaction, axis=0))
    with scene(config) as world:
        recording = world.run(
            config.duration,
            controllers={"arm": drive},
            probes={
                "reference": lambda: drive.desired.position,
                "reference_speed": lambda: float(drive.desired.velocity[0]),
                "path": lambda: drive.path.position,
                "error": lambda: drive.error,
                "gain": lambda: interaction.gain.gain,
                "phase": lambda: float(interaction.gain.phase),
                "desired_force": lambda: interaction.desired_force,
            },
            stop=beyond(drive, config.bound),
            on_divergence="stop",
        )
    gain: Any = interaction.gain
    if gain.learned is not None:
        recording.frames["iterates"] = learning_study.iterates(gain, true_model(config))
        if config.noise.draws:
            recording.frames["noise"] = learning_study.noise_study(
                gain, config.noise.draws, config.noise.force, config.noise.position, rng("noise")
            )
            recording.frames["assumptions"] = learning_study.assumptions(
                gain, config.object.surface, config.noise.surface
            )
    return recording


def true_model(config: Config) -> InteractionModel:
    """What no law is told: the object itself, with the reference generator that the learner assumes."""
    return InteractionModel(config.object.stiffness, config.object.damping, config.exosystem)


def measure(recording: Recording, config: Config) -> Metrics:
    metrics = _tracking(recording, config)
    if metrics["touched_at"] is not None and recording.time[-1] > metrics["touched_at"] + 1.0:
        metrics |= _transfer(recording, config) | _settled(recording, config)
    if "iterates" in recording.frames:
        last = recording.frames["iterates"].iloc[-1]
        errors = {key: abs(last[f"next_{key}"] / last[f"optimal_{key}"] - 1.0) for key in "xs"}
        metrics |= {
            "gain_x": last.next_x,
            "gain_s": last.next_s,
            "gain_error_x": errors["x"],
            "gain_error_s": errors["s"],
            "digits": -math.log10(max(errors.values())),
            "iterations": len(recording.frames["iterates"]),
            "rank": int(last["rank"]),
            "condition": last.condition,
            "last_change": last.change,
        }
    if "assumptions" in recording.frames:
        found = recording.frames["assumptions"].set_index("assumption")
        noise = recording.frames["noise"].query("quantity == 'force' and noise == 0.1")
        metrics |= {
            "desired_path_gain_x": found.gain_x["regressed on the desired path"],
            "desired_path_error": abs(found.gain_x["regressed on the desired path"] / last.optimal_x - 1.0),
            "surface_low_gain_x": found.gain_x.filter(like="surface").iloc[0],
            "surface_high_gain_x": found.gain_x.filter(like="surface").iloc[1],
            "noise_std_x": noise.std_x.iloc[0] if len(noise) else None,
        }
    return metrics


def _contact(recording: Recording) -> Mask:
    return recording["object.x"] != 0.0


def _tracking(recording: Recording, config: Config) -> Metrics:
    """bound_used: largest error in contact over its bound, 1 where one was met, if only between two samples; None where
    the run diverged."""
    contact = _contact(recording)
    error, ended = 1e3 * np.abs(recording["error"]), float(recording.time[-1])
    touched = float(recording.time[contact.argmax()]) if contact.any() else None
    violated = recording.status.startswith("error bound")
    diverged = not violated and recording.status != "finished"
    used = float(np.max(error[contact] / (1e3 * np.array(config.bound)), initial=0.0))
    return {
        "touched_at": touched,
        "surface_error": 1e3 * abs(float(recording["arm.tip"][contact.argmax(), 0]) - config.object.surface)
        if contact.any()
        else None,
        "left_at": float(recording.time[contact][-1]) if contact.any() else None,
        "violated_at": ended if violated else None,
        "diverged_at": ended if diverged else None,
        "max_error_x": float(error[contact, 0].max()) if contact.any() else None,
        "max_error_y": float(error[contact, 1].max()) if contact.any() else None,
        "bound_used": None if diverged else max(used, 1.0) if violated else used,
    }


def _transfer(recording: Recording, config: Config) -> Metrics:
    """Jump of the desired force by the gain alone; what follows the change of gain.

    force_rate, reference_speed: largest. oscillation: way of the indentation beyond one press and release [mm]; None
    where the run was stopped at its bound, for what is cut off cannot oscillate.
    """
    contact, phase = _contact(recording), recording["phase"]
    indentation = recording["arm.tip"][:, 0] - config.object.surface
    state = np.column_stack([indentation, (recording["path"][:, 0] - config.object.surface) / config.cost.output])
    jump = np.abs(np.sum(np.diff(recording["gain"], axis=0) * state[:-1], axis=1))
    start = recording.time[contact.argmax()] + config.switch_after
    if (phase >= TRANSFERRING).any():
        start = recording.time[(phase >= TRANSFERRING).argmax()]
    near = recording.between(start - 0.2, start + config.watched) & contact
    rate = np.gradient(recording["object.x"], config.step)
    depth = 1e3 * indentation[near]
    whole = recording.status == "finished" and near.any()
    travel = float(np.abs(np.diff(depth)).sum() - (2.0 * depth.max() - depth[0] - depth[-1])) if whole else 0.0
    return {
        "switch_at": float(start),
        "force_jump": float(jump[contact[:-1]].max()) if contact[:-1].any() else None,
        "force_rate": float(np.abs(rate[near]).max()) if near.any() else None,
        "reference_speed": float(np.abs(recording["reference_speed"][near]).max()) if near.any() else None,
        "oscillation": max(travel, 0.0) if whole else None,
    }


def _settled(recording: Recording, config: Config) -> Metrics:
    """Indentation over desired indentation late in the contact, its cost, and the cost of the whole contact."""
    contact, surface = _contact(recording), config.object.surface
    depth, force = recording["arm.tip"][:, 0] - surface, recording["object.x"]
    wanted = recording["path"][:, 0] - surface
    cost = config.cost.tracking * (depth - wanted) ** 2 + config.cost.effort * force**2
    start = recording.time[contact.argmax()] + config.judged
    late = recording.between(start, start + 0.5) & contact
    fraction = float(np.mean(depth[late] / wanted[late])) if late.any() else None
    final = np.asarray(recording["gain"][-1])
    theory = steady_fraction(final, config.object.stiffness, config.cost.output)
    return {
        "fraction": fraction,
        "fraction_theory": theory,
        "final_cost": steady_cost(theory, config.object.stiffness, config.cost),
        "contact_cost": float(np.trapezoid(cost[contact], dx=config.step)),
    }


def objects(config: Config) -> list[str]:
    """The cases with the object of the book, and with each other one."""
    return [name for name, case in config.cases.items() if name == "soft" or case.object != config.object]


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Largest relative error of the learned gain over all objects that were met; None where one of them taught none."""
    runs = [metrics[case] for case in objects(config) if case in metrics]
    errors = [values.get(key) for values in runs for key in ("gain_error_x", "gain_error_s")]
    known = [error for error in errors if error is not None]
    return {"worst_gain_error": max(known) if known and len(known) == len(errors) else None}
