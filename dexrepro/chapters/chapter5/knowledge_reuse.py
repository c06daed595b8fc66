"""A network that goes on learning letter after letter, against one that starts anew (Sect. 5.4.2)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter5 import bounded_tracking, pen
from dexrepro.experiment import Config, Figure, Metrics, Recording

FIGURES = {
    "5.E": Figure(
        "RMS joint error in the first second of each letter and over the whole letter, for a network that keeps its "
        "weights and gains ten nodes a letter and for one that starts anew with as many nodes. Ours; the book says "
        "that learned weights can be accumulated and reused.",
        "From the second letter on the network that keeps its weights starts with a smaller error.",
    ),
}
TABLES = {"T5.I": "RMS joint error [mrad] with weights kept, learned anew, or kept under the printed sign"}


def simulate(config: Config, rng: Any) -> Recording:
    nominal, generator = pen.model(config), rng("nodes")
    centres, weights, rows, steps = np.empty((0, 6)), None, [], 0
    for index, letter in enumerate(config.hand.sequence):
        path = bounded_tracking.learned_path(letter, config, rng)
        target = pen.reference(pen.on_paper(path), config.arm.step)
        added = config.network.nodes if index == 0 else config.network.added
        centres = np.concatenate([centres, pen.node_centres(config, target, added, generator)])
        learner = pen.network(config, centres)
        learner.reset(weights if config.network.keep else None)
        recording = pen.track(config, target, pen.law(config, nominal, learner), nominal)
        if config.network.keep:
            weights = learner.weights.copy()
        squared = np.sum(recording["error"] ** 2, axis=1)
        usage = pen.bound_use(recording, config).max()
        early = recording.between(0, config.early)
        rows.append((letter, len(centres), *(1e3 * np.sqrt((squared[early].mean(), squared.mean()))), usage))
        steps += recording.steps
    frame = pd.DataFrame(rows, columns=["letter", "nodes", "early", "whole", "bound_use"])
    return Recording(frames={"letters": frame}, steps=steps, simulated=steps * config.arm.step)


def measure(recording: Recording, config: Config) -> Metrics:
    frame = recording.frames["letters"].set_index("letter")
    return {f"{letter}.{name}": float(frame[name][letter]) for letter in frame.index for name in frame.columns[1:]}


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    from dexrepro.report import style

    if not {"kept", "anew"} <= set(recordings):
        return {}
    names = list(config.hand.sequence)
    figure, axes = style.subplots(1, 2, height=2.2)
    for panel, column, title in zip(axes, ("early", "whole"), (f"first {config.early:g} s", "whole letter")):
        for shift, case, line in ((-0.2, "anew", "plain"), (0.2, "kept", "book")):
            frame = recordings[case].frames["letters"]
            places = np.arange(len(names)) + shift
            panel.bar(places, frame[column], 0.38, color=style.LINES[line]["color"], label=f"weights {case}")
        panel.set_xticks(range(len(names)), names)
        panel.set(xlabel="Letters in the order written", title=title)
    axes[0].set_ylabel("RMS joint error [mrad]")
    axes[1].legend()
    gain = min(metrics["anew"][f"{n}.early"] / metrics["kept"][f"{n}.early"] for n in names[1:])  # type: ignore[operator]
    style.title(figure, f"Kept weights begin each later letter with an error at least {gain:.1f} times smaller")
    return {"5.E": figure}


def tabulate(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    parts = [recording.frames["letters"].assign(weights=case) for case, recording in recordings.items()]
    names = {
        "early": f"first {config.early:g} s [mrad]",
        "whole": "whole letter [mrad]",
        "bound_use": "largest share of the bound",
    }
    return {"T5.I": pd.concat(parts, ignore_index=True).rename(columns=names)} if parts else {}
