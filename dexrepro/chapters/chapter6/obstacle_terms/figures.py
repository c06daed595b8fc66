"""What ``obstacle_terms`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter6 import plane
from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "6.D": Figure(
        "(a) Sub-skill 2 past the triangle: steering [16] with three representations, dynamic potential [39], filter "
        "and constrained primitive. (b) Steering over the heading error. (c) Distance to a point obstacle over the "
        "offset of a straight reach. (d) Bars passed by paths that arrive, of five offsets. Ours, on Sect. 6.5.",
        "Paths past a triangle, the steering term over the heading, distances to a point and bars passed, by method.",
    )
}
TABLES = {
    "T6.D": "Clearance to the triangle with standard and with tuned parameters (20 settings each), and cost a step",
    "T6.E": "Bars passed, of five offsets, by half-width and representation",
}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    columns = {"clearance": "clearance, standard [cm]", "goal_error": "goal error, standard [cm]",
               "tuned_clearance": "clearance, tuned [cm]", "settings_that_pass": "settings of 20 that pass",
               "bars_tuned_20mm": "bars of 2 cm passed, best setting, of 5",
               "operations": "operations a step"}  # fmt: skip
    bars = []
    for case in recordings:
        counts = {
            name.removeprefix("bars_passed_").removesuffix("mm") + " mm": value
            for name, value in metrics[case].items()
            if name.startswith("bars_passed_")
        }
        if counts:
            bars.append({"method": case, **counts})
    return {"T6.D": by_case(metrics, columns, recordings, "method"), "T6.E": pd.DataFrame(bars)}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    lines = {
        "centroid": "extra1",
        "closest": "extra2",
        "boundary": "extra3",
        "potential": "rival",
        "filter": "plain",
        "constrained": "book",
    }
    if not set(lines) <= set(recordings):
        return {}
    figure, ((a, b), (c, d)) = style.subplots(2, 2, height=4.6)
    plane.draw_map(a, config.cases["constrained"], reference=False)
    for case, line in lines.items():
        a.plot(*recordings[case].frames["path"].to_numpy().T, label=case, **style.LINES[line])
    a.set(xlim=(4, 18.5), ylim=(9, 16), ylabel="y [cm]")
    phi = np.linspace(0, np.pi / 2, 300)
    b.plot(np.degrees(phi), config.strength * phi * np.exp(-config.decay * phi), **style.LINES["plain"])
    b.set(xlabel="Angle between heading and obstacle [deg]", ylabel="$\\|p\\|/\\|v\\|$ [1/s]")
    for case, name in (("centroid", "steering"), ("potential", "potential")):
        frame = recordings[case].frames["points"]
        c.plot(np.maximum(frame.offset, 1e-8), frame.distance, marker=".", label=name, **style.LINES[lines[case]])
    c.set(xscale="log", xlabel="Offset of the point [cm] (left: 0)", ylabel="Smallest distance [cm]", ylim=(0, None))
    c.legend()
    for case in ("centroid", "closest", "boundary", "potential"):
        bars = recordings[case].frames["bars"]
        passed = bars.passed.groupby(bars.half_width).sum()
        d.plot(passed.index, passed, marker=".", **style.LINES[lines[case]])
    d.set(xlabel="Half-width of the bar [cm]", ylabel="Bars passed, of 5 [-]", ylim=(-0.2, 5.3))
    figure.legend(*a.get_legend_handles_labels(), loc="outside lower center", ncols=6, fontsize=6.5)
    style.panels((a, b, c, d), "past the triangle", "steering term", "point obstacle", "bars")
    near, width = (metrics["centroid"][f"{name}aligned_distance"] or 0 for name in ("", "nearly_")), 20
    best = max(metrics[case][f"bars_passed_{width}mm"] or 0 for case in ("centroid", "closest", "boundary"))
    tuned = max(metrics[case][f"bars_tuned_{width}mm"] or 0 for case in ("centroid", "closest", "boundary"))
    text = "Steering passes a point ahead at {:.2f} cm, beside it at {:.2f} cm".format(*near)
    passes = f"{best} of 5 bars of half-width {width} mm, tuned {tuned}"
    return {"6.D": style.title(figure, f"{text}; it passes {passes}")}
