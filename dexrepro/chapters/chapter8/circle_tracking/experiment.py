"""A two-link arm without a known model tracks a circle inside hard error bounds, with and without joint friction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter8.task import beyond, circle, two_link
from dexrepro.control.barrier_tracking import barrier_energy
from dexrepro.control.contract import build, channels
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import rms, rms_length
from dexrepro.networks import AdaptiveNetwork, GrowingGaussians
from dexrepro.physics.drive import EndPointDrive
from dexrepro.physics.elements import JointLoad, joint_friction
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.two_link import TwoLink

RATE = 100.0


def scene(config: Config) -> World:
    """The arm in a vertical plane (gravity along -y), its end point at the start."""
    world = World(step=config.step, gravity=(0.0, -config.gravity, 0.0), perturbation=config.perturbation)
    start = TwoLink(config.arm.lengths).inverse(config.start, config.arm.elbow)
    world.add_arm("arm", two_link(config.arm), start)
    friction = config.friction
    if friction.coulomb or friction.viscous:
        world.add(JointLoad("arm", joint_friction(friction.viscous, friction.coulomb, friction.width)))
    return world


def simulate(config: Config, rng: Rng) -> Recording:
    gravity = (0.0, -config.gravity, 0.0)
    arm = two_link(config.arm)
    factor = match_rates(config) if config.match else 1.0
    nominal = RigidBodyModel(arm, gravity, mass_error=config.model_error)
    chosen = config[config.controller] if config.law is None else config.law
    law, networks = build(chosen, networks=config.networks, model=nominal), config.networks
    drive = EndPointDrive(law, circle(config.path), RigidBodyModel(arm, gravity))
    learns = config.law is None and config.controller == "barrier"
    probes: dict[str, Callable[[], Any]] = {
        "reference": lambda: drive.desired.position,
        "error": lambda: drive.error,
        **channels(law, "nodes", "network_force", "feature_power"),
    }
    with scene(config) as world:
        recording = world.run(
            config.duration,
            controllers={"arm": drive},
            probes=probes,
            stop=beyond(drive, config.bound) if learns else None,
            record_every=config.record_every,
        )
    if learns:
        recording.frames["rate"] = pd.DataFrame({"gravity": [float(networks[2].gain)], "factor": [factor]})
        if networks[2].basis.grows:
            recording.frames["nodes"] = pd.DataFrame(networks[2].basis.centres.copy(), columns=["x", "y"])
    return recording


def match_rates(config: Config) -> float:
    """Scale the rates so that rate x mean |features of G|^2 is the broad network's on the judged path; the factor."""
    own = config.networks[2].basis
    broad = GrowingGaussians(2, width=config.match.width, threshold=config.match.threshold)
    motion = circle(config.path)
    path = [np.array(config.start)] + [motion(time).position for time in np.arange(0.0, config.early, 0.05)]
    steady = round(config.settled / 0.05)
    wanted, has = (np.mean([np.sum(basis(x, grow=True) ** 2) for x in path][steady:]) for basis in (broad, own))
    factor = float(wanted / has)
    networks: tuple[AdaptiveNetwork, ...] = config.networks
    for network in networks:
        network.gain = network.gain * factor
    return factor


def measure(recording: Recording, config: Config) -> Metrics:
    bound = np.array(config.bound)
    error = recording["error"]
    largest = np.abs(error).max(axis=0)
    finished = recording.status == "finished"
    used = float(np.max(largest / bound))
    steady, early = (error[recording.between(config.settled, end)] for end in (config.duration, config.early))
    energy = barrier_energy(np.clip(error, -0.999 * bound, 0.999 * bound), bound).sum(axis=1)
    metrics: Metrics = {
        "max_x": 1e3 * largest[0],
        "max_y": 1e3 * largest[1],
        "bound_used": used if finished else max(used, 1.0),  # it may pass the bound between two samples
        "violated_at": None if finished else float(recording.time[-1]),
        "energy_ratio": float(energy[recording.time > 1.0].max() / energy[0]) if recording.time[-1] > 1.0 else None,
    }
    for name, part in (("rms", steady), ("early", early)):
        for axis, letter in enumerate("xy"):
            metrics[f"{name}_{letter}"] = 1e3 * rms(part[:, axis])
    steps = np.diff(recording["arm.torque"][recording.between(config.settled, config.early)], axis=0)
    metrics["torque_step"] = rms(steps) if len(steps) else None
    if "network_force" in recording:
        counts = recording["nodes"][-1].astype(int)
        features = config.networks[2].basis.features_per_node
        force, power = (recording[key][recording.between(config.settled)] for key in ("network_force", "feature_power"))
        early_power = recording["feature_power"][recording.between(config.settled, config.early)]
        metrics |= {f"nodes_{name}": int(count) for name, count in zip(("d", "c", "g"), counts)}
        metrics |= {
            "nodes": int(counts.sum()),
            "features": int(counts.sum()) * features,
            "network_force": rms_length(force),
            "feature_power": float(power.mean()) if len(power) else None,
            "early_gain": _gain(recording, early_power),
            "gain": _gain(recording, power),
        }
    return metrics


def _gain(recording: Recording, power: Array) -> float | None:
    """Adaptation gain of G: its rate times the mean squared length of its features."""
    return float(power.mean() * recording.frames["rate"]["gravity"][0]) if len(power) else None


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Error of the fixed network over that of the grown one from 5 to 10 s, by axis, where both cases were run."""
    pairs = {
        "unit": ("broad_unit", "fuzzy_unit"),
        "tuned": ("broad", "fuzzy"),
        "friction": ("friction_broad", "friction_fuzzy"),
    }
    result: Metrics = {}
    for name, (broad, fuzzy) in pairs.items():
        if broad in metrics and fuzzy in metrics:
            for key in ("early_x", "early_y"):
                mine, other = metrics[broad][key], metrics[fuzzy][key]
                result[f"ratio_{name}_{key[-1]}"] = other / mine if mine and other else None
    return result
