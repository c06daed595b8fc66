"""Stored metrics and verdicts: compare results with them (never simulating), and renew them.

A tolerance says how sensitive a number is: ``update`` reruns each case with the initial state moved by each of
``PERTURBATIONS``, and experiments of seconds also with the arithmetic of other machines (``arithmetics``), and keeps
``rtol = max(1e-3, 10 x the largest relative change)``, 3 x that of another arithmetic, likewise ``atol`` near zero.
Counts are exact unless a rerun changes them. A "reason" says by what other arithmetic a metric moves farther than by
another initial state; one in other words was set by hand with its tolerance, and survives updates.
"""

from __future__ import annotations

import math
import os
import shlex
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from dexrepro import chapters
from dexrepro.checks import is_number
from dexrepro.claims import cases_in
from dexrepro.config import baseline_dir
from dexrepro.damage import check_result, read_table
from dexrepro.errors import InputError, one_line
from dexrepro.overrides import selecting
from dexrepro.plan import Plan, outdated, plan_chapter
from dexrepro.pool import BLAS_THREADS
from dexrepro.runner import run_plans
from dexrepro.selection import select
from dexrepro.storage import read_json, require, write_json

PERTURBATIONS = (1e-9, -1e-9)  # rad, or share of the input data's range; one may take the same branch by luck
SECONDS = 60.0  # of wall time of all cases, up to which an experiment is run with other arithmetic, too
RTOL = 1e-3
ATOL = 1e-9
NEAR_ZERO = 1e-6
ELSEWHERE = 3.0  # times the change of another arithmetic, which is one of those that other machines show
MEASURED = "the same code gave "  # begins a reason that an update has measured, and may renew
TABLE = 0.05  # by which a number of a table may change where no metric of its digits is more sensitive


class ResultsMissing(Exception):
    """There is nothing to compare; the message names the command to run."""


def baseline_file(chapter: str, experiment: str) -> Path:
    """Baseline of one experiment; that of an experiment outside the package stands in its own folder."""
    if chapters.is_added(chapter):
        return chapters.load(chapter).folder / experiment / "baseline.json"
    return baseline_dir() / f"chapter{chapter}" / f"{experiment}.json"


@dataclass
class Baseline:
    """What is stored of one experiment: metrics as ``{name: {value, rtol, atol}}``, verdicts by claim, tables by id.

    tables: None where none have been stored yet; then none are compared. free: columns ("T4.D/step [µs]") that may
    differ, by the reason why; they are set by hand and survive updates.
    """

    metrics: dict[str, dict[str, Any]] = field(default_factory=dict)
    claims: dict[str, str] = field(default_factory=dict)
    tables: dict[str, dict[str, list[Any]]] | None = None
    free: dict[str, str] = field(default_factory=dict)

    @property
    def values(self) -> dict[str, float | None]:
        """The metrics by name, without their tolerances."""
        return {name: entry["value"] for name, entry in self.metrics.items()}

    @classmethod
    def of(cls, chapter: str, experiment: str) -> Baseline:
        """The baseline of an experiment, empty where there is none. Raises InputError where its file is damaged."""
        path = baseline_file(chapter, experiment)
        if not path.exists():
            return cls()
        try:
            found = cls(**read_json(path))
            require(vars(found), {"metrics": dict, "claims": dict, "free": dict})
            for name, entry in found.metrics.items():
                _check_entry(name, entry)
            for table in (found.tables or {}).values():
                if len({len(column) for column in table.values()}) > 1:
                    raise ValueError("the columns of a table have one length")
        except (OSError, ValueError, TypeError, KeyError, AttributeError) as error:
            raise InputError(f"{path} is no baseline ({one_line(error)})") from error
        return found


def stored(chapter: str) -> dict[str, Baseline]:
    """The baseline of every experiment of a chapter, by its name."""
    return {item.name: Baseline.of(chapter, item.name) for item in chapters.load(chapter).experiments}


def stored_values(chapter: str) -> dict[str, float | None]:
    """The stored metrics of a whole chapter by name."""
    return {name: value for baseline in stored(chapter).values() for name, value in baseline.values.items()}


def _check_entry(name: str, entry: Mapping[str, Any]) -> None:
    value, tolerances = entry["value"], (entry["rtol"], entry["atol"])
    if value is not None and not isinstance(value, int | float):
        raise ValueError(f"{name}: value = {value!r} must be a number or null")
    for key, size in zip(("rtol", "atol"), tolerances, strict=True):
        top = 1 if key == "rtol" else math.inf
        if not isinstance(size, int | float) or not 0 <= size <= top or math.isinf(size):
            allowed = "0..1" if key == "rtol" else "a finite number of 0 or greater"
            raise ValueError(f"{name}: {key} = {size!r} is not allowed: it must be {allowed}")


@dataclass(frozen=True)
class Drift:
    """A metric outside its tolerance."""

    experiment: str
    name: str
    value: float | None
    baseline: float | None
    rtol: float
    atol: float


@dataclass(frozen=True)
class ClaimCheck:
    """A claim's verdict in the results, and the one stored (None: there is none)."""

    id: str
    experiment: str
    verdict: str | None
    expected: str | None
    margin: float | None


@dataclass
class ChapterReport:
    """What ``dexrepro check --json`` says of a chapter: names of metrics, ids of claims, and sentences about tables.

    unknown: experiments that have a baseline and no longer exist; outdated: what makes a result another than the
    present configuration and code would give (it is said, and is no drift).
    """

    chapter: str
    compared: int = 0
    drifted: list[Drift] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    new: list[str] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)
    claims: list[ClaimCheck] = field(default_factory=list)
    verdict_changed: list[str] = field(default_factory=list)
    tables: int = 0
    tables_changed: list[str] = field(default_factory=list)
    unknown: list[str] = field(default_factory=list)
    outdated: list[str] = field(default_factory=list)

    @property
    def ok(self) -> bool:
        """New metrics count as drift too: a baseline that does not know a number does not guard it."""
        wrong = (self.drifted, self.missing, self.new, self.verdict_changed, self.tables_changed, self.unknown)
        return not any(wrong)


def check_chapter(chapter: str, results: Path, only: Sequence[str] = ()) -> ChapterReport:
    """Compare the results of a chapter, or of some of its experiments, with its baseline; nothing is written.

    Raises ResultsMissing where an experiment was not run, InputError where a result or a baseline is damaged.
    """
    plans, skipped = plan_chapter(chapter, write=False)
    by_name = {plan.experiment: plan for plan in plans}
    report = ChapterReport(chapter)
    if not only and not chapters.is_added(chapter):
        names = {experiment.name for experiment in chapters.load(chapter).experiments}
        stored_files = (baseline_dir() / f"chapter{chapter}").glob("*.json")
        report.unknown = sorted(path.stem for path in stored_files if path.stem not in names)
    for experiment in select(chapter, list(only) or None, None):
        stored = Baseline.of(chapter, experiment.name)
        if experiment.name in skipped:
            report.skipped += list(stored.metrics)
            continue
        folder = results / f"chapter{chapter}" / experiment.name
        if not (folder / "run.json").exists():
            raise _missing(chapter, experiment.name, results)
        check_result(folder, "metrics.json", "claims.json")
        if reason := outdated(by_name[experiment.name], read_json(folder / "run.json")):
            report.outdated.append(f"{experiment.name}: {reason}")
        _compare(report, experiment.name, read_json(folder / "metrics.json"), stored.metrics)
        _compare_claims(report, experiment.name, read_json(folder / "claims.json"), stored.claims)
        _compare_tables(report, folder / "tables", stored)
    return report


def _missing(chapter: str, experiment: str, results: Path, case: str = "") -> ResultsMissing:
    where = "" if results == Path("results") else f" results={shlex.quote(str(results))}"
    command = f"dexrepro run{chapters.option(chapter)} chapter={chapter} only={experiment}{case}{where}"
    return ResultsMissing(f"no results of {experiment}; run: {command}")


def check_cases(chapter: str, results: Path, only: Sequence[str], case: str) -> ChapterReport:
    """The same for the metrics of the cases that a word ``case=...`` chooses, and the claims that are about no other,
    from a run of them or else of all."""
    plans, _ = plan_chapter(chapter, [*selecting(results, only), case], write=False)
    report = ChapterReport(chapter)
    for plan in plans:
        places = plan.folder, results / f"chapter{chapter}" / plan.experiment
        folder = next((place for place in places if (place / "run.json").exists()), None)
        if folder is None:
            raise _missing(chapter, plan.experiment, results, f" {case}")
        check_result(folder, "metrics.json", "claims.json")
        run, cases = read_json(folder / "run.json"), {job.case for job in plan.jobs}
        if reason := outdated(plan, run | {"contents": {c: run["contents"].get(c) for c in plan.contents}}):
            report.outdated.append(f"{plan.experiment}: {reason}")
        begins, stored = tuple(f"{plan.experiment}.{case}." for case in cases), Baseline.of(chapter, plan.experiment)
        chosen = (
            {name: item for name, item in every.items() if name.startswith(begins)}
            for every in (read_json(folder / "metrics.json"), stored.metrics)
        )
        _compare(report, plan.experiment, *chosen)
        needed = {claim.id: cases_in(claim.metrics) for claim in chapters.load(chapter).claims_of(plan.experiment)}
        about = {name for name, (own, over_several) in needed.items() if cases.issuperset(own) and not over_several}
        claims = [claim for claim in read_json(folder / "claims.json") if claim["id"] in about]
        verdicts = {name: verdict for name, verdict in stored.claims.items() if name in about}
        _compare_claims(report, plan.experiment, claims, verdicts)
    return report


def _compare(
    report: ChapterReport, experiment: str, metrics: Mapping[str, Any], stored: Mapping[str, Mapping[str, Any]]
) -> None:
    for name, entry in stored.items():
        if name not in metrics:
            report.missing.append(name)
            continue
        report.compared += 1
        if not agrees(metrics[name], entry):
            values = metrics[name], entry["value"], entry["rtol"], entry["atol"]
            report.drifted.append(Drift(experiment, name, *values))
    report.new += [name for name in metrics if name not in stored]


def _compare_claims(
    report: ChapterReport, experiment: str, claims: Sequence[Mapping[str, Any]], stored: Mapping[str, str]
) -> None:
    found = {claim["id"]: claim for claim in claims}
    for key in dict.fromkeys([*found, *stored]):
        verdict, margin = found.get(key, {}).get("verdict"), found.get(key, {}).get("margin")
        report.claims.append(ClaimCheck(key, experiment, verdict, stored.get(key), margin))
        if verdict != stored.get(key):
            report.verdict_changed.append(key)


def _compare_tables(report: ChapterReport, folder: Path, stored: Baseline) -> None:
    """Tables guard what is done to numbers on the way to a reader (a unit, a column); drift is for the metrics."""
    made = tables_of(folder)
    if stored.tables is None:
        return
    for name in dict.fromkeys([*made, *stored.tables]):
        report.tables += 1
        if name not in made or name not in stored.tables:
            report.tables_changed.append(f"{name} is {'missing' if name not in made else 'new'}")
            continue
        old, new = stored.tables[name], made[name]
        if list(old) != list(new) or len(next(iter(old.values()), [])) != len(next(iter(new.values()), [])):
            report.tables_changed.append(f"{name} has other rows or columns")
            continue
        for column in (column for column in old if f"{name}/{column}" not in stored.free):
            size = max((abs(cell) for cell in old[column] if isinstance(cell, int | float)), default=0.0)
            for row, (before, after) in enumerate(zip(old[column], new[column], strict=True), 1):
                if not _same_cell(after, before, size, stored.metrics):
                    report.tables_changed.append(f"{name}, row {row}, {column}: {after}, stored {before}")


def _same_cell(value: Any, stored: Any, size: float, metrics: Mapping[str, Mapping[str, Any]]) -> bool:
    """Whether a cell is what it was, within 5 % or the tolerance of the metrics that it may show, in whatever unit."""
    numbers = list(map(is_number, (value, stored)))
    if not all(numbers) or stored == 0:
        return value == stored or (all(numbers) and abs(value) <= 1e-6 + 1e-3 * size)
    tolerance = TABLE
    for entry in metrics.values():
        shown = entry["value"]
        if shown and abs((power := math.log10(abs(stored / shown))) - round(power)) < 1e-4:
            tolerance = max(tolerance, entry["rtol"] + entry["atol"] / abs(shown))
    return abs(value - stored) <= tolerance * abs(stored) + 1e-3 * TABLE * size


def tables_of(folder: Path) -> dict[str, dict[str, list[Any]]]:
    """The tables of a result by id, each as its columns. Raises InputError where one cannot be read."""
    tables = {path.stem: read_table(path) for path in sorted(folder.glob("*.csv"))}
    return {
        name: {str(column): [None if cell != cell else cell for cell in frame[column].tolist()] for column in frame}
        for name, frame in tables.items()
    }


def agrees(value: float | None, entry: Mapping[str, Any]) -> bool:
    """Whether a metric is within its stored tolerance; null agrees with null alone."""
    expected = entry["value"]
    if value is None or expected is None:
        return value is expected
    return abs(value - expected) <= entry["atol"] + entry["rtol"] * abs(expected)


# --------------------------------------------------------------------------------------------------------- updating


def update_chapter(
    chapter: str, results: Path, only: Sequence[str] = (), *, accept: Sequence[str], workers: int | None
) -> list[str]:
    """Run experiments of a chapter (none named: all) as shipped and perturbed; store metrics, tolerances, verdicts.

    Returns what changed, a line each. Raises InputError where a verdict changed that is not in ``accept``.
    """
    plans, *perturbed = _plans_of_update(chapter, selecting(results, only), results)
    for group in (plans, *perturbed):
        if failed := run_plans(group, workers=workers, force=False).failed:
            raise InputError(failed)
    elsewhere = _run_elsewhere(chapter, plans, results, workers)
    old = {plan.experiment: Baseline.of(chapter, plan.experiment) for plan in plans}
    new = {
        plan.experiment: _renewed(old[plan.experiment], plan, moved, elsewhere.get(plan.experiment, {}))
        for plan, *moved in zip(plans, *perturbed, strict=True)
    }
    turned = _turned_verdicts(old, new, accept)
    files = {baseline_file(chapter, name): baseline for name, baseline in new.items()}
    for path, baseline in files.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_json(path, asdict(baseline))
    sensitive = [line for baseline in new.values() for line in _sensitive(baseline.metrics)]
    return [*turned, *sensitive, *(f"wrote {path}" for path in files)]


def _plans_of_update(chapter: str, overrides: Sequence[str], results: Path) -> list[list[Plan]]:
    """As shipped, and with each of the PERTURBATIONS. Raises InputError without the engine of the baselines."""
    plans, *perturbed = (plan_chapter(chapter, overrides, perturbation=size)[0] for size in (0.0, *PERTURBATIONS))
    foreign = [plan.experiment for plan in plans if plan.off_reference]
    if foreign and not chapters.is_added(chapter):
        raise InputError(
            f"the baselines of {', '.join(foreign)} are PyBullet's, which is not installed here: --update would "
            "replace them by numbers of MuJoCo's"
        )
    for number, group in enumerate(perturbed):
        for plan in group:
            plan.folder = results / ".cache" / f"perturbed{number}" / plan.experiment
    return [plans, *perturbed]


def _renewed(
    old: Baseline, plan: Plan, perturbed: Sequence[Plan], elsewhere: Mapping[str, Mapping[str, float | None]]
) -> Baseline:
    """The baseline that an experiment's results make of the old one; elsewhere: metrics by the arithmetic."""
    metrics, *disturbed = (read_json(p.folder / "metrics.json") for p in (plan, *perturbed))
    entries = {
        name: _entry(
            value,
            [moved.get(name) for moved in disturbed],
            {text: found.get(name) for text, found in elsewhere.items()},
            old.metrics.get(name),
        )
        for name, value in metrics.items()
    }
    verdicts = {claim["id"]: claim["verdict"] for claim in read_json(plan.folder / "claims.json")}
    return Baseline(entries, verdicts, tables_of(plan.folder / "tables"), old.free)


def _turned_verdicts(old: Mapping[str, Baseline], new: Mapping[str, Baseline], accept: Sequence[str]) -> list[str]:
    """A line for each verdict that changed. Raises InputError where one of them is not accepted."""
    turned = {
        key: f"{before} -> {after}"
        for name, baseline in old.items()
        for key, before in baseline.claims.items()
        if (after := new[name].claims.get(key, before)) != before
    }
    if refused := [key for key in turned if key not in accept]:
        texts = ", ".join(f"{key} ({turned[key]})" for key in refused)
        raise InputError(f"verdicts changed: {texts}; review them and repeat with --accept {' '.join(refused)}")
    return [f"{key}: {text}" for key, text in turned.items()]


def arithmetics() -> tuple[dict[str, str], ...]:
    """Environments that change the last bits: an old processor's BLAS, numpy and libm; another BLAS and two threads."""
    import numpy as np
    from threadpoolctl import threadpool_info

    vectors = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
    old = {"NPY_DISABLE_CPU_FEATURES": " ".join(vectors), "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}
    here = {library.get("architecture") for library in threadpool_info()}
    wide = "SkylakeX" if here == {"Haswell"} and any("AVX512" in name for name in vectors) else "Haswell"
    return {"OPENBLAS_CORETYPE": "Prescott", **old}, {"OPENBLAS_CORETYPE": wide, BLAS_THREADS: "2"}


def _run_elsewhere(
    chapter: str, plans: Sequence[Plan], results: Path, workers: int | None
) -> dict[str, dict[str, dict[str, Any]]]:
    """Metrics of the experiments that run in seconds, by experiment and by the arithmetic of another machine."""
    short = [p.experiment for p in plans if read_json(p.folder / "run.json")["wall"] < SECONDS]
    found: dict[str, dict[str, dict[str, Any]]] = {name: {} for name in short}
    for number, environment in enumerate(arithmetics() if short else ()):
        there = results.absolute() / ".cache" / f"arithmetic{number}"
        line = [sys.executable, "-m", "dexrepro", "run", f"chapter={chapter}", f"only=[{','.join(short)}]"]
        line += [f"results={there}", *([f"workers={workers}"] if workers else [])]
        done = subprocess.run(line, env=os.environ | environment, capture_output=True, encoding="utf-8", check=False)
        text = ", ".join(f"{key}={value}" for key, value in environment.items())
        if done.returncode:
            raise InputError(f"with {text}: {' '.join(done.stderr.split())}")
        for name in short:
            found[name][text] = read_json(there / f"chapter{chapter}" / name / "metrics.json")
    return found


def _entry(
    value: float | None,
    disturbed: Sequence[float | None],
    elsewhere: Mapping[str, float | None],
    stored: Mapping[str, Any] | None,
) -> dict[str, Any]:
    """disturbed: values with a moved initial state; elsewhere: those with the arithmetic of other machines, by name."""
    if stored and not stored.get("reason", MEASURED).startswith(MEASURED):
        return {**stored, "value": value}
    entry, there = _fresh_entry(value, disturbed), _fresh_entry(value, list(elsewhere.values()), ELSEWHERE)
    moved = {text: other for text, other in elsewhere.items() if not agrees(other, entry)}
    entry |= {kind: max(entry[kind], there[kind]) for kind in ("rtol", "atol")}
    if stored and agrees(value, stored):  # a sensitivity once seen remains
        entry |= {kind: max(entry[kind], stored[kind]) for kind in ("rtol", "atol")}
    if moved:
        entry["reason"] = MEASURED + "; ".join(f"{other:.6g} with {text}" for text, other in moved.items())
    elif stored and "reason" in stored and agrees(value, stored):
        entry["reason"] = stored["reason"]
    return entry


def _fresh_entry(value: float | None, disturbed: Sequence[float | None], margin: float = 10.0) -> dict[str, Any]:
    known = [other for other in disturbed if other is not None]
    if value is None or not known:
        return {"value": value, "rtol": 0.0, "atol": 0.0}
    change = max(abs(other - value) for other in known)
    if isinstance(value, int):
        return {"value": value, "rtol": 0.0, "atol": _rounded(margin * change)}
    if abs(value) < NEAR_ZERO:
        return {"value": value, "rtol": RTOL, "atol": _rounded(max(ATOL, margin * change))}
    rtol = _rounded(max(RTOL, margin * change / abs(value)))
    if rtol > 1:  # it is near zero by the measure of its own sensitivity
        return {"value": value, "rtol": RTOL, "atol": _rounded(margin * change)}
    return {"value": value, "rtol": rtol, "atol": ATOL}


def _rounded(tolerance: float) -> float:
    """Round up to two digits, so that baselines differ only where something happened."""
    if tolerance == 0:
        return 0.0
    unit = 10.0 ** (math.floor(math.log10(tolerance)) - 1)
    return float(f"{math.ceil(tolerance / unit - 1e-9) * unit:.2g}")


def _sensitive(metrics: Mapping[str, Mapping[str, Any]]) -> list[str]:
    sizes = {name: entry["rtol"] + entry["atol"] / abs(entry["value"] or 1) for name, entry in metrics.items()}
    return [
        f"{name}: very sensitive (tolerance {size:.0%}), a poor metric" for name, size in sizes.items() if size > 0.2
    ]
