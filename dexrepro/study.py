"""How fragile is a claim? Vary what the book does not print, within the ranges declared in conf/, and count.

A sample draws every ranged parameter of an experiment, and the seed, from its own generator; all claims of the
experiment share it. Samples are kept one a line beside the summary, so that a study goes on where it was stopped, here
or in another checkout; those of another configuration, or of claims that said something else, no longer count. The
same study may be started any number of times, on any machine that shares the results folder: its processes share the
samples.
"""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from dexrepro import chapters
from dexrepro.baselines import baseline_dir
from dexrepro.case import generator, live
from dexrepro.case import run as run_case
from dexrepro.claims import Claim, robustness
from dexrepro.config import (
    InputError,
    Provenance,
    compose_chapter,
    experiment_cases,
    nearest,
    provenance,
    resolved_block,
)
from dexrepro.experiment import Config, Metrics
from dexrepro.measures import binomial_interval
from dexrepro.pool import COMPLETES, Failure, Pool
from dexrepro.runner import flat, summarise
from dexrepro.storage import claimed, digest_of, finite, locked, read_json, write_json, write_text


class SamplesFailed(Exception):
    """Samples of a study are missing; the sentence says why, and the others are stored."""


def experiments_of(chapter: str, only: Sequence[str], claim: str | None) -> list[str]:
    """Names of the experiments a study is about. Raises InputError for an unknown claim."""
    loaded = chapters.load(chapter)
    by_id = {item.id: item for item in loaded.claims if item.predicate}
    if claim is None:
        about = {item.experiment for item in by_id.values()}
        if without := [name for name in only if name not in about]:
            raise InputError(f"{', '.join(without)} of chapter {chapter}: there is no claim that a study could test")
        return [e.name for e in loaded.experiments if e.name in about and (not only or e.name in only)]
    if claim not in by_id:
        raise InputError(f"unknown claim '{claim}' in chapter {chapter}: {nearest(claim, by_id)}")
    return [by_id[claim].experiment]


QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the margin, in a summary


@cache
def parameters(chapter: str, experiment: str) -> dict[str, Provenance]:
    """Parameters with a declared range that an experiment uses: its own, and the shared ones it refers to."""
    composed = compose_chapter(chapter)
    referred = _references(composed, composed[experiment])
    found = {}
    for key, origin in provenance(chapter).items():
        own = key.startswith(f"{experiment}.") and ".cases." not in key
        shared = any(key == name or key.startswith(f"{name}.") for name in referred)
        value = _get(composed, key)
        scalar = isinstance(value, int | float) and not isinstance(value, bool)
        if origin.low is not None and scalar and (own or shared):
            found[key] = origin
    return found


def _references(composed: Mapping[str, Any], node: Any) -> set[str]:
    """Names a node refers to as ``${name}``, and those that these refer to in turn."""
    found: set[str] = set()
    todo = [node]
    while todo:
        names = set(re.findall(r"\$\{([\w.]+)\}", json.dumps(todo.pop(), default=str))) - found
        found |= names
        todo += [_get(composed, name) for name in names]
    return found


def draw(chapter: str, experiment: str, index: int) -> tuple[dict[str, float], dict[str, Any]]:
    """Sample number ``index``: the values drawn, and under them the experiment's block with all its ``cases``."""
    composed = compose_chapter(chapter)
    rng = generator(index, experiment, "study")
    values: dict[str, float] = {}
    for key, origin in parameters(chapter, experiment).items():
        low, high = origin.low or 0.0, origin.high or 0.0
        wide = low > 0 and high / low >= 10
        value = float(np.exp(rng.uniform(np.log(low), np.log(high)))) if wide else float(rng.uniform(low, high))
        if isinstance(_get(composed, key), int):
            value = round(value)
        values[key] = value
        _set(composed, key, value)
    values["seed"] = int(rng.integers(1 << 16))
    return values, {**resolved_block(composed, experiment), "cases": experiment_cases(composed, experiment)}


def evaluate(chapter: str, experiment: str, index: int) -> dict[str, Any]:
    """Simulate one sample and return its values and the margin of every claim (None where a case of it failed)."""
    values, block = draw(chapter, experiment, index)
    cases = block["cases"]
    seed = int(values["seed"])
    loaded = chapters.load(chapter)
    definition, claims = loaded.experiment(experiment), loaded.claims_of(experiment)
    errors: list[str] = []
    metrics: dict[str, Metrics] = {}
    for case in _cases_of(claims, cases):
        try:
            config = live({**cases[case], "perturbation": 0.0, "seed": seed, "case": case})
            metrics[case] = run_case(definition, config, seed)[1]
        except Exception as problem:
            errors.append(f"{case}: {type(problem).__name__}: {problem}")
    if len(metrics) == len(cases):
        summarise(definition, metrics, Config.of(block))
    measured = finite(flat(experiment, metrics))
    margins = {claim.id: claim.predicate.margin(measured) for claim in claims if claim.predicate}
    return {
        "index": index,
        "digest": _digest(claims, block, seed),
        "values": _rounded(values),
        "margins": _rounded(margins),
        "error": "; ".join(errors) or None,
    }


def _digest(claims: Sequence[Claim], block: Mapping[str, Any], seed: float) -> str:
    """Changes with the configuration of a sample and with what the claims say."""
    return digest_of([block, seed, {c.id: c.predicate.text for c in claims if c.predicate}])[:10]


def _rounded(numbers: Mapping[str, float | None]) -> dict[str, float | None]:
    return {key: value if value is None else float(f"{value:.6g}") for key, value in numbers.items()}


def _cases_of(claims: Sequence[Claim], cases: Mapping[str, Any]) -> list[str]:
    """The cases that the claims are about: all as soon as a claim needs a number over several cases."""
    parts = [name.split(".") for claim in claims if claim.predicate for name in claim.predicate.metrics]
    if any(len(part) < 3 for part in parts):
        return list(cases)
    return [case for case in cases if any(part[1] == case for part in parts)]


def run(
    chapter: str,
    experiment: str,
    samples: int,
    results: Path,
    *,
    workers: int | None = None,
    hours: float | None = None,
    update: bool = False,
) -> Path:
    """Evaluate what is missing of ``samples`` samples, store all there are with their summary; returns its path.

    ``update`` renews the study that is shipped. Raises InputError where a summary of more samples, of another
    configuration, would be replaced, and SamplesFailed, at the end, where a sample could not be made.
    """
    target = summary_file(experiment, results, update)
    for folder in (target.parent, _folder(results)):
        folder.mkdir(parents=True, exist_ok=True)
    done = _kept(chapter, experiment, results)
    missing = [index for index in range(samples) if index not in done]
    if (before := _size(target)) > len(done) + len(missing):
        raise InputError(
            f"samples = {samples} is not allowed: {target} holds {before} samples of another configuration, which "
            f"fewer do not replace; ask for {before} or more, or for another folder with results=DIR"
        )
    deadline = time.time() + 3600 * hours if hours else float("inf")
    with Pool(workers) as pool:
        for index in missing:
            pool.add(index, contribute, chapter, experiment, index, results, deadline)
        failed = [(index, value.sentence) for index, value in pool.results() if isinstance(value, Failure)]
    with locked(_folder(results)):  # who ends last sees every sample
        entries = list(_kept(chapter, experiment, results).values())
        if len(entries) >= _size(target):  # fewer where the hours are over
            write_text(_lines(target), "".join(map(_line, entries)))
            write_json(target, summary(chapter, experiment, entries))
    if failed:
        index, reason = failed[0]
        more = f" and {len(failed) - 1} more" if len(failed) > 1 else ""
        reason = reason.removesuffix(f"; {COMPLETES}")
        raise SamplesFailed(f"sample {index}{more} of {experiment} failed: {reason}; {COMPLETES}")
    return target


def contribute(chapter: str, experiment: str, index: int, results: Path, deadline: float) -> None:
    """Evaluate one sample and add its line, unless another process does or has done so, or it is too late."""
    with claimed(_folder(results), f"{experiment}.{index}", wait=False) as mine:
        if not mine or time.time() > deadline or index in _kept(chapter, experiment, results, index):
            return
        line = _line(finite(evaluate(chapter, experiment, index)))
        with locked(_folder(results)), open(_lines(summary_file(experiment, results)), "a+b") as file:
            file.seek(max(file.tell() - 1, 0))
            cut_short = file.read(1) not in (b"", b"\n")
            file.write(b"\n" * cut_short + line.encode())


def _kept(chapter: str, experiment: str, results: Path, only: int | None = None) -> dict[int, dict[str, Any]]:
    """The samples there are, shipped or made here, of the present configuration and claims, in the order of index."""
    found, claims = {}, chapters.load(chapter).claims_of(experiment)
    for update in (True, False):
        for entry in _read(_lines(summary_file(experiment, results, update))):
            if only in (None, entry["index"]) and entry["index"] >= 0:
                values, block = draw(chapter, experiment, entry["index"])
                if entry["digest"] == _digest(claims, block, values["seed"]):
                    found[entry["index"]] = entry
    return dict(sorted(found.items()))


def _folder(results: Path) -> Path:
    return results / "studies"


def _size(summary: Path) -> int:
    return int(_summary(summary)["samples"]) if summary.exists() else 0


def _lines(summary: Path) -> Path:
    return summary.with_suffix(".jsonl")


def _line(entry: Mapping[str, Any]) -> str:
    return json.dumps(entry) + "\n"


def summary_file(experiment: str, results: Path, shipped: bool = False) -> Path:
    """Where the summary of a study is kept: among the user's results, or beside the baselines that are shipped."""
    return (baseline_dir() / "study" if shipped else _folder(results)) / f"{experiment}.json"


def summary(chapter: str, experiment: str, entries: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """How often each claim holds, with its Wilson interval, and the parameter its margin follows most."""
    claims = {}
    for claim in chapters.load(chapter).claims_of(experiment):
        pairs = [(e["margins"][claim.id], e["values"]) for e in entries if e["margins"].get(claim.id) is not None]
        if not pairs:
            continue
        margins = np.array([margin for margin, _ in pairs])
        holds = int(np.sum(margins > 0))
        low, high = binomial_interval(holds, len(pairs))
        parameter, correlation = _most_influential(margins, [values for _, values in pairs])
        claims[claim.id] = {
            "samples": len(pairs), "holds": holds, "share": holds / len(pairs), "low": low, "high": high,
            "parameter": parameter, "correlation": correlation, "median_margin": float(np.median(margins)),
            "quantiles": np.quantile(margins, QUANTILES).tolist(),
        }  # fmt: skip
    failed = sum(entry["error"] is not None for entry in entries)
    varied = {key: [o.low, o.high] for key, o in parameters(chapter, experiment).items()}
    return {"chapter": chapter, "experiment": experiment, "samples": len(entries), "failed": failed,
            "varied": varied, "claims": claims}  # fmt: skip


def stored(results: Path) -> list[dict[str, Any]]:
    """Every study there is: of those shipped and those made here, the one of more samples; ours where equal."""
    paths = [*(baseline_dir() / "study").glob("*.json"), *_folder(results).glob("*.json")]
    return [_summary(path) for _, path in sorted({path.name: path for path in sorted(paths, key=_size)}.items())]


def _summary(path: Path) -> dict[str, Any]:
    """A stored summary. Raises InputError where the file is none."""
    try:
        found: dict[str, Any] = read_json(path)
        numbers = [found["samples"], *(row[key] for row in found["claims"].values() for key in ("samples", "holds"))]
        if not all(isinstance(number, int) for number in numbers) or not isinstance(found["chapter"], str):
            raise ValueError("it counts no samples of a chapter")
    except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        raise InputError(f"{path} is no study ({reason}); remove it and repeat: dexrepro study") from error
    return found


def robustness_of(chapter: str, results: Path = Path("results")) -> dict[str, str]:
    """What the studies show each claim of a chapter to be: "robust", "fragile" or "open"."""
    found: dict[str, str] = {}
    for item in stored(results):
        if item["chapter"] == chapter:
            found |= {key: robustness(entry["holds"], entry["samples"]) for key, entry in item["claims"].items()}
    return found


def _most_influential(margins: Any, values: Sequence[Mapping[str, float]]) -> tuple[str | None, float | None]:
    best: tuple[str | None, float | None] = (None, None)
    if len(margins) < 8 or np.ptp(margins) == 0:
        return best
    for key in values[0]:
        column = np.array([row[key] for row in values])
        if key == "seed" or np.ptp(column) == 0:
            continue
        rank = stats.spearmanr(column, margins)
        if rank.pvalue < 0.05 and abs(rank.statistic) > abs(best[1] or 0):
            best = key, float(rank.statistic)
    return best


def _read(path: Path) -> Iterator[dict[str, Any]]:
    """The samples of a file; what is none (a line may have been cut short) is left out."""
    for line in path.read_bytes().splitlines() if path.exists() else ():
        with suppress(ValueError, RecursionError, TypeError, LookupError):
            entry = json.loads(line)
            if isinstance(entry["index"], int) and {"digest", "values", "margins", "error"} <= set(entry):
                yield entry


def _get(node: Any, dotted: str) -> Any:
    for part in dotted.split("."):
        node = node.get(part) if isinstance(node, Mapping) else None
    return node


def _set(node: Any, dotted: str, value: Any) -> None:
    *parents, last = dotted.split(".")
    for part in parents:
        node = node[part]
    node[last] = value
