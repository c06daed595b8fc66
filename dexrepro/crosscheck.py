"""The book under a second engine: which numbers and verdicts are PyBullet's own.

PyBullet's side are the stored baselines (``dexrepro check`` says whether they are today's); the other side is run here,
as any ``engine=…``. A number differs where it is outside its baseline's tolerance, and matters where it is also outside
the spread of the study's samples: then another engine moves it more than what the book does not print.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from dexrepro import chapters
from dexrepro.baselines import Baseline, agrees
from dexrepro.cache_key import uses_engine
from dexrepro.claims import NOT_EVALUATED
from dexrepro.config import baseline_dir
from dexrepro.errors import InputError, one_line
from dexrepro.overrides import selecting
from dexrepro.plan import Plan, plan_chapter
from dexrepro.progress import Silent
from dexrepro.result import flat
from dexrepro.runner import run_plans
from dexrepro.storage import read_json, require, write_json
from dexrepro.study.samples import shipped_samples

OTHER = "mujoco"
SPREAD = (0.05, 0.95)  # quantiles of a number among the samples of a study


@dataclass(frozen=True)
class Difference:
    """A number outside its tolerance: both values, and the samples' range (None: no study has it)."""

    name: str
    reference: float | None
    other: float | None
    spread: tuple[float, float] | None

    @property
    def matters(self) -> bool:
        """Whether no sample of the study spreads as far."""
        if self.spread is None or self.other is None:
            return True
        low, high = self.spread
        return not low <= self.other <= high


@dataclass(frozen=True)
class Comparison:
    """One experiment under both engines: how many numbers were compared, which differ, and each claim's verdicts."""

    chapter: str
    experiment: str
    version: str
    compared: int
    metrics: list[Difference] = field(default_factory=list)
    claims: dict[str, tuple[str, str]] = field(default_factory=dict)

    @property
    def turned(self) -> list[str]:
        """Claims whose verdicts differ."""
        return [key for key, (reference, other) in self.claims.items() if reference != other]


def run(
    chapter: str, only: Sequence[str], results: Path, workers: int | None, progress: Silent | None = None
) -> list[Comparison]:
    """Run what simulates arms under the other engine and compare. Raises InputError where a case fails."""
    words = [*selecting(results, only), f"engine={OTHER}"]
    loaded = chapters.load(chapter)
    plans = [plan for plan in plan_chapter(chapter, words)[0] if uses_engine(loaded.experiment(plan.experiment))]
    outcome = run_plans(plans, workers=workers, force=False, progress=progress)
    if outcome.failures:
        raise InputError(outcome.failed)
    return [compare(plan, outcome.folders[plan.experiment]) for plan in plans]


def compare(plan: Plan, folder: Path) -> Comparison:
    """A result of the other engine beside the stored baseline: numbers and claims that both have."""
    baseline, made = Baseline.of(plan.chapter, plan.experiment), read_json(folder / "metrics.json")
    both = [name for name in baseline.metrics if name in made]
    outside = [name for name in both if not agrees(made[name], baseline.metrics[name])]
    spreads = _spreads(plan.experiment, outside)
    differences = [Difference(name, baseline.metrics[name]["value"], made[name], spreads[name]) for name in outside]
    verdicts = {claim.id: claim.evaluate(made).verdict for claim in chapters.load(plan.chapter).claims}
    claims = {
        key: (verdict, verdicts[key])
        for key, verdict in baseline.claims.items()
        if NOT_EVALUATED not in (verdict, verdicts.get(key, NOT_EVALUATED))
    }
    return Comparison(plan.chapter, plan.experiment, plan.versions[OTHER], len(both), differences, claims)


def respread(experiment: str) -> None:
    """Put the spreads of the study that is shipped into the comparison that is shipped."""
    path = table(Path(), shipped=True)
    for item in stored(path):
        if item.experiment == experiment and item.metrics:
            spreads = _spreads(experiment, [one.name for one in item.metrics])
            keep([replace(item, metrics=[replace(one, spread=spreads[one.name]) for one in item.metrics])], path)


def _spreads(experiment: str, names: Sequence[str]) -> dict[str, tuple[float, float] | None]:
    """Of each number among the samples of the study that is shipped."""
    entries = shipped_samples(experiment) if names else []
    cases = ({case: row.get("metrics", {}) for case, row in entry["cases"].items()} for entry in entries)
    rows = [flat(experiment, metrics) for metrics in cases]
    return {name: _spread([row.get(name) for row in rows]) for name in names}


def _spread(values: Sequence[float | None]) -> tuple[float, float] | None:
    known = [value for value in values if value is not None]
    if len(known) < 2:
        return None
    low, high = np.quantile(known, SPREAD).tolist()
    return low, high


def table(results: Path, shipped: bool = False) -> Path:
    """Where the comparisons are kept: among the results, or beside the baselines that are shipped."""
    return baseline_dir() / "crosscheck.json" if shipped else results / "crosscheck" / "crosscheck.json"


def keep(found: Sequence[Comparison], path: Path) -> None:
    """Put comparisons in the place of those of the same experiments."""
    rows = {item.experiment: item for item in (*stored(path), *found)}
    ordered = sorted(rows.values(), key=lambda item: (item.chapter, item.experiment))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_json(path, [asdict(item) for item in ordered])


def stored(path: Path) -> list[Comparison]:
    """The comparisons in a file, none where there is no file. Raises InputError where it is damaged."""
    if not path.exists():
        return []
    try:
        return [_of(row) for row in read_json(path)]
    except (OSError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise InputError(f"{path} is no table of comparisons ({one_line(error)})") from error


def _of(row: Mapping[str, Any]) -> Comparison:
    require(row, {"chapter": str, "experiment": str, "metrics": list, "claims": dict})
    metrics = [Difference(**{**item, "spread": item["spread"] and tuple(item["spread"])}) for item in row["metrics"]]
    claims = {key: (reference, other) for key, (reference, other) in row["claims"].items()}
    return Comparison(**{**row, "metrics": metrics, "claims": claims})


def verdicts(results: Path) -> dict[str, tuple[str, str]]:
    """The verdict of every claim under both engines, shipped or made here, where it is known."""
    return {key: pair for item in _known(results).values() for key, pair in item.claims.items()}


def agrees_on(experiment: str, results: Path) -> bool:
    """Whether every claim of an experiment is known to have one verdict under both engines."""
    item = _known(results).get(experiment)
    return item is not None and not item.turned


def _known(results: Path) -> dict[str, Comparison]:
    return {item.experiment: item for place in (True, False) for item in stored(table(results, place))}
