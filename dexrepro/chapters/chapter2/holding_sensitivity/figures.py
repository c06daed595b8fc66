"""What ``holding_sensitivity`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Recordings

from .experiment import flipped_claims, margins_of

TABLES = {"T2.S": "Variants that flip a verdict on Table 2.1, with the margins of the claims they touch"}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows: list[dict[str, Any]] = []
    margins = margins_of(recordings["all"].frames["errors"])
    for name, found in margins.items():
        flipped = [claim for claim, margin in found.items() if flipped_claims(margins["default"][claim], margin)]
        if flipped or name == "default":
            change = str(dict(config.variants.get(name, {}))).strip("{}").replace("'", "")
            labels = {"variant": name.replace("_", " "), "change": change, "flips": ", ".join(flipped)}
            rows.append(labels | found)
    return {"T2.S": pd.DataFrame(rows)}
