"""What ``two_nuts`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recording, Recordings
from dexrepro.humans.operator import COMFORTABLE_ROLL, FOREARM_ROLL
from dexrepro.report import style

from .experiment import nuts

FIGURES = {
    "1.13": Figure(
        "General mapping, one synthetic operator: roll of the hand with the comfortable band and the range of the "
        "forearm, and the tool's distance from the nearer nut. The book shows five photographs.",
        "The hand stays far outside its comfortable range and the tool shakes by about a millimetre.",
    ),
    "1.14": Figure(
        "Re-fixing and a scale of 1, the same synthetic operator. The book shows five photographs.",
        "The hand stays inside its comfortable range thanks to re-fixing, and the tool shakes less.",
    ),
}
UNITS = {"roll": "rad", "tool_roll": "rad", "hand": "m", "tool": "m", "scale": "1"}
TABLES = {"T1.C": "Posture, precision and time of thirteen synthetic operators with both mappings (medians)"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    titles = {
        "general": ("1.13", "The general mapping keeps the hand out of its comfortable range"),
        "proposed": ("1.14", "Re-fixing keeps the hand comfortable, a small scale keeps the tool steady"),
    }
    return {
        identifier: _draw_history(recordings[case], text, config)
        for case, (identifier, text) in titles.items()
        if case in recordings
    }


def _draw_history(recording: Recording, text: str, config: Config) -> Drawing:
    figure, axes = style.subplots(2, 1, height=3.2, sharex=True)
    time = recording.time
    comfort, limit = np.rad2deg(COMFORTABLE_ROLL), np.rad2deg(FOREARM_ROLL)
    style.band(axes[0], time[[0, -1]], -comfort, comfort)
    for sign in (-1, 1):
        axes[0].axhline(sign * limit, **style.LINES["reference"])
    axes[0].plot(time, np.rad2deg(recording["roll"]), label="hand", **style.LINES["book"])
    axes[0].plot(time, np.rad2deg(recording["tool_roll"]), label="tool", **style.LINES["rival"])
    axes[0].set(ylabel="Roll [deg]", ylim=(-110, 260), xlim=(0, time[-1]))
    for word, height in (("comfortable", -comfort), ("range of the forearm", -limit)):
        axes[0].annotate(word, (time[-1], height), xytext=(-3, 1), textcoords="offset points", fontsize=6.5, ha="right",
                         va="bottom", color="#555555")  # fmt: skip
    axes[0].legend(loc="upper left", ncols=2)
    near = np.min(np.linalg.norm(recording["tool"][:, None] - nuts(config)[None], axis=2), axis=1)
    axes[1].semilogy(time, np.maximum(1e3 * near, 0.02), **style.LINES["book"])
    axes[1].set(xlabel="Time [s]", ylabel="To a nut [mm]", ylim=(0.1, 200))
    figure.align_ylabels(axes)
    return style.title(figure, text)


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = {case: recording.frames["operators"].median() for case, recording in recordings.items()}
    return {"T1.C": pd.DataFrame(rows).T.rename_axis("mapping").reset_index()}
