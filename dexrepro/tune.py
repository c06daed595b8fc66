"""Tune a case: search the parameters for which one of its metrics is best.

Half of the budget covers the ranges evenly (scrambled Sobol points), the rest lies, also by Sobol points, in ever
smaller boxes around the best so far; the first run is the case as it stands. Runs are kept with what they are made of:
the same search repeats none, and one with a larger budget uses those there are.
"""

from __future__ import annotations

import copy
import importlib
import inspect
import math
import re
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from dexrepro import chapters
from dexrepro.arrays import Array
from dexrepro.cache_key import content_of
from dexrepro.case import measured
from dexrepro.cases import experiment_cases
from dexrepro.checks import is_number, leaves, set_value, value_at
from dexrepro.config import baseline_dir, compose_chapter
from dexrepro.control.contract import is_plain
from dexrepro.errors import InputError, nearest, refused
from dexrepro.experiment import Metrics
from dexrepro.physics.engine import default
from dexrepro.plan import case_values, lacking, writable
from dexrepro.pool import Failure, Pool
from dexrepro.provenance import provenance
from dexrepro.selection import chapters_of
from dexrepro.storage import digest_of, read_json, write_json
from dexrepro.study.draws import within

ROUNDS, SHRINK = 4, 0.4  # boxes around the best, each this share as wide as the one before
PERIODS = ("dt", "control_period", "step")  # names of the time between two calls of a law, which is no gain of it
EDGE = 0.02  # share of a range that counts as its edge
NO_BETTER = "no run is better than the case as it stands"
ALIKE = "every run gives the same: what was searched does not change this metric"
Range = tuple[float, float]


@dataclass(frozen=True)
class Search:
    """What is tuned: a case of resolved ``values``, ranges by dotted key, a metric; ``sign`` is -1 to maximise it.

    metric: one, or several with + between them, whose sum counts. limits: what other metrics may be at most.
    listed: the case is made from a list (``each``), so that only all of its experiment can be overridden. guessed:
    nobody has given the ranges, so that the search follows what is best beyond them.
    """

    chapter: str
    experiment: str
    case: str
    values: dict[str, Any]
    ranges: dict[str, Range]
    metric: str
    sign: int
    seed: int
    limits: dict[str, float] = field(default_factory=dict)
    listed: bool = False
    guessed: bool = False

    @property
    def name(self) -> str:
        return f"{self.experiment}.{self.case}"

    def at(self, point: Array) -> dict[str, float]:
        """The parameters at a point of the unit cube."""
        return {
            key: within(float(share), low, high, isinstance(value_at(self.values, key), int))
            for share, (key, (low, high)) in zip(point, self.ranges.items(), strict=True)
        }

    def config(self, chosen: Mapping[str, float]) -> dict[str, Any]:
        """The configuration of the case with some parameters chosen."""
        config = copy.deepcopy(self.values)
        for key, value in chosen.items():
            set_value(config, key, value)
        return case_values(config, self.case, self.seed, default())

    def metrics(self, chosen: Mapping[str, float]) -> Metrics:
        """What one run measures."""
        return measured(chapters.load(self.chapter).experiment(self.experiment), self.config(chosen))

    def override(self, chosen: Mapping[str, float]) -> str:
        """The words that give the case these parameters; a list is given whole."""
        place = self.experiment if self.listed else f"++{self.experiment}.cases.{self.case}"
        config, words = self.config(chosen), {}
        for key in chosen:
            while key.rpartition(".")[2].isdigit():
                key = key.rpartition(".")[0]
            text = str(value_at(config, key)).replace(" ", "")
            words[key] = f"'{place}.{key}={text}'"
        return " ".join(words.values())


@dataclass
class Found:
    """What a search found: the metric as the case stands and at its best, the parameters there, and what to know."""

    start: float | None
    best: float | None
    chosen: dict[str, float]
    runs: int
    failed: int
    edges: list[str]  # sentences: parameters whose best lies at the edge of the range, or why nothing is better


def search_of(
    case: str,
    metric: str,
    sign: int,
    parameters: Sequence[str] = (),
    overrides: Sequence[str] = (),
    limits: Mapping[str, float] | None = None,
) -> Search:
    """The search that words ask for: ``parameters`` such as ``law.gain=0.01..0.1``, or ``law.gain`` for its own range.

    Without parameters those of the case's law are tuned, see ``_of_laws``. Raises InputError with one sentence.
    """
    experiment, dot, name = case.partition(".")
    if not dot:
        raise refused("case", case, "be EXPERIMENT.CASE, such as skill_reuse.none")
    numbers, overrides = chapters_of([f"only={experiment}", *overrides])
    if needed := lacking(chapters.load(numbers[0]).experiment(experiment)):
        raise InputError(f"{experiment} {needed}")
    composed = compose_chapter(numbers[0], overrides)
    cases = experiment_cases(composed, experiment)
    if name not in cases:
        raise refused("case", case, f"be EXPERIMENT.CASE; {nearest(name, cases)}")
    values, declared = cases[name], _declared(numbers[0], experiment, composed)
    declared = {key: span for key, span in declared.items() if is_number(value_at(values, key))}
    ranges = dict(_asked(word, values, declared) for word in parameters)
    ranges, guessed = (ranges, False) if ranges else _of_laws(values, declared, composed[experiment])
    listed = name not in (composed[experiment].get("cases") or {"default": {}})
    seed, bounds = composed["seed"], dict(limits or {})
    return Search(numbers[0], experiment, name, values, ranges, metric, sign, seed, bounds, listed, guessed)


def shipped(case: str) -> Path:
    """Where the search for a case's values is kept that is shipped with the book, made or not."""
    return baseline_dir() / "tuning" / f"{case}.json"


def searched() -> list[str]:
    """Cases of the book whose values are the best of a search that is shipped."""
    return sorted(path.stem for path in shipped("").parent.glob("*.json"))


def words_of(case: str) -> list[str]:
    """The words by which the search that is shipped was asked for; none where there is none."""
    if case not in searched():
        return []
    stored = read_json(shipped(case))
    goal = "minimise" if stored["sign"] == 1 else "maximise"
    limits = ",".join(f"{name}:{most:g}" for name, most in stored.get("limits", {}).items())
    words = [f"{key}={low:g}..{high:g}" for key, (low, high) in stored["ranges"].items()]
    asked = [f"{goal}={stored['metric']}", f"budget={len(stored['runs'])}", *([f"limit={limits}"] if limits else [])]
    return [*asked, *words]


def numbers_of(search: Search) -> list[str]:
    """Keys of the case's parameters that are numbers, those with a declared range first."""
    declared = _declared(search.chapter, search.experiment, compose_chapter(search.chapter))
    return sorted(
        (key for key, value in leaves(search.values) if is_number(value)), key=lambda key: key not in declared
    )


def _declared(chapter: str, experiment: str, composed: Mapping[str, Any]) -> dict[str, Range]:
    """Ranges that the configuration declares, by key within the experiment: its own comments and those referred to."""
    origins, found = provenance(chapter), {}
    for key, _ in leaves({name: value for name, value in composed[experiment].items() if name != "cases"}):
        place: str | None = f"{experiment}.{key}"
        while place:
            whole, node = re.sub(r"(\.\d+)+$", "", place), value_at(composed, place)
            origin = origins[whole].of(place[len(whole) + 1 :]) if whole in origins else None
            if origin and origin.low is not None and origin.high is not None:
                found[key] = (origin.low, origin.high)
            referred = re.fullmatch(r"\$\{([\w.]+)\}", node) if isinstance(node, str) else None
            place = referred[1] if referred and key not in found else None
    return found


def _asked(word: str, values: Mapping[str, Any], declared: Mapping[str, Range]) -> tuple[str, Range]:
    """A parameter and its range from a word such as ``law.gain=0.01..0.1``."""
    key, mark, text = word.partition("=")
    numbers = [name for name, value in leaves(values) if is_number(value)]
    if key not in numbers:
        raise InputError(f"unknown parameter '{key}': {nearest(key, numbers)}")
    if not mark and key in declared:
        return key, declared[key]
    ends = text.split("..")
    try:
        low, high = map(float, ends)
    except ValueError:
        low = high = 0.0
    if not low < high:
        raise refused(key, text, f"be a range such as {key}=0.1..1, low before high")
    return key, (low, high)


def _of_laws(
    values: Mapping[str, Any], declared: Mapping[str, Range], block: Mapping[str, Any]
) -> tuple[dict[str, Range], bool]:
    """What of the case's law declares a range; where nothing does, its own positive numbers, a quarter to four times,
    which is a guess.

    Its own are those that stand in it, not what it refers to, such as ``${shared.dt}``; where none stands in it, those
    that it shares with other experiments, not with the others of its own, such as the force they all hold.
    """
    of_law = tuple(f"{law}." for law in _laws(values))
    tunable = {key: span for key, span in declared.items() if key.rpartition(".")[2] not in PERIODS}
    found = {key: span for key, span in tunable.items() if key.startswith(of_law)}
    if found:
        return found, False
    numbers = {key: value for key, value in leaves(values) if key.startswith(of_law) and isinstance(value, float)}
    written = {key: str(value_at(block, key)) for key, value in numbers.items() if value > 0}
    own = [key for key, text in written.items() if "${" not in text]
    own = own or [key for key, text in written.items() if text.startswith("${shared.") and not key.endswith(".dt")]
    return {key: (numbers[key] / 4, numbers[key] * 4) for key in own}, True


def _laws(values: Mapping[str, Any]) -> list[str]:
    """Keys of the blocks that build the case's law: its own, else the controller's that is chosen, else all."""
    found = [
        key.rpartition(".")[0] for key, value in leaves(values) if key.endswith("_target_") and kind_of(str(value))
    ]
    chosen = ("law", f"laws.{values.get('controller')}", str(values.get("controller")))
    return next(([law] for law in chosen if law in found), found)


def kind_of(target: str) -> str | None:
    """The kind of the law that a ``_target_`` names, None where it is no law."""
    module, _, name = target.rpartition(".")
    try:
        law = getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError, ValueError):
        return None
    plain = inspect.isclass(law) and not module.startswith("dexrepro.") and is_plain(law)
    return "holding" if plain else getattr(law, "kind", None)


def run(
    search: Search,
    budget: int,
    results: Path,
    workers: int | None = None,
    tell: Callable[[str], None] = lambda text: None,
    update: bool = False,
) -> tuple[Found, Path]:
    """Search with ``budget`` runs, store all of them under ``results/tuning``; what was found, and the file.

    tell: is told how far it is, after every round. update: store them with the book's evidence, too, at the end.
    """
    definition = chapters.load(search.chapter).experiment(search.experiment)
    about = {"case": search.name, "metric": search.metric, "sign": search.sign, "ranges": search.ranges,
             "seed": search.seed, **({"limits": search.limits} if search.limits else {})}  # fmt: skip
    path = results / "tuning" / f"{search.name}-{digest_of([about, search.values])[:10]}.json"
    writable(results)
    path.parent.mkdir(parents=True, exist_ok=True)
    kept = (_kept(shipped(search.name)) if update else {}) | _kept(path)
    rows: list[dict[str, Any]] = []
    with Pool(workers) as pool:

        def measure(points: Sequence[Array | None]) -> None:
            wanted = [{} if point is None else search.at(point) for point in points]
            contents = [content_of(definition, search.config(chosen)) for chosen in wanted]
            for k, content in enumerate(contents):
                if content not in kept:
                    pool.add(k, search.metrics, wanted[k])
            fresh = dict(pool.results())
            for k, (point, chosen, content) in enumerate(zip(points, wanted, contents)):
                row = kept.get(content) or _row(search, content, chosen, fresh[k])
                rows.append({**row, "point": None if point is None else [round(float(x), 6) for x in point]})
            found = _found(search, rows)
            write_json(path, about | vars(found) | {"override": search.override(found.chosen), "runs": rows})
            best = "no usable one" if found.best is None else f"{found.best:.4g}"
            tell(f"{search.name}: {len(rows)} of {budget} runs, {search.metric} {best}")

        measure([None])
        for points in _rounds(search, budget - 1, rows):
            if len(points):
                measure(list(points))
    if update:
        made, path = read_json(path), shipped(search.name)
        path.parent.mkdir(parents=True, exist_ok=True)
        write_json(path, made)
    return _found(search, rows), path


def _kept(path: Path) -> dict[str, dict[str, Any]]:
    """Runs of an earlier search by their content; what is damaged is run again."""
    with suppress(OSError, ValueError, LookupError, TypeError):
        rows = {row["content"]: row for row in read_json(path)["runs"]}
        if all(isinstance(row["value"], float | int | None) and isinstance(row["parameters"], dict)
               for row in rows.values()):  # fmt: skip
            return rows
    return {}


def _rounds(search: Search, budget: int, rows: Sequence[Mapping[str, Any]]) -> Iterator[Array]:
    """Points of the unit cube to be run next: an even cover, then boxes around the best of all ``rows`` so far."""
    if not search.ranges:
        return
    sobol = stats.qmc.Sobol(len(search.ranges), seed=zlib.crc32(f"{search.name}.{search.seed}".encode()))
    unit, sizes = iter(sobol.random(4096)), [len(part) for part in np.array_split(np.arange(budget // 2), ROUNDS)]
    yield np.array(list(islice(unit, budget - sum(sizes))))
    for number, size in enumerate(sizes, 1):
        tried = [row for row in rows if row["point"] is not None and row["value"] is not None]
        points = np.array(list(islice(unit, size)))
        if size and tried:
            best = np.array(min(tried, key=lambda row: search.sign * row["value"])["point"])
            points = best + SHRINK**number * (points - 0.5)
            points = points if search.guessed else np.clip(points, 0, 1)
        yield points


def _row(search: Search, content: str, chosen: Mapping[str, float], result: Any) -> dict[str, Any]:
    """One run as it is stored. Raises InputError for a metric that the case does not have."""
    row = {"content": content, "parameters": chosen, "value": None}
    if isinstance(result, Failure):
        return row | {"error": result.sentence}
    terms = search.metric.split("+")
    for name in (*terms, *search.limits):
        if name not in result:
            raise InputError(f"unknown metric '{name}' of {search.name}: {nearest(name, result)}")
    for name, most in search.limits.items():
        if not (result[name] is not None and result[name] <= most):
            return row | {"error": f"{name} = {result[name]} is more than {most:g}"}
    values = [result[name] for name in terms]
    return row | {"value": None if None in values else math.fsum(values)}


def _found(search: Search, rows: Sequence[Mapping[str, Any]]) -> Found:
    valid = [row for row in rows if row["value"] is not None]
    if not valid:
        why = rows[0].get("error", "undefined")
        return Found(None, None, {}, len(rows), len(rows), [f"no run gave '{search.metric}'; the first: {why}"])
    best, start = min(valid, key=lambda row: search.sign * row["value"]), rows[0]["value"]
    if start is not None and math.isclose(best["value"], start, rel_tol=1e-9):
        best = rows[0]
    edges = []
    if best is rows[0] and len(rows) > 1:
        alike = all(math.isclose(row["value"], start, rel_tol=1e-9) for row in valid)
        edges = [ALIKE if alike else NO_BETTER]
    for share, (key, (low, high)) in zip(best["point"] or (), search.ranges.items()):
        if min(share, 1 - share) < EDGE:
            side = "lower" if share < EDGE else "upper"
            what = f"beyond or at the {side} end of the guess" if search.guessed else f"at the {side} edge of"
            edges.append(f"{key} = {best['parameters'][key]:g} lies {what} {low:g}..{high:g}: widen it")
    failed = len(rows) - len(valid)
    return Found(start, best["value"], dict(best["parameters"]), len(rows), failed, edges)
