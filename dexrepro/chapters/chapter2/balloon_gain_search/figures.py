"""What ``balloon_gain_search`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd

from dexrepro.chapters.chapter2.gain_search import figures as gain_search
from dexrepro.experiment import Config, Recording

TABLES = {"T2.H": "Gains found for the Baxter experiment: the best of equally many random candidates"}


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Any], config: Config
) -> dict[str, pd.DataFrame]:
    return {"T2.H": gain_search.table(metrics["all"], config)}
