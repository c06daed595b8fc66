"""The simulated platform: poses of the planar arms, the leader's paths, the force of an offset (Sect. 2.4.1)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2.planar_pair import path
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.robots.planar import PlanarChain


def simulate(config: Config, rng: Rng) -> Recording:
    arms = []
    for pose, follower in (("a", config.follower.pose_a), ("b", config.follower.pose_b)):
        for arm, base, q in (
            ("leader", config.leader.base, config.leader.pose),
            ("follower", config.follower.base, follower),
        ):
            links = PlanarChain(config.lengths, config.masses, base).links([angle + config.perturbation for angle in q])
            x, y = (np.cumsum([base[axis], *links[3 * axis : 3 * axis + 3]]) for axis in (0, 1))
            arms.append(pd.DataFrame({"pose": pose, "arm": arm, "x": x, "y": y}))
    paths = []
    for trajectory in (1, 2):
        shape = Config.of({"leader": {**config.leader, "trajectory": trajectory}, "period": config.period})
        points = np.array([path(shape)(t) for t in np.linspace(0, config.duration, 401)])
        paths.append(pd.DataFrame({"trajectory": trajectory, "x": points[:, 0], "y": points[:, 1]}))
    frames = {"arms": pd.concat(arms), "paths": pd.concat(paths), "forces": _forces(config)}
    return Recording(frames=frames)


def _forces(config: Config) -> pd.DataFrame:
    """Force on the follower at the distance of the desired force along the line, for lateral offsets dy = y_1 - y_2."""
    offset = np.linspace(-0.1, 0.1, 201)
    along = config.rest_length - config.desired_force / config.stiffness
    length = np.hypot(along, offset)
    push = np.maximum(config.stiffness * (config.rest_length - length), 0.0)
    central = {"central_x": push * along / length, "central_y": push * offset / length}
    constant = {"constant_x": np.full_like(offset, config.desired_force), "constant_y": -config.stiffness * offset}
    return pd.DataFrame({"offset": offset, **central, **constant})


def measure(recording: Recording, config: Config) -> Metrics:
    arms, forces = recording.frames["arms"], recording.frames["forces"]
    tips = {(pose, arm): rows.iloc[-1] for (pose, arm), rows in arms.groupby(["pose", "arm"])}
    below = forces.iloc[90]  # the follower 10 mm below its partner
    result: Metrics = {}
    for pose in "ab":
        result[f"tip_x_{pose}"] = float(tips[pose, "follower"]["x"])
        result[f"offset_{pose}"] = float(tips[pose, "follower"]["y"] - tips[pose, "leader"]["y"])
    return result | {f"lateral_force_{model}": float(below[f"{model}_y"]) for model in ("central", "constant")}
