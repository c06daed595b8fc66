"""The two-link arm of Sect. 4.5 in its vertical plane: scene, reference motions and the chain of runs that learns."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array
from dexrepro.control.contract import Law, build, memory, report
from dexrepro.control.motion import Sampled
from dexrepro.experiment import Config, Recording
from dexrepro.physics.drive import EndPointDrive, Kinematics
from dexrepro.physics.elements import Push
from dexrepro.physics.plant import Sense
from dexrepro.physics.world import World
from dexrepro.robots.planar import planar
from dexrepro.robots.two_link import TwoLink

SNAPSHOT = 50  # control periods between two records of the weights
ELLIPSE, FROZEN = 4, 5  # segment numbers after the strokes 0 to 3


def stroke(config: Config, angle: float, duration: float) -> Sampled:
    """A diameter of the ellipse, travelled to and fro; ``angle`` [deg] is the parameter of its end on the ellipse."""
    rate, direction = 2 * math.pi / config.task.period, math.radians(angle)
    phase = rate * np.arange(round(duration / config.step))[:, None] * config.step
    end = np.array(config.task.semi_axes) * (math.cos(direction), math.sin(direction))
    sine, cosine = np.sin(phase), np.cos(phase)
    return Sampled(config.step, np.array(config.task.centre) + sine * end, rate * cosine * end, -(rate**2) * sine * end)


def ellipse(config: Config, duration: float) -> Sampled:
    """The ellipse around the centre, counterclockwise from the parameter ``task.phase``."""
    rate = 2 * math.pi / config.task.period
    phase = rate * np.arange(round(duration / config.step)) * config.step + config.task.phase
    axes = np.array(config.task.semi_axes)
    circle = np.stack([np.cos(phase), np.sin(phase)], axis=1)
    turned = np.stack([-np.sin(phase), np.cos(phase)], axis=1)
    return Sampled(
        config.step, np.array(config.task.centre) + axes * circle, rate * axes * turned, -(rate**2) * axes * circle
    )


def scene(config: Config, start: Sequence[float] | None = None) -> World:
    """The arm at rest with its tip at ``start`` (None: the task's), under gravity and the force field at its tip."""
    start = config.task.start if start is None else start
    world = World(step=config.step, gravity=(0.0, -config.arm.gravity, 0.0), perturbation=config.perturbation)
    arm = planar(config.arm.lengths, config.arm.masses, config.arm.inertias, radius=0.03)
    world.add_arm("arm", arm, position=TwoLink(config.arm.lengths).inverse(start))
    x, y = config.task.force
    world.add(Push("arm", lambda time: (x, y, 0.0), name="field"))
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    """The recorded joint angles under the name by which the scene shows them."""
    return replace(recording, series=recording.series | {"arm.position": recording["position"]})


class Pilot:
    """Drives the arm with a law along a reference, and keeps what the network's weights did.

    The torque's damping term is taken at the present velocity: it is light for these links (K_2 step / M = 0.01).
    """

    def __init__(self, law: Law, kinematics: Kinematics, reference: Sampled, averaged: int) -> None:
        self.drive = EndPointDrive(law, reference, None, kinematics=kinematics)
        self.law, self.reference, self.network = law, reference, memory(law)
        self._from = len(reference) - averaged
        self._sum, self._samples = np.empty((0, 0)), 0
        self.snapshots: list[Array] = []

    def __call__(self, sense: Sense) -> Array:
        k = self.reference.index(sense.time)
        torque, damping, _ = self.drive(sense)
        if self.network is not None:
            if k % SNAPSHOT == 0:
                self.snapshots.append(self.network.weights.copy())
            if k >= self._from:
                self._average(self.network.weights)
        return torque if damping is None else torque - damping * sense.velocity

    def _average(self, weights: Array) -> None:
        if self._sum.shape != weights.shape:  # the node set grew inside the window: begin anew
            self._sum, self._samples = np.zeros(weights.shape), 0
        self._sum += weights
        self._samples += 1

    @property
    def mean_weights(self) -> Array:
        """W-bar, the mean over the last reference period at the final number of nodes (4.31)."""
        return self._sum / self._samples

    def state(self) -> tuple[float, ...]:
        """Error (2), usage (2), E, nodes, |G|^2, |Xi|, largest |Xi_k|, alpha' (2): the columns of ``STATE``."""
        told = {**UNTOLD, **report(self.law)}
        z = told["input"].tolist()
        norm, peak = math.hypot(*z), max(map(abs, z))
        return (*self.drive.error.tolist(), *told["usage"], told["share"], told["nodes"], told["feature_energy"], norm,
                peak, *z[6:])  # fmt: skip


#: What a law is taken to report where it reports nothing.
UNTOLD: dict[str, Any] = {"usage": (math.nan,) * 2, "share": 1.0, "nodes": 0, "feature_energy": 0.0,
                          "input": np.full(8, math.nan)}  # fmt: skip
STATE: dict[str, Any] = {"error": slice(0, 2), "usage": slice(2, 4), "share": 4, "nodes": 5, "feature_energy": 6}
STATE |= {"input_norm": 7, "input_peak": 8, "virtual_acceleration": slice(9, 11)}


def simulate(config: Config) -> Recording:
    """Train on the strokes (if the case trains), then draw the ellipse; segments follow each other in ``time``."""
    arm = TwoLink(config.arm.lengths)
    law = build(config.law, model=arm, network=None)
    if (network := memory(law)) is not None:
        network.gain = network.gain * config.gain_factor
    parts, weights = [], []
    status = "finished"
    for number, reference in _segments(config, law):
        pilot = Pilot(law, arm, reference, round(config.task.period / config.step))
        with scene(config, config.task.ellipse_start if number >= ELLIPSE else None) as world:
            part = world.run(
                reference.duration,
                {"arm": pilot},
                probes={"state": pilot.state},
                on_divergence="stop",
            )
            if config.picture and number == ELLIPSE:
                part.images["arm"] = picture(world, part["arm.position"][0])
        parts.append((number, part))
        weights.append(pilot.snapshots)
        if part.status != "finished":
            status = part.status
            break
        if pilot.network is not None and law.learning and number < ELLIPSE:
            pilot.network.reset(pilot.mean_weights if config.carried == "weights" else None)
    recording = _joined(parts, config)
    recording.status = status
    _add_weights(recording, parts, weights, law, config)
    return recording


def _segments(config: Config, law: Any) -> Iterator[tuple[int, Sampled]]:
    if config.training:
        for number, angle in enumerate(config.task.stroke_angles):
            yield number, stroke(config, angle, config.task.stroke_duration)
    if config.frozen:  # before the learning run, which changes weights and nodes
        law.learning = False
        yield FROZEN, ellipse(config, config.task.duration)
        law.learning = True
    yield ELLIPSE, ellipse(config, config.task.duration)


def _joined(parts: list[tuple[int, Recording]], config: Config) -> Recording:
    """One recording, its segments in the order of their numbers."""
    parts = sorted(parts, key=lambda part: part[0])
    state = np.concatenate([part["state"] for _, part in parts])
    series = {name: state[:, columns] for name, columns in STATE.items()}
    for name, source in (("torque", "arm.torque"), ("position", "arm.position"), ("tip", "arm.tip")):
        series[name] = np.concatenate([part[source][:, :2] for _, part in parts])
    series["segment"] = np.concatenate([np.full(len(part.time), number) for number, part in parts])
    images = {name: image for _, part in parts for name, image in part.images.items()}
    return Recording(
        {"time": np.arange(len(state)) * config.step, **series},
        images=images,
        steps=sum(part.steps for _, part in parts),
        simulated=sum(part.simulated for _, part in parts),
    )


def _add_weights(
    recording: Recording, parts: list[tuple[int, Recording]], weights: list[list[Array]], law: Any, config: Config
) -> None:
    """Frames ``settled`` and, of growing networks, ``weights`` (those of the Gaussians, over time) and ``centres``."""
    network = memory(law)
    if network is None:
        return
    histories = sorted(zip([number for number, _ in parts], weights), key=lambda item: item[0])
    per_node = network.basis.features_per_node
    last = round(10.0 / (SNAPSHOT * config.step))
    recording.frames["settled"] = pd.DataFrame(
        [settled(history[-last:], per_node) for number, history in histories if number == ELLIPSE]
    )
    if not network.basis.grows:
        return
    basis, rows = network.basis, []
    for number, history in histories:
        for k, snapshot in enumerate(history):
            gaussians = np.full((basis.nodes, 2), np.nan)
            gaussians[: len(snapshot) // per_node] = snapshot[::per_node]
            rows.append([number, k * SNAPSHOT * config.step, *gaussians.T.ravel()])
    names = [f"joint{joint}_node{node}" for joint in (1, 2) for node in range(1, basis.nodes + 1)]
    recording.frames["weights"] = pd.DataFrame(rows, columns=["segment", "time", *names])
    inputs = [f"{name}{joint}" for name in ("q", "dq", "alpha", "dalpha") for joint in (1, 2)]
    recording.frames["centres"] = pd.DataFrame(basis.centres.copy(), columns=inputs)


def settled(history: list[Array], per_node: int) -> dict[str, float]:
    """Whether weights (features, outputs) recorded over whole periods have converged, and how many are large.

    drift: change of the mean from the first to the second half; ripple: rms about the mean of the second half, both
    over the norm of that mean. large, very_large: Gaussians whose weight of joint 1 exceeds a tenth, a fifth of the
    largest; nodes: all.
    """
    half = np.array([weights for weights in history if weights.shape == history[-1].shape])
    first, second = half[: len(half) // 2], half[len(half) // 2 :]
    mean = second.mean(axis=0)
    size = np.linalg.norm(mean) or 1.0
    return {
        "drift": float(np.linalg.norm(mean - first.mean(axis=0)) / size) if len(first) else 0.0,
        "ripple": float(np.sqrt(np.mean(np.sum((second - mean) ** 2, axis=(1, 2)))) / size),
        "large": large(mean[::per_node, 0]),
        "very_large": large(mean[::per_node, 0], 0.2),
        "nodes": len(mean[::per_node]),
        "global": float(np.abs(mean[1::per_node]).max() / (np.abs(mean[::per_node]).max() or 1.0))
        if per_node == 3
        else 0.0,
    }


def large(weights: Array, share: float = 0.1) -> int:
    """Number of weights above a share of the largest."""
    size = np.abs(weights)
    return int(np.sum(size > share * size.max())) if size.max() > 0 else 0


def picture(world: World, position: Array) -> Any:
    """The arm seen along the normal of its plane: (x, y) in [0, 2] x [-1, 1] m fills the picture."""
    from dexrepro.physics.rendering import Camera

    distance = 4.0
    view = Camera((1.0, 0.0, 0.0), distance, 0.0, -89.99, 2 * math.degrees(math.atan(1.0 / distance)))
    return world.render({"arm": position}, camera=view, size=(500, 500))
