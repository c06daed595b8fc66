"""Tables that every chapter makes of its metrics."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics


def by_case(
    metrics: AllMetrics, columns: Mapping[str, str], cases: Iterable[str] | None = None, first: str = "case",
    told: Callable[[str], Mapping[str, Any]] = lambda case: {},
) -> pd.DataFrame:  # fmt: skip
    """One row a case: its name under ``first``, then its metrics under the headings that ``columns`` gives them.

    cases: which, in this order, by default all; those without metrics are left out. What a case lacks stays empty.
    told: what stands between, by heading, such as settings of the case.
    """
    shown = metrics if cases is None else [case for case in cases if case in metrics]
    return pd.DataFrame(
        {first: case, **told(case), **{text: metrics[case].get(name) for name, text in columns.items()}}
        for case in shown
    )
