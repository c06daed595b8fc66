"""The arm that holds the pen: its scene, the reference along a path and the run under a tracking law."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from dexrepro.control.prescribed_performance import PerformanceBound
from dexrepro.experiment import Config, Recording
from dexrepro.networks import AdaptiveNetwork, Gaussians
from dexrepro.physics.elements import JointLoad, TipForce, joint_friction
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.world import World
from dexrepro.primitives import Demonstration
from dexrepro.robots.pen_arm import pen, pen_arm
from dexrepro.robots.pen_kinematics import pen_arm_angles

Reference = tuple[Any, Any, Any]


def on_paper(path: Any) -> Any:
    """Tip positions (N, 3) [m] for a letter (N, 2) [cm]: to the right is -y, up on the paper is away from the arm."""
    return np.stack([0.145 + 0.008 * path[:, 1], -0.01 * (path[:, 0] - 2.0), np.full(len(path), -0.10)], axis=1)


def over_table(path: Any) -> Any:
    """Tip positions (..., 3) [m] for a crossing (..., 3) [cm]."""
    path = np.asarray(path)
    return np.stack([0.17 + 0.01 * path[..., 1], -0.01 * path[..., 0], -0.10 + 0.01 * path[..., 2]], axis=-1)


def from_table(tip: Any) -> Any:
    """The inverse of ``over_table``."""
    tip = np.asarray(tip)
    return 100 * np.stack([-tip[..., 1], tip[..., 0] - 0.17, tip[..., 2] + 0.10], axis=-1)


def reference(tip: Any, step: float) -> Reference:
    """Joint angles, rates and accelerations (N, 3) each for a tip path (N, 3) [m] sampled every ``step`` [s]."""
    time = step * np.arange(len(tip))
    angles = Demonstration.of(time, pen_arm_angles(tip), at_rest=False)
    return angles.position, angles.velocity, angles.acceleration


def world(config: Config, start: Any) -> World:
    """The arm at joint angles ``start`` [rad], with friction in its joints and drag at its tip."""
    result = World(step=config.step, perturbation=config.perturbation)
    sensor = Sensor(
        encoder_resolution=config.sensing.resolution, velocity_cutoff=config.sensing.velocity_cutoff or np.inf
    )
    result.add_arm("arm", pen_arm(tool=pen(config.arm.pen_mass), effort=config.arm.torque_limit), start, sensor=sensor)
    result.add(JointLoad("arm", joint_friction(config.arm.viscous, config.arm.coulomb)))
    if config.arm.drag:
        result.add(TipForce("drag", "arm", _drag(config.arm.drag)))
    return result


def _drag(size: float) -> Callable[[float, Any, Any], Any]:
    """The paper holds the pen back with a force [N] that needs a few mm/s to build up."""

    def law(_: float, __: Any, velocity: Any) -> tuple[float, float, float]:
        x, y, _ = velocity.tolist()
        factor = -size / (np.hypot(x, y) + 0.005)
        return factor * x, factor * y, 0.0

    return law


def model(config: Config) -> RigidBodyModel:
    """What the laws know: the arm with other masses."""
    return RigidBodyModel(pen_arm(tool=pen(config.arm.pen_mass)), mass_error=config.model_mass - 1.0)


def network(config: Config, target: Reference, rng: np.random.Generator, nodes: int | None = None) -> AdaptiveNetwork:
    """Gaussian nodes scattered along a reference, weights zero."""
    centres = node_centres(config, target, rng, config.network.nodes if nodes is None else nodes)
    return AdaptiveNetwork(
        Gaussians(centres, np.sqrt(2.0)),
        3,
        gain=config.network.gain,
        leakage=config.network.gain * config.network.leakage,
        step=config.step,
    )


def node_centres(config: Config, target: Reference, rng: np.random.Generator, nodes: int) -> Any:
    """Centres (nodes, 6) in the scaled input [q / 0.35, q' / 1.2]."""
    samples = np.linspace(0, len(target[0]) - 1, nodes).round().astype(int)
    scaled = np.concatenate([target[0] / 0.35, target[1] / 1.2], axis=1)
    return scaled[samples] + config.network.scatter * rng.standard_normal((nodes, 6))


def track(config: Config, target: Reference, law: Any, nominal: RigidBodyModel) -> Recording:
    """Run the arm along a reference under ``law``, from the configured initial joint error.

    Records ``error`` e = q_d - q [rad], ``velocity_error`` [rad/s] and ``goal`` (the reference's tip) beside the
    World's channels.
    """
    position, velocity, acceleration = target
    step, share = config.step, config.contact_estimate

    def controller(sense: Any) -> Any:
        k = round(sense.time / step)
        contact = share * nominal.jacobian(sense.position)[:3].T @ sense.force if config.arm.drag else 0.0
        return law(sense.position, sense.velocity, (position[k], velocity[k], acceleration[k]), contact)

    probes = {"velocity_error": lambda: law.velocity_error}
    with world(config, position[0] - np.array(config.initial_error)) as scene:
        recording = scene.run((len(position) - 1) * step, {"arm": controller}, probes=probes, on_divergence="stop")
    count = len(recording.time)
    recording.series["desired"] = position[:count]
    recording.series["error"] = position[:count] - recording["arm.position"]
    return recording


def bound(config: Config) -> PerformanceBound:
    return PerformanceBound(**config.bound)
