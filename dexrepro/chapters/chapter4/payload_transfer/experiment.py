"""A Baxter arm learns to carry a loose payload and moves it along nine new trajectories (Sect. 4.6)."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter4 import payload_arm
from dexrepro.chapters.chapter4.measures import Array
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms_length
from dexrepro.robots import kinematics
from dexrepro.robots.baxter import baxter
from dexrepro.robots.rotations import rotation_error

RATE = 50.0

scene = payload_arm.scene
stage = payload_arm.stage


def simulate(config: Config, rng: Rng) -> Recording:
    return payload_arm.simulate(config)


def measure(recording: Recording, config: Config) -> Metrics:
    metrics: Metrics = {"diverged": int(recording.status != "finished")}
    phase, nodes = recording["phase"], recording["nodes"]
    step = recording.time[1] - recording.time[0]
    errors: list[float] = []
    rates: list[float] = []
    for number in np.unique(phase):
        now = phase == number
        error = 1e3 * recording["error"][now]
        if number in payload_arm.TRAINING:
            metrics[f"nodes_phase{number + 1:.0f}"] = int(nodes[now][-1])
            continue
        errors.append(rms_length(error))
        rates.append(rms_length(np.diff(error, axis=0) / step))
        metrics[f"trajectory{number - 1:.0f}_rmse_mm"] = errors[-1]
    late = phase > 1
    return metrics | {
        "rmse_mm": float(np.mean(errors)),
        "worst_rmse_mm": float(np.max(errors)),
        "oscillation_mm_s": float(np.mean(rates)),
        "max_usage": float(np.abs(recording["usage"][late]).max()),
        "violations": int(np.sum(np.abs(recording["usage"][late]).max(axis=1) >= 1.0)),
        "smallest_share": float(recording["share"].min()),
        "most_nodes": int(nodes.max()),
        "hand_tilt": _hand_tilt(recording["position"][late][::50]),
        **_gain(recording["feature_energy"][late], config),
        **_reach_of_lattice(recording, config),
    }


def _gain(energy: Array, config: Config) -> Metrics:
    """Mean |G|^2 on the trajectories, and what of the effective gain aimed at that gives."""
    if config.network is None:
        return {}
    return {"feature_energy": float(energy.mean()), "gain_ratio": float(energy.mean()) / config.feature_energy}


def _hand_tilt(positions: Array) -> float:
    """Largest sine of the angle by which the hand, whose orientation is not controlled, turned from its start."""
    rotations = kinematics.forward(baxter("right"), positions)[1]
    errors = np.linalg.norm(rotation_error(rotations[0], rotations), axis=-1)
    return float(np.max(np.sin(np.minimum(errors, np.pi / 2))))


def _reach_of_lattice(recording: Recording, config: Config) -> Metrics:
    """How strongly a fixed network responds in each phase, and how many points lie within its box of tip positions."""
    basis = None if config.network is None else config.network.keywords["basis"]
    if basis is None or basis.grows or config.mode == "zero":
        return {}
    phase, activation = recording["phase"], recording["activation"]
    corners = basis.centres[:: 2**7, :7]  # every combination of joint angles once
    tips = kinematics.forward(baxter("right"), corners)[0]
    points = np.array([config.task.home, *config.task.starts, *config.task.ends])
    inside = np.all((points >= tips.min(axis=0)) & (points <= tips.max(axis=0)), axis=1)
    return {
        "activation_phase1": float(np.median(activation[phase == 0])),
        "activation_phase2": float(np.median(activation[phase == 1])),
        "points_in_box": int(inside.sum()),
    }
