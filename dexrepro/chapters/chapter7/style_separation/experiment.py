"""How many style parameters the twelve reactions need: singular values, errors and collisions against the rank."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms_distance
from dexrepro.primitives.reactive import Styles

RATE = 50.0


def simulate(config: Config, rng: Rng) -> Recording:
    ordinary, reactions = skills.demonstrate(config)
    learned = skills.Skills(config, ordinary, reactions)
    chosen = [i for i, c in enumerate(skills.conditions(config)) if c.labels[:2] in subset(config)]
    targets = learned.reaction_targets[chosen] @ learned.reach.axes.T
    change = learned.features.blocks(learned.primitive.phases).change
    rows = []
    for rank in range(1, min(config.ranks, len(chosen)) + 1):
        styles = Styles.separate(targets, rank, config.style.shared)
        weights = styles.fit(learned.features, learned.primitive.phases, config.enhancement.ridge)
        paths = learned.perform(change @ weights)
        error = rms_distance(paths, learned.demonstrated[chosen])
        clearance = [
            float(skills.conditions(config)[i].obstacle.clearance(path, config.scene.tool_radius))
            for i, path in zip(chosen, paths)
        ]
        rows.append(
            {"rank": rank, "mean": error.mean(), "worst": error.max(), "collisions": int(np.less(clearance, 0).sum()),
             "end_error": np.linalg.norm(paths[:, -1] - learned.goal, axis=-1).max()}
        )  # fmt: skip
    spectrum = pd.DataFrame(styles.spectrum[:, : len(chosen)].T, columns=range(len(styles.spectrum)))
    frames = {"ranks": pd.DataFrame(rows), "spectrum": spectrum.head(config.ranks)}
    spread = np.sqrt(((reactions - reactions.mean(axis=1)[:, None]) ** 2).sum(axis=-1).mean(axis=(1, 2)))
    frames["spread"] = pd.DataFrame({"spread": spread[chosen]})
    return Recording(series={"time": learned.primitive.time}, frames=frames, steps=len(rows))


def subset(config: Config) -> set[tuple[str, str]]:
    """The obstacles (distance, height) whose reactions are taken together."""
    labels = {c.labels[:2] for c in skills.conditions(config)}
    return labels if config.obstacles == "all" else {tuple(config.obstacles)}


def measure(recording: Recording, config: Config) -> Metrics:
    ranks = recording.frames["ranks"].set_index("rank")
    return {
        **{f"mean{r}": float(ranks["mean"][r]) for r in ranks.index},
        **{f"worst{r}": float(ranks["worst"][r]) for r in ranks.index},
        **{f"collisions{r}": int(ranks["collisions"][r]) for r in ranks.index},
        "end_error": float(ranks["end_error"].iloc[-1]),
        "spread": float(recording.frames["spread"]["spread"].mean()),
    }
