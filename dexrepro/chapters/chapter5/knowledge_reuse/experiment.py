"""A network that goes on learning letter after letter, against one that starts anew (Sect. 5.4.2)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter5 import letters, pen
from dexrepro.chapters.chapter5.bounded_tracking import experiment as bounded_tracking
from dexrepro.control.contract import build
from dexrepro.experiment import Config, Metrics, Recording


def simulate(config: Config, rng: Rng) -> Recording:
    nominal, generator = pen.model(config), rng("nodes")
    centres, weights, rows, steps, status = np.empty((0, 6)), None, [], 0, "finished"
    for index, letter in enumerate(letters.named("sequence", config, least=1)):
        path = bounded_tracking.learned_path(letter, config, rng)
        target = pen.reference(pen.on_paper(path), config.arm.step)
        added = config.network.nodes if index == 0 else config.network.added
        centres = np.concatenate([centres, pen.node_centres(config, target, added, generator)])
        learner = pen.network(config, centres, target)
        learner.reset(weights if config.network.keep else None)
        recording = pen.track(config, target, build(config.law, model=nominal, network=learner), nominal)
        if config.network.keep:
            weights = learner.weights.copy()
        squared = np.sum(recording["error"] ** 2, axis=1)
        usage = pen.bound_use(recording, config).max()
        early = recording.between(0, config.early)
        rows.append((letter, len(centres), *(1e3 * np.sqrt((squared[early].mean(), squared.mean()))), usage))
        steps += recording.steps
        status = recording.status if status == "finished" else status
    frame = pd.DataFrame(rows, columns=["letter", "nodes", "early", "whole", "bound_use"])
    return Recording(frames={"letters": frame}, steps=steps, simulated=steps * config.arm.step, status=status)


def measure(recording: Recording, config: Config) -> Metrics:
    frame = recording.frames["letters"].set_index("letter")
    return {f"{letter}.{name}": float(frame[name][letter]) for letter in frame.index for name in frame.columns[1:]}
