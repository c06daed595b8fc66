"""Tables of metrics, one row a case."""

import pandas as pd

from dexrepro.report.tables import by_case

METRICS = {"proposed": {"rmse": 0.1, "peak": 2.0}, "rival": {"rmse": 0.3}}


def test_rows_are_cases_and_absent_metrics_stay_empty() -> None:
    table = by_case(METRICS, {"rmse": "RMSE [N]", "peak": "peak [N]"})
    assert list(table) == ["case", "RMSE [N]", "peak [N]"]
    assert table["RMSE [N]"].tolist() == [0.1, 0.3]
    assert pd.isna(table["peak [N]"][1])


def test_cases_are_chosen_and_those_without_metrics_left_out() -> None:
    assert by_case(METRICS, {}, ["rival", "not run"], first="law")["law"].tolist() == ["rival"]
