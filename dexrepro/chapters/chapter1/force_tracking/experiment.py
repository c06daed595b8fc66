"""Three holding laws on two planar arms with an object whose stiffness varies, Section 1.5.1.

The leader's motion is unknown to the follower; both arms are torque-controlled in the World, the object is a massless
spring that never pulls, and its force is felt without noise. Cases c1, c2, c3 are the three columns of Fig. 1.10.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.arrays import Rng
from dexrepro.control.contract import channels
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import rms
from dexrepro.physics.drive import HoldingDrive
from dexrepro.physics.elements import Elastic
from dexrepro.physics.loop import Probe
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import Sense
from dexrepro.physics.servo import PlanarServo
from dexrepro.physics.world import World
from dexrepro.robots.planar import PlanarChain, planar

RATE = 50.0
CASES = ("c1", "c2", "c3")
LATE = 5.0  # s, after the transient
RECORDED = 1  # control periods between recorded samples: what is measured must not depend on it
HELD = ("rmse_late", "iae", "settling", "reference_error", "tracking", "largest_late", "force_start")


def motion(config: Config, time: Any) -> Any:
    """Displacement x_D [m] of the teleoperated follower at ``time`` [s]."""
    if config.motion == "ramp":
        return np.minimum(config.ramp_end, config.ramp_speed * time)
    return config.sine_amplitude * np.sin(config.sine_rate * time)


def stiffness(config: Config, time: Any) -> Any:
    """Stiffness k_o [N/m] of the object at ``time`` [s]."""
    return config.stiffness + config.stiffness_swing * np.sin(config.stiffness_rate * time)


def scene(config: Config) -> World:
    """Two planar arms that just touch the object."""
    world = World(step=config.step, gravity=(0.0, 0.0, 0.0), perturbation=config.perturbation)
    for name in ("leader", "follower"):
        arm = planar(config.arm.lengths, config.arm.masses, base=config.bases[name])
        world.add_arm(name, arm, np.array(config.start[name]) * np.pi / 3)
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    leader, follower = np.split(recording["joints"], 2, axis=1)
    return Recording({"time": recording.time, "leader.position": leader, "follower.position": follower})


def simulate(config: Config, rng: Rng) -> Recording:
    dt, law = config.control_period, HoldingDrive(config.law)
    with scene(config) as world:
        followers = {}
        for name, plant in world.arms.items():
            chain = PlanarChain(config.arm.lengths, config.arm.masses, tuple(config.bases[name]))
            model = RigidBodyModel(plant.arm, gravity=(0, 0, 0), mass_error=config.arm.mass_error)
            follower = PlanarServo(chain, model, dt=dt, gain=config.inverse_gain, bandwidth=config.arm.bandwidth)
            follower.reset(np.array(plant.q))
            followers[name] = follower
        (x0, height), (x1, _) = followers["leader"].last, followers["follower"].last
        world.add(
            Elastic("object", ("follower", "leader"), lambda t: float(stiffness(config, t)), x1 - x0, unilateral=True)
        )

        origin = 0.0  # of the displacements that the law knows and commands

        def lead(sense: Sense) -> Any:
            nonlocal origin
            own = followers["leader"]
            if config.frame == "tool":
                origin = own.chain.forward(sense.position.tolist())[0] - x0
            return own(sense, x0 + float(motion(config, sense.time)), height)

        def follow(sense: Sense) -> Any:
            own = followers["follower"]
            position = own.chain.forward(sense.position.tolist())[0] - x1 - origin
            return own(sense, x1 + origin + float(law(sense.time, position, float(sense.force[0]))), height)

        probes: dict[str, Probe] = {"reference": lambda: followers["follower"].last[0] - x1}
        probes |= channels(config.law, "weights", "estimate")
        recording = world.run(
            config.duration,
            controllers={"leader": lead, "follower": follow},
            control_period=dt,
            probes=probes,
            record_every=RECORDED * round(dt / config.step),
            stop=lambda _: "left the workspace" if abs(followers["follower"].last[0] - x1) > config.workspace else None,
            on_divergence="stop",
        )
    time, partner = recording.time, recording["leader.tip"][:, 0] - x0
    known = partner if config.frame == "tool" else 0.0
    tip, reference = recording["follower.tip"][:, 0] - x1 - known, recording["reference"] - known
    series = {
        "time": time,
        "error": recording["object.force"] - config.desired_force,
        "displacement": tip,
        "partner": partner,
        "reference": reference,
        "contact": motion(config, time) - config.desired_force / stiffness(config, time) - known,
        "stiffness": stiffness(config, time) + 0.0 * time,
        "joints": np.hstack([recording["leader.position"], recording["follower.position"]]),
        "tracking": np.abs(tip - reference),
    }
    if "weights" in recording and recording.status == "finished":
        series["lyapunov"], series["weights"] = lyapunov(recording, series, config), recording["weights"]
    recording.series = series
    return recording


def lyapunov(recording: Recording, series: dict[str, Any], config: Config) -> Any:
    """V of Eq. (1.34), (1.35) along a run with perfect tracking (V_3 = 0) and constant weights W*.

    Where the contact position is no ramp, W* is the least-squares fit without the directions in which the nearly equal
    lags could only be told apart by weights of a thousand a second (a difference quotient, which would fit anything).
    """
    z, contact, dt = series["displacement"], series["contact"], RECORDED * config.control_period
    rate = np.gradient(contact, dt)
    lags = recording["weights"].shape[1] - 1
    regressor = np.stack([np.ones_like(z), *(np.r_[np.zeros(i), z[: len(z) - i]] for i in range(lags))], axis=1)
    if config.motion == "ramp" and config.stiffness_swing == 0:
        best = np.zeros_like(recording["weights"])
        best[:, 0] = rate  # Eq. (1.28) holds exactly
    else:
        best = np.linalg.lstsq(regressor, rate, rcond=1e-2)[0]
    beta = config.adaptation
    weights = np.sum((recording["weights"] - best) ** 2, axis=1)
    return (weights + (recording["estimate"] - contact) ** 2) / (2 * beta) + series["error"] ** 2 / (
        2 * series["stiffness"]
    )


def measure(recording: Recording, config: Config) -> Metrics:
    time, error = recording.time, recording["error"]
    if len(time) < 2 or recording.status != "finished":
        # What is left after contact is lost counts as a force error of f_d, as it is.
        lost = config.desired_force
        held = np.sum(error**2) + (round(config.duration / config.control_period / RECORDED) - len(error)) * lost**2
        rmse = float(np.sqrt(held * RECORDED * config.control_period / config.duration))
        return {"rmse": rmse, "finished": 0} | dict.fromkeys(HELD)
    late = recording.between(LATE)
    outside = np.flatnonzero(np.abs(error) > 0.05 * config.desired_force)
    result: Metrics = {
        "rmse": rms(error),
        "rmse_late": rms(error[late]),
        "iae": float(np.trapezoid(np.abs(error), time)),
        "settling": float(time[outside[-1]]) if len(outside) else 0.0,
        "reference_error": rms((recording["reference"] - recording["contact"])[late]),
        "tracking": float(recording["tracking"][late].max()),
        "largest_late": float(np.abs(error[late]).max()),
        "force_start": float(error[0] + config.desired_force),
        "finished": 1,
    }
    if "lyapunov" in recording:
        v = recording["lyapunov"][:: max(round(0.01 / config.control_period / RECORDED), 1)]
        result |= {"v_start": float(v[0]), "v_end": float(v[-1]), "v_rising": float(np.mean(np.diff(v) > 0))}
        result["weights_end"] = float(np.abs(recording["weights"][-1]).max())
    return result


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """Spread of the whole-run error over the three cases; undefined where one of them lost contact."""
    result: Metrics = {}
    for law, name in (("proposed", "spread"), ("integral", "integral_spread")):
        found = [metrics.get(f"{case}_{law}", {}) for case in CASES]
        if all(found):
            errors = [float(values["rmse"] or 0.0) for values in found]
            held = all(values["finished"] for values in found)
            result[name] = max(errors) / min(errors) - 1.0 if held else None
    return result
