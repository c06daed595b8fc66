"""Run draw after draw until every claim is decided; any number of processes may share the work."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dexrepro import chapters, crosscheck
from dexrepro.cache_key import uses_engine
from dexrepro.claims import LOOKS, OPEN, SEEN, cases_in
from dexrepro.errors import InputError, nearest
from dexrepro.physics.engine import REFERENCE
from dexrepro.plan import matching
from dexrepro.pool import COMPLETES, Failure, Pool
from dexrepro.storage import claimed, locked, write_json
from dexrepro.study import samples
from dexrepro.study.draws import draw, drawn
from dexrepro.study.samples import Cases
from dexrepro.study.summaries import held, summary


class SamplesFailed(Exception):
    """Samples of a study are missing; the sentence says why, and the others are stored."""


def experiments_of(chapter: str, only: Sequence[str], claim: str | None) -> list[str]:
    """Names of the experiments a study is about. Raises InputError for an unknown claim."""
    loaded = chapters.load(chapter)
    by_id = {item.id: item for item in loaded.claims if item.predicate}
    if claim is None:
        about = {item.experiment for item in by_id.values()}
        if without := [e.name for e in loaded.experiments if e.name in only and e.name not in about]:
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
    chosen = tuple(matching(wanted.split(","), names, f" of {experiment}"))
    predicates = [claim.predicate for claim in chapters.load(chapter).claims_of(experiment) if claim.predicate]
    about = [cases_in(predicate.metrics) for predicate in predicates]
    if not any({*cases} <= {*chosen} and not over_several for cases, over_several in about):
        raise InputError(f"case = {wanted} is not allowed: no claim of {experiment} is about these cases alone")
    return chosen


def run(
    chapter: str,
    experiment: str,
    count: int | None,
    results: Path,
    *,
    workers: int | None = None,
    hours: float | None = None,
    update: bool = False,
    engine: str = REFERENCE,
    only: Cases = (),
) -> Path:
    """Evaluate what is missing of ``count`` samples, store all there are with their summary; returns its path.

    count: None takes as many as decide every claim, 16 at least and 100 at most; once controls have been ``SEEN``,
    those cases alone that decide. ``update`` renews the study that is shipped. engine: of the samples made now. only:
    run these cases alone, for the claims about no other, with a summary of their own.
    Raises InputError where a summary of more samples, of another configuration, would be replaced, or where the engine
    is not known to decide every claim as that of the baselines does, and SamplesFailed, at the end, where a sample
    could not be made.
    """
    engine = _engine_for(chapter, experiment, engine, results)
    target = samples.summary_file(experiment, results, update, only)
    for folder in (target.parent, samples.studies_folder(results)):
        folder.mkdir(parents=True, exist_ok=True)
    if count is not None:
        _refuse_fewer(chapter, experiment, count, results, target)
    deadline = time.time() + 3600 * hours if hours else float("inf")
    claims = undecided = chapters.load(chapter).claims_of(experiment)
    names, failed = list(draw(chapter, experiment, 0)[1]["cases"]), []
    kept = kept_samples(chapter, experiment, results, only=only)
    with Pool(workers) as pool:
        for look in (0, *([count] if count is not None else (SEEN, *LOOKS))):  # first at what there is
            deciding = count is None and look > SEEN
            over = samples.cases_over(chapter, experiment, kept.values()) if deciding else None
            needed = samples.needed_cases(undecided, names, deciding=deciding, over=over)
            wanted = tuple(case for case in needed if not only or case in only)
            lacking = [i for i in range(look) if i not in kept or not {*wanted} <= kept[i]["cases"].keys()]
            if not lacking and (look or not kept):
                continue
            for index in lacking:
                pool.add(index, contribute, chapter, experiment, index, results, deadline, engine, wanted)
            failed = [(index, value.sentence) for index, value in pool.results() if isinstance(value, Failure)]
            with locked(samples.studies_folder(results)):  # who ends last sees every sample
                kept = kept_samples(chapter, experiment, results, only=only) if lacking else kept
                words = _store(chapter, experiment, list(kept.values()), target)
            if count is None and look != SEEN:  # what has no number to judge by, after draws of it, has none after more
                undecided = [c for c in claims if words.get(c.id, OPEN if look == 0 else "") == OPEN]
            if failed or not undecided or time.time() > deadline:
                break
    if update:
        crosscheck.respread(experiment)
    if failed:
        raise SamplesFailed(_sentence(experiment, failed))
    return target


def _engine_for(chapter: str, experiment: str, engine: str, results: Path) -> str:
    """The engine of samples made now. Raises InputError where it may decide other than that of the baselines."""
    if not uses_engine(chapters.load(chapter).experiment(experiment)):
        return REFERENCE
    if engine != REFERENCE and not crosscheck.agrees_on(experiment, results):
        raise InputError(
            f"engine = {engine} is not allowed for a study of {experiment}: its claims are not known to have the same "
            f"verdicts under both engines; ask: dexrepro crosscheck chapter={chapter} only={experiment}"
        )
    return engine


def _store(chapter: str, experiment: str, entries: list[dict[str, Any]], target: Path) -> dict[str, str]:
    """Write samples and their summary unless more are held, as where the hours are over; every claim's word."""
    found = summary(chapter, experiment, entries)
    if len(entries) >= held(target):
        samples.write_samples(samples.samples_file(target), entries)
        write_json(target, found)
    return {key: row["word"] for key, row in found["claims"].items()}


def _sentence(experiment: str, failed: Sequence[tuple[Any, str]]) -> str:
    index, reason = failed[0]
    more = f" and {len(failed) - 1} more" if len(failed) > 1 else ""
    return f"sample {index}{more} of {experiment} failed: {reason.removesuffix(f'; {COMPLETES}')}; {COMPLETES}"


def _refuse_fewer(chapter: str, experiment: str, count: int, results: Path, target: Path) -> None:
    before, there = held(target), len(kept_samples(chapter, experiment, results))
    if before > max(there, count):
        raise InputError(
            f"samples = {count} is not allowed: {target} holds {before} samples of another configuration, which "
            f"fewer do not replace; ask for {before} or more, or for another folder with results=DIR"
        )


def contribute(
    chapter: str, experiment: str, index: int, results: Path, deadline: float, engine: str = REFERENCE, only: Cases = ()
) -> None:
    """Evaluate one sample and add its line, unless another process does or has done so, or it is too late."""
    with claimed(samples.studies_folder(results), f"{experiment}.{index}", wait=False) as mine:
        if not mine or time.time() > deadline:
            return
        kept = kept_samples(chapter, experiment, results, index).get(index, {"cases": {}})["cases"]
        if only and {*only} <= kept.keys():
            return
        known = {row["content"]: row for row in kept.values()}
        sample = samples.evaluate(chapter, experiment, index, known, engine, only)
        with locked(samples.studies_folder(results)):
            samples.add_sample(samples.samples_file(samples.summary_file(experiment, results)), sample)


def kept_samples(
    chapter: str, experiment: str, results: Path, number: int | None = None, only: Cases = ()
) -> dict[int, dict[str, Any]]:
    """What the samples there are, shipped or made here, hold of the present simulations, in the order of index.

    A sample counts where it has all cases that decide a claim, that of a ``number`` whatever it has. One of another
    engine counts as long as the cross-check shows that it decides every claim alike.
    """
    found: dict[int, dict[str, Any]] = {}
    for entry in samples.all_samples(experiment, results):
        index = entry["index"]
        if number not in (None, index) or ("engine" in entry and not crosscheck.agrees_on(experiment, results)):
            continue
        today = samples.contents(chapter, experiment, entry, only)
        rows = {case: row for case, row in entry["cases"].items() if row["content"] == today.get(case)}
        before = found.get(index, {"cases": {}})
        if before["cases"] and before.get("engine") == entry.get("engine"):
            rows = {**before["cases"], **rows}
        if len(rows) >= len(before["cases"]):
            found[index] = {**entry, "values": drawn(chapter, experiment, index), "cases": rows}
    if number is not None:
        return found
    names = list(draw(chapter, experiment, 0)[1]["cases"])
    claims = chapters.load(chapter).claims_of(experiment)
    over = samples.cases_over(chapter, experiment, found.values())
    about = [{*samples.needed_cases([claim], names, deciding=True, over=over)} for claim in claims if claim.predicate]
    useful = (index for index, entry in found.items() if any(cases <= entry["cases"].keys() for cases in about))
    return {index: found[index] for index in sorted(useful)}
