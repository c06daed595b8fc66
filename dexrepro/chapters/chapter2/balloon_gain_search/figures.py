"""What ``balloon_gain_search`` shows: its figures and tables."""

from __future__ import annotations

import pandas as pd

from dexrepro.chapters.chapter2.gain_search import figures as gain_search
from dexrepro.experiment import AllMetrics, Config, Recordings

TABLES = {"T2.H": "Gains found for the Baxter experiment: the best of equally many random candidates"}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    return {"T2.H": gain_search.table(metrics["all"], config)}
