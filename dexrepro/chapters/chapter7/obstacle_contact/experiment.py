"""The arm meets a stack that is taller than it was told, and is pushed: what variable impedance changes."""

from __future__ import annotations

import math

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter7 import desk
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.humans.reaching import Obstacle
from dexrepro.measures import rms
from dexrepro.physics.elements import Push
from dexrepro.physics.world import World
from dexrepro.robots.pen_arm import pen_arm_tip

RATE = 200.0


def scene(config: Config) -> World:
    """The arm, the board and the stack, which is taller than the arm was told."""
    world = desk.build(config, desk.to_robot(np.array([*config.task.start, 0.0])), contacts=True)
    stack = Obstacle(config.task.obstacle, config.task.height + config.rise, config.scene.cube)
    desk.furnish(world, stack, cube=False)
    return world


def simulate(config: Config, rng: Rng) -> Recording:
    task, reference = desk.planned(config)
    with desk.build(config, reference.tip[0], contacts=True) as world:
        stack = Obstacle(task.obstacle.position, task.obstacle.height + config.rise, task.obstacle.side)
        desk.add_stack(
            world,
            stack,
            contactStiffness=config.contact.stiffness,
            contactDamping=config.contact.damping,
            friction=config.contact.friction,
        )
        world.add(Push("arm", lambda t: (0.0, config.push_force if pushed(config, t) else 0.0, 0.0)))
        probes = {"contact": lambda: world.contact_force("arm", "stack")}
        recording = desk.run(config, reference, world, probes=probes)
    recording.series["predicted"] = np.full(len(recording.time), predicted_deviation(recording, config))
    return recording


def pushed(config: Config, time: float) -> bool:
    return any(start <= time < end for start, end in config.pushes.values())


def predicted_deviation(recording: Recording, config: Config) -> float:
    """Deviation [mm] J (K k)^-1 J^T F of the last posture under the push without estimation, friction left out.

    nan for a law that reports no impedance.
    """
    angles, nudge = recording["reference"][-1], 1e-6
    steps = nudge * np.eye(3)
    jacobian = (pen_arm_tip(angles + steps) - pen_arm_tip(angles - steps)).T / (2 * nudge)
    if "impedance" not in recording:
        return math.nan
    compliance = jacobian @ np.diag(1 / (recording["impedance"][-1] * config.error_slope)) @ jacobian.T
    return float(1e3 * np.linalg.norm(compliance @ (0.0, config.push_force, 0.0)))


def measure(recording: Recording, config: Config) -> Metrics:
    force = recording["contact"]
    touching = force > 1e-3
    free = recording["arm.tip"] - recording["planned"]
    deviation = {}
    for name, (start, end) in config.pushes.items():
        before = free[np.searchsorted(recording.time, start) - 1]
        during = recording.between(start, min(end, recording.time[-1]))
        deviation[f"{name}_push"] = 1e3 * float(np.linalg.norm(free[during] - before, axis=1).max())
    last = 1e3 * float(np.linalg.norm(free[-1] - free[np.searchsorted(recording.time, config.pushes["rest"][0]) - 1]))
    return {
        **deviation,
        "static_deviation": last,
        "predicted_deviation": float(recording["predicted"][0]),
        "compliance_ratio": last / float(recording["predicted"][0]),
        "contact_peak": float(force.max()),
        "contact_impulse": float(force.sum() * config.control_period),
        "contact_time": float(touching.sum() * config.control_period),
        "rms_error": rms(desk.tip_error(recording)),
        "largest_torque": float(np.abs(recording["arm.torque"]).max()),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Relative spread of the peak contact force over the impedances, with and without estimation."""
    peaks: dict[str, list[float]] = {"estimated": [], "plain": []}
    for case, values in metrics.items():
        peaks["estimated" if config.cases[case].law.get("estimation", True) else "plain"].append(
            values["contact_peak"] or 0.0
        )
    return {f"{name}_spread": float(np.ptp(values) / np.mean(values)) for name, values in peaks.items() if any(values)}
