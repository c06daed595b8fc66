"""What ``grasp_through_opening`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Film, Recordings
from dexrepro.physics.rendering import Camera
from dexrepro.report import style

FIGURES = {
    "3.D": Figure(
        "Objects lifted through the opening out of {.trials} random scenes: grasps chosen by the "
        "network from the camera's picture against grasps drawn at random around what the camera sees, with 95 % "
        "intervals (simulated; closing is modelled as a rigid hold of an object that lies between the fingers). The "
        "book shows single grasps.",
        "Bars of the objects lifted with chosen and with random grasps, with intervals.",
    )
}
UNITS = {"raised": "m"}
TABLES = {"T3.G": "Scenes: grasp, what happened, errors"}
FILM = Film(
    "chosen", "The simulated arm reaches through the opening, takes the object that the network chose and lifts it out "
    "(first success; two walls of the box are left out).",
    Camera(target=(0.55, -0.2, 0.2), distance=1.65, yaw=40.0, pitch=-25.0), "raised", "Object lifted by [mm]",
    scale=1e3,
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    cases = [case for case in ("chosen", "random") if case in recordings]
    if len(cases) < 2:
        return {}
    figure, (left, right) = style.subplots(1, 2, height=2.6, width_ratios=(1, 1.2))
    for k, (case, colour) in enumerate(zip(cases, (style.BOOK, style.PLAIN))):
        found: Any = metrics[case]
        low, high = found["success"] - found["success_low"], found["success_high"] - found["success"]
        left.bar(k, 100 * found["success"], color=colour, width=0.6)
        left.errorbar(k, 100 * found["success"], [[100 * low], [100 * high]], color="black", capsize=3, linewidth=0.8)
        left.text(k + 0.06, 100 * found["success"] + 1, f"{found['lifted']}/{found['trials']}", fontsize=7)
    left.set(xticks=range(2), xticklabels=["by the network", "at random"], ylabel="Objects lifted [%]", ylim=(0, 105))
    image = recordings["chosen"].images.get("lifted")
    if image is not None:
        right.imshow(image)
    right.set_axis_off()
    chosen, drawn = (metrics[case]["lifted"] for case in cases)
    style.title(figure, f"Chosen grasps lift {chosen} of {metrics['chosen']['trials']} objects, random ones {drawn}")
    return {"3.D": figure}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    tables = []
    for case, recording in recordings.items():
        table = recording.frames["scenes"].copy()
        table.insert(0, "case", case)
        table["opening_error"] *= 1e3
        tables.append(table)
    names = {"opening_error": "opening error [mm]", "x": "x [m]", "y": "y [m]", "angle": "angle [rad]",
             "truly": "true class", "possible": "graspable candidates", "contact_time": "contact [s]"}  # fmt: skip
    return {"T3.G": pd.concat(tables).rename(columns=names)} if tables else {}
