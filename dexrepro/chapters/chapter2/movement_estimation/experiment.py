"""Estimating an unseen partner's movement from the contact force alone (Sect. 2.4.1.2)."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2 import planar_pair
from dexrepro.chapters.chapter2.measures import force_error, mean
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import last_outside, rms
from dexrepro.physics.drive import HoldingDrive

RATE = 50.0
SETTLED = 20.0  # s, from here on a run counts as settled

scene = planar_pair.scene


def simulate(config: Config, rng: Rng) -> Recording:
    recording = planar_pair.simulate(config)
    # What the book plots as x_c: exact while the two tips stay on the holding line.
    recording.series["rest_position"] = config.rest_length + recording["leader.tip"][:, 0]
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    time, late, early = recording.time, recording.between(SETTLED), recording.between(0, 10)
    force, desired = recording["follower.force"][:, 0], config.desired_force
    rest, stiffness, velocity = recording.series.get("estimate", np.full((time.size, 3), np.nan)).T
    error = rest - recording["rest_position"]
    residual = error - desired * (1 / stiffness - 1 / config.stiffness)
    true_velocity = np.gradient(recording["rest_position"], time) if time.size > 1 else np.zeros(time.size)
    return {
        "rmse": rms(force_error(recording, desired, SETTLED)),
        "settling_time": last_outside(time, force - desired, 0.05 * desired),
        "estimation_error": mean(error[late]),
        "predicted_offset": mean(desired * (1 / stiffness - 1 / config.stiffness)[late]),
        "residual": rms(residual[late]),
        "early_residual": rms(residual[early]),
        "convergence_time": last_outside(time, residual, 1e-3),
        "velocity_slope": _slope(true_velocity[late], velocity[late]),
        "held": recording.simulated,
        "smallest_stiffness": float(stiffness.min()),
        "replay_difference": _replay(recording, config) if recording.status == "finished" else None,
    }


def _slope(true: Any, estimated: Any) -> float | None:
    """Regression slope of the estimated velocity of the rest position on the true one."""
    return float(true @ estimated / (true @ true)) if true.size else None


def _replay(recording: Recording, config: Config) -> float:
    """Largest difference [m] of the reference when the law alone is fed the arm's own position and force."""
    start = recording.between(0, 10)
    law, times = HoldingDrive(config.law), recording.time[start].tolist()
    positions, forces = (recording[f"follower.{name}"][start, 0].tolist() for name in ("tip", "force"))
    law.reset(times[0], positions[0])
    replayed = [law(*sample) for sample in zip(times, positions, forces)]
    return float(np.abs(np.array(replayed) - recording["reference"][start, 0]).max())


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """How the offset of the estimate scales from the desired force of the runs to one a tenth of it."""
    light, full = (metrics.get(case, {}).get("estimation_error") for case in ("light30", "sigma30"))
    return {"offset_ratio": light / full} if light and full else {}
