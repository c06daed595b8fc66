"""A skill that crosses one block grows to cross two and three, and reaches nine goals (Sect. 5.5.3)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter5 import crossing, letters
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.crossing import clearance
from dexrepro.measures import rms_distance

GOALS = ["draw", "blocks", "goal", "x", "y", "clearance", "end_error", "unchanged"]


def simulate(config: Config, rng: Rng) -> Recording:
    hand, generator = rng("demonstration"), rng("features")
    rows, changes, reached, kept = [], [], [], None
    for draw in range(config.features.draws):
        shown = {blocks: crossing.repetitions(blocks, config, hand) for blocks in crossing.HEIGHTS}
        averages = {blocks: crossing.averaged(paths, config) for blocks, paths in shown.items()}
        if reason := crossing.undefined(averages, config):
            return Recording(status=reason)
        taught = {blocks: letters.taught(average, config) for blocks, average in averages.items()}
        skills = crossing.learn(taught, config, generator)
        rows += _quality(draw, skills, config)
        changes += _changes(draw, skills, config)
        reached += _generalisations(draw, skills, config)
        kept = kept or _paths(shown, skills, config)
    return Recording(
        frames={
            "quality": pd.DataFrame(rows, columns=["draw", "skill", "blocks", "clearance", "rms"]),
            "changes": pd.DataFrame(changes, columns=["draw", "blocks", "m", "change"]),
            "goals": pd.DataFrame(reached, columns=GOALS),
            "paths": pd.concat(kept or [], ignore_index=True),
        },
        steps=config.dmp.samples * (len(rows) + len(changes) + len(reached)),
    )


def _quality(draw: int, skills: crossing.Skills, config: Config) -> list[tuple[Any, ...]]:
    """Clearance of every skill over every stack, and its distance from the demonstration of its own."""
    result = []
    for skill, primitive in skills.skills.items():
        path = letters.rollout(primitive, config)
        rms = rms_distance(path, skills.demonstrations[skill].position)
        result += [(draw, skill, blocks, clearance(path, blocks).min(), rms) for blocks in crossing.HEIGHTS]
    return result


def _changes(draw: int, skills: crossing.Skills, config: Config) -> list[tuple[Any, ...]]:
    counts, result = (0, *config.features.counts), []
    for blocks in crossing.HEIGHTS[1:]:
        paths = [letters.rollout(skills.steps[blocks, m], config) for m in counts]
        result += [
            (draw, blocks, m, rms_distance(after, before)) for m, before, after in zip(counts[1:], paths, paths[1:])
        ]
    return result


def _generalisations(draw: int, skills: crossing.Skills, config: Config) -> list[tuple[Any, ...]]:
    targets, result = crossing.goals(config), []
    for blocks in crossing.HEIGHTS[1:]:
        paths = letters.rollout(skills.skills[blocks], config, goal=targets)
        distances, ends = clearance(paths, blocks).min(axis=1), np.linalg.norm(paths[:, -1] - targets, axis=1)
        # Without a change of g every path ends where the demonstration does.
        missed = np.linalg.norm(letters.rollout(skills.skills[blocks], config)[-1] - targets, axis=1)
        for k, (goal, *found) in enumerate(zip(targets, distances, ends, missed)):
            result.append((draw, blocks, k, goal[0], goal[1], *found))
    return result


def _paths(shown: dict[int, list[Any]], skills: crossing.Skills, config: Config) -> list[pd.DataFrame]:
    """What the figure shows: demonstrations, skills with their steps, generalisations; every fifth point."""
    parts = [_frame(path, kind="demonstration", blocks=1, index=k) for k, path in enumerate(shown[1])]
    parts += [_frame(letters.rollout(p, config), kind="skill", blocks=b, index=0) for b, p in skills.skills.items()]
    parts += [_frame(letters.rollout(p, config), kind="step", blocks=b, index=m) for (b, m), p in skills.steps.items()]
    for blocks in crossing.HEIGHTS[1:]:
        paths = letters.rollout(skills.skills[blocks], config, goal=crossing.goals(config))
        parts += [_frame(path, kind="goal", blocks=blocks, index=k) for k, path in enumerate(paths)]
    return parts


def _frame(path: Any, **columns: Any) -> pd.DataFrame:
    return pd.DataFrame({**columns, **dict(zip("xyz", path[::5].T))})


def measure(recording: Recording, config: Config) -> Metrics:
    if not recording.frames:
        return {}
    quality, reached = recording.frames["quality"], recording.frames["goals"]
    clear = quality.groupby(["skill", "blocks"]).clearance.median()
    metrics: Metrics = {f"skill{s}.over{b}": float(clear[s, b]) for s in (1, 3) for b in crossing.HEIGHTS}
    metrics["skill1.rms"] = float(quality[(quality.skill == 1) & (quality.blocks == 1)].rms.median())
    changes = recording.frames["changes"].pivot(index=["draw", "blocks"], columns="m", values="change")
    for blocks in crossing.HEIGHTS[1:]:
        own = quality[(quality.skill == blocks) & (quality.blocks == blocks)]
        metrics[f"skill{blocks}.clearance"] = float(own.clearance.min())
        metrics[f"skill{blocks}.rms"] = float(own.rms.median())
        steps = changes.xs(blocks, level="blocks").to_numpy()
        metrics[f"skill{blocks}.last_change"] = float((steps[:, -1] / steps[:, 0]).max())
        metrics[f"skill{blocks}.shrinks_always"] = float(np.mean(np.diff(steps, axis=1).max(axis=1) <= 0))
        medians = np.median(steps, axis=0)
        metrics[f"skill{blocks}.largest_step"] = float((medians[1:] / medians[:-1]).max())
        part = reached[reached.blocks == blocks]
        metrics[f"goals{blocks}.clearance"] = float(part.clearance.min())
        metrics[f"goals{blocks}.free"] = float(np.mean(part.clearance > 0))
        metrics[f"goals{blocks}.end_error"] = float(part.end_error.max())
        metrics[f"goals{blocks}.missed"] = float(part.unchanged.max())
    return metrics
