"""Two results side by side: configuration, metrics, verdicts, and their series in one picture or on a page."""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dexrepro.checks import differences, leaves
from dexrepro.damage import check_result
from dexrepro.errors import InputError
from dexrepro.recordings import load_recording
from dexrepro.report import explorer, style, words
from dexrepro.report.page import templates
from dexrepro.report.verdicts import changes
from dexrepro.storage import read_json, read_yaml

PANELS = 6
LONGEST = 120  # letters of a value, such as all that a case sets


def _short(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 4]} ..."


def compare(a: Path, b: Path) -> Iterator[str]:
    """Yield what differs, a line each, and write ``diff-<b>.png`` into the folder ``a``'s parent.

    Raises InputError where a folder holds no result, or a damaged one.
    """
    _check(a, b)
    for line in differences(*(read_yaml(folder / "config.yaml") for folder in (a, b))):
        mine, mark, theirs = line.rpartition(" (book: ")
        yield f"config   {_short(mine)} ({b}: {_short(theirs[:-1])})" if mark else f"config   {line}"
    for name, mine, theirs in _differing(*(read_json(folder / "metrics.json") for folder in (a, b))):
        yield f"metric   {name}: {mine} | {theirs}"
    verdicts = ({c["id"]: c["verdict"] for c in read_json(folder / "claims.json")} for folder in (a, b))
    for key, mine, theirs in _differing(*verdicts):
        yield f"verdict  {key}: {mine} | {theirs}"
    picture = _overlay(a, b)
    yield f"series   {picture}" if picture else "series   no common channel differs"


def write_page(a: Path, b: Path, page: Path) -> None:
    """Write one file that opens from disk: changed parameters, verdicts and metrics, and both recordings to explore.

    Raises InputError where a folder holds no result, or a damaged one, or the two are of different experiments.
    """
    _check(a, b)
    runs = [read_json(folder / "run.json") for folder in (a, b)]
    names = [run["experiment"] for run in runs]
    if names[0] != names[1]:
        raise InputError(f"{a} is a result of {names[0]}, {b} one of {names[1]}; series of one experiment are compared")
    parameters = [dict(leaves(read_yaml(folder / "config.yaml"))) for folder in (a, b)]
    metrics = _differing(*(read_json(folder / "metrics.json") for folder in (a, b)))
    series, recorded = _recorded(a, b, [run["cases"] for run in runs], page)
    assets = ("style.css", "app.js", "explorer.js", "vendor/uplot/uPlot.min.css", "vendor/uplot/uPlot.iife.min.js")
    text = (
        templates()
        .get_template("diff.html")
        .render(
            a=str(a),
            b=str(b),
            experiment=names[0],
            parameters=_of_their_own(_differing(*parameters)),
            metrics=[
                (name, words.number(x), words.number(y)) for name, x, y in sorted(metrics, key=_change, reverse=True)
            ],
            changes=changes(*(read_json(folder / "claims.json") for folder in (a, b))),
            series=series,
            recorded=recorded,
            scripts=json.dumps(
                [*assets, "files/diff/series.js", *(case["script"] for case in series["cases"].values())]
            ),
            inside={name: _asset(name) for name in assets},
        )
    )
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(text, encoding="utf-8")


def _check(*folders: Path) -> None:
    for folder in folders:
        if not (folder / "metrics.json").exists():
            raise InputError(f"{folder} holds no result (no metrics.json)")
        check_result(folder, "config.yaml", "metrics.json", "claims.json", series=True)


def _differing(first: Mapping[str, Any], second: Mapping[str, Any]) -> list[tuple[str, Any, Any]]:
    """(name, value, value) of what differs; None where one lacks it."""
    names = dict.fromkeys([*first, *second])
    return [(name, first.get(name), second.get(name)) for name in names if first.get(name) != second.get(name)]


def _of_their_own(rows: list[tuple[str, Any, Any]]) -> list[tuple[str, Any, Any]]:
    """The rows without those of cases that only follow what the experiment says for all of them."""
    shared = {(name, str(x), str(y)) for name, x, y in rows}
    return [row for row in rows if (re.sub(r"^cases\.\w+\.", "", row[0]), str(row[1]), str(row[2])) not in shared
            or not row[0].startswith("cases.")]  # fmt: skip


def _change(row: tuple[str, Any, Any]) -> float:
    """The relative change of a metric; infinite where one lacks it."""
    _, x, y = row
    return abs(x - y) / max(abs(x), abs(y)) if x is not None and y is not None else np.inf


def _recorded(a: Path, b: Path, cases: list[dict[str, Any]], page: Path) -> tuple[dict[str, Any], str]:
    """What the page knows of the series of both, cases of one name first, and the script that holds them."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for name, place, known in zip("AB", (a, b), cases):
            experiment = check_result(place)
            target = Path(folder) / name
            target.mkdir()
            if (series := explorer.write(place, target, known, experiment.film, experiment.units)) is None:
                return {"cases": {}}, ""
            for case, entry in series["cases"].items():
                entry["csv"] = Path(os.path.relpath(place / "series" / f"{case}.csv.gz", page.parent)).as_posix()
            series["cases"] = {f"{name}: {case}": entry for case, entry in series["cases"].items()}
            found.append(series)
        scripts = [path.read_text("utf-8") for path in sorted(Path(folder).rglob("series-*.js"))]
    first, second = found
    both = [case for case in cases[0] if f"A: {case}" in first["cases"] and f"B: {case}" in second["cases"]]
    first["first"]["cases"] = [f"{name}: {case}" for case in both[:2] for name in "AB"]
    first["cases"] |= second["cases"]
    first["channels"] = list({channel["name"]: channel for channel in first["channels"] + second["channels"]}.values())
    return first | {"name": "diff"}, words.script('RECORDED["diff"]', first | {"name": "diff"}) + "".join(scripts)


def _asset(name: str) -> str:
    home = Path(__file__).parent
    return (home / ("" if name.startswith("vendor") else "templates") / name).read_text("utf-8")


def _overlay(a: Path, b: Path) -> Path | None:
    pairs = []
    cases = [case for case in read_json(a / "run.json")["cases"] if case in read_json(b / "run.json")["cases"]]
    for case in cases:
        first, second = (load_recording(folder / "series", case) for folder in (a, b))
        for channel in first.series:
            if channel == "time" or channel not in second or first[channel].dtype.kind not in "fi":
                continue
            one, two = (r[channel].reshape(len(r.time), -1) for r in (first, second))
            resampled = np.column_stack([np.interp(first.time, second.time, column) for column in two.T])
            if one.shape == resampled.shape:
                spread = np.ptp(one) or 1.0
                pairs.append((float(np.max(np.abs(one - resampled)) / spread), case, channel, first, second))
    pairs = sorted((pair for pair in pairs if pair[0] > 0), key=lambda pair: -pair[0])[:PANELS]
    if not pairs:
        return None
    with style.style():
        figure, axes = style.subplots(len(pairs), height=1.3 * len(pairs) + 0.4, squeeze=False)
        for ax, (_, case, channel, first, second) in zip(axes[:, 0], pairs, strict=True):
            lines = ax.plot(first.time, first[channel], color=style.BOOK)
            others = ax.plot(second.time, second[channel], color=style.RIVAL, linestyle="-.")
            ax.set_title(f"{case}: {channel}")
        axes[0, 0].legend([lines[0], others[0]], [str(a), str(b)])
        axes[-1, 0].set_xlabel("Time [s]")
        target = a.parent / f"diff-{a.name}-{b.name}.png"
        figure.savefig(target)
    return target
