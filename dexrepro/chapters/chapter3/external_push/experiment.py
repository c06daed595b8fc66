"""A push on the forearm while the arm holds the target inside the box: what the observer sees (Sect. 3.5.3)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd

from dexrepro.arrays import Array, Rng
from dexrepro.chapters.chapter3 import reach
from dexrepro.chapters.chapter3.measures import add_distances, reach_metrics
from dexrepro.chapters.chapter3.scene import ARM, ELBOW, FOREARM, Touching, build, cutaway, gripper_arm
from dexrepro.control.momentum_observer import MomentumObserver
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms
from dexrepro.physics.elements import Push
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.kinematics import joint_frames, point_jacobian

RATE = 100.0
SWEPT = {"lag": "lag", "noisy": "noisy_error", "clean": "clean_error"}


def scene(config: Config) -> World:
    world = build(config)
    world.add(Push(ARM, trapezoid(config.push), FOREARM, tuple(config.push.place)))
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    """Shows the push as a bar that ends at the forearm."""
    shown = cutaway(world, recording, config)
    elbow = joint_frames(gripper_arm(config.gripper), recording[f"{ARM}.position"])[:, ELBOW]
    force = np.stack([recording[f"push.{axis}"] for axis in "xyz"], axis=1)
    forearm = elbow[:, :3, 3] + elbow[:, :3, :3] @ np.array(config.push.place) - 0.17 * force / config.push.force
    world.add_box("push", (0.025, 0.2, 0.025), (0, 0, 0), colour=(0.0, 0.45, 0.7, 1.0), collides=False)
    shown.series["push.pose"] = np.where(np.linalg.norm(force, axis=1, keepdims=True) > 0, forearm, -9.0)
    return shown


def trapezoid(push: Config) -> Callable[[float], tuple[float, ...]]:
    """Force (3,) [N] at a time [s]: ramp up, hold, ramp down."""
    zero, full = (0.0, 0.0, 0.0), [push.force * share for share in push.direction]

    def force(time: float) -> tuple[float, ...]:
        share = min((time - push.start) / push.ramp, (push.start + push.duration - time) / push.ramp, 1.0)
        return tuple(share * f for f in full) if share > 0 else zero

    return force


def simulate(config: Config, rng: Rng) -> Recording:
    centre = np.array(config.centre, dtype=float)
    with scene(config) as world:
        recording = reach.run(world, config, lambda _: centre, Touching(world))
    add_distances(recording, config, centre)
    place = tuple(config.push.place)
    jacobian = point_jacobian(gripper_arm(config.gripper), recording[f"{ARM}.position"], 4, place)[:, :3]
    force = np.stack([recording[f"push.{axis}"] for axis in "xyz"], axis=1)
    recording.series["external"] = np.einsum("ki,kij->kj", force, jacobian)
    if config.sweep.run:
        recording.frames["sweep"] = _sweep(recording, config, rng("momentum"))
    return recording


def _sweep(recording: Recording, config: Config, rng: np.random.Generator) -> pd.DataFrame:
    """The observer of every gain fed with the recorded motion, without and with noise on the momentum."""
    part = recording.between(config.push.start - 0.5, config.push.start + config.push.duration + 0.5)
    positions, rates, torques = (recording[f"{ARM}.{name}"][part] for name in ("position", "velocity", "torque"))
    model = RigidBodyModel(gripper_arm(config.gripper))
    masses = [model.mass_matrix(q) for q in positions]
    biases = [model.bias(q, dq) for q, dq in zip(positions, rates)]
    model.close()
    noise = config.sweep.momentum_noise * rng.standard_normal(rates.shape)
    noisy = [dq + np.linalg.solve(mass, e) for mass, dq, e in zip(masses, rates, noise)]
    time, truth = recording.time[part], recording["external"][part]
    pushed = (time >= config.push.start) & (time <= config.push.start + config.push.duration)
    rows = []
    for gain in config.sweep.gains:
        row = {"gain": gain}
        for name, velocities in (("clean", rates), ("noisy", noisy)):
            observer = MomentumObserver(gain=gain, dt=config.step)
            zero = [np.zeros(7), *torques[:-1]]
            seen = np.array([observer(*values) for values in zip(masses, velocities, biases, zero)])
            row[f"{name}_error"] = rms((seen - truth)[pushed]) / rms(truth[pushed])
            if name == "clean":
                row["lag"] = _lag(time, truth, seen, config)
        rows.append(row)
    return pd.DataFrame(rows)


def _lag(time: Array, truth: Array, seen: Array, config: Config) -> float | None:
    """Delay [s] with which the observed torque of the most loaded joint reaches half of its plateau."""
    plateau = (time >= config.push.start + 0.5) & (time <= config.push.start + config.push.duration - 0.2)
    joint = int(np.abs(truth[plateau]).mean(axis=0).argmax())
    half = 0.5 * truth[plateau][:, joint].mean()
    rising = time >= config.push.start
    before = seen[time < config.push.start][:, joint].mean()
    crossings = []
    for signal in (truth[rising, joint], seen[rising, joint] - before):
        above = np.abs(signal) >= abs(half)
        if not above.any():
            return None
        index = int(above.argmax())
        share = (abs(half) - abs(signal[index - 1])) / (abs(signal[index]) - abs(signal[index - 1])) if index else 1.0
        crossings.append(time[rising][index] - (1 - share) * config.step)
    return float(crossings[1] - crossings[0])


def measure(recording: Recording, config: Config) -> Metrics:
    push, time = config.push, recording.time
    release = push.start + push.duration
    before, during = recording.between(push.start - 0.5, push.start), recording.between(push.start, release)
    after = recording.between(release)
    truth, seen = recording["external"], recording["observed"]
    change = seen - seen[before].mean(axis=0)
    distance, error = recording["rcm_distance"], recording["error"]
    rest, peak = float(distance[before].mean()), float(distance[during | after].max())
    metrics = reach_metrics(recording, config)
    size = rms(truth[during])
    metrics.update(
        observer_error=rms((seen - truth)[during]) / size,
        observer_change_error=rms((change - truth)[during]) / size,
        observer_lag=(lag := _lag(time, truth, seen, config)),
        observer_lag_ratio=None if lag is None else lag * float(np.max(config.observer.gain)),
        torque_peak=float(np.abs(truth).max()),
        rcm_rest=rest,
        rcm_peak=peak,
        rcm_final=float(distance[-200:].mean()),
        error_peak=float(error[during | after].max()),
        rcm_recovery_time=_recovery(time[after], distance[after], rest + 0.1 * (peak - rest) + 1e-4, release),
    )
    if "sweep" in recording.frames:
        table = recording.frames["sweep"]
        for gain, row in zip(config.sweep.gains, table.to_dict("records")):
            metrics.update({f"{name}_{gain:g}": row[key] for name, key in SWEPT.items()})
    return metrics


def _recovery(time: Array, distance: Array, bound: float, release: float) -> float | None:
    """Time after the release [s] from which the distance stays within the bound; None if it never does."""
    outside = np.flatnonzero(distance > bound)
    if len(outside) and outside[-1] == len(distance) - 1:
        return None
    return float(time[outside[-1]] - release) if len(outside) else 0.0
