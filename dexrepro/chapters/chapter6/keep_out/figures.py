"""What ``keep_out`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "6.C": Figure(
        "(a) A straight reach with a disk to stay out of, used as the reference point of the outside constraint: end "
        "positions are dots, crosses where the barrier is stepped over and the law is undefined from there. The "
        "consistent law cancels the primitive, so with the disk as its reference it does not move to the goal and "
        "only draws away from the disk. (b) Distance to the centre of a disk that crosses the path; the book's "
        "route, a tube about a forecast detour, against the filter and the outside law. Ours; Sect. 6.5 describes "
        "moving obstacles.",
        "Paths of a reach with a still disk on its way, and distances to a disk that crosses it, under four laws each.",
    )
}
UNITS = {"position": "cm", "centre": "cm", "distance": "cm"}
TABLES = {"T6.C": "Laws that stay outside of a still and of a moving disk"}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for case, numbers in metrics.items():
        c = config.cases[case]
        rows.append({
            "case": case, "route": c.route, "law": c.cdmp.law, "smallest distance / radius": numbers["distance_share"],
            "goal error [cm]": numbers["goal_error_worst"], "first stepped over at [s]": numbers["stepped_over_at"],
            "runs that stepped over": f"{numbers['stepped_over']} of {len(c.offsets)}",
        })  # fmt: skip
    return {"T6.C": pd.DataFrame(rows)}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    still = {
        "still_feedforward": "book",
        "still_printed": "printed",
        "still_consistent": "extra1",
        "still_filter": "rival",
    }
    moving = {
        "moving_detour_feedforward": ("detour, feedforward", "book"),
        "moving_detour_printed": ("detour, printed", "printed"),
        "moving_filter": ("filter", "rival"),
        "moving_outside": ("outside", "extra2"),
    }
    if not set(still) | set(moving) <= set(recordings):
        return {}
    figure, (left, right) = style.subplots(1, 2, height=2.8)
    shown = config.cases["still_printed"]
    angle = np.linspace(0, 2 * np.pi, 100)
    place = np.array([shown.reach / 2, shown.offsets[1]])
    left.fill(*(place[:, None] + shown.radius * np.array([np.cos(angle), np.sin(angle)])), color="#A8DCF0", linewidth=0)
    for case, line in still.items():
        path = recordings[case]["position"][:, 2:4]
        path = path[np.isfinite(path).all(axis=1)]
        left.plot(*path.T, label=config.cases[case].cdmp.law, **style.LINES[line])
        whole = len(path) == len(recordings[case].time)
        left.plot(*path[-1], "o" if whole else "x", color=style.LINES[line]["color"], markersize=3.5 if whole else 6)
    moved = recordings["still_consistent"]["position"]
    way = 1e4 * float(np.linalg.norm(moved[-1, 2:4] - moved[0, 2:4]))
    left.annotate(
        f"consistent: ends\n{way:.1f} µm from its start", (0, 0), (0.1, -1.6), fontsize=6.5,
        color=style.LINES["extra1"]["color"], arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": "#444444"},
    )  # fmt: skip
    left.set(aspect="equal", xlabel="x [cm]", ylabel="y [cm]", xlim=(-0.5, 10.5), ylim=(-2, 3))
    left.legend(loc="upper left", ncols=2, fontsize=6.5)
    for case, (label, line) in moving.items():
        run = recordings[case]
        right.plot(run.time, run["distance"][:, 0], label=label, **style.LINES[line])
    right.axhline(shown.radius, **style.LINES["reference"])
    right.annotate(
        "edge of the disk", (0.1, shown.radius), xytext=(0, -2), textcoords="offset points", fontsize=7, va="top"
    )
    right.set(xlabel="Time [s]", ylabel="Distance to the centre [cm]", ylim=(0, 9.5))
    right.legend(loc="upper center", fontsize=6.5, ncols=2)
    style.panels((left, right), "still disk", "disk that crosses the path")
    outside = [metrics[case] for case in ("still_printed", "still_feedforward", "moving_outside")]
    over = sum(numbers["stepped_over"] or 0 for numbers in outside)
    total = sum(len(config.cases[case].offsets) for case in ("still_printed", "still_feedforward", "moving_outside"))
    detour = metrics["moving_detour_feedforward"]["distance_share"] or 0.0
    style.title(
        figure,
        f"{over} of {total} runs of the outside law step over its barrier; "
        f"a tube about a detour keeps {style.at_least(detour, 2)} radii off",
    )
    return {"6.C": figure}
