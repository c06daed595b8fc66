"""What ``coupled_primitives`` shows: its figures and tables."""

from __future__ import annotations

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Recordings

UNITS = {"error": "cm (surface: N)", "goal_error": "cm"}
TABLES = {"T6.1": "The coupled primitives of Table 6.1 with and without their coupling"}
ROWS = {
    "obstacle": ("[16]", "acceleration", "smallest distance to a point [cm]"),
    "distance": ("[20]", "velocity", "largest error of the distance [cm]"),
    "force": ("[19]", "velocity and acceleration", "largest error of the distance [cm]"),
    "surface": ("[17]", "acceleration", "rms of the force error [N]"),
}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for case, numbers in metrics.items():
        c = config.cases[case]
        row, level, unit = ROWS[c.system]
        gains = {"gain": c.coupling, "second gain": c.prediction}
        end = {
            "metric": unit,
            "value": numbers["size"],
            "at the end": numbers["end_error"],
            "goal error [cm]": numbers["goal_error"],
        }
        rows.append({"row": row, "case": case, "coupling level": level, **gains, **end})
    return {"T6.1": pd.DataFrame(rows)}
