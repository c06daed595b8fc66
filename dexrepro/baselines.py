"""Stored metrics and verdicts: compare results with them (never simulating), and renew them.

A tolerance says how sensitive a number is: ``update`` reruns each case with the initial state moved by each of
``PERTURBATIONS`` and keeps ``rtol = max(1e-3, 10 x the largest relative change)``, likewise ``atol`` for metrics near
zero. Counts are exact unless a rerun changes them. A tolerance with a "reason" was set by hand and survives updates.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from dexrepro import chapters
from dexrepro.config import InputError
from dexrepro.plan import plan_chapter, select
from dexrepro.report.damage import check_result
from dexrepro.runner import run_plans
from dexrepro.storage import read_json, write_json

PERTURBATIONS = (1e-9, -1e-9)  # rad, or share of the input data's range; one may take the same branch by luck
RTOL = 1e-3
ATOL = 1e-9
NEAR_ZERO = 1e-6


class ResultsMissing(Exception):
    """There is nothing to compare; the message names the command to run."""


def baseline_dir() -> Path:
    """Where baselines are stored: in an installed wheel, or in results/baselines of a checkout."""
    inside = Path(__file__).parent / "baselines"
    return inside if inside.is_dir() else Path(__file__).parent.parent / "results" / "baselines"


def baseline_file(chapter: str, experiment: str) -> Path:
    """Baseline of one experiment; that of an experiment outside the package stands in its own folder."""
    if chapters.is_added(chapter):
        return chapters.load(chapter).folder / experiment / "baseline.json"
    return baseline_dir() / f"chapter{chapter}" / f"{experiment}.json"


def read(chapter: str) -> dict[str, Any]:
    """Stored baseline of a chapter: {"metrics": {experiment: {name: {value, rtol, atol}}}, "claims": {id: verdict}}."""
    whole: dict[str, Any] = {"metrics": {}, "claims": {}}
    for experiment in chapters.load(chapter).experiments:
        if (path := baseline_file(chapter, experiment.name)).exists():
            stored = read_json(path)
            whole["metrics"][experiment.name] = stored["metrics"]
            whole["claims"] |= stored["claims"]
    return whole


def _write(chapter: str, baseline: Mapping[str, Any]) -> list[str]:
    written = []
    for name, metrics in baseline["metrics"].items():
        ids = [claim.id for claim in chapters.load(chapter).claims_of(name)]
        verdicts = {key: baseline["claims"][key] for key in ids if key in baseline["claims"]}
        path = baseline_file(chapter, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        write_json(path, {"metrics": metrics, "claims": verdicts})
        written.append(f"wrote {path}")
    return written


def check_chapter(chapter: str, results: Path, only: Sequence[str] = ()) -> dict[str, Any]:
    """Compare the results of a chapter, or of some of its experiments, with its baseline.

    Returns the shape documented for ``dexrepro check --json``. Raises ResultsMissing where an experiment was not run,
    InputError where a result is damaged.
    """
    baseline = read(chapter)
    _, skipped = plan_chapter(chapter, [f"results='{results}'"])
    report: dict[str, Any] = {
        "chapter": chapter,
        "compared": 0,
        "drifted": [],
        "missing": [],
        "new": [],
        "skipped": [],
        "claims": [],
        "verdict_changed": [],
    }
    for experiment in select(chapter, list(only) or None, None):
        stored = baseline["metrics"].get(experiment.name, {})
        if experiment.name in skipped:
            report["skipped"] += list(stored)
            continue
        folder = results / f"chapter{chapter}" / experiment.name
        if not (folder / "run.json").exists():
            raise ResultsMissing(
                f"no results of {experiment.name}; run: dexrepro run chapter={chapter} only={experiment.name}"
            )
        check_result(folder, "metrics.json", "claims.json")
        metrics, claims = read_json(folder / "metrics.json"), read_json(folder / "claims.json")
        _compare(report, experiment.name, metrics, stored)
        for claim in claims:
            expected = baseline["claims"].get(claim["id"])
            report["claims"].append(
                {
                    "id": claim["id"],
                    "experiment": experiment.name,
                    "verdict": claim["verdict"],
                    "expected": expected,
                    "margin": claim["margin"],
                }
            )
            if claim["verdict"] != expected:
                report["verdict_changed"].append(claim["id"])
    return report


def _compare(
    report: dict[str, Any], experiment: str, metrics: Mapping[str, Any], stored: Mapping[str, Mapping[str, Any]]
) -> None:
    for name, entry in stored.items():
        if name not in metrics:
            report["missing"].append(name)
            continue
        report["compared"] += 1
        if not agrees(metrics[name], entry):
            report["drifted"].append(
                {
                    "experiment": experiment,
                    "name": name,
                    "value": metrics[name],
                    "baseline": entry["value"],
                    "rtol": entry["rtol"],
                    "atol": entry["atol"],
                }
            )
    report["new"] += [name for name in metrics if name not in stored]


def agrees(value: float | None, entry: Mapping[str, Any]) -> bool:
    """Whether a metric is within its stored tolerance; null agrees with null alone."""
    expected = entry["value"]
    if value is None or expected is None:
        return value is expected
    return abs(value - expected) <= entry["atol"] + entry["rtol"] * abs(expected)


def is_ok(report: Mapping[str, Any]) -> bool:
    """New metrics count as drift too: a baseline that does not know a number does not guard it."""
    return not (report["drifted"] or report["missing"] or report["new"] or report["verdict_changed"])


# --------------------------------------------------------------------------------------------------------- updating


def update_chapter(
    chapter: str, results: Path, only: Sequence[str] = (), *, accept: Sequence[str], workers: int | None
) -> list[str]:
    """Run experiments of a chapter (none named: all) as shipped and perturbed; store metrics, tolerances, verdicts.

    Returns what changed, a line each. Raises InputError where a verdict changed that is not in ``accept``.
    """
    overrides = [f"results='{results}'", *([f"only=[{','.join(only)}]"] if only else [])]
    plans, _ = plan_chapter(chapter, overrides)
    moved = [plan_chapter(chapter, overrides, perturbation=size)[0] for size in PERTURBATIONS]
    for number, group in enumerate(moved):
        for plan in group:
            plan.folder = results / ".cache" / f"perturbed{number}" / plan.experiment
    for which in (plans, *moved):
        outcome = run_plans(which, workers=workers, force=False)
        if outcome.failures:
            raise InputError("; ".join(f"{name}: {text}" for name, text in outcome.failures.items()))
    old = read(chapter)
    new: dict[str, Any] = {"metrics": {}, "claims": {}}
    for plan, *perturbed in zip(plans, *moved, strict=True):
        metrics, *disturbed = (read_json(p.folder / "metrics.json") for p in (plan, *perturbed))
        stored = old["metrics"].get(plan.experiment, {})
        new["metrics"][plan.experiment] = {
            name: _entry(value, [other.get(name) for other in disturbed], stored.get(name))
            for name, value in metrics.items()
        }
        for claim in read_json(plan.folder / "claims.json"):
            new["claims"][claim["id"]] = claim["verdict"]
    changed = {
        key: (old["claims"][key], verdict)
        for key, verdict in new["claims"].items()
        if key in old["claims"] and old["claims"][key] != verdict
    }
    refused = [key for key in changed if key not in accept]
    if refused:
        texts = ", ".join(f"{key} ({changed[key][0]} -> {changed[key][1]})" for key in refused)
        raise InputError(f"verdicts changed: {texts}; review them and repeat with --accept {' '.join(refused)}")
    written = _write(chapter, new)
    return [f"{key}: {before} -> {after}" for key, (before, after) in changed.items()] + _sensitive(new) + written


def _entry(value: float | None, disturbed: Sequence[float | None], stored: Mapping[str, Any] | None) -> dict[str, Any]:
    if stored and stored.get("reason"):
        return {**stored, "value": value}
    entry = _fresh_entry(value, disturbed)
    if stored and agrees(value, stored):  # a sensitivity once seen remains
        entry |= {kind: max(entry[kind], stored[kind]) for kind in ("rtol", "atol")}
    return entry


def _fresh_entry(value: float | None, disturbed: Sequence[float | None]) -> dict[str, Any]:
    known = [other for other in disturbed if other is not None]
    if value is None or not known:
        return {"value": value, "rtol": 0.0, "atol": 0.0}
    change = max(abs(other - value) for other in known)
    if isinstance(value, int):
        return {"value": value, "rtol": 0.0, "atol": _rounded(10 * change)}
    if abs(value) < NEAR_ZERO:
        return {"value": value, "rtol": RTOL, "atol": _rounded(max(ATOL, 10 * change))}
    return {"value": value, "rtol": _rounded(max(RTOL, 10 * change / abs(value))), "atol": ATOL}


def _rounded(tolerance: float) -> float:
    """Round up to two digits, so that baselines differ only where something happened."""
    if tolerance == 0:
        return 0.0
    unit = 10.0 ** (math.floor(math.log10(tolerance)) - 1)
    return float(f"{math.ceil(tolerance / unit - 1e-9) * unit:.2g}")


def _sensitive(baseline: Mapping[str, Any]) -> list[str]:
    return [
        f"{name}: very sensitive (tolerance {entry['rtol']:.0%}), a poor metric"
        for metrics in baseline["metrics"].values()
        for name, entry in metrics.items()
        if entry["rtol"] > 0.2
    ]
