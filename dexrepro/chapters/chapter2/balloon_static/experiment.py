"""Finding the holding position from two wrong starts, the partner at rest, on Baxter (Sect. 2.4.2.1)."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter2 import balloon_pair
from dexrepro.chapters.chapter2.measures import mean
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import last_outside, rms
from dexrepro.physics.rendering import Camera

RATE = 50.0
SETTLED = 20.0  # s

scene = balloon_pair.scene
stage = balloon_pair.stage


def simulate(config: Config, rng: Rng) -> Recording:
    rest = np.zeros(3)
    recording = balloon_pair.run(config, rng, lambda t: rest)
    with scene(config) as world:
        contact = recording["follower.tip"][np.searchsorted(recording.time, 0.0) - 1]
        middle, colour = (contact + recording["leader.tip"][0]) / 2, (0.95, 0.55, 0.15, 1.0)
        world.add_sphere("balloon", config.rest_length / 2 - 0.02, middle, colour=colour, collides=False)
        camera = Camera(target=(0.35, 0.05, 0.22), distance=1.35, yaw=125.0, pitch=-18.0)
        recording.images["contact"] = world.snapshot(recording, 0.0, camera, (900, 700))
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    held, settled = recording.between(0), recording.between(SETTLED)
    last = recording.time > recording.time[-1] - 5
    time, tip, force = recording.time[held], recording["follower.tip"], recording["follower.force"]
    lateral = np.hypot(*(tip - recording["leader.tip"])[:, [0, 2]].T)
    sideways = np.abs(force[:, [0, 2]]).max(axis=1)
    return {
        "lateral_offset": float(lateral[-1]),
        "alignment_time": last_outside(time, lateral[held], 5e-3),
        "lateral_force_time": last_outside(time, sideways[held], 0.1),
        "largest_lateral_force": float(sideways[held].max()),
        "force_along": mean(force[last, 1]),
        "settling_time": last_outside(time, force[held, 1] - config.desired_force, 0.05 * config.desired_force),
        "rmse": rms(recording["object.force"][settled] - config.desired_force),
        "overshoot": float(force[held, 1].max() - config.desired_force),
        "contact_y": float(tip[held][0, 1]),
        **{f"final_{axis}": float(value) for axis, value in zip("xyz", tip[last].mean(axis=0))},
        "largest_torque": float(np.abs(recording["follower.torque"]).max()),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Distance [m] between the places that the two starts lead to, with and without the regulation."""
    result: Metrics = {}
    for name, start in (("destination_spread", "off"), ("unregulated_spread", "unregulated")):
        found = [metrics[case] for case in (f"{start}_80", f"{start}_100") if case in metrics]
        if len(found) == 2:
            places = np.array([[values[f"final_{axis}"] for axis in "xyz"] for values in found], dtype=float)
            result[name] = float(np.linalg.norm(np.ptp(places, axis=0)))
    return result
