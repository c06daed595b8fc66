"""AFR follows a moving object, avoids it and assists when DFR comes, Sections 1.3.3, 1.3.4 (Task 3, Fig. 1.16).

Two simulated Baxter arms under torque. A person moves the object left and right, back and forth, up and down; then DFR
approaches, holds and rotates it. AFR sees the object through a camera (sampled, noisy, off-centre) and knows the
commands to DFR; its position comes from the potential field, its orientation from Eq. (1.14). Only the field is tested
here: there is no contact force that would end it.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from dexrepro.chapters.chapter1.followers import Follower
from dexrepro.chapters.chapter1.hold_and_move import BALL, FLIP, LEVEL, SIDES, joint_channels
from dexrepro.chapters.measures import rms
from dexrepro.control.facing import facing
from dexrepro.experiment import Config, Figure, Film, Metrics, Recording
from dexrepro.humans.operator import minimum_jerk
from dexrepro.physics.rendering import Camera
from dexrepro.physics.world import World
from dexrepro.robots.baxter import baxter, posture
from dexrepro.robots.inverse_kinematics import nearest
from dexrepro.robots.kinematics import forward
from dexrepro.robots.rotations import quaternion_from_rotation, rotation_from_quaternion

FIGURES = {
    "1.7": Figure(
        "Potential (lines) and force (arrows) in the plane of the holding line for DFR far from, near to and at the "
        "object (circle), with the three points of Eq. (1.19). The book shows a sketch.",
        "As DFR comes closer the minimum of the potential moves from beside the object into it.",
    ),
    "1.12": Figure(
        "Simulated. The camera's object: four edge points, their noisy average at 15 Hz, off-centre, over two seconds.",
        "The measured position scatters about a point 18 mm from the true centre.",
    ),
    "1.16": Figure(
        "Simulated Baxter. Top: pictures at the book's instants. Then: AFR, DFR and object along the holding line and "
        "across it; clearance of AFR's end point from the object; weights; angles between the tools' axes and between "
        "AFR's axis and the direction to DFR. The book shows photographs.",
        "AFR follows the object at a distance, comes to it when DFR does and keeps facing DFR.",
    ),
}
TABLES = {"T1.E": "Potential field: adjustable weights and ablations"}
RATE = 25.0
SHAKEN, APPROACH, HOLD, PITCHED = 18.0, 24.0, 30.0, 38.0  # s, ends of the phases
VIEW = Camera(target=(0.5, -0.06, 0.3), distance=1.45, yaw=75.0, pitch=-18.0)
FILM = Film(
    "adjustable", "The left arm follows the ball that a person moves, and comes to it when the right arm does; contact "
    "is not simulated.", Camera(target=(0.5, -0.08, 0.27), distance=1.4, yaw=75.0, pitch=-18.0),
    "clearance", "Distance to the ball [mm]", scale=1e3,
)  # fmt: skip
INSTANTS = {"a": 1.5, "b": 7.5, "c": 13.5, "d": 21.0, "e": 25.0, "f": 32.0, "g": 40.0}


class Object:
    """A ball that is where ``path`` (n, 3) [m], one a control period, says; it feels nothing."""

    name = "mover"

    def __init__(self, body: Any, path: Any, period: float) -> None:
        self.body, self.path, self.period = body, path, period

    def bind(self, world: Any) -> Any:
        import pybullet as bullet

        def apply(time: float) -> None:
            place = self.path[min(int(time / self.period + 1e-6), len(self.path) - 1)]
            bullet.resetBasePositionAndOrientation(
                self.body.body, place, (0, 0, 0, 1), physicsClientId=self.body.client
            )

        return apply

    def channels(self) -> dict[str, float]:
        return {}


def scene(config: Config) -> World:
    """Two arms and the ball, AFR at the ready position."""
    world = World(step=config.step, perturbation=config.perturbation)
    centre, along = np.array(config.place), np.array([0.0, 1.0, 0.0])
    starts = {"leader": (centre - config.leader_distance * along, LEVEL),
              "follower": (centre + config.start_offset * along, LEVEL @ FLIP)}  # fmt: skip
    for name, side in SIDES.items():
        arm = baxter(side)
        world.add_arm(name, arm, nearest(arm, posture(side), *starts[name]))
    world.add_sphere("object", config.radius, config.place, colour=BALL)
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    clearance = np.linalg.norm(recording["follower"] - recording["object"], axis=1) - config.radius
    return Recording({"time": recording.time, "object.pose": recording["object"], "clearance": clearance}
                     | joint_channels(recording["joints"]))  # fmt: skip


def script(config: Config) -> dict[str, Any]:
    """Object centre and DFR pose, one row a control period: centre, position (n, 3) [m], rotation (n, 3, 3)."""
    dt = config.control_period
    t = dt * np.arange(round(config.duration / dt) + 1)
    shake = np.zeros((len(t), 3))
    for k, axis in enumerate((1, 0, 2)):
        inside = (t >= 6.0 * k) & (t < 6.0 * (k + 1))
        shake[inside, axis] = config.shake[k] * np.sin(2 * np.pi * t[inside] / 6.0)
    done = np.clip((t - SHAKEN) / (APPROACH - SHAKEN), 0, 1)
    share = np.interp(done, np.linspace(0, 1, 501), np.r_[0.0, minimum_jerk(500)])
    along = np.array([0.0, 1.0, 0.0])
    distance = config.leader_distance + (config.radius - config.leader_distance) * share
    rest = np.array(config.place)
    position = rest - distance[:, None] * along
    yaw = np.deg2rad(config.yaw) * np.sin(2 * np.pi * np.maximum(t - HOLD, 0) / 8.0)
    pitch = np.deg2rad(config.pitch) * np.sin(2 * np.pi * np.maximum(t - PITCHED, 0) / 8.0)
    turns = Rotation.from_euler("zx", np.stack([yaw, pitch], axis=1)).as_matrix()
    rotation = turns @ LEVEL
    # Once held, the object goes along with DFR's tool.
    held = (t >= APPROACH)[:, None]
    centre = np.where(held, position + config.radius * rotation[:, :, 2], rest + shake)
    return {"time": t, "centre": centre, "position": position, "rotation": rotation}


def camera(config: Config, centre: Any, rng: np.random.Generator) -> Any:
    """What the camera says about the object's centre: mean of four noisy edge points, sampled and held, off-centre."""
    every = round(1.0 / (config.camera.rate * config.control_period))
    frames = centre[::every]
    edges = config.camera.noise * rng.standard_normal((4, len(frames), 3))
    seen = frames + edges.mean(axis=0) + np.array(config.camera.bias)
    return np.repeat(seen, every, axis=0)[: len(centre)]


def simulate(config: Config, rng: Any) -> Recording:
    dt, field, plan = config.control_period, config.field, script(config)
    seen = camera(config, plan["centre"], rng("camera"))
    facings = rotation_from_quaternion(facing(quaternion_from_rotation(plan["rotation"])))
    axes = plan["rotation"][:, :, 2]
    images: dict[str, Any] = {}
    with scene(config) as world:
        followers = {
            name: Follower(plant.arm, np.array(plant.q), dt=dt, **config.arm) for name, plant in world.arms.items()
        }
        for name, plant in world.arms.items():
            followers[name].reset(np.array(plant.q))
        world.add(Object(world.bodies["object"], plan["centre"], dt))
        field.reset(world.arm("follower").sense.tip)

        def lead(sense: Any) -> Any:
            k = round(sense.time / dt)
            return followers["leader"].go(sense, plan["position"][k], plan["rotation"][k])

        def follow(sense: Any) -> Any:
            k = round(sense.time / dt)
            target = field(plan["position"][k], axes[k], seen[k])
            return followers["follower"].go(sense, target, facings[k])

        def shoot(name: str) -> None:
            images[name] = world.render(camera=VIEW, size=(280, 230))

        recording = world.run(
            config.duration,
            controllers={"leader": lead, "follower": follow},
            control_period=dt,
            probes={
                "weights": lambda: field.active,
                "ready": lambda: field.points[1],
                "target": lambda: field.position,
            },
            events=[(at, partial(shoot, name)) for name, at in INSTANTS.items()] if config.photograph else (),
            record_every=round(dt / config.step),
        )
        recording.series = _condense(recording, plan, seen, world)
    if config.photograph:
        recording.frames["field"] = _field(config)
    recording.images = images
    return recording


def _condense(recording: Recording, plan: dict[str, Any], seen: Any, world: World) -> dict[str, Any]:
    poses = {name: forward(world.arm(name).arm, recording[f"{name}.position"]) for name in SIDES}
    n = len(recording.time)
    own, partner = poses["follower"], poses["leader"]
    direction = partner[0] - own[0]
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return {
        "time": recording.time,
        "follower": own[0],
        "leader": partner[0],
        "object": plan["centre"][:n],
        "seen": seen[:n],
        "weights": recording["weights"],
        "ready": recording["ready"],
        "facing": np.arccos(np.clip(-np.sum(own[1][:, :, 2] * partner[1][:, :, 2], axis=1), -1, 1)),
        "pointing": np.arccos(np.clip(np.sum(own[1][:, :, 2] * direction, axis=1), -1, 1)),
        "joints": np.hstack([recording[f"{name}.position"] for name in SIDES]),
    }


def _field(config: Config) -> pd.DataFrame:
    """Potential [J] on a grid of the holding plane for three distances of DFR [m]."""
    y, z = np.meshgrid(np.linspace(-0.2, 0.6, 81), np.linspace(-0.3, 0.3, 61))
    points = np.stack([np.zeros_like(y), y, z], axis=-1)
    axis = np.array([0.0, 1.0, 0.0])
    frames = []
    for distance in (0.38, 0.24, config.radius):
        # The measured object is off the holding line, as in the book's sketch.
        config.field.place(np.array([0.0, -distance, 0.0]), axis, np.array([0.0, 0.0, config.camera.bias[2]]))
        force = config.field.force(points)
        frame = pd.DataFrame({"y": y.ravel(), "z": z.ravel(), "potential": config.field.potential(points).ravel()})
        frame[["fy", "fz"]] = force[..., 1:].reshape(-1, 2)
        frame["distance"] = distance
        for k, point in enumerate(config.field.points):
            frame[f"p{k + 1}y"], frame[f"p{k + 1}z"] = point[1], point[2]
        frames.append(frame)
    return pd.concat(frames)


def measure(recording: Recording, config: Config) -> Metrics:
    time, radius = recording.time, config.radius
    clearance = np.linalg.norm(recording["follower"] - recording["object"], axis=1) - radius
    partner = np.linalg.norm(recording["leader"] - recording["object"], axis=1) - radius
    shaken, held = recording.between(0.5, SHAKEN), recording.between(APPROACH)
    lag = np.linalg.norm(recording["follower"] - recording["ready"], axis=1)
    result: Metrics = {
        "lag_rms": rms(lag[shaken]),
        "lag_most": float(lag[shaken].max()),
        "clearance": float(clearance[recording.between(0.0, APPROACH - 2.0)].min()),
        "own_contact": _first(time, clearance <= 0),
        "partner_contact": _first(time, partner <= 1e-3),
    }
    if result["own_contact"] is not None and result["partner_contact"] is not None:
        result["own_before_partner"] = result["partner_contact"] - result["own_contact"]
    if held.any():
        result |= {
            "facing": float(np.rad2deg(recording["facing"][held].max())),
            "pointing": float(np.rad2deg(recording["pointing"][held].max())),
        }
    if recording.between(HOLD).any():
        result["gap_spread"] = float(clearance[recording.between(HOLD)].std())
    return result


def _first(time: Any, happened: Any) -> float | None:
    return float(time[np.argmax(happened)]) if happened.any() else None


def draw(recordings: dict[str, Recording], metrics: Any, config: Config) -> dict[str, Any]:
    if "adjustable" not in recordings:
        return {}
    recording = recordings["adjustable"]
    return {
        "1.7": _draw_field(recording.frames["field"], config),
        "1.12": _draw_camera(recording, config),
        "1.16": _draw_task(recording, config),
    }


def _draw_field(field: pd.DataFrame, config: Config) -> Any:
    from dexrepro.report import style

    figure, axes = style.subplots(1, 3, height=2.25, sharey=True)
    for axis, word, (_, part) in zip(axes, ("far", "near", "touching"), field.groupby("distance", sort=False)):
        y, z = np.unique(part["y"]), np.unique(part["z"])
        grid = {key: part[key].to_numpy().reshape(len(z), len(y)) for key in ("potential", "fy", "fz")}
        axis.contour(
            y, z, np.sqrt(grid["potential"]), levels=np.linspace(0.02, 0.5, 13), colors=style.PLAIN, linewidths=0.5
        )
        step, size = (slice(None, None, 6), slice(None, None, 6)), np.hypot(grid["fy"], grid["fz"]) + 1e-9
        show = np.minimum(size, 0.3) / size
        axis.quiver(y[step[1]], z[step[0]], (show * grid["fy"])[step], (show * grid["fz"])[step], color=style.BOOK,
                    scale=4, width=0.005)  # fmt: skip
        axis.add_patch(style.plt.Circle((0, 0), config.radius, color=style.RIVAL, alpha=0.35, linewidth=0))
        for k in (1, 2, 3):
            place = part[f"p{k}y"].iloc[0], part[f"p{k}z"].iloc[0]
            axis.plot(*place, "k.", markersize=4)
            below = k == 3
            axis.annotate(f"$P_{k}$", place, xytext=(0, -3 if below else 3), textcoords="offset points", fontsize=8,
                          ha="center", va="top" if below else "bottom")  # fmt: skip
        axis.set_aspect("equal")
        axis.set(xlabel="Along the holding line [m]", title=f"DFR {word}, {1e3 * part['distance'].iloc[0]:.0f} mm away",
                 xlim=(-0.2, 0.6))  # fmt: skip
    axes[0].set_ylabel("Across [m]")
    style.title(figure, "The closer DFR comes, the more the field draws AFR into the object")
    return figure


def _draw_camera(recording: Recording, config: Config) -> Any:
    from dexrepro.report import style

    figure, axis = style.subplots(width=style.ONE_COLUMN, height=2.9)
    still = recording.between(SHAKEN, SHAKEN + 2.0)
    centre, seen = recording["object"][still], 1e3 * (recording["seen"] - recording["object"])[still]
    angles = np.linspace(0, 2 * np.pi, 200)
    axis.plot(1e3 * config.radius * np.cos(angles), 1e3 * config.radius * np.sin(angles), color=style.PLAIN)
    for angle in (0, 0.5 * np.pi, np.pi, 1.5 * np.pi):
        axis.plot(1e3 * config.radius * np.cos(angle), 1e3 * config.radius * np.sin(angle), "s", color=style.RIVAL,
                  markersize=4, label="edge point" if angle == 0 else None)  # fmt: skip
    axis.plot(0, 0, "+", color="black", label="true centre")
    axis.plot(seen[:, 0], seen[:, 2], "o", markersize=2, color=style.BOOK, alpha=0.6, label="measured")
    axis.set_aspect("equal")
    axis.set(xlabel="x [mm]", ylabel="z [mm]", xlim=(-170, 170), ylim=(-170, 170))
    figure.legend(loc="outside lower center", ncols=3, handletextpad=0.3, columnspacing=0.8)
    offset = np.linalg.norm(seen.mean(axis=0)) if len(centre) else 0.0
    style.title(figure, f"The camera sees the object {offset:.0f} mm off centre")
    return figure


def _draw_task(recording: Recording, config: Config) -> Any:
    from dexrepro.report import style

    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 7.6))
    grid = figure.add_gridspec(6, 7, height_ratios=(0.55, 1.1, 1.1, 0.8, 0.6, 0.8))
    pictures = style.trimmed(recording.images)
    for k, (name, at) in enumerate(INSTANTS.items()):
        axis = figure.add_subplot(grid[0, k])
        axis.imshow(pictures[name])
        axis.set_axis_off()
        axis.set_title(f"({name}) {at:g} s", fontsize=7)
    axes = [figure.add_subplot(grid[row, :]) for row in range(1, 6)]
    time = recording.time
    for k, (axis, label) in enumerate(zip(axes[:2], ("Along [m]", "Up [m]"))):
        for name, role in (("follower", "book"), ("leader", "extra1"), ("object", "reference")):
            axis.plot(time, recording[name][:, 1 + k], label={"follower": "AFR", "leader": "DFR"}.get(name, name),
                      **style.LINES[role])  # fmt: skip
        axis.set_ylabel(label)
    axes[0].legend(ncols=3, loc="lower right")
    clearance = np.linalg.norm(recording["follower"] - recording["object"], axis=1) - config.radius
    axes[2].axhline(0, color="black", linewidth=0.4)
    axes[2].plot(time, 1e3 * clearance, **style.LINES["book"])
    axes[2].set_ylabel("Clearance [mm]")
    for k, role in ((0, "plain"), (2, "book")):
        axes[3].plot(time, recording["weights"][:, k], label=f"$w_{k + 1}$", **style.LINES[role])
    axes[3].set_ylabel("Weight [-]")
    axes[3].legend(loc="center right")
    for name, role in (("facing", "book"), ("pointing", "rival")):
        axes[4].plot(time, np.rad2deg(recording[name]), label=name, **style.LINES[role])
    axes[4].set(xlabel="Time [s]", ylabel="Angle [deg]")
    axes[4].legend(ncols=2, loc="upper right")
    words = ("left, right", "back, forth", "up, down", "DFR comes", "held", "yaw", "yaw and pitch")
    edges = (0.0, 6.0, 12.0, SHAKEN, APPROACH, HOLD, PITCHED, time[-1])
    for axis in axes[:-1]:
        axis.set_xticklabels([])
    for axis in axes:
        axis.set_xlim(0, time[-1])
        for k in range(7):
            if k % 2 == 0:
                style.phase(axis, edges[k], edges[k + 1])
    for k, word in enumerate(words):
        axes[0].annotate(word, (0.5 * (edges[k] + edges[k + 1]), 1.0), xycoords=("data", "axes fraction"),
                         fontsize=6.5, ha="center", va="bottom", color="#555555")  # fmt: skip
    style.title(figure, "AFR keeps its distance while the object moves, comes when DFR comes, and faces it throughout")
    return figure


def tabulate(recordings: dict[str, Recording], metrics: Any, config: Config) -> dict[str, pd.DataFrame]:
    columns = {"lag_rms": "lag RMS [m]", "lag_most": "largest lag [m]", "clearance": "least clearance [m]",
               "own_contact": "AFR touches [s]", "partner_contact": "DFR touches [s]", "facing": "facing [deg]",
               "pointing": "pointing [deg]"}  # fmt: skip
    rows = [
        {"case": case.replace("_", " ")} | {text: metrics[case].get(key) for key, text in columns.items()}
        for case in recordings
    ]
    return {"T1.E": pd.DataFrame(rows)}
