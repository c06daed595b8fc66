"""One search budget for every holding law of the Baxter experiment, on one axis of it (ours, for Sect. 2.4.2.2)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2.balloon_movement.experiment import path
from dexrepro.chapters.chapter2.batch import at, controlled_by, grouped_laws
from dexrepro.chapters.chapter2.gain_search import experiment as gain_search
from dexrepro.chapters.chapter2.measures import Array
from dexrepro.control.holding_reference import FadeIn
from dexrepro.experiment import Config, Recording
from dexrepro.physics.sensor import smoothing

measure = gain_search.measure
FADED = ("force", "force_integral", "passive_impedance")  # laws that would otherwise step at contact


def simulate(config: Config, rng: Rng) -> Recording:
    """Run every candidate along the holding line, against two balloons; candidate 0 is the default setting."""
    rows = [
        controlled_by(law, {**config.run, **setting, "object_stiffness": stiffness}) | labels
        for law, setting, labels in gain_search.candidates(config, rng("candidates"))
        for stiffness in config.stiffness
    ]
    runs = pd.DataFrame(rows).astype({"window": float})
    runs = runs.sort_values("law", kind="stable").reset_index(drop=True)
    with np.errstate(all="ignore"):
        runs["rmse"] = _force_rmse(runs, config, rng("force noise"))
    steps = len(runs) * round(config.duration / config.step)
    return Recording(frames={"candidates": gain_search.summary(runs, config)}, steps=steps)


def _force_rmse(runs: pd.DataFrame, config: Config, noise: np.random.Generator) -> Array:
    """Root mean square [N] after ``settled`` of each run: the gripper follows like the servo's joints."""
    dt, w, desired = config.step, config.servo.frequency, config.desired_force
    k = runs["object_stiffness"].to_numpy()
    kinds = runs["law"].to_numpy()
    laws = [(part, _faded(law, config) if kinds[part.start] in FADED else law) for part, law in grouped_laws(runs, dt)]
    for _, law in laws:
        law.reset(at(np.zeros(1), 0.0))
    position, velocity, reference, sensed = (np.zeros(len(runs)) for _ in range(4))
    square, share, steps = np.zeros(len(runs)), smoothing(config.sensor.cutoff, dt), round(config.duration / dt)
    partner = [path(config.path, i * dt)[1] for i in range(steps)]
    disturbance = config.sensor.noise * noise.standard_normal(steps)
    for i in range(steps):
        force = np.maximum(0.0, config.contact_force + k * (partner[i] - position))
        sensed += share * (force + disturbance[i] - sensed)
        for part, law in laws:
            reference[part] = law(at(position[part], sensed[part]))
        velocity += dt * (w * w * (reference - position) - 2 * w * velocity)
        position = position + dt * velocity
        if i * dt >= config.settled:
            square += (force - desired) ** 2
    result: Array = np.sqrt(square * dt / (config.duration - config.settled))
    return result


def _faded(law: Any, config: Config) -> FadeIn:
    run = config.run
    return FadeIn(law=law, desired_force=config.desired_force, smoothing_rate=run.fade_rate,
                  smoothing_power=run.smoothing_power, dt=config.step)  # fmt: skip
