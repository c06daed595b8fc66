"""Which variants turn a claim around: comparisons of two cases (or of a case with a bound), as run and as varied."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import pandas as pd

from dexrepro.experiment import AllMetrics, Config


class Variant(NamedTuple):
    """The claim says that a metric of the first is below that of the second (a case, or a number); so it is varied."""

    claim: str
    what: str
    metric: str
    varied: tuple[str, str | float]
    base: tuple[str, str | float]


def sensitivity_table(
    variants: Iterable[Variant], metrics: AllMetrics, names: Mapping[str, str], config: Config
) -> pd.DataFrame:
    """One row a variant: both numbers as run and as varied, and whether the comparison turns around.

    names: what each metric is called, with its unit. The text of a variant may name parameters of its case as {0.key}.
    """
    rows = []
    for variant in variants:
        base, varied = _pair(variant.base, variant.metric, metrics), _pair(variant.varied, variant.metric, metrics)
        if base is None or varied is None:
            continue
        rows.append(
            {
                "claim": variant.claim,
                "variant": variant.what.format(config.cases.get(variant.varied[0])),
                "quantity": names[variant.metric],
                "as run": base[0],
                "rival, as run": base[1],
                "varied": varied[0],
                "rival, varied": varied[1],
                "verdict changes": "yes" if (base[0] < base[1]) != (varied[0] < varied[1]) else "no",
            }
        )
    return pd.DataFrame(rows)


def _pair(sides: tuple[str, str | float], metric: str, metrics: AllMetrics) -> tuple[float, float] | None:
    values = [metrics.get(side, {}).get(metric) if isinstance(side, str) else side for side in sides]
    if values[0] is None or values[1] is None:
        return None
    return float(values[0]), float(values[1])
