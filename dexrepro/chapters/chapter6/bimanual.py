"""Experiment 2: from measured skeletons to joint paths that keep link lengths and hand distance (Sect. 6.4.2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from dexrepro.arrays import Array
from dexrepro.chapters.chapter6 import learning
from dexrepro.experiment import Config
from dexrepro.humans.skeleton import Body, DepthCamera, Occlusion, carry
from dexrepro.primitives.constrained import Reference, Skill
from dexrepro.primitives.dmp import DMP

SHOULDER, ELBOW, WRIST = 0, 1, 2


@dataclass
class Movement:
    """Joint paths of several groups of demonstrations.

    time: (n,) [s]; truth: (n, 2, 3, 3); original and joints (unconstrained and constrained primitives):
    (n, groups, 2, 3, 3), with axes side (left, right), joint (shoulder, elbow, wrist), coordinate [cm].
    measured: (groups, demonstrations, samples, 6, 3); projections: projected steps of each track. Where a law without
    projection leaves its barrier, that track and those after it are NaN, the first one from that instant.
    """

    time: Array
    truth: Array
    measured: Array
    original: Array
    joints: Array
    projections: dict[str, int]
    undefined_from: float | None


def body(config: Config) -> Body:
    s = config.skeleton
    return Body(s.upper_arm, s.forearm, s.half_width, s.box_length)


def truth(config: Config, u: Array) -> Array:
    """True joint positions (n, 6, 3) at normalised times."""
    s = config.skeleton
    return carry(u, body(config), s.centres, s.instants, np.radians(s.yaw), np.radians(s.twist))


def camera(config: Config) -> DepthCamera:
    c = config.camera
    occlusions = {name: Occlusion(*values) for name, values in c.occlusions.items()}
    return DepthCamera(tuple(c.noise), occlusions, c.occlusion_gain, c.bursts)


def move(config: Config, rng: np.random.Generator) -> Movement:
    """Measure, learn a primitive a joint from the median demonstration, and apply the two loops of Fig. 6.8."""
    s = config.skeleton
    exact = truth(config, np.linspace(0, 1, s.samples))
    groups = s.groups
    measured = np.stack([camera(config).observe(exact, s.demonstrations, rng) for _ in range(groups)])
    measured *= 1 + config.perturbation
    median = np.median(measured, axis=1)
    steps = round(s.duration / config.step)
    time = np.linspace(0, s.duration, steps + 1)
    learned = [
        [learning.learn(np.linspace(0, s.duration, s.samples), median[g, :, j], config.dmp) for j in range(6)]
        for g in range(groups)
    ]
    nominal = [[p.rollout(config.step, horizon=s.duration) for p in row] for row in learned]
    original = np.stack([np.stack([m.position for m in row], axis=1) for row in nominal], axis=1)
    original = original.reshape(steps + 1, groups, 2, 3, 3)
    joints, projections, lost = _constrain(config, time, original, _skills(learned, nominal))
    at = truth(config, np.linspace(0, 1, steps + 1)).reshape(-1, 2, 3, 3)
    return Movement(time, at, measured, original, joints, projections, lost)


def _skills(learned: list[list[DMP]], nominal: Any) -> list[Skill]:
    """A batch (groups * 2 sides) for each of shoulder, elbow and wrist."""
    skills = []
    for joint in (SHOULDER, ELBOW, WRIST):
        pairs = [(row[side * 3 + joint], m[side * 3 + joint]) for row, m in zip(learned, nominal) for side in (0, 1)]
        skills.append(learning.skill([p for p, _ in pairs], [m for _, m in pairs]))
    return skills


def _constrain(
    config: Config, time: Array, original: Array, skills: list[Skill]
) -> tuple[Array, dict[str, int], float | None]:
    """Loop 1, relative distance, loop 2: the stages that :func:`stages` names, in its order."""
    s, x = config.skeleton, {joint: original[:, :, :, joint].copy() for joint in (SHOULDER, ELBOW, WRIST)}
    projections: dict[str, int] = {}
    lost: list[float] = []

    def track(name: str, joint: int, reference: Array, margin: float) -> None:
        x[joint], projections[name] = _track(config, time, skills[joint], reference, margin)
        undefined = ~np.isfinite(x[joint]).all(axis=(1, 2, 3))
        if undefined.any() and not lost:
            lost.append(float(time[undefined.argmax()]))

    links = {ELBOW: (SHOULDER, s.upper_arm), WRIST: (ELBOW, s.forearm)}
    if config.loop1:
        for joint, (base, length) in links.items():
            track(f"loop 1, {_NAMES[joint]}", joint, _at_length(x[base], x[joint], length), config.link_margin)
    if config.relative:
        centre, heading = x[WRIST].mean(axis=2, keepdims=True), x[WRIST][:, :, 1:] - x[WRIST][:, :, :1]
        heading = heading / np.linalg.norm(heading, axis=-1, keepdims=True)
        hands = centre + s.box_length / 2 * np.concatenate([-heading, heading], axis=2)
        track("hands", WRIST, hands, config.hand_margin)
    if config.loop2:
        for joint, base, length in ((ELBOW, WRIST, s.forearm), (SHOULDER, ELBOW, s.upper_arm)):
            track(f"loop 2, {_NAMES[joint]}", joint, _at_length(x[base], x[joint], length), config.link_margin)
    return np.stack([x[SHOULDER], x[ELBOW], x[WRIST]], axis=3), projections, lost[0] if lost else None


_NAMES = {SHOULDER: "shoulder", ELBOW: "elbow", WRIST: "wrist"}


def stages() -> list[tuple[str, list[str]]]:
    """Names of the stages and their tracks, as Fig. 6.8 shows them."""
    return [
        ("loop 1", ["elbow about shoulder", "wrist about elbow"]),
        ("relative", ["hands about their centre"]),
        ("loop 2", ["elbow about wrist", "shoulder about elbow"]),
    ]


def _at_length(base: Array, joint: Array, length: float) -> Array:
    """Points at a link's length from its base, in the joint's present direction."""
    link = joint - base
    return base + length * link / np.linalg.norm(link, axis=-1, keepdims=True)


def _track(config: Config, time: Array, skill: Skill, reference: Array, margin: float) -> tuple[Array, int]:
    """Constrained primitives of one joint, both sides and all groups, about references (n, groups, 2, 3)."""
    shape = reference.shape
    flat = reference.reshape(len(time), -1, 3)
    knots = np.linspace(0, len(time) - 1, config.skeleton.samples).round().astype(int)
    if not np.isfinite(flat).all():
        return np.full(shape, np.nan), 0
    spline = CubicSpline(time[knots], flat[knots])
    smooth = Reference(spline(time), spline(time, 1), spline(time, 2))
    if not config.primitive:
        return smooth.position.reshape(shape), 0
    path = learning.constrained(
        skill, smooth, Config({**config.cdmp, "margin": margin}), config.step, skill.time_constant * smooth.velocity[0]
    )
    return path.position.reshape(shape), int(path.projected.any(axis=1).sum())


def lengths(joints: Array) -> Mapping[str, Array]:
    """Link lengths (..., 2 sides) and hand distance (...) of joint positions (..., 2, 3, 3) [cm]."""
    return {
        "se": np.linalg.norm(joints[..., ELBOW, :] - joints[..., SHOULDER, :], axis=-1),
        "ew": np.linalg.norm(joints[..., WRIST, :] - joints[..., ELBOW, :], axis=-1),
        "hands": np.linalg.norm(joints[..., 1, WRIST, :] - joints[..., 0, WRIST, :], axis=-1),
    }
