"""Reactions to conditions that were never shown, against the nearest demonstration and against linear interpolation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms_distance
from dexrepro.networks.fuzzy import FuzzySystem

RATE = 50.0
METHODS = {"fuzzy": "fuzzy rules", "nearest": "nearest", "nearest_same": "nearest, same direction",
           "plane": "plane a direction", "ordinary": "no reaction"}  # fmt: skip

Predictor = Callable[[dict[str, float], np.ndarray, list[skills.Condition], Config], np.ndarray]


def simulate(config: Config, rng: Rng) -> Recording:
    ordinary, reactions = skills.demonstrate(config)
    learned = skills.Skills(config, ordinary, reactions)
    known = skills.conditions(config)
    frames = {
        "rules": at_the_rules(config, learned, known),
        "left_out": leave_one_out(config, learned, known),
        "unseen": unseen(config, learned, known),
    }
    return Recording(
        series={"time": learned.primitive.time}, frames=frames, steps=sum(len(frame) for frame in frames.values())
    )


def at_the_rules(config: Config, learned: skills.Skills, known: list[skills.Condition]) -> pd.DataFrame:
    """How far the fuzzy output at each rule's own condition is from that rule's reaction [cm]."""
    own = learned.perform(learned.reactions)
    blended = learned.perform(np.array([fuzzy(c.inputs, learned.reactions, known, config) for c in known]))
    return pd.DataFrame({"condition": [c.name for c in known], "rmse": rms_distance(blended, own)})


def leave_one_out(config: Config, learned: skills.Skills, known: list[skills.Condition]) -> pd.DataFrame:
    rows: dict[str, Any] = {"condition": [c.name for c in known]}
    for method, predict in PREDICTORS.items():
        forcing = [
            predict(c.inputs, np.delete(learned.reactions, i, axis=0), known[:i] + known[i + 1 :], config)
            for i, c in enumerate(known)
        ]
        rows[method] = rms_distance(learned.perform(np.array(forcing)), learned.demonstrated)
    return pd.DataFrame(rows)


def unseen(config: Config, learned: skills.Skills, known: list[skills.Condition]) -> pd.DataFrame:
    """Errors [cm] against the person's own noise-free reactions to every other combination, and who touches."""
    task, someone, scene = learned.reach, skills.person(config), config.scene
    ends = [np.asarray(scene[name]) for name in ("close", "far")]
    shown = {(round(c.distance, 6), c.obstacle.height, c.direction) for c in known}
    cases = []
    for share in np.linspace(0, 1, config.places):
        place = ends[0] + share * (ends[1] - ends[0])
        distance = float(np.hypot(*(place - scene.start)))
        for height in config.heights:
            cases += [
                ({"distance": distance, "height": height, "direction": t}, skills.Obstacle(place, height, scene.cube))
                for t in config.directions
                if (round(distance, 6), height, t) not in shown
            ]
    truth = np.array(
        [someone.ordinary(task) + someone.reaction(task, obstacle, x["direction"]) for x, obstacle in cases]
    )
    rows: dict[str, Any] = {name: [x[name] for x, _ in cases] for name in cases[0][0]}
    performed = {"person": truth}
    for method, predict in PREDICTORS.items():
        forcing = np.array([predict(x, learned.reactions, known, config) for x, _ in cases])
        performed[method] = learned.perform(forcing)
        rows[method] = rms_distance(performed[method], truth)
    for method, paths in performed.items():
        clear = [float(o.clearance(path, scene.tool_radius)) for (_, o), path in zip(cases, paths)]
        rows[f"{method}_touches"] = np.less(clear, 0).astype(int)
    return pd.DataFrame(rows)


# ------------------------------------------------------------------------------------------------------ predictors


def fuzzy(x: dict[str, float], reactions: np.ndarray, known: list[skills.Condition], config: Config) -> np.ndarray:
    whole = skills.fuzzy_system(config)
    rules = [dict(zip(("distance", "height", "direction"), c.labels)) for c in known]
    weights = whole.weights and [whole.weights[whole.rules.index(rule)] for rule in rules]
    return FuzzySystem(whole.sets, rules, weights).blend(reactions, **x)


def nearest(
    x: dict[str, float],
    reactions: np.ndarray,
    known: list[skills.Condition],
    config: Config,
    same_direction: bool = False,
) -> np.ndarray:
    """Reaction to the closest known condition in inputs divided by their ranges; ties are averaged."""
    span = np.ptp([list(c.inputs.values()) for c in skills.conditions(config)], axis=0)
    points = np.array([list(c.inputs.values()) for c in known]) / span
    away = np.linalg.norm(points - np.array(list(x.values())) / span, axis=1)
    if same_direction:
        turn = np.abs(points[:, 2] - x["direction"])
        away = np.where(turn <= turn.min() + 1e-9, away, np.inf)
    return reactions[away <= away.min() + 1e-9].mean(axis=0)


def plane(x: dict[str, float], reactions: np.ndarray, known: list[skills.Condition], config: Config) -> np.ndarray:
    """Least squares on a plane over distance and height for each direction, linear between directions."""
    directions = [config.scene[name] for name in ("left", "forward", "right")]

    def features(inputs: Mapping[str, float]) -> np.ndarray:
        hats = [np.interp(inputs["direction"], directions, unit) for unit in np.eye(3)]
        return np.outer(hats, (1.0, inputs["distance"], inputs["height"])).ravel()

    design = np.array([features(c.inputs) for c in known])
    weights = np.linalg.lstsq(design, reactions.reshape(len(reactions), -1), rcond=1e-10)[0]
    return (features(x) @ weights).reshape(reactions.shape[1:])


PREDICTORS: dict[str, Predictor] = {
    "fuzzy": fuzzy,
    "nearest": nearest,
    "nearest_same": lambda x, reactions, known, config: nearest(x, reactions, known, config, same_direction=True),
    "plane": plane,
    "ordinary": lambda x, reactions, known, config: np.zeros(reactions.shape[1:]),
}


# ---------------------------------------------------------------------------------------------------------- results


def measure(recording: Recording, config: Config) -> Metrics:
    left_out, novel, rules = (recording.frames[name] for name in ("left_out", "unseen", "rules"))
    return {
        "rule_error": float(rules.rmse.mean()),
        "rule_worst": float(rules.rmse.max()),
        **{f"left_out_{m}": float(left_out[m].mean()) for m in METHODS},
        "left_out_wins": int((left_out.fuzzy < left_out.nearest).sum()),
        **{f"unseen_{m}": float(novel[m].mean()) for m in METHODS},
        "unseen_wins": float((novel.fuzzy < novel.nearest).mean()),
        "unseen_wins_plane": float((novel.fuzzy < novel.plane).mean()),
        **{f"touches_{m}": float(novel[f"{m}_touches"].mean()) for m in (*METHODS, "person")},
        "unseen_count": len(novel),
    }
