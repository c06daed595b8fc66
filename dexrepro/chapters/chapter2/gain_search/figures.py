"""What ``gain_search`` shows: its figures and tables."""

from __future__ import annotations

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Metrics, Recordings

TABLES = {"T2.G": "Gains found for each law: the best of equally many random candidates, beside the printed ones"}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    return {"T2.G": table(metrics["all"], config)}


def table(found: Metrics, config: Config) -> pd.DataFrame:
    """What the search found, one row a law."""
    rows = [
        {
            "law": law,
            "candidates": config.candidates,
            "gains": "; ".join(f"{name} = {found[f'{law}_{name}']:.4g}" for name in ranges),
            "RMSE, default gains [N]": found[f"{law}_default"],
            "RMSE, best candidate [N]": found[f"{law}_best"],
        }
        for law, ranges in config.ranges.items()
    ]
    return pd.DataFrame(rows)
