import pandas as pd

from dexrepro.experiment import Figure

FIGURES = {"90.10": Figure("simulated decay", "a falling curve")}
TABLES = {"T90.1": "final values"}
UNITS = {"x": "m"}


def draw(recordings, metrics, config):
    from dexrepro.report import style

    figure, axes = style.subplots()
    for case, recording in recordings.items():
        axes.plot(recording.time, recording["x"], label=case)
    return {"90.10": figure}


def tabulate(recordings, metrics, config):
    return {"T90.1": pd.DataFrame({"case": list(recordings), "final": [metrics[c]["final"] for c in recordings]})}
