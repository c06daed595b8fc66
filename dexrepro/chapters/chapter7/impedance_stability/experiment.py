"""How large the impedance may be: the sampled loop of the time-delay estimation, predicted and measured on the arm."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter7 import desk
from dexrepro.control.time_delay_impedance import sampled_spectral_radius
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording, changed
from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.pen_arm import gripper, pen_arm

RATE = 1000.0
CHATTER = 1.0  # N m of torque travel a joint; smooth runs have 0.15
FLOOR = 1e-4  # V / V(0) down to which V is judged: below is the noise of the estimate


def simulate(config: Config, rng: Rng) -> Recording:
    _, reference = desk.planned(config)
    with desk.build(config, reference.tip[0]) as world:
        recording = desk.run(config, reference, world, events=desk.payload_events(world, config))
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    metrics: Metrics = dict(desk.tracking_metrics(recording, config))
    metrics["predicted_radius"] = radius(recording, config)
    metrics["stable"] = int(bool(metrics["finished"]) and (metrics["torque_travel"] or 0.0) < CHATTER)
    if not metrics["stable"]:  # the size of a limit cycle changes with the last digits
        metrics["rms_error"] = metrics["largest_error"] = None
    if any(config.initial_error) and "filtered_error" in recording:
        metrics |= lyapunov_metrics(recording, config)
    else:
        early = recording.time < 0.1
        recording.series = {name: values[early] for name, values in recording.series.items()}
    return metrics


def radius(recording: Recording, config: Config) -> float:
    """Largest spectral radius along the planned path, with the cube in the gripper only while it is carried."""
    empty, period = config.arm.gripper_mass, config.control_period
    known = config.arm.model_gripper_mass
    nominal = RigidBodyModel(pen_arm(gripper(known) if known else None))
    true = {mass: RigidBodyModel(pen_arm(gripper(mass))) for mass in (empty, empty + config.arm.payload_mass)}
    radii = []
    for k in range(0, len(recording.time), 50):
        carried = config.pick <= recording.time[k] < config.release
        mass = true[empty + config.arm.payload_mass * carried].mass_matrix(recording["reference"][k])
        impedance = config.stiffness_gain * recording["stiffness"][k]
        radii.append(sampled_spectral_radius(mass, nominal.mass_matrix(recording["reference"][k]), impedance, period))
    return max(radii)


def lyapunov_metrics(recording: Recording, config: Config) -> Metrics:
    """V = r^T M r with the true inertia, Eq. (7.41): largest relative rise until it is a ten-thousandth, and when."""
    model = RigidBodyModel(pen_arm(gripper(config.arm.gripper_mass)))
    early = recording.time < 0.4
    pairs = zip(recording["arm.position"][early], recording["filtered_error"][early])
    value = np.array([r @ model.mass_matrix(q) @ r for q, r in pairs])
    recording.series = {"time": recording.time[early], "lyapunov": value}
    low = np.flatnonzero(value < FLOOR * value[0])
    falling = value[: low[0] + 1] if len(low) else value
    return {
        "lyapunov_rise": float((falling[1:] / falling[:-1]).max() - 1),
        "lyapunov_time": 1e3 * float(recording.time[low[0]]) if len(low) else None,
        "lyapunov_floor": float(np.median(value[len(value) // 2 :]) / value[0]),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Largest stable and smallest unstable gain k_s, measured and predicted."""
    rows = gains(metrics, config)
    result: Metrics = {}
    for name, stable in (
        ("measured", [bool(m["stable"]) for _, m in rows]),
        ("predicted", [(m["predicted_radius"] or 0.0) < 1 for _, m in rows]),
    ):
        result[f"{name}_stable"] = max((gain for (gain, _), good in zip(rows, stable) if good), default=None)
        result[f"{name}_unstable"] = min((gain for (gain, _), good in zip(rows, stable) if not good), default=None)
    limits = list(result.values())
    if None not in limits:
        low, high, predicted_low, predicted_high = limits
        result["limit_ratio"] = (low + high) / (predicted_low + predicted_high)  # type: ignore[operator]
    return result


def gains(metrics: AllMetrics, config: Config) -> list[tuple[float, Metrics]]:
    """k_s and metrics of the cases that differ in nothing else, k_s as it is varied."""
    return [
        (case.stiffness_gain, metrics[name])
        for name, case in config.cases.items()
        if name in metrics
        and case.stiffness_gain in np.atleast_1d(config.stiffness_gain)
        and changed(case, config) <= {"stiffness_gain", "law.impedance.stiffness_gain"}
    ]
