"""From the potential field to force control at first contact, with and without a latch (Section 1.4).

The book says that contact force invalidates the field and initialises the force law. A light touch, a noisy sensor and
a bare comparison make that switch chatter; a latch that asks for three samples and opens below a smaller force
does not.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter1.assistive import AssistiveFollower
from dexrepro.chapters.chapter1.followers import Follower
from dexrepro.chapters.chapter1.hold_and_move import BALL, FLIP, LEVEL, SIDES, TABLE
from dexrepro.chapters.measures import rms
from dexrepro.control.hand_over import ContactLatch
from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.humans.operator import minimum_jerk
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.soft_object import Cushion, SoftObject
from dexrepro.physics.world import World
from dexrepro.robots.baxter import baxter, posture
from dexrepro.robots.inverse_kinematics import nearest

FIGURES = {
    "1.C": Figure(
        "AFR's contact force and phase (field or force law) while DFR touches a soft object lightly, simulated Baxter "
        "arms; desired force 1.5 N, sensor noise 0.3 N. The book does not show the switch.",
        "With a latch the phase changes once, with a bare comparison it changes many times.",
    )
}
TABLES = {"T1.G": "Hand-over from the field to the force law"}
RATE = 100.0
ARRIVED = 2.5  # s, DFR has reached the object
ALONG = np.array([0.0, 1.0, 0.0])


def scene(config: Config, rng: Any = None) -> World:
    """A soft ball on a stand between the two arms."""
    world = World(step=config.step, perturbation=config.perturbation)
    place, ready = np.array(config.place), config.radius + 0.10
    for name, side in SIDES.items():
        arm = baxter(side)
        offset = -config.leader_distance if name == "leader" else ready
        start = nearest(arm, posture(side), place + offset * ALONG, LEVEL if name == "leader" else LEVEL @ FLIP)
        noise = rng("force sensor") if rng and name == "follower" else None
        world.add_arm(
            name, arm, start, sensor=Sensor(force_noise=config.sensor_noise) if noise else Sensor(), rng=noise
        )
    world.add_sphere("object", config.radius, config.place, mass=config.mass, colour=BALL, angularDamping=0.2)
    world.add_box("stand", (0.2, 0.2, 0.02), place - [0.0, 0.0, config.radius + 0.01], friction=1.0, colour=TABLE)
    return world


def simulate(config: Config, rng: Any) -> Recording:
    dt, cushion = config.control_period, config.cushion
    t = dt * np.arange(round(config.duration / dt) + 1)
    share = np.interp((t - 0.3) / (ARRIVED - 0.3), np.linspace(0, 1, 501), np.r_[0.0, minimum_jerk(500)])
    reach = config.leader_distance - config.radius + config.touch
    path = np.array(config.place) + (reach * share - config.leader_distance)[:, None] * ALONG
    with scene(config, rng) as world:
        arms = {name: Follower(plant.arm, np.array(plant.q), dt=dt, **config.arm) for name, plant in world.arms.items()}
        arms["leader"].reset(np.array(world.arm("leader").q))
        own = AssistiveFollower(
            arms["follower"], config.field, ContactLatch(**config.latch), config.law, speed_limit=config.speed_limit
        )
        own.reset(np.array(world.arm("follower").q), world.arm("follower").sense.tip)
        left, right = (Cushion(dt=config.step, **cushion) for _ in range(2))
        world.add(
            SoftObject("grip", "object", ("leader", "follower"), (left, right), length=2 * config.radius,
                       friction=config.friction, shear=config.shear, shear_damping=config.shear_damping,
                       scale=lambda _: 1.0)
        )  # fmt: skip
        body = world.bodies["object"]

        def follow(sense: Any) -> Any:
            seen = np.array((body.x, body.y, body.z)) + config.camera_bias
            return own.go(sense, path[round(sense.time / dt)], ALONG, seen, LEVEL @ FLIP)

        recording = world.run(
            config.duration,
            controllers={
                "leader": lambda sense: arms["leader"].go(sense, path[round(sense.time / dt)], LEVEL),
                "follower": follow,
            },
            control_period=dt,
            probes={"phase": lambda: float(own.phase), "sensed": lambda: own.force},
            record_every=round(dt / config.step),
        )
    recording.series = {
        "time": recording.time,
        "force": recording["grip.force_follower"],
        "sensed": recording["sensed"],
        "phase": recording["phase"],
    }
    return recording


def measure(recording: Recording, config: Config) -> Metrics:
    phase, time = recording["phase"], recording.time
    late = recording.between(config.duration - 2.0)
    error = recording["force"][late] - config.law.desired_force
    return {
        "switches": int(np.sum(np.abs(np.diff(phase)))),
        "contact": float(time[np.argmax(phase > 0)]) if phase.any() else None,
        "holding_at_end": int(phase[-1]),
        "rmse": rms(error),
        "bias": float(error.mean()),
    }


def draw(recordings: dict[str, Recording], metrics: Any, config: Config) -> dict[str, Any]:
    if not {"latched", "bare"} <= set(recordings):
        return {}
    from dexrepro.report import style

    figure, axes = style.subplots(2, 2, height=2.8, sharex=True, sharey="row", height_ratios=(2, 1))
    for column, (case, role) in enumerate((("latched", "book"), ("bare", "printed"))):
        recording = recordings[case]
        part = recording.time > 1.0
        axes[0, column].plot(recording.time[part], recording["sensed"][part], color=style.PLAIN, linewidth=0.5,
                             label="sensed")  # fmt: skip
        axes[0, column].plot(recording.time[part], recording["force"][part], color=style.LINES[role]["color"],
                             label="true")  # fmt: skip
        axes[0, column].axhline(config.cases[case].law["desired_force"], **style.LINES["reference"])
        axes[1, column].plot(recording.time[part], recording["phase"][part], color=style.LINES[role]["color"],
                             linewidth=0.7)  # fmt: skip
        axes[1, column].set(xlabel="Time [s]", yticks=(0, 1), yticklabels=("field", "force law"))
        times = metrics[case]["switches"]
        word = "Latch" if case == "latched" else "Bare comparison"
        axes[0, column].set_title(f"{word}: {times} switch{'' if times == 1 else 'es'}")
    axes[0, 0].set_ylabel("Contact force [N]")
    axes[0, 0].set_ylim(-0.15, 3.4)
    axes[0, 0].legend(loc="upper left", ncols=2)
    style.title(figure, "A latch hands over once where a bare comparison chatters")
    return {"1.C": figure}


def tabulate(recordings: dict[str, Recording], metrics: Any, config: Config) -> dict[str, pd.DataFrame]:
    table = pd.DataFrame([{"case": case.replace("_", " "), **metrics[case]} for case in recordings])
    names = {"contact": "contact after [s]", "holding_at_end": "holding at the end", "rmse": "RMS force error [N]",
             "bias": "mean force error [N]"}  # fmt: skip
    return {"T1.G": table.rename(columns=names)}
