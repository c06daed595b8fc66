"""How often does a claim hold? Vary what the book does not print, within the ranges declared in conf/, and count.

A sample draws every ranged parameter of an experiment, and the seed: scrambled Sobol points cover the ranges evenly. It
keeps the *metrics* of the cases, each with the key of its simulation, so that claims, controls and printed forms are
evaluated from samples made earlier: rewording a claim costs nothing, a new case costs that case alone, and only a
changed simulation runs again; ``confirm`` carries samples over a change of code that changed no number. A study looks
at its claims every few samples from 16 on, then draws for those alone that are open, and ends when none is, or at 100.

Samples are kept one a line beside the summary; the same study may be started any number of times, on any machine that
shares the results folder: its processes share the samples.
"""

from __future__ import annotations

import fnmatch
import gzip
import json
import re
import time
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import chdir, nullcontext, suppress
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from dexrepro import baselines, chapters, crosscheck
from dexrepro.arrays import Array
from dexrepro.baselines import baseline_dir
from dexrepro.case import live
from dexrepro.case import run as run_case
from dexrepro.checks import is_number, leaves, set_value, value_at
from dexrepro.claims import LOOKS, OPEN, Claim, robustness
from dexrepro.config import compose_chapter, experiment_cases, resolved_block
from dexrepro.errors import InputError, nearest
from dexrepro.experiment import Config, Metrics
from dexrepro.physics import engine as physics
from dexrepro.physics.engine import REFERENCE
from dexrepro.plan import content_of, uses_engine
from dexrepro.pool import COMPLETES, Failure, Pool
from dexrepro.provenance import Provenance, provenance
from dexrepro.result import flat, summarise
from dexrepro.storage import claimed, digest_of, finite, locked, opened, read_json, require, write_json, write_text

Cases = tuple[str, ...]


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
        for item in loaded.claims:
            if item.id == claim:
                raise InputError(f"claim = {claim} is not allowed: it is not testable: {item.not_testable}")
        raise InputError(f"unknown claim '{claim}' in chapter {chapter}: {nearest(claim, by_id)}")
    return [by_id[claim].experiment]


def cases_of(chapter: str, experiment: str, wanted: str) -> Cases:
    """The cases that names and patterns parted by commas mean. Raises InputError where one means none, or no claim is
    about them alone."""
    names = list(draw(chapter, experiment, 0)[1]["cases"])
    for pattern in wanted.split(","):
        if not fnmatch.filter(names, pattern):
            raise InputError(f"unknown case '{pattern}' of {experiment}: {nearest(pattern, names)}")
    chosen = tuple(name for name in names if any(fnmatch.fnmatchcase(name, p) for p in wanted.split(",")))
    predicates = [claim.predicate for claim in chapters.load(chapter).claims_of(experiment) if claim.predicate]
    about = [{name.split(".")[1] if name.count(".") > 1 else "" for name in found.metrics} for found in predicates]
    if not any(cases <= set(chosen) for cases in about):
        raise InputError(f"case = {wanted} is not allowed: no claim of {experiment} is about these cases alone")
    return chosen


QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the margin, in a summary


def parameters(chapter: str, experiment: str) -> dict[str, Provenance]:
    """Parameters that a study of an experiment varies: chosen ones, its own and the shared ones that it refers to.

    A list of numbers is varied element by element, under the keys ``list.0``, ``list.1``, ... What is derived, as the
    best gain of a search, is not: a rival with any other gain is a weaker rival.
    """
    return {key: origin for key, origin in ranged(chapter, experiment).items() if origin.kind == "chosen"}


@cache
def ranged(chapter: str, experiment: str) -> dict[str, Provenance]:
    """Parameters that an experiment uses with a range or words to draw from, each of which has its own dimension."""
    composed = compose_chapter(chapter)
    referred = _references(composed, composed[experiment])
    found = {}
    for key, origin in provenance(chapter).items():
        own = key.startswith(f"{experiment}.") and ".cases." not in key
        shared = any(key == name or key.startswith(f"{name}.") for name in referred)
        if (origin.low is not None or origin.drawn) and (own or shared):
            for place, value in leaves(value_at(composed, key)):
                if value in origin.words if origin.drawn else is_number(value) and origin.of(place).low is not None:
                    found[f"{key}.{place}".rstrip(".")] = origin.of(place)
    return found


def _references(composed: Mapping[str, Any], node: Any) -> set[str]:
    """Names a node refers to as ``${name}``, and those that these refer to in turn."""
    found: set[str] = set()
    todo = [node]
    while todo:
        names = set(re.findall(r"\$\{([\w.]+)\}", json.dumps(todo.pop(), default=str))) - found
        found |= names
        todo += [value_at(composed, name) for name in names]
    return found


@cache
def _points(experiment: str, dimensions: int) -> Array:
    """Scrambled Sobol points in the unit cube, one a sample."""
    from scipy.stats import qmc

    return qmc.Sobol(max(dimensions, 1), seed=zlib.crc32(experiment.encode())).random(1024)


def draw(chapter: str, experiment: str, index: int) -> tuple[dict[str, float | str], dict[str, Any]]:
    """Sample number ``index``: the values drawn, and under them the experiment's block with all its ``cases``."""
    composed = compose_chapter(chapter)
    varied = ranged(chapter, experiment)
    numbers = {key: origin for key, origin in varied.items() if not origin.drawn}
    words = {key: origin for key, origin in varied.items() if origin.drawn}
    point = _points(experiment, len(numbers) + 1)[index]
    values: dict[str, float | str] = {}
    for share, (key, origin) in zip(point, numbers.items(), strict=False):
        if origin.kind != "chosen":
            continue
        low, high = origin.low or 0.0, origin.high or 0.0
        whole = isinstance(value_at(composed, key), int) and low.is_integer() and high.is_integer()
        values[key] = within(float(share), low, high, whole)
        set_value(composed, key, values[key])
    for share, (key, origin) in zip(_points(f"words of {experiment}", len(words))[index], words.items(), strict=False):
        values[key] = origin.words[int(share * len(origin.words))]
        set_value(composed, key, values[key])
    values["seed"] = int(point[-1] * (1 << 16))
    return values, {**resolved_block(composed, experiment), "cases": experiment_cases(composed, experiment)}


def within(share: float, low: float, high: float, whole: bool = False) -> float:
    """The value at a share of a range, to six digits; a range over a decade is covered evenly in the logarithm."""
    value = low * (high / low) ** share if low > 0 and high / low >= 10 else low + (high - low) * share
    return round(value) if whole else float(f"{value:.6g}")


def evaluate(
    chapter: str, experiment: str, index: int, known: Mapping[str, Any], engine: str = REFERENCE, only: Cases = ()
) -> dict[str, Any]:
    """One sample: what was drawn and, of every case that a claim is about, the key of its simulation and its metrics.

    known: cases that were run before, by the key of their simulation; they are taken over. engine: of the simulations;
    a sample says which it was, where it is not that of the baselines. only: some of the cases.
    """
    physics.use(engine)
    values, block = draw(chapter, experiment, index)
    seed = int(values["seed"])
    loaded = chapters.load(chapter)
    definition, cases = loaded.experiment(experiment), {}
    for case in _cases_of(loaded.claims_of(experiment), block["cases"], only):
        config = _values(block, case, seed, engine)
        content = content_of(definition, config)
        if content in known:
            cases[case] = known[content]
            continue
        start = time.process_time()
        try:
            with chdir("."), physics.unseen() if uses_engine(definition) else nullcontext():  # a law may go elsewhere
                metrics = run_case(definition, live(config), seed)[1]
            found: dict[str, Any] = {"metrics": _rounded(finite(metrics))}
        except Exception as problem:
            found = {"error": f"{type(problem).__name__}: {' '.join(str(problem).split())}"}
        cases[case] = {"content": content, **found, "seconds": round(time.process_time() - start, 3)}
    return {"index": index, "values": values, "cases": cases, **_told(engine)}


def _values(block: Mapping[str, Any], case: str, seed: int, engine: str) -> dict[str, Any]:
    return {**block["cases"][case], "perturbation": 0.0, "seed": seed, "case": case, **_told(engine)}


def _told(engine: str) -> dict[str, str]:
    return {} if engine == REFERENCE else {"engine": engine}


def _contents(chapter: str, experiment: str, entry: Mapping[str, Any], only: Cases = ()) -> dict[str, str]:
    """The key of the present simulation of every case that a claim is about, in one sample."""
    values, block = draw(chapter, experiment, entry["index"])
    loaded, seed = chapters.load(chapter), int(values["seed"])
    definition = loaded.experiment(experiment)
    return {
        case: content_of(definition, _values(block, case, seed, entry.get("engine", REFERENCE)))
        for case in _cases_of(loaded.claims_of(experiment), block["cases"], only)
    }


def confirm(chapter: str, experiment: str, results: Path, update: bool = False) -> tuple[int, list[str]]:
    """Carry samples over a change of code: returns how many cases of samples were carried, and the cases that differ.

    Of every case the first and the last sample made by other code, of the same draw, run again. One whose metrics are
    in both what they were, within the tolerances of the baseline, is the same simulation: its other samples count as
    such. The samples are those that are shipped where ``update`` renews them, else those among the results.
    """
    path = _lines(summary_file(experiment, results, update))
    entries = {entry["index"]: entry for entry in (read_samples(path) if update else _all(experiment, results))}
    old: dict[str, list[int]] = {}
    for index, entry in entries.items():
        if entry["values"] == draw(chapter, experiment, index)[0]:
            for case, content in _contents(chapter, experiment, entry).items():
                if entry["cases"].get(case, {"content": content})["content"] != content:
                    old.setdefault(case, []).append(index)
    runs: dict[int, Cases] = {}
    for case, indices in old.items():
        for index in {indices[0], indices[-1]}:
            runs[index] = (*runs.get(index, ()), case)
    again = {
        index: evaluate(chapter, experiment, index, {}, entries[index].get("engine", REFERENCE), cases)["cases"]
        for index, cases in runs.items()
    }
    known = baselines.Baseline.of(chapter, experiment).metrics
    same = {
        case
        for case in old
        if all(
            _is_same(f"{experiment}.{case}", entries[index]["cases"][case], rows[case], known)
            for index, rows in again.items()
            if case in rows
        )
    }
    for case in same:
        for index in old[case]:
            entries[index]["cases"][case]["content"] = _contents(chapter, experiment, entries[index], (case,))[case]
    if same:
        path.parent.mkdir(parents=True, exist_ok=True)
        with locked(_folder(results)):
            _write_lines(path, [entries[index] for index in sorted(entries)])
    return sum(len(old[case]) for case in same), sorted(old.keys() - same)


def _is_same(name: str, old: Mapping[str, Any], new: Mapping[str, Any], known: Mapping[str, Mapping[str, Any]]) -> bool:
    """Whether a case of a sample gave the same numbers twice, or failed twice with the same words."""
    was, now = ({f"{name}.{key}": value for key, value in row.get("metrics", {}).items()} for row in (old, new))
    exact = {"rtol": 2e-6, "atol": 0.0}  # samples keep six digits
    entries = {key: {**known.get(key, exact), "value": value} for key, value in was.items()}
    if _words(old) != _words(new):
        return False
    return was.keys() == now.keys() and all(baselines.agrees(now[key], entry) for key, entry in entries.items())


def _words(row: Mapping[str, Any]) -> list[str]:
    """Why a case failed, without its numbers, in which rounding may show."""
    return re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", str(row.get("error", ""))).split()


def metrics_of(chapter: str, experiment: str, entry: Mapping[str, Any]) -> Metrics:
    """All metrics of a sample by their full names, with those over several cases; a case that failed has none."""
    nested: dict[str, Metrics] = {
        case: dict(row["metrics"]) for case, row in entry["cases"].items() if "metrics" in row
    }
    definition = chapters.load(chapter).experiment(experiment)
    if definition.function("summarise") and len(nested) == len(entry["cases"]):
        block = draw(chapter, experiment, entry["index"])[1]
        if len(nested) == len(block["cases"]):
            summarise(definition, nested, Config.of(block))
    return finite(flat(experiment, nested))


def _rounded(numbers: Mapping[str, float | None]) -> dict[str, float | None]:
    return {key: value if value is None else float(f"{value:.6g}") for key, value in numbers.items()}


def _cases_of(claims: Sequence[Claim], cases: Iterable[str], only: Cases = ()) -> list[str]:
    """The cases that the claims are about, all as soon as a claim needs a number over several; of them only some."""
    if only:
        return [case for case in cases if case in only]
    parts = [name.split(".") for claim in claims for name in claim.metrics]
    if any(len(part) < 3 for part in parts):
        return list(cases)
    return [case for case in cases if any(part[1] == case for part in parts)]


def run(
    chapter: str,
    experiment: str,
    samples: int | None,
    results: Path,
    *,
    workers: int | None = None,
    hours: float | None = None,
    update: bool = False,
    engine: str = REFERENCE,
    only: Cases = (),
) -> Path:
    """Evaluate what is missing of ``samples`` samples, store all there are with their summary; returns its path.

    samples: None takes as many as decide every claim, 100 at most. ``update`` renews the study that is shipped. engine:
    of the samples made now. only: run these cases alone, for the claims about no other, with a summary of their own.
    Raises InputError where a summary of more samples, of another configuration, would be replaced, or where the engine
    is not known to decide every claim as that of the baselines does, and SamplesFailed, at the end, where a sample
    could not be made.
    """
    if not uses_engine(chapters.load(chapter).experiment(experiment)):
        engine = REFERENCE
    if engine != REFERENCE and not crosscheck.agrees_on(experiment, results):
        raise InputError(
            f"engine = {engine} is not allowed for a study of {experiment}: its claims are not known to have the same "
            f"verdicts under both engines; ask: dexrepro crosscheck chapter={chapter} only={experiment}"
        )
    target = summary_file(experiment, results, update, only)
    for folder in (target.parent, _folder(results)):
        folder.mkdir(parents=True, exist_ok=True)
    if samples is not None:
        _refuse_fewer(chapter, experiment, samples, results, target)
    deadline = time.time() + 3600 * hours if hours else float("inf")
    claims = undecided = chapters.load(chapter).claims_of(experiment)
    names, failed = list(draw(chapter, experiment, 0)[1]["cases"]), []
    kept = _kept(chapter, experiment, results, only=only)
    with Pool(workers) as pool:
        for look in (0, *([samples] if samples is not None else LOOKS)):  # first at what there is
            wanted = tuple(case for case in _cases_of(undecided, names) if not only or case in only)
            lacking = [i for i in range(look) if i not in kept or not {*wanted} <= kept[i]["cases"].keys()]
            if not lacking and (look or not kept):
                continue
            for index in lacking:
                pool.add(index, contribute, chapter, experiment, index, results, deadline, engine, wanted)
            failed = [(index, value.sentence) for index, value in pool.results() if isinstance(value, Failure)]
            with locked(_folder(results)):  # who ends last sees every sample
                kept = _kept(chapter, experiment, results, only=only) if lacking else kept
                found = summary(chapter, experiment, list(kept.values()))
                if len(kept) >= _held(target):  # fewer where the hours are over
                    _write_lines(_lines(target), list(kept.values()))
                    write_json(target, found)
            if failed or time.time() > deadline:
                break
            if samples is None:  # what has no number to judge by, after draws of it, has none after more
                unknown = {"word": OPEN if look == 0 else ""}
                undecided = [c for c in claims if found["claims"].get(c.id, unknown)["word"] == OPEN]
                if not undecided:
                    break
    if failed:
        index, reason = failed[0]
        more = f" and {len(failed) - 1} more" if len(failed) > 1 else ""
        reason = reason.removesuffix(f"; {COMPLETES}")
        raise SamplesFailed(f"sample {index}{more} of {experiment} failed: {reason}; {COMPLETES}")
    return target


def _refuse_fewer(chapter: str, experiment: str, samples: int, results: Path, target: Path) -> None:
    before, there = _held(target), len(_kept(chapter, experiment, results))
    if before > max(there, samples):
        raise InputError(
            f"samples = {samples} is not allowed: {target} holds {before} samples of another configuration, which "
            f"fewer do not replace; ask for {before} or more, or for another folder with results=DIR"
        )


def contribute(
    chapter: str, experiment: str, index: int, results: Path, deadline: float, engine: str = REFERENCE, only: Cases = ()
) -> None:
    """Evaluate one sample and add its line, unless another process does or has done so, or it is too late."""
    with claimed(_folder(results), f"{experiment}.{index}", wait=False) as mine:
        if not mine or time.time() > deadline:
            return
        kept = _kept(chapter, experiment, results, index).get(index, {"cases": {}})["cases"]
        if only and {*only} <= kept.keys():
            return
        known = {row["content"]: row for row in kept.values()}
        line = _line(evaluate(chapter, experiment, index, known, engine, only))
        with locked(_folder(results)), open(_lines(summary_file(experiment, results)), "a+b") as file:
            file.seek(max(file.tell() - 1, 0))
            cut_short = file.read(1) not in (b"", b"\n")
            file.write(b"\n" * cut_short + line.encode())


def _kept(
    chapter: str, experiment: str, results: Path, number: int | None = None, only: Cases = ()
) -> dict[int, dict[str, Any]]:
    """What the samples there are, shipped or made here, hold of the present simulations, in the order of index.

    A sample counts where it has all cases of a claim. One of another engine counts as long as the cross-check shows
    that it decides every claim alike.
    """
    found: dict[int, dict[str, Any]] = {}
    for entry in _all(experiment, results):
        index = entry["index"]
        if number not in (None, index) or ("engine" in entry and not crosscheck.agrees_on(experiment, results)):
            continue
        contents = _contents(chapter, experiment, entry, only)
        rows = {case: row for case, row in entry["cases"].items() if row["content"] == contents.get(case)}
        before = found.get(index, {"cases": {}})
        if before["cases"] and before.get("engine") == entry.get("engine"):
            rows = {**before["cases"], **rows}
        if len(rows) >= len(before["cases"]):
            found[index] = {**entry, "values": draw(chapter, experiment, index)[0], "cases": rows}
    names = list(draw(chapter, experiment, 0)[1]["cases"])
    about = [{*_cases_of([claim], names)} for claim in chapters.load(chapter).claims_of(experiment)]
    useful = (index for index, entry in found.items() if any(cases <= entry["cases"].keys() for cases in about))
    return {index: found[index] for index in sorted(useful)}


def _all(experiment: str, results: Path) -> Iterator[dict[str, Any]]:
    for update in (True, False):
        yield from read_samples(_lines(summary_file(experiment, results, update)))


def shipped_samples(experiment: str) -> list[dict[str, Any]]:
    """The samples that are shipped, whatever simulation made them."""
    return list(read_samples(_lines(summary_file(experiment, Path(), shipped=True))))


def _folder(results: Path) -> Path:
    return results / "studies"


def _size(summary: Path) -> int:
    return int(_summary(summary)["samples"]) if summary.exists() else 0


def _held(summary: Path) -> int:
    """Samples that a summary must not lose: those beside it. One without its samples cannot go on and is replaced."""
    return _size(summary) if _lines(summary).exists() else 0


def _lines(summary: Path) -> Path:
    """Samples beside a summary: plain where they grow, compressed where they are shipped."""
    return summary.with_suffix(".jsonl.gz" if summary.parent == baseline_dir() / "study" else ".jsonl")


def _line(entry: Mapping[str, Any]) -> str:
    return json.dumps(entry) + "\n"


def _write_lines(path: Path, entries: Sequence[Mapping[str, Any]]) -> None:
    text = "".join(map(_line, entries))
    if path.suffix == ".gz":
        path.write_bytes(gzip.compress(text.encode(), mtime=0))
    else:
        write_text(path, text)


def summary_file(experiment: str, results: Path, shipped: bool = False, only: Cases = ()) -> Path:
    """Where the summary of a study, or of one of some cases ``only``, is kept: among the user's results, or beside the
    baselines that are shipped."""
    if only:
        return _folder(results) / "cases" / f"{experiment}-{digest_of([*only])[:10]}.json"
    return (baseline_dir() / "study" if shipped else _folder(results)) / f"{experiment}.json"


def summary(chapter: str, experiment: str, entries: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """How often each claim holds and its control fails, what that shows, and the parameter its margin follows.

    Only samples count whose cases all ran; "undefined" says in how many a metric was undefined, where the claim fails.
    """
    from dexrepro.measures import binomial_interval

    claims: dict[str, Any] = {}
    origins = parameters(chapter, experiment)
    sampled = [(metrics_of(chapter, experiment, entry), _numeric(entry["values"], origins)) for entry in entries]
    for claim in chapters.load(chapter).claims_of(experiment):
        pairs = [
            (evaluation, values)
            for metrics, values in sampled
            if (evaluation := claim.evaluate(metrics)).margin is not None
        ]
        if not pairs:
            continue
        margins = np.array([found.margin for found, _ in pairs], dtype=float)
        controls = [found.control_margin for found, _ in pairs if found.control_margin is not None]
        holds = int(np.sum(margins > 0))
        low, high = binomial_interval(holds, len(pairs))
        parameter, correlation = _most_influential(margins, [values for _, values in pairs])
        names = claim.predicate.metrics if claim.predicate else ()
        claims[claim.id] = {
            "predicate": str(claim.predicate), "samples": len(pairs), "holds": holds, "share": holds / len(pairs),
            "low": low, "high": high, "word": robustness(holds, len(pairs)),
            "undefined": sum(any(found.values[name] is None for name in names) for found, _ in pairs),
            "control_fails": sum(margin <= 0 for margin in controls) if controls else None,
            "parameter": parameter, "correlation": correlation, "median_margin": float(np.median(margins)),
            "quantiles": np.quantile(margins, QUANTILES).tolist(), "least": float(margins.min()),
            "boundary": _boundary(parameter, pairs),
        }  # fmt: skip
    engines = dict(sorted(Counter(entry.get("engine", REFERENCE) for entry in entries).items()))
    failed = sum(any("error" in row for row in entry["cases"].values()) for entry in entries)
    varied = {key: list(o.words) if o.drawn else [o.low, o.high] for key, o in origins.items()}
    seconds = sum(row.get("seconds", 0.0) for entry in entries for row in entry["cases"].values())
    return {"chapter": chapter, "experiment": experiment, "samples": len(entries), "failed": failed,
            "seconds": round(seconds, 1), "varied": varied, "claims": claims,
            **({"engines": engines} if set(engines) - {REFERENCE} else {})}  # fmt: skip


def _numeric(values: Mapping[str, float | str], origins: Mapping[str, Provenance]) -> dict[str, float]:
    """The values drawn, with the place of a word among its words."""
    return {k: origins[k].words.index(v) if isinstance(v, str) else v for k, v in values.items()}


def _boundary(parameter: str | None, pairs: Sequence[tuple[Any, Mapping[str, float]]]) -> list[list[float]] | None:
    """Value of the deciding parameter and margin of every sample: where the claim turns."""
    if parameter is None:
        return None
    return sorted([float(values[parameter]), float(f"{found.margin:.4g}")] for found, values in pairs)


def stored(results: Path) -> list[dict[str, Any]]:
    """Every study there is: of those shipped and those made here, the one of more samples; ours where equal.

    A study of a claim that says something else today, or is gone, says nothing of it: its row is left out.
    """
    paths = [*(baseline_dir() / "study").glob("*.json"), *_folder(results).glob("*.json")]
    found = [_summary(path) for _, path in sorted({path.name: path for path in sorted(paths, key=_size)}.items())]
    for item in list(found):
        known = chapters.load(item["chapter"]).claims if item["chapter"] in chapters.numbers() else ()
        today = {claim.id: str(claim.predicate) for claim in known}
        rows = item["claims"].items()
        kept = {key: row for key, row in rows if key in today and row.get("predicate") in (None, today[key])}
        if item["claims"] and not kept:
            found.remove(item)
        item["claims"] = kept
    return found


NUMBER = (int, float)
ROW = {"samples": int, "holds": int, "share": NUMBER, "low": NUMBER, "high": NUMBER, "median_margin": NUMBER,
       "parameter": (str, type(None)), "correlation": (int, float, type(None))}  # fmt: skip


def _summary(path: Path) -> dict[str, Any]:
    """A stored summary. Raises InputError where the file is none."""
    try:
        found: dict[str, Any] = read_json(path)
        require(found, {"chapter": str, "experiment": str, "samples": int, "varied": dict, "claims": dict})
        for key, row in found["claims"].items():
            require(row, ROW, f"{key}.")
            quantiles = row.get("quantiles") or [row["median_margin"]] * len(QUANTILES)
            if len(quantiles) != len(QUANTILES) or not all(isinstance(size, int | float) for size in quantiles):
                raise ValueError(f"{key}.quantiles = {quantiles} is of another kind")
    except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        raise InputError(f"{path} is no study ({reason}); remove it and repeat: dexrepro study") from error
    return found


def robustness_of(chapter: str, results: Path = Path("results")) -> dict[str, str]:
    """What the studies show each claim of a chapter to be: "robust", "fragile" or "open"."""
    rows = [row for item in stored(results) if item["chapter"] == chapter for row in item["claims"].items()]
    return {key: robustness(row["holds"], row["samples"]) for key, row in rows}


PERMUTATIONS = 999


def _most_influential(margins: Array, values: Sequence[Mapping[str, float]]) -> tuple[str | None, float | None]:
    """The parameter whose ranks follow the margins' most, if that is more than chance among all parameters.

    The largest |Spearman correlation| is compared with the largest under permuted margins (5 % of 999), so that trying
    many parameters finds none by luck.
    """
    names = [key for key in values[0] if key != "seed" and len({row[key] for row in values}) > 1]
    if len(margins) < LOOKS[0] or np.ptp(margins) == 0 or not names:
        return None, None
    columns = np.array([[row[key] for row in values] for key in names])
    ranks, order = _standard_ranks(columns), _standard_ranks(margins[None, :])[0]
    correlations = ranks @ order / len(order)
    best = int(np.argmax(np.abs(correlations)))
    rng = np.random.default_rng(0)
    permuted = np.array([rng.permutation(order) for _ in range(PERMUTATIONS)])
    chance = np.max(np.abs(permuted @ ranks.T), axis=1) / len(order)
    if np.sum(chance >= abs(correlations[best])) + 1 > 0.05 * (PERMUTATIONS + 1):
        return None, None
    return names[best], float(correlations[best])


def _standard_ranks(rows: Array) -> Array:
    from scipy.stats import rankdata

    ranks = rankdata(rows, axis=1)
    return (ranks - ranks.mean(axis=1, keepdims=True)) / ranks.std(axis=1, keepdims=True)


def read_samples(path: Path) -> Iterator[dict[str, Any]]:
    """The samples of a file; what is none (a line may have been cut short) is left out."""
    try:
        data = b""
        if path.exists():
            with opened(path) as file:
                data = file.read()
        lines = (gzip.decompress(data) if path.suffix == ".gz" and data else data).splitlines()
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(f"{path} holds no samples of a study ({error}); remove it") from error
    for line in lines:
        with suppress(ValueError, RecursionError, TypeError, LookupError, AttributeError):
            entry = json.loads(line)
            sound = isinstance(entry["index"], int) and entry["index"] >= 0 and isinstance(entry["values"], dict)
            if sound and all(isinstance(row["content"], str) for row in entry["cases"].values()):
                yield entry
