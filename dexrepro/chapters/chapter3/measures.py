"""Numbers read off a reach through the opening."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array
from dexrepro.chapters.chapter3.scene import ARM, distance_to_centre, gripper_arm
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms


def add_distances(recording: Recording, config: Config, centres: Array) -> None:
    """Add what the book plots: ``error``, the distance of the tip to the target, and ``rcm_distance``, Dis_R [m]."""
    recording.series["error"] = np.linalg.norm(recording[f"{ARM}.tip"] - np.array(config.target), axis=1)
    positions = recording[f"{ARM}.position"]
    recording.series["rcm_distance"] = distance_to_centre(gripper_arm(config.gripper), positions, centres)


def reach_metrics(recording: Recording, config: Config) -> Metrics:
    """Errors and distances [m] of one run; "inside" is everything after the tip has reached the opening."""
    arm, positions = gripper_arm(config.gripper), recording[f"{ARM}.position"]
    inside = recording.between(config.phases[0])
    distance, contact = recording["rcm_distance"], recording["contact"]
    finished = recording.status.startswith("finished") and bool(inside.any())
    return {
        "final_position_error": last(recording["error"]) if finished else None,
        "tracking_error_max": float(recording["tracking"].max()),
        "tracking_error_inside": rms(recording["tracking"][inside]) if finished else None,
        "rcm_distance_max": float(distance[inside].max()) if finished else None,
        "rcm_distance_mean": float(distance[inside].mean()) if finished else None,
        "rcm_distance_final": last(distance) if finished else None,
        "contact_time": float((contact[:, 0] > 0).sum() * config.step),
        "contact_force_max": float(contact[:, 1].max()),
        "clearance": float(contact[:, 2].min()),
        "node_count": int(recording["nodes"][-1]),
        "joint_speed_max": float(np.abs(recording[f"{ARM}.velocity"]).max()),
        "limit_margin": float(min((positions - arm.lower).min(), (arm.upper - positions).min())),
        "finished": int(finished),
    }


COLUMNS = {
    "final_position_error": "end error [m]",
    "tracking_error_max": "largest tracking error [m]",
    "tracking_error_inside": "tracking error inside, rms [m]",
    "rcm_distance_max": "largest Dis_R [m]",
    "rcm_distance_mean": "mean Dis_R [m]",
    "rcm_distance_final": "final Dis_R [m]",
    "contact_time": "contact [s]",
    "contact_force_max": "largest contact force [N]",
    "clearance": "clearance [m]",
    "node_count": "nodes",
    "joint_speed_max": "largest joint speed [rad/s]",
    "limit_margin": "margin to the joint limits [rad]",
    "moving_distance_max": "largest Dis_R, moving [m]",
    "moving_distance_mean": "mean Dis_R, moving [m]",
    "moving_error_max": "largest end error, moving [m]",
    "centre_speed_max": "largest speed of the opening [m/s]",
    "excursion": "excursion of the opening [m]",
    "observer_error": "observer error [-]",
    "observer_change_error": "observer error of the change [-]",
    "observer_lag": "observer lag [s]",
    "rcm_rest": "Dis_R at rest [m]",
    "rcm_peak": "peak Dis_R [m]",
    "rcm_final": "Dis_R in the end [m]",
    "rcm_recovery_time": "recovery [s]",
    "error_peak": "peak end error [m]",
}
"""What the metrics are called in tables, with their units."""


def headed(rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """A table of metrics under the names of :data:`COLUMNS`, lengths in mm."""
    table = pd.DataFrame(rows).rename(columns=COLUMNS)
    lengths = [name for name in map(str, table) if name.endswith(" [m]")]
    for name in lengths:
        table[name] = 1e3 * table[name].astype(float)
    return table.rename(columns={name: name.replace(" [m]", " [mm]") for name in lengths})


def last(values: Array) -> float:
    """Mean of the last 100 samples."""
    return float(values[-100:].mean())
