"""What ``hand_over`` shows: its figures and tables."""

from __future__ import annotations

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "1.C": Figure(
        "AFR's contact force and phase (field or force law) while DFR touches a soft object lightly, simulated Baxter "
        "arms; desired force {.desired_force:g} N, sensor noise {.sensor_noise:g} N. The book does "
        "not show the switch.",
        "Contact force and phase over time, with a latch and with a bare comparison.",
    )
}
UNITS = {"force": "N", "sensed": "N", "phase": "1"}
TABLES = {"T1.G": "Hand-over from the field to the force law"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"latched", "bare"} <= set(recordings):
        return {}
    figure, axes = style.subplots(2, 2, height=2.8, sharex=True, sharey="row", height_ratios=(2, 1))
    for column, (case, role, word) in enumerate((("latched", "book", "Latch"), ("bare", "printed", "Bare comparison"))):
        recording = recordings[case]
        part = recording.time > 1.0
        axes[0, column].plot(recording.time[part], recording["sensed"][part], color=style.PLAIN, linewidth=0.5,
                             label="sensed")  # fmt: skip
        axes[0, column].plot(recording.time[part], recording["force"][part], color=style.LINES[role]["color"],
                             label="true")  # fmt: skip
        axes[0, column].axhline(config.cases[case].desired_force, **style.LINES["reference"])
        axes[1, column].plot(recording.time[part], recording["phase"][part], color=style.LINES[role]["color"],
                             linewidth=0.7)  # fmt: skip
        axes[1, column].set(xlabel="Time [s]", yticks=(0, 1), yticklabels=("field", "force law"))
        times = metrics[case]["switches"]
        axes[0, column].set_title(f"{word}: {times} switch{'' if times == 1 else 'es'}")
    axes[0, 0].set_ylabel("Contact force [N]")
    axes[0, 0].set_ylim(-0.15, 3.4)
    axes[0, 0].legend(loc="upper left", ncols=2)
    latched, bare = (metrics[case]["switches"] for case in ("latched", "bare"))
    return {
        "1.C": style.title(figure, f"The phase switches {latched} times with a latch, {bare} with a bare comparison")
    }


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    table = pd.DataFrame([{"case": case.replace("_", " "), **metrics[case]} for case in recordings])
    names = {"contact": "contact after [s]", "holding_at_end": "holding at the end", "rmse": "RMS force error [N]",
             "bias": "mean force error [N]"}  # fmt: skip
    return {"T1.G": table.rename(columns=names)}
