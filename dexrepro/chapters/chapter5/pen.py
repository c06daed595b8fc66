"""The arm that holds the pen: its scene, the reference along a path and the run under a tracking law."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from dexrepro.control.bounded_neural import barrier
from dexrepro.control.contract import Law, channels
from dexrepro.control.motion import Sampled
from dexrepro.control.prescribed_performance import PerformanceBound
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms
from dexrepro.networks import AdaptiveNetwork, Gaussians
from dexrepro.physics.drive import JointDrive
from dexrepro.physics.elements import JointLoad, TipForce, joint_friction
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.world import World
from dexrepro.primitives import Demonstration
from dexrepro.robots.arm import Shape, Tool
from dexrepro.robots.pen_arm import DARK, LENGTH, WHITE, pen, pen_arm, pen_arm_angles, pen_arm_tip

SETTLED = 1.0  # s, from here on errors count as settled
HEIGHT = -0.10  # m, of paper and table below the arm's shoulder


def on_paper(path: Any) -> Any:
    """Tip positions (N, 3) [m] for a letter (N, 2) [cm]: to the right is -y, up on the paper is away from the arm."""
    return np.stack([0.145 + 0.008 * path[:, 1], -0.01 * (path[:, 0] - 2.0), np.full(len(path), HEIGHT)], axis=1)


def from_paper(tip: Any) -> Any:
    """The inverse of ``on_paper``."""
    return np.stack([2.0 - 100 * tip[:, 1], (tip[:, 0] - 0.145) / 0.008], axis=1)


def over_table(path: Any) -> Any:
    """Tip positions (..., 3) [m] for a crossing (..., 3) [cm]."""
    path = np.asarray(path)
    return np.stack([0.17 + 0.01 * path[..., 1], -0.01 * path[..., 0], HEIGHT + 0.01 * path[..., 2]], axis=-1)


def from_table(tip: Any) -> Any:
    """The inverse of ``over_table``."""
    return 100 * np.stack([-tip[..., 1], tip[..., 0] - 0.17, tip[..., 2] - HEIGHT], axis=-1)


def reference(tip: Any, step: float) -> Sampled:
    """The joints' motion for a tip path (N, 3) [m] sampled every ``step`` [s]."""
    angles = Demonstration.of(step * np.arange(len(tip)), pen_arm_angles(tip), at_rest=False)
    return Sampled(step, angles.position, angles.velocity, angles.acceleration)


def world(config: Config, start: Any) -> World:
    """The arm at joint angles ``start`` [rad], with friction in its joints and drag at its tip."""
    settings = config.arm
    result = World(step=settings.step, perturbation=config.perturbation)
    cutoff = np.inf if settings.velocity_cutoff is None else settings.velocity_cutoff
    sensor = Sensor(encoder_resolution=settings.resolution, velocity_cutoff=cutoff)
    result.add_arm("arm", pen_arm(tool=_pen(settings.pen_mass), effort=settings.torque_limit), start, sensor=sensor)
    result.add(JointLoad("arm", joint_friction(settings.viscous, settings.coulomb)))
    if settings.drag:
        result.add(TipForce("drag", "arm", _drag(settings.drag)))
    return result


def _pen(mass: float) -> Tool:
    """The pen in line with the forearm, which is shown that much shorter; its mass sits at the point."""
    forearm = Shape.between((-LENGTH, 0, 0), (-0.035, 0, 0), 0.01, WHITE)
    return replace(
        pen(mass), shapes=(forearm, Shape.between((-0.035, 0, 0), (0, 0, 0), 0.003, DARK)), replaces=("forearm",)
    )


def _drag(size: float) -> Callable[[float, Any, Any], Any]:
    """The paper holds the pen back with a force [N] that needs a few mm/s to build up."""

    def law(_: float, __: Any, velocity: Any) -> tuple[float, float, float]:
        x, y, _ = velocity.tolist()
        factor = -size / (np.hypot(x, y) + 0.005)
        return factor * x, factor * y, 0.0

    return law


def model(config: Config) -> RigidBodyModel:
    """What the laws know: the arm with other masses."""
    return RigidBodyModel(pen_arm(tool=pen(config.arm.pen_mass)), mass_error=config.arm.model_mass - 1.0)


def node_centres(config: Config, target: Sampled, nodes: int, rng: np.random.Generator) -> Any:
    """Centres (nodes, 6) scattered along a reference, in the scaled input [q / 0.35, q' / 1.2] of the law."""
    samples = np.linspace(0, len(target) - 1, nodes).round().astype(int)
    return _inputs(target)[samples] + config.network.scatter * rng.standard_normal((nodes, 6))


def _inputs(target: Sampled) -> Any:
    """The network's input (N, 6) along a reference."""
    return np.concatenate([target.position / 0.35, target.velocity / 1.2], axis=1)


def network(config: Config, centres: Any, target: Sampled) -> AdaptiveNetwork:
    """exp(-|z - c|^2 / 2) at the centres; dW/dt = gain (S delta^T - leakage W).

    ``integrator``: one constant node in their place, at their mean |S|^2 along the reference times the gain and the
    same rate of forgetting, so that the network is an integral of the velocity error and nothing else is changed.
    """
    gain, forgetting = config.network.gain, config.network.gain * config.network.leakage
    nodes = Gaussians(centres, np.sqrt(2.0))
    if config.network.integrator:
        gain *= np.mean([np.sum(nodes(z) ** 2) for z in _inputs(target)[::10]])
        nodes = Gaussians(np.zeros((1, 6)), 1e9)
    return AdaptiveNetwork(nodes, 3, gain=gain, leakage=forgetting, step=config.arm.step)


def track(config: Config, target: Sampled, law: Law, nominal: RigidBodyModel) -> Recording:
    """Run the arm along a reference from the configured initial joint error.

    Records ``desired`` joint angles, ``error`` e = q_d - q [rad] and, if the law reports it, ``velocity_error`` delta
    beside the World's channels.
    """
    position, share = target.position, config.arm.contact_estimate if config.arm.drag else 0.0

    def contact(sense: Sense) -> Any:
        return share * (sense.force @ nominal.jacobian(sense.position)[:3])

    controller = JointDrive(law, target, contact if share else None)
    probes = channels(law, "velocity_error")
    duration = (len(position) - 1) * config.arm.step
    with world(config, position[0] - np.array(config.arm.initial_error)) as scene:
        recording = scene.run(duration, {"arm": controller}, probes=probes, on_divergence="stop")
    recording.series["desired"] = position[: len(recording.time)]
    recording.series["error"] = recording["desired"] - recording["arm.position"]
    return recording


def bound_use(recording: Recording, config: Config) -> Any:
    """Largest share of the bound that a joint error uses, (N,); below 1 inside. For live and plain configurations."""
    bound = config.bound
    if isinstance(bound, dict):
        bound = PerformanceBound(**{key: value for key, value in bound.items() if key != "_target_"})
    return np.abs(bound.usage(recording["error"], bound.nu(recording.time)[:, None])).max(axis=1)


def quality(recording: Recording, config: Config) -> Metrics:
    """How the run kept to its reference: share of the bound used, errors from ``SETTLED`` on, torque, Lyapunov."""
    error, late = recording["error"], recording.between(SETTLED)
    usage = bound_use(recording, config)
    tip = np.linalg.norm(pen_arm_tip(recording["desired"]) - recording["arm.tip"], axis=1)
    torque = recording["arm.torque"]
    return {
        "bound_use": float(usage.max()),
        "outside": float(np.mean(usage > 1)),
        "error_rms": rms(1e3 * np.linalg.norm(error[late], axis=1)),
        "tip_rms": rms(1e3 * tip[late]),
        "torque_max": float(np.abs(torque).max()),
        "torque_step": rms(np.diff(torque[late], axis=0)),
        **_lyapunov(recording, config),
    }


def _lyapunov(recording: Recording, config: Config) -> Metrics:
    """rho V_1 + V_2 with the plant's own mass matrix (a measurement, no law sees it), relative to its start."""
    if "velocity_error" not in recording:
        return {"lyapunov_peak": None, "lyapunov_late": None}
    every = slice(None, None, 20)
    time, delta = recording.time[every], recording["velocity_error"][every]
    plant = RigidBodyModel(pen_arm(tool=pen(config.arm.pen_mass)))
    masses = np.array([plant.mass_matrix(q) for q in recording["arm.position"][every]])
    kinetic = 0.5 * np.einsum("ni,nij,nj->n", delta, masses, delta)
    value = config.barrier_weight * barrier(recording["error"][every], config.bound, time) + kinetic
    if not np.isfinite(value).all():
        return {"lyapunov_peak": None, "lyapunov_late": None}
    late = value[time >= 2]
    return {
        "lyapunov_peak": float(value.max() / value[0]),
        "lyapunov_late": float(late.max() / value[0]) if late.size else None,
    }
