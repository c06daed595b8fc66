"""Algebra of the relative pose transformation and of the facing orientation, Sections 1.3.1 to 1.3.3.

No robot moves here: random poses test the identities, a minimum-jerk hand movement tests the scaling.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Rng
from dexrepro.control.facing import facing, quaternion_from_rotation_printed
from dexrepro.control.pose_transformation import ConstantScaling, RelativePose, SpeedScaling
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.operator import strides
from dexrepro.robots.rotations import quaternion_from_euler, quaternion_from_rotation, rotation_from_quaternion

RATE = 1000.0


def simulate(config: Config, rng: Rng) -> Recording:
    draws = rng("poses")
    frames = {"errors": _identities(config, draws), "moves": _moves(config)}
    quaternions = quaternion_from_rotation(Rotation.random(3, random_state=draws).as_matrix())
    frames["triads"] = pd.DataFrame(
        np.vstack([rotation_from_quaternion(q).reshape(-1, 9) for q in (quaternions, facing(quaternions))])
    )
    return Recording(frames=frames, steps=config.samples)


def _identities(config: Config, draws: np.random.Generator) -> pd.DataFrame:
    """Largest residuals of the identities over random poses [-], or [rad] for angles."""
    n = config.samples
    rotations = Rotation.random(n, random_state=draws).as_matrix()
    q = quaternion_from_rotation(rotations)
    start = time.perf_counter()
    faced = facing(q)
    cost = (time.perf_counter() - start) / n
    angles = draws.uniform(-np.pi, np.pi, (n, 3))
    euler = quaternion_from_euler(angles + [np.pi, 0, 0]) - facing(quaternion_from_euler(angles))
    axes = draws.normal(size=(1000, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    jump, residual = _fixings(draws)
    return pd.DataFrame(
        [
            {
                "facing": np.abs(rotation_from_quaternion(faced) - rotations * [1.0, -1.0, -1.0]).max(),
                "orthogonal": np.abs(np.sum(q * faced, axis=1)).max(),
                "euler": np.abs(euler).max(),
                "half_turn_printed": _half_turns(axes, np.pi, quaternion_from_rotation_printed),
                "half_turn": _half_turns(axes, np.pi, quaternion_from_rotation),
                "near_half_turn_printed": _half_turns(axes, np.pi - 0.1, quaternion_from_rotation_printed),
                "radicand": _radicand(axes),
                "fixing_jump": jump,
                "fixing_rotation": residual,
                "microseconds": 1e6 * cost,
            }
        ]
    )


def _half_turns(axes: Any, angle: float, convert: Any) -> float:
    """Largest angle [rad] between rotations about ``axes`` and their way through a quaternion."""
    rotations = Rotation.from_rotvec(angle * axes)
    q = convert(rotations.as_matrix())
    back = Rotation.from_matrix(rotation_from_quaternion(q / np.linalg.norm(q, axis=1, keepdims=True)))
    return float((back.inv() * rotations).magnitude().max())


def _radicand(axes: Any) -> float:
    """Share of half-turns whose radicand 1 + trace comes out as 0 or less in floating point."""
    matrices = Rotation.from_rotvec((np.pi - 1e-8) * axes).as_matrix()
    return float(np.mean(1.0 + np.trace(matrices, axis1=1, axis2=2) <= 0.0))


def _fixings(draws: np.random.Generator) -> tuple[float, float]:
    """Largest jump of the tool at 1000 re-fixings, and largest deviation of its later rotation from the leader's."""
    jump = residual = 0.0
    for _ in range(1000):
        frame, before, after, tool = Rotation.random(4, random_state=draws).as_matrix()
        pose = RelativePose(scaling=ConstantScaling(factor=3.0), dt=0.01, leader_to_follower=frame)
        hand, place = draws.normal(size=3), draws.normal(size=3)
        pose.reset(hand, before, place, tool)
        position, rotation = pose(hand, before)
        jump = max(jump, np.abs(rotation - tool).max(), np.abs(position - place).max())
        turned = pose(hand, after)[1] @ tool.T
        residual = max(residual, np.abs(turned - frame @ after @ before.T @ frame.T).max())
    return float(jump), float(residual)


def _moves(config: Config) -> pd.DataFrame:
    """Tool displacement [m] of a hand movement for both readings of Eq. (1.11) with s(v)."""
    rows, dt = [], config.control_period
    for duration in config.move_durations:
        n = round(duration / dt)
        hand = config.move * np.r_[0.0, strides(n)]
        for incremental in (True, False):
            pose = RelativePose(scaling=SpeedScaling(), dt=dt, incremental=incremental)
            pose.reset(np.zeros(3), np.eye(3), np.zeros(3), np.eye(3))
            for k, x in enumerate(hand):
                tool = pose(np.array([x, 0.0, 0.0]), np.eye(3))[0][0]
                rows.append((duration, "incremental" if incremental else "total", k * dt, x, tool))
    return pd.DataFrame(rows, columns=["duration", "form", "time", "hand", "tool"])


def measure(recording: Recording, config: Config) -> Metrics:
    errors = recording.frames["errors"].drop(columns="microseconds")
    result: Metrics = {str(name): float(errors[name].iloc[0]) for name in errors}
    fastest = recording.frames["moves"].query(f"duration == {min(config.move_durations)}")
    for form, rows in fastest.groupby("form"):
        result[f"{form}_end"] = float(rows["tool"].iloc[-1])
        result[f"{form}_pull_back"] = float(rows["tool"].max() - rows["tool"].iloc[-1])
    speeds = np.linspace(0, 0.5, 501)
    scale = SpeedScaling()(speeds)
    rule = facing(np.eye(4))  # as a matrix, which says what the rule computes
    result |= {
        "multiplications": int(np.sum((rule != 0) & (np.abs(rule) != 1))),
        "additions": int(np.sum(np.maximum((rule != 0).sum(axis=0) - 1, 0))),
        "scale_least": float(scale[speeds <= 0.05].max()),
        "scale_most": float(scale[speeds >= 0.3].min()),
        "scale_steps_down": int(np.sum(np.diff(scale) < 0)),
    }
    return result
