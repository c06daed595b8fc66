"""A result folder: what its files hold, and the claims, tables and figures that are made of them alone."""

from __future__ import annotations

import base64
import contextlib
import html
import shutil
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dexrepro import chapters
from dexrepro.cache_key import presentation
from dexrepro.checks import leaves, returned, returned_numbers
from dexrepro.errors import InputError, nearest
from dexrepro.experiment import AllMetrics, Config, Experiment, Metrics, Recording
from dexrepro.plan import PARTIAL
from dexrepro.storage import copy, finite, read_json, read_yaml, whole_folder, write_json

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

SUMMARY = "summary"  # stands for the numbers over several cases in nested metrics


@dataclass(frozen=True)
class CaseEntry:
    """What run.json says of a case: how it ended, steps, simulated time [s], wall time [s] and their quotient.

    warnings: what the user's files made doubtful, above all. unread: keys of its configuration that it did not read;
    None where that was not watched.
    """

    status: str
    steps: int
    simulated: float
    wall: float
    real_time_factor: float | None
    warnings: list[str] = field(default_factory=list)
    unread: list[str] | None = None


@dataclass(frozen=True)
class RunEntry:
    """run.json: what was run, with what code and packages, on what machine, and how long it took.

    contents: what each case is made of; presentation: the code that drew it (see ``plan``); series: their files.
    """

    chapter: str
    experiment: str
    version: str
    revision: str | None
    seed: int
    contents: dict[str, str]
    presentation: str
    differs: list[str]
    series: list[str]
    packages: dict[str, str]
    machine: str
    python: str
    wall: float
    steps: int
    simulated: float
    real_time_factor: float | None
    cases: dict[str, CaseEntry]


def over_cases(experiment: Experiment, metrics: AllMetrics, config: Config) -> Metrics:
    """The numbers over several cases, of which an experiment may have none."""
    function = experiment.function("summarise")
    return finite(returned_numbers(function(metrics, config), "experiment.py: summarise")) if function else {}


@contextlib.contextmanager
def _lenient(incomplete: bool) -> Iterator[None]:
    """Let pass what fails for want of other cases, in a result that has not all of them."""
    try:
        yield
    except Exception:
        if not incomplete:
            raise


def _ended_at_once(recording: Recording) -> bool:
    """Whether a stop condition ended the run before there was anything to record."""
    return recording.status != "finished" and not (recording.series or recording.frames or recording.images)


def recorded(experiment: Experiment, folder: Path) -> tuple[dict[str, Recording], dict[str, Metrics], Config, bool]:
    """What a result's files hold: what can be drawn by case, metrics by case and over several, values, and whether
    cases are missing: not asked for or, with other parameters than the book's, ended before there was a sample."""
    from dexrepro.recordings import load_recording

    run = read_json(folder / "run.json")
    config = Config.of(read_yaml(folder / "config.yaml"))
    nested: dict[str, Metrics] = {case: {} for case in run["cases"]}
    for name, value in read_json(folder / "metrics.json").items():
        _, first, *rest = name.split(".", 2)
        if rest and first in nested:
            nested[first][rest[0]] = value
    recordings = {
        case: load_recording(folder / "series", case, entry["status"]) for case, entry in run["cases"].items()
    }
    shown = {case: recording for case, recording in recordings.items() if not _ended_at_once(recording)}
    some_cases = any(text.startswith(PARTIAL) for text in run["differs"])
    incomplete = some_cases or (bool(run["differs"]) and len(shown) < len(recordings))
    if not some_cases:  # a number over the cases is one over all of them
        with _lenient(incomplete):
            if found := over_cases(experiment, nested, config):
                nested[SUMMARY] = found
    return shown, nested, config, incomplete


def present(chapter: str, experiment: Experiment, folder: Path) -> None:
    """Numbers over several cases, claims, tables and figures of a result folder, from its files alone."""
    from pandas import DataFrame

    from dexrepro.report import style

    recordings, nested, config, incomplete = recorded(experiment, folder)
    flat_metrics = flat(experiment.name, nested)
    write_json(folder / "metrics.json", flat_metrics)
    settings = dict(leaves({experiment.name: config}))
    about = chapters.load(chapter).claims_of(experiment.name)
    claims = [claim.evaluate(flat_metrics, settings).as_dict() for claim in about]
    write_json(folder / "claims.json", claims)
    for name in ("tables", "figures"):
        shutil.rmtree(folder / name, ignore_errors=True)
        (folder / name).mkdir()
    if tabulate := experiment.function("tabulate"):
        must = "a dictionary of data frames by their names in TABLES"
        with _lenient(incomplete):
            tables = returned(tabulate(recordings, nested, config), "figures.py: tabulate", must, of=DataFrame)
            for identifier, table in tables.items():
                if len(table.columns):  # of some cases there may be nothing to tell
                    table.to_csv(folder / "tables" / f"{identifier}.csv", index=False, float_format="%.6g")
    if draw := experiment.function("draw"):
        with style.style(), _lenient(incomplete):
            for identifier, figure in drawn(experiment, draw(recordings, nested, config)).items():
                style.save(figure, folder / "figures", identifier)


def drawn(experiment: Experiment, given: Any) -> dict[str, Figure]:
    """What ``draw`` gave, if its figures are those that the experiment names."""
    import matplotlib.figure

    returned(
        given, "figures.py: draw", "a dictionary of figures by their names in FIGURES", of=matplotlib.figure.Figure
    )
    if unknown := [name for name in given if name not in experiment.figures]:
        raise InputError(
            f"figures.py: draw gave '{unknown[0]}', not in FIGURES; {nearest(unknown[0], experiment.figures)}"
        )
    return dict(given)


def redraw(chapter: str, name: str, target: Path) -> None:
    """Present again a result from its files alone; where that fails, it stays as it was."""
    experiment = chapters.load(chapter).experiment(name)
    with whole_folder(target) as folder:
        shutil.copytree(target, folder, dirs_exist_ok=True, copy_function=copy)
        write_json(folder / "run.json", read_json(target / "run.json") | {"presentation": presentation(experiment)})
        present(chapter, experiment, folder)


def flat(experiment: str, nested: Mapping[str, Metrics]) -> Metrics:
    """``experiment.case.metric`` and, for numbers over several cases, ``experiment.metric``."""
    return {
        f"{experiment}.{name}" if case == SUMMARY else f"{experiment}.{case}.{name}": value
        for case, metrics in nested.items()
        for name, value in metrics.items()
    }


class Result:
    """One result folder, read when asked: metrics, claims, run (provenance), recordings, tables, figures.

    Raises FileNotFoundError where the folder holds no result.
    """

    def __init__(self, folder: Path) -> None:
        if not (folder / "run.json").exists():
            raise FileNotFoundError(f"{folder} holds no result (no run.json)")
        self.folder = folder
        self.run: dict[str, Any] = read_json(folder / "run.json")
        self.metrics: dict[str, float | None] = read_json(folder / "metrics.json")
        self.claims: list[dict[str, Any]] = read_json(folder / "claims.json")

    def recording(self, case: str) -> Recording:
        """Series, frames and images of one case, at the rate kept on disk."""
        from dexrepro.recordings import load_recording

        return load_recording(self.folder / "series", case, self.run["cases"][case]["status"])

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        from dexrepro.recordings import read_frame

        return {path.stem: read_frame(path) for path in sorted((self.folder / "tables").glob("*.csv"))}

    @property
    def figures(self) -> dict[str, Path]:
        return {path.stem: path for path in sorted((self.folder / "figures").glob("*.png"))}

    @property
    def warnings(self) -> list[str]:
        """What the user's files made doubtful, each sentence once."""
        return sorted({text for entry in self.run["cases"].values() for text in entry.get("warnings", ())})

    def __repr__(self) -> str:
        return f"Result({str(self.folder)!r}, {len(self.metrics)} metrics, {len(self.claims)} claims)"

    def _repr_html_(self) -> str:
        """What a notebook shows: the claims with their verdicts, and the figures."""
        cells = [(c["id"], c["statement"], c["verdict"], _short(c["margin"]), c["note"]) for c in self.claims]
        head = "".join(f"<th>{name}</th>" for name in ("claim", "statement", "verdict", "margin", "note"))
        rows = ("".join(f'<td style="text-align:left">{html.escape(text)}</td>' for text in row) for row in cells)
        table = f"<table><tr>{head}</tr>{''.join(f'<tr>{row}</tr>' for row in rows)}</table>" if cells else ""
        differs = f"<p>differs from the book in: {html.escape(', '.join(self.run['differs']))}</p>"
        images = (
            f'<img alt="{name}" style="max-width:100%" src="data:image/png;base64,'
            f'{base64.b64encode(path.read_bytes()).decode()}">' for name, path in self.figures.items()
        )  # fmt: skip
        folder = html.escape(str(self.folder))
        return f"<h4>{folder}</h4>{differs if self.run.get('differs') else ''}{table}{''.join(images)}"


class Results(dict[str, Result]):
    """Results by experiment."""

    def _repr_html_(self) -> str:
        return "".join(result._repr_html_() for result in self.values())


def _short(number: float | None) -> str:
    return "" if number is None else f"{number:.3g}"
