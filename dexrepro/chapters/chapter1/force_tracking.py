"""Three holding laws on two planar arms with an object whose stiffness varies, Section 1.5.1.

The leader's motion is unknown to the follower; both arms are torque-controlled in the World, the object is a massless
spring that never pulls, and its force is felt without noise. Cases c1, c2, c3 are the three columns of Fig. 1.10.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter1.followers import PlanarFollower
from dexrepro.chapters.measures import rms
from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.physics.elements import Elastic
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.planar import PlanarChain, planar

FIGURES = {
    "1.9": Figure(
        "The two planar arms and the object at four instants of the first case, proposed law. The book shows a sketch "
        "of the platform.",
        "Two three-link arms hold a spring between them and move right together.",
    ),
    "1.10": Figure(
        "Simulated torque-controlled arms. Columns: the book's three cases. Rows: force error; the same after "
        "5 s; the contact position x_d that gives the desired force, the reference x_r and the stiffness; the Lyapunov "
        "function of Eq. (1.34) along the run, which the book does not draw (W*: exact and small in case 1, elsewhere "
        "the best constant weights of moderate size).",
        "The proposed law has the smallest force error of three controllers in all three cases.",
    ),
}
TABLES = {"T1.A": "Force error of every law in the three cases of Fig. 1.10"}
RATE = 50.0
CASES = ("c1", "c2", "c3")
LATE = 5.0  # s, after the transient
RECORDED = 5  # control periods between recorded samples
ROLES = {"proposed": "book", "force": "rival", "passive": "plain"}


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
    world = World(step=config.control_period, gravity=(0.0, 0.0, 0.0), perturbation=config.perturbation)
    for name in ("leader", "follower"):
        arm = planar(config.arm.lengths, config.arm.masses, base=config.bases[name])
        world.add_arm(name, arm, np.array(config.start[name]) * np.pi / 3)
    return world


def simulate(config: Config, rng: Any) -> Recording:
    dt, law = config.control_period, config.law
    law.reset(0.0)
    with scene(config) as world:
        followers = {}
        for name, plant in world.arms.items():
            chain = PlanarChain(config.arm.lengths, config.arm.masses, tuple(config.bases[name]))
            model = RigidBodyModel(plant.arm, gravity=(0, 0, 0), mass_error=config.arm.mass_error)
            follower = PlanarFollower(chain, model, dt=dt, gain=config.inverse_gain, bandwidth=config.arm.bandwidth)
            follower.reset(np.array(plant.q))
            followers[name] = follower
        (x0, height), (x1, _) = followers["leader"].last, followers["follower"].last
        world.add(
            Elastic("object", ("follower", "leader"), lambda t: float(stiffness(config, t)), x1 - x0, unilateral=True)
        )

        def lead(sense: Any) -> Any:
            return followers["leader"](sense, x0 + float(motion(config, sense.time)), height)

        def follow(sense: Any) -> Any:
            own = followers["follower"]
            position = own.chain.forward(sense.position.tolist())[0] - x1
            return own(sense, x1 + float(law(position, float(sense.force[0]))), height)

        probes = {"reference": lambda: followers["follower"].last[0] - x1}
        if hasattr(law, "weights"):
            probes |= {"weights": lambda: law.weights, "estimate": lambda: float(law.estimate)}
        recording = world.run(
            config.duration,
            controllers={"leader": lead, "follower": follow},
            control_period=dt,
            probes=probes,
            record_every=RECORDED,
            stop=lambda _: "left the workspace" if abs(followers["follower"].last[0] - x1) > config.workspace else None,
            on_divergence="stop",
        )
    time, tip = recording.time, recording["follower.tip"][:, 0] - x1
    series = {
        "time": time,
        "error": recording["object.force"] - config.desired_force,
        "displacement": tip,
        "partner": recording["leader.tip"][:, 0] - x0,
        "reference": recording["reference"],
        "contact": motion(config, time) - config.desired_force / stiffness(config, time),
        "stiffness": stiffness(config, time) + 0.0 * time,
        "joints": np.hstack([recording["leader.position"], recording["follower.position"]]),
        "tracking": np.abs(tip - recording["reference"]),
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
        return {"rmse": float(np.sqrt(held * RECORDED * config.control_period / config.duration)), "finished": 0}
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


def summarise(metrics: Any, config: Config) -> Metrics:
    own = [metrics.get(f"{case}_proposed", {}).get("rmse") for case in CASES]
    if any(value is None for value in own):
        return {}
    return {"spread": float(max(own) / min(own) - 1.0)}


def draw(recordings: dict[str, Recording], metrics: Any, config: Config) -> dict[str, Any]:
    figures = {}
    if "c1_proposed" in recordings:
        figures["1.9"] = _draw_arms(recordings["c1_proposed"], config)
    if all(f"{case}_{law}" in recordings for case in CASES for law in ROLES):
        figures["1.10"] = _draw_errors(recordings, metrics)
    return figures


def _draw_arms(recording: Recording, config: Config) -> Any:
    from dexrepro.report import style

    figure, axes = style.subplots(1, 4, height=1.95, sharex=True, sharey=True)
    chains = [PlanarChain(config.arm.lengths, config.arm.masses, tuple(base)) for base in config.bases.values()]
    for axis, instant in zip(axes, np.linspace(0, recording.time[-1], 4)):
        joints = recording["joints"][np.argmin(np.abs(recording.time - instant))]
        ends = []
        for chain, q, colour in zip(chains, (joints[:3], joints[3:]), (style.EXTRA[0], style.BOOK)):
            turns = np.cumsum(q)
            x = chain.base[0] + np.cumsum(np.r_[0.0, chain.lengths * np.cos(turns)])
            y = chain.base[1] + np.cumsum(np.r_[0.0, chain.lengths * np.sin(turns)])
            axis.plot(x, y, "-o", color=colour, markersize=3)
            ends.append((x[-1], y[-1]))
        axis.plot(*zip(*ends), color=style.RIVAL, linestyle=(0, (1, 0.6)), linewidth=3)
        axis.set_title(f"{instant:.0f} s, {1e3 * abs(ends[1][0] - ends[0][0]):.0f} mm apart")
        axis.set_aspect("equal")
        axis.set(xlim=(-0.35, 0.95), ylim=(-0.1, 0.85), xticks=(0.0, 0.5))
        axis.set_xlabel("x [m]")
    axes[0].set_ylabel("y [m]")
    axes[0].annotate("DFR", (-0.05, -0.03), fontsize=7, color=style.EXTRA[0], ha="right")
    axes[0].annotate("AFR", (0.56, -0.03), fontsize=7, color=style.BOOK)
    style.title(figure, "The follower (blue) keeps squeezing the object while its partner (green) moves right")
    return figure


def _draw_errors(recordings: dict[str, Recording], metrics: Any) -> Any:
    from dexrepro.report import style

    figure, axes = style.subplots(4, 3, height=6.6, sharex=True, sharey="row")
    for column, case in enumerate(CASES):
        for law, role in ROLES.items():
            recording = recordings[f"{case}_{law}"]
            for row in (0, 1):
                late = recording.time >= (LATE if row else 0)
                axes[row, column].plot(recording.time[late], recording["error"][late], **style.LINES[role], label=law)
        recording = recordings[f"{case}_proposed"]
        time = recording.time
        axes[2, column].plot(time, 1e3 * recording["contact"], **style.LINES["reference"], label="$x_d$")
        axes[2, column].plot(time, 1e3 * recording["reference"], **style.LINES["book"], label="$x_r$")
        twin = axes[2, column].twinx()
        twin.plot(time, recording["stiffness"], **style.LINES["extra1"], label="$k_o$")
        twin.set_ylim(30, 65)
        twin.spines["right"].set_visible(True)
        if column == 2:
            twin.set_ylabel("Stiffness $k_o$ [N/m]")
        else:
            twin.set_yticklabels([])
        axes[3, column].semilogy(time, recording["lyapunov"], **style.LINES["book"])
        axes[3, column].set_xlabel("Time [s]")
        axes[1, column].axhline(0, color="black", linewidth=0.4)
        axes[0, column].set_title(("Ramp, constant $k_o$", "Ramp, varying $k_o$", "Sine, varying $k_o$")[column])
    for row, text in enumerate(("Force error [N]", "after 5 s [N]", "Position [mm]", "Lyapunov $V$ [-]")):
        axes[row, 0].set_ylabel(text)
    axes[0, 0].legend(loc="lower right")
    handles = [*axes[2, 0].get_lines(), *twin.get_lines()]
    axes[2, 0].legend(handles, [line.get_label() for line in handles], loc="lower right", ncols=3)
    best = sum(
        metrics[f"{case}_proposed"]["rmse"]
        < min(metrics[f"{case}_{law}"]["rmse"] for law in ROLES if law != "proposed")
        for case in CASES
    )
    style.title(figure, f"The proposed law keeps the smallest force error in {best} of {len(CASES)} cases")
    return figure


COLUMNS = {
    "rmse": "RMSE [N]",
    "rmse_late": f"RMSE after {LATE:g} s [N]",
    "iae": "integral of the error [N s]",
    "settling": "settling [s]",
}


def tabulate(recordings: dict[str, Recording], metrics: Any, config: Config) -> dict[str, pd.DataFrame]:
    laws = dict.fromkeys(case.partition("_")[2] for case in metrics if case[:2] in CASES)
    rows = []
    for law in laws:
        row: dict[str, Any] = {"law": law.replace("_", " ")}
        for case in CASES:
            values = metrics.get(f"{case}_{law}", {})
            row |= {f"{case} {text}": values.get(key) for key, text in COLUMNS.items()}
        rows.append(row)
    return {"T1.A": pd.DataFrame(rows)}
