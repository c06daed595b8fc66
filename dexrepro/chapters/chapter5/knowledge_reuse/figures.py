"""What ``knowledge_reuse`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "5.E": Figure(
        "RMS joint error in the first second of each letter and over the whole letter, for a network that keeps its "
        "weights and gains ten nodes a letter and for one that starts anew with as many nodes. Ours; the book says "
        "that learned weights can be accumulated and reused.",
        "Errors in the first second and over each letter, weights kept and learned anew.",
    )
}
TABLES = {"T5.I": "RMS joint error [mrad] with weights kept, learned anew, or kept under the printed sign"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
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
    less = f"an error at least {style.at_least(gain, 1)} times smaller"
    return {"5.E": style.title(figure, f"Kept weights begin each later letter with {less}")}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    parts = [recording.frames["letters"].assign(weights=case) for case, recording in recordings.items()]
    names = {
        "early": f"first {config.early:g} s [mrad]",
        "whole": "whole letter [mrad]",
        "bound_use": "largest share of the bound",
    }
    return {"T5.I": pd.concat(parts, ignore_index=True).rename(columns=names)} if parts else {}
