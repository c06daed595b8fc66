"""A two-link arm without a known model tracks a circle inside hard error bounds, with and without joint friction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter8.task import TaskController, beyond, circle, joint_angles, two_link
from dexrepro.control.barrier_tracking import BarrierTracking
from dexrepro.control.dynamics_networks import dynamics_networks
from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.physics.elements import JointLoad, joint_friction
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World

RATE = 100.0


def scene(config: Config) -> World:
    """The arm in a vertical plane (gravity along -y), its end point at the start."""
    world = World(step=config.step, gravity=(0.0, -config.gravity, 0.0), perturbation=config.perturbation)
    world.add_arm("arm", two_link(config.arm), joint_angles(config.arm, config.start))
    if config.friction.coulomb or config.friction.viscous:
        world.add(JointLoad("arm", joint_friction(config.friction.viscous, config.friction.coulomb, config.friction.width)))
    return world


def simulate(config: Config, rng: Callable[[str], np.random.Generator]) -> Recording:
    gravity = (0.0, -config.gravity, 0.0)
    arm = two_link(config.arm)
    model = RigidBodyModel(arm, gravity)
    law = config.laws[config.law]
    if config.law == "hinfinity":
        law = law(RigidBodyModel(arm, gravity, mass_error=config.model_error))
    controller = TaskController(law, circle(config.path), model)
    probes: dict[str, Callable[[], Any]] = {
        "reference": lambda: controller.reference.position,
        "error": lambda: controller.error,
    }
    if isinstance(law, BarrierTracking):
        probes |= {
            "nodes": lambda: law.nodes,
            "network_force": lambda: law.network_force,
            "feature_power": lambda: law.feature_power,
        }
    with scene(config) as world:
        return world.run(
            config.duration,
            controllers={"arm": controller},
            probes=probes,
            stop=beyond(controller, config.bound),
        )


def measure(recording: Recording, config: Config) -> Metrics:
    error = recording["error"]
    bound = np.array(config.bound)
    steady = error[recording.between(config.settled)]
    rms = np.sqrt(np.mean(steady**2, axis=0)) if len(steady) else (None, None)
    return {"max_x": np.abs(error).max(0)[0], "max_y": np.abs(error).max(0)[1], "rms": rms}
