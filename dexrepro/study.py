"""How fragile is a claim? Vary what the book does not print, within the ranges declared in conf/, and count.

A sample draws every ranged parameter of an experiment, and the seed, from its own generator; all claims of the
experiment share it. Samples are kept one a line, so that a study goes on where it was stopped.
"""

from __future__ import annotations

import copy
import json
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from dexrepro import chapters
from dexrepro.baselines import baseline_dir
from dexrepro.config import InputError, Provenance, compose_chapter, experiment_cases, nearest, provenance
from dexrepro.experiment import Metrics
from dexrepro.runner import available_cores, begin_worker, flat, generator, live, summarise
from dexrepro.storage import finite, read_json, write_json


def experiments_of(chapter: str, only: Sequence[str], claim: str | None) -> list[str]:
    """Names of the experiments a study is about. Raises InputError for an unknown claim."""
    loaded = chapters.load(chapter)
    if claim is None:
        return [experiment.name for experiment in loaded.experiments if not only or experiment.name in only]
    by_id = {item.id: item for item in loaded.claims if item.predicate}
    if claim not in by_id:
        raise InputError(f"unknown claim '{claim}' in chapter {chapter}: {nearest(claim, by_id)}")
    return [by_id[claim].experiment]


def parameters(chapter: str, experiment: str) -> dict[str, Provenance]:
    """Parameters with a declared range that an experiment uses: its own, and the shared ones it refers to."""
    composed = compose_chapter(chapter)
    block = json.dumps(composed[experiment], default=str)
    found = {}
    for key, origin in provenance(chapter).items():
        own = key.startswith(f"{experiment}.") and ".cases." not in key
        shared = key.startswith("shared.") and f"${{{key}}}" in block
        value = _get(composed, key)
        scalar = isinstance(value, int | float) and not isinstance(value, bool)
        if origin.low is not None and scalar and (own or shared):
            found[key] = origin
    return found


def draw(chapter: str, experiment: str, index: int) -> tuple[dict[str, float], dict[str, Any]]:
    """Sample number ``index``: the values drawn, and the configuration of every case under them."""
    composed = copy.deepcopy(compose_chapter(chapter))
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
    return values, experiment_cases(composed, experiment)


def evaluate(chapter: str, experiment: str, index: int) -> dict[str, Any]:
    """Simulate one sample and return its values and the margin of every claim (None where it failed)."""
    values, cases = draw(chapter, experiment, index)
    module = chapters.load(chapter).experiment(experiment)
    start, error = time.perf_counter(), None
    metrics: dict[str, Metrics] = {}
    try:
        for case, raw in cases.items():
            config = live({**raw, "perturbation": 0.0, "seed": values["seed"], "case": case})
            recording = module.module.simulate(
                config, lambda purpose: generator(int(values["seed"]), experiment, purpose)
            )
            metrics[case] = module.module.measure(recording, config)
        summarise(module, metrics, live({"cases": cases}))
    except Exception as problem:
        error = f"{type(problem).__name__}: {problem}"
    measured = finite(flat(experiment, metrics))
    margins = {
        claim.id: None if error or claim.predicate is None else claim.predicate.margin(measured)
        for claim in chapters.load(chapter).claims_of(experiment)
    }
    wall = time.perf_counter() - start
    return {"index": index, "values": values, "margins": margins, "error": error, "wall": wall}


def run(
    chapter: str,
    experiment: str,
    samples: int,
    results: Path,
    *,
    workers: int | None = None,
    hours: float | None = None,
) -> Path:
    """Evaluate what is missing of ``samples`` samples, store the summary among the baselines and return its path."""
    lines = results / "study" / f"{experiment}.jsonl"
    lines.parent.mkdir(parents=True, exist_ok=True)
    done = {entry["index"] for entry in _read(lines)}
    missing = [index for index in range(samples) if index not in done]
    deadline = time.monotonic() + 3600 * hours if hours else float("inf")
    count = workers or available_cores()
    with ProcessPoolExecutor(count, initializer=begin_worker, initargs=(None,)) as pool, open(lines, "a") as file:
        while missing and time.monotonic() < deadline:
            batch, missing = missing[: 4 * count], missing[4 * count :]
            for future in as_completed([pool.submit(evaluate, chapter, experiment, index) for index in batch]):
                file.write(json.dumps(finite(future.result())) + "\n")
                file.flush()
    target = baseline_dir() / "study" / f"{experiment}.json"
    target.parent.mkdir(parents=True, exist_ok=True)
    entries = [entry for entry in _read(lines) if entry["index"] < samples]
    write_json(target, summary(chapter, experiment, entries))
    return target


def summary(chapter: str, experiment: str, entries: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """How often each claim holds, with its Wilson interval, and the parameter its margin follows most."""
    claims = {}
    for claim in chapters.load(chapter).claims_of(experiment):
        pairs = [(e["margins"][claim.id], e["values"]) for e in entries if e["margins"].get(claim.id) is not None]
        if not pairs:
            continue
        margins = np.array([margin for margin, _ in pairs])
        holds = int(np.sum(margins > 0))
        low, high = stats.binomtest(holds, len(pairs)).proportion_ci(method="wilson")
        parameter, correlation = _most_influential(margins, [values for _, values in pairs])
        claims[claim.id] = {
            "samples": len(pairs), "holds": holds, "share": holds / len(pairs), "low": low, "high": high,
            "parameter": parameter, "correlation": correlation, "median_margin": float(np.median(margins)),
        }  # fmt: skip
    failed = sum(entry["error"] is not None for entry in entries)
    varied = {key: [o.low, o.high] for key, o in parameters(chapter, experiment).items()}
    return {"chapter": chapter, "experiment": experiment, "samples": len(entries), "failed": failed,
            "varied": varied, "claims": claims}  # fmt: skip


def stored() -> list[dict[str, Any]]:
    """Every study stored among the baselines."""
    return [read_json(path) for path in sorted((baseline_dir() / "study").glob("*.json"))]


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
    if path.exists():
        for line in path.read_text().splitlines():
            if line.endswith("}"):  # the last line may have been cut short
                yield json.loads(line)


def _get(node: Any, dotted: str) -> Any:
    for part in dotted.split("."):
        node = node.get(part) if isinstance(node, Mapping) else None
    return node


def _set(node: Any, dotted: str, value: Any) -> None:
    *parents, last = dotted.split(".")
    for part in parents:
        node = node[part]
    node[last] = value
