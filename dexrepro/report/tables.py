"""Tables that every chapter makes of its metrics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import pandas as pd

from dexrepro.experiment import AllMetrics


def by_case(
    metrics: AllMetrics, columns: Mapping[str, str], cases: Iterable[str] | None = None, first: str = "case"
) -> pd.DataFrame:
    """One row a case: its name under ``first``, then its metrics under the headings that ``columns`` gives them.

    cases: which, in this order, by default all; those without metrics are left out. What a case lacks stays empty.
    """
    shown = metrics if cases is None else [case for case in cases if case in metrics]
    return pd.DataFrame(
        [{first: case, **{text: metrics[case].get(name) for name, text in columns.items()}} for case in shown]
    )
