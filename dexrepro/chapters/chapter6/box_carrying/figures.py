"""What ``box_carrying`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Film, Recordings
from dexrepro.physics.rendering import Camera
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "6.12": Figure(
        "Two simulated arms carry a box of 0.6 kg between flat palms, without any grip but friction: rendered "
        "instants, distance of the box from the middle between the palms, and the smaller palm force. The book shows "
        "photographs of the constrained case.",
        "Pictures of the arms with the box, its distance from the hands and the palm forces, for two sets of paths.",
    )
}
UNITS = {"palm_left": "N", "palm_right": "N", "middle": "m", "reference_left": "m", "reference_right": "m"}
TABLES = {"T6.Sd": "Variants of law, squeeze and joint stiffness in carrying the box"}
FILM = Film(
    "constrained", "Two arms carry the box between flat palms and put it down.",
    Camera(target=(0.62, 0.03, 0.14), distance=1.85, yaw=115.0, pitch=-25.0, field_of_view=42.0), "palm_left",
    "Force of the left palm [N]",
)  # fmt: skip


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    columns = {
        "carried": "carried",
        "lost_at": "lost after [s]",
        "box_error_max": "largest box error [cm]",
        "min_palm_force": "smallest palm force [N]",
        "tracking_error": "largest palm error [cm]",
    }
    return {"T6.Sd": by_case(metrics, columns)}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"constrained", "original"} <= set(recordings):
        return {}
    runs = {"constrained": recordings["constrained"], "original": recordings["original"]}
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 4.2))
    halves = figure.add_gridspec(2, 1, height_ratios=[2, 1.5])
    grid, graphs = halves[0].subgridspec(2, 6), halves[1].subgridspec(1, 2)
    pictures = style.trimmed({(case, name): image for case, run in runs.items() for name, image in run.images.items()})
    for row, (case, run) in enumerate(runs.items()):
        for i, name in enumerate(sorted(run.images)):
            axes = figure.add_subplot(grid[row, i])
            word = f"{case + ', ' if i == 0 else ''}{name.partition('_')[2]} s"
            style.photo(axes, pictures[case, name], word, fontsize=7)
    left, right = (figure.add_subplot(graphs[k]) for k in (0, 1))
    for (case, run), line in zip(runs.items(), ("book", "plain")):
        gap = 100 * np.linalg.norm(run["box.pose"][:, :3] - run["middle"], axis=1)
        left.plot(run.time, gap, label=case, **style.LINES[line])
        right.plot(run.time, np.minimum(run["palm_left"], run["palm_right"]), **style.LINES[line])
    left.axhline(100 * config.lost, **style.LINES["reference"])
    for axes in (left, right):
        style.event(axes, config.ramp, "start")
    left.annotate("lost", (8.4, 100 * config.lost), fontsize=7, va="bottom", ha="right")
    left.set(xlabel="Time [s]", ylabel="Box error [cm]", ylim=(0, 12))
    right.set(xlabel="Time [s]", ylabel="Smaller palm force [N]")
    left.legend(loc="center right")
    kept, dropped = metrics["constrained"]["box_error_max"], metrics["original"]["lost_at"]
    late = f",\nalong the original ones it is lost {dropped:.1f} s after the start" if dropped else ""
    finding = f"Along constrained paths the box strays {style.at_most(kept or 0.0, 1)} cm at most{late}"
    return {"6.12": style.title(figure, finding)}
