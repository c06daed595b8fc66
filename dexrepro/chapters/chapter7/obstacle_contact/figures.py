"""What ``obstacle_contact`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "7.D": Figure(
        "The arm passes forward over a stack that is taller than planned, so that its end touches the soft top, and "
        "is pushed sideways before the obstacle, behind it and at rest (simulated; not in the book). (a) "
        "Contact force. (b) Sideways deviation caused by the push before the obstacle. (c) Deviation under the three "
        "pushes without estimation; dots: with it.",
        "Contact force, a push and the deviations under three pushes, for four impedances with and without estimation.",
    )
}
UNITS = {
    "reference": "rad", "planned": "m", "filtered_error": "rad/s", "impedance": "N m s/rad", "stiffness": "1",
    "contact": "N", "predicted": "mm", "push": "N",
}  # fmt: skip
TABLES = {"T7.D": "Contact and pushes under constant and variable impedance"}


NAMES = {"muscle": "muscle", "low": "constant, smallest", "mean": "constant, mean", "high": "constant, largest"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"muscle", "low", "muscle_plain", "low_plain"} <= set(recordings):
        return {}
    figure, (contact, push, bars) = style.subplots(1, 3, height=2.7)
    lines = {"muscle": (style.BOOK, "-", "muscle"), "low": (style.EXTRA[0], ":", NAMES["low"]),
             "muscle_plain": (style.BOOK, "--", "muscle, no estimation"),
             "low_plain": (style.EXTRA[0], "--", f"{NAMES['low']}, no estimation")}  # fmt: skip
    start, end = config.pushes.before
    for case, (colour, line, label) in lines.items():
        recording = recordings[case]
        look: Any = {"color": colour, "linestyle": line, "linewidth": 2.6 if case == "muscle" else 1.2}
        contact.plot(recording.time, recording["contact"], label=label, **look)
        window = recording.between(start - 0.1, end + 0.3)
        free = 1e3 * (recording["arm.tip"] - recording["planned"])[:, 1]
        push.plot(recording.time[window], free[window] - free[window][0], **look)
    contact.set(xlabel="Time [s]", ylabel="Contact force [N]", xlim=(2.8, 4.2), ylim=(0, None))
    contact.legend(fontsize=6.5, loc="upper left", borderpad=0.0)
    contact.set_ylim(top=1.8 * contact.get_ylim()[1])
    push.axvspan(start, end, color="#EAF2F8", linewidth=0)
    push.set(xlabel="Time [s]", ylabel="Sideways deviation [mm]")
    width = 0.2
    colours = (style.BOOK, style.EXTRA[0], style.PLAIN, style.RIVAL)
    for k, (name, colour) in enumerate(zip(NAMES, colours)):
        places = np.arange(3) + width * (k - 1.5)
        values, estimated = (
            [metrics[case][f"{when}_push"] for when in config.pushes] for case in (f"{name}_plain", name)
        )
        bars.bar(places, values, width, color=colour, label=NAMES[name])
        bars.plot(places, estimated, ".", color="k", markersize=3)
    bars.set(xticks=range(3), xticklabels=["before", "behind", "at rest"], ylabel="Deviation [mm]")
    bars.set_ylim(top=2.2 * bars.get_ylim()[1])
    bars.plot([], [], ".", color="k", markersize=3, label="with estimation")
    bars.legend(fontsize=6.5, loc="upper right", handlelength=1.0, borderpad=0.0)
    style.panels((contact, push, bars), "contact with the stack", f"push of {config.push_force:g} N", "pushes")
    most = {
        end: max(
            float(metrics[case][f"{when}_push"] or 0.0) for case in metrics if case in cases for when in config.pushes
        )
        for end, cases in (("", tuple(NAMES)), ("_plain", tuple(f"{name}_plain" for name in NAMES)))
    }
    style.title(
        figure,
        f"Pushes move the arm by at most {style.at_most(most[''], 2)} mm with estimation, by up to "
        f"{most['_plain']:.2f} mm without, where the impedance counts",
    )
    return {"7.D": figure}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    names = {str(config.cases[case].law.get("impedance")): text for case, text in NAMES.items() if case in config.cases}
    columns = {"contact_peak": "peak contact force [N]", "contact_impulse": "contact impulse [N s]",
               "before_push": "push before [mm]", "behind_push": "push behind [mm]", "rest_push": "push at rest [mm]",
               "static_deviation": "static deviation [mm]", "rms_error": "RMS error of the run [mm]"}  # fmt: skip

    def told(case: str) -> dict[str, Any]:
        law = config.cases[case].law
        return {"impedance": names.get(str(law.get("impedance")), case), "estimation": law.get("estimation", True)}

    return {"T7.D": by_case(metrics, columns, config.cases, told=told).drop(columns="case")}
