"""What a configuration asks for: experiments, their cases with all values, where the results go, what is cached."""

from __future__ import annotations

import fnmatch
import importlib.util
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any

from dexrepro import chapters
from dexrepro.cache_key import content_of, own_digest, package_digest, presentation, uses_engine
from dexrepro.cases import experiment_cases, resolved_block
from dexrepro.checks import (
    check_files,
    check_keys,
    check_lengths,
    check_sizes,
    check_types,
    check_unread,
    check_words,
    differences,
    same,
)
from dexrepro.config import SETTINGS, compose_chapter
from dexrepro.errors import InputError, folder_named, nearest, refused
from dexrepro.experiment import Experiment
from dexrepro.physics.engine import REFERENCE, default
from dexrepro.provenance import times_of, words_of
from dexrepro.selection import select
from dexrepro.storage import digest_of

NUMERICAL = ("numpy", "scipy")  # packages whose version can change a number, beside the engine
PARTIAL = "case="  # begins the word by which a result of some cases differs from the whole one


@dataclass(frozen=True)
class Job:
    """One case to simulate and measure.

    content: hash of its values and of all code and files that it uses; own: of the user's files among them.
    watched: whether it is noted which of its values are read.
    """

    chapter: str
    experiment: str
    case: str
    config: dict[str, Any]
    seed: int
    content: str
    own: str
    folder: str
    gui: bool = False
    timeout: float | None = None
    watched: bool = False

    @property
    def name(self) -> str:
        return f"{self.experiment}.{self.case}"


@dataclass
class Plan:
    """One experiment to run: its cases and where its result goes."""

    chapter: str
    experiment: str
    block: dict[str, Any]
    jobs: list[Job]
    folder: Path
    seed: int
    engine: str
    differs: list[str] = field(default_factory=list)

    @property
    def versions(self) -> dict[str, str]:
        """Packages whose version can change a number of it, with their versions."""
        experiment = chapters.load(self.chapter).experiment(self.experiment)
        engine = [self.engine] if uses_engine(experiment) else []
        return {name: version(name) for name in (*NUMERICAL, *engine, *experiment.requires)}

    @property
    def off_reference(self) -> bool:
        """Whether it simulates arms by another engine than that of the baselines."""
        return REFERENCE != self.engine in self.versions

    @property
    def contents(self) -> dict[str, str]:
        """What each case is made of."""
        return {job.case: job.content for job in self.jobs}

    @cached_property
    def presentation(self) -> str:
        """Hash of the code that makes claims, tables and figures of numbers."""
        return presentation(chapters.load(self.chapter).experiment(self.experiment))


def plan_chapter(
    chapter: str,
    overrides: Sequence[str] = (),
    *,
    composed: Mapping[str, Any] | None = None,
    perturbation: float = 0.0,
    write: bool = True,
) -> tuple[list[Plan], dict[str, str]]:
    """Plans of the experiments that the configuration selects, and those skipped with the reason.

    write: see that results can be written; else nothing is made.
    """
    package_digest.cache_clear()
    if chapter not in (*chapters.numbers(), chapters.OWN):
        raise InputError(f"unknown chapter '{chapter}'; chapters: {', '.join(chapters.numbers())}")
    config = composed if composed is not None else compose_chapter(chapter, overrides)
    shipped = compose_chapter(chapter)
    if config["gui"]:
        _require_display()
    results = folder_named(config["results"])
    if write:
        writable(results)
    plans, skipped = [], {}
    for experiment in select(chapter, config["only"], config["figure"]):
        if needed := lacking(experiment):
            skipped[experiment.name] = needed
            continue
        plans.append(_plan(chapter, experiment.name, config, shipped, results, perturbation))
    return _of_cases(plans, config["case"]), skipped


def _of_cases(plans: list[Plan], wanted: str | Sequence[str] | None) -> list[Plan]:
    """The plans for some of their cases, by name or pattern: a result of its own, which stands for no whole one."""
    if wanted is None:
        return plans
    patterns = [str(name) for name in (wanted if isinstance(wanted, list) else [wanted])]
    if not patterns:
        raise refused("case", "[]", "name a case")
    about = [plan.experiment for plan in plans]
    of = f" of {', '.join(about)}" if len(about) < 4 else f" of chapter {plans[0].chapter}"
    wanted = matching(patterns, [job.case for plan in plans for job in plan.jobs], of)
    result = []
    for plan in plans:
        jobs = [job for job in plan.jobs if job.case in wanted]
        if 0 < len(jobs) < len(plan.jobs):
            label, chosen = plan.folder.name.rpartition("-")[0] or plan.folder.name, [job.case for job in jobs]
            folder = plan.folder.parents[1] / "runs" / f"{label}-{digest_of([plan.folder.name, chosen])[:10]}"
            plan = replace(plan, jobs=jobs, folder=folder, differs=[*plan.differs, f"{PARTIAL}{','.join(chosen)}"])
        result += [plan] if jobs else []
    return result


def matching(patterns: Sequence[str], names: Sequence[str], of: str = "") -> list[str]:
    """The names of cases that patterns mean. Raises InputError for one that means none."""
    for pattern in patterns:
        if not fnmatch.filter(names, pattern):
            raise InputError(f"unknown case '{pattern}'{of}: {nearest(pattern, dict.fromkeys(names))}")
    return _meant(patterns, names)


def _meant(patterns: Sequence[object], names: Iterable[str]) -> list[str]:
    """The names that patterns mean; of another experiment they may mean none."""
    return [name for name in names if any(fnmatch.fnmatchcase(name, str(pattern)) for pattern in patterns)]


def lacking(experiment: Experiment) -> str:
    """What an experiment needs that is not installed, and how to get it ("" where nothing)."""
    absent = [name for name in experiment.requires if importlib.util.find_spec(name) is None]
    return f"needs {', '.join(absent)}: pip install {' '.join(absent)}" if absent else ""


def _require_display() -> None:
    from dexrepro.physics.loading import can_open_window

    if not can_open_window():
        shown = os.environ.get("DISPLAY")
        why = f"DISPLAY = {shown} cannot be opened" if shown else "DISPLAY is not set"
        raise InputError(f"gui = true is not allowed: it needs a display, and there is none ({why})")


def _plan(
    chapter: str, name: str, config: Mapping[str, Any], shipped: Mapping[str, Any], results: Path, perturbation: float
) -> Plan:
    seed: int = config["seed"]
    cases, block = experiment_cases(config, name), resolved_block(config, name)
    check_keys(block, resolved_block(shipped, name), name)
    differs = [] if _as_shipped(config, shipped) else _differs(name, config, shipped, cases, block)
    for values in cases.values() if differs else ():
        check_words(values, words_of(chapter, name), name)
        check_sizes(values, times_of(chapter, name), name)
    experiment, engine = chapters.load(chapter).experiment(name), str(config["engine"] or default())
    told = engine if uses_engine(experiment) else REFERENCE
    if engine != default() and uses_engine(experiment):
        differs.append(f"engine={engine}")
    folder = results / f"chapter{chapter}" / name
    if differs:
        label = block["name"] if chapter == chapters.OWN else name
        folder = results / "runs" / f"{label}-{digest_of([cases, seed, *([told] if told != REFERENCE else [])])[:10]}"
    plan = Plan(chapter, name, block, [], folder, seed, engine, differs)
    versions = list(plan.versions.values())
    watched = chapter != chapters.OWN and (bool(differs) or chapters.is_added(chapter))
    for case, values in cases.items():
        values = case_values(values, case, seed, told, perturbation)
        own = own_digest(values)
        content = content_of(experiment, values, own)
        cached = results / ".cache" / name / f"{case}-{digest_of([content, versions])[:16]}"
        plan.jobs.append(Job(chapter, name, case, values, seed, content, own, str(cached), bool(config["gui"]),
                             config["case_timeout"], watched))  # fmt: skip
    return plan


def case_values(
    values: Mapping[str, Any], case: str, seed: int, engine: str = REFERENCE, perturbation: float = 0.0
) -> dict[str, Any]:
    """The configuration of a case with what it is told beside its values (``experiment.ADDED``)."""
    told = {} if engine == REFERENCE else {"engine": engine}
    return {**values, "perturbation": perturbation, "seed": seed, "case": case, **told}


def _as_shipped(config: Mapping[str, Any], shipped: Mapping[str, Any]) -> bool:
    return all(same(config.get(key), shipped.get(key)) for key in {*config, *shipped} - {*SETTINGS, "hydra"} | {"seed"})


def _differs(
    name: str, config: Mapping[str, Any], shipped: Mapping[str, Any], cases: Mapping[str, Any], block: Mapping[str, Any]
) -> list[str]:
    """In what an experiment differs from the book. Raises InputError where a text stands for a number."""
    book = experiment_cases(shipped, name)
    first = next(iter(book.values()))
    for case, values in cases.items():
        for check in (check_types, check_lengths, check_files):
            check(values, book.get(case, first), name)
    changed = [key for key, value in config[name].items() if not same(value, shipped[name].get(key))]
    check_unread(changed, cases.values(), first, name)
    own = {key_of(text): text for text in differences(block, resolved_block(shipped, name))}
    listed = differences({"cases": config[name].get("cases")}, {"cases": shipped[name].get("cases")})
    reached: dict[str, str] = {}  # what changes in a case that is run, by its key there; the first case that has it
    wanted = config["case"] if isinstance(config["case"], list) else [config["case"] or "*"]
    others = {*cases} - {*_meant(wanted, cases)}
    mine, theirs = ({case: kept[case] for case in kept if case not in others} for kept in (cases, book))
    for text in differences(mine, theirs):
        case, _, key = key_of(text).partition(".")
        if f"cases.{case}.{key}" not in map(key_of, listed):
            reached.setdefault(key, text)
    for key in own.keys() - reached.keys() if "" not in reached else ():
        own[key] += f", without effect: every case{' that is run' if others else ''} sets its own"
    # A shared value that only a case refers to is named where that case has it.
    beside = [text for key, text in reached.items() if key and key not in own]
    seed = differences({"seed": config["seed"]}, {"seed": shipped["seed"]})
    return [*own.values(), *seed, *listed, *beside]


def key_of(difference: str) -> str:
    """The key that a line of ``differences`` is about."""
    return difference.partition("=")[0].removesuffix(" left out")


def writable(results: Path) -> Path:
    """The results folder, made if needed. Raises InputError where nothing can be written."""
    try:
        (results / ".cache").mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=results / ".cache").close()
    except OSError as error:
        dead = [path for path in (results, *results.parents) if path.is_symlink() and not path.exists()]
        reason = f"the link {dead[0]} leads nowhere" if dead else error.strerror
        raise InputError(f"results = {results} is not allowed: cannot write there ({reason})") from error
    return results


def outdated(plan: Plan, run: Mapping[str, Any]) -> str:
    """Why a result with this run.json is not what the present configuration and code give ("" where it is)."""
    was: Mapping[str, Any] = run.get("contents", {})
    other = [case for case in {**was, **plan.contents} if was.get(case) != plan.contents.get(case)]
    if other:
        more = f" and {len(other) - 1} more cases" if len(other) > 1 else ""
        return f"{other[0]}{more} of another configuration or code than the present"
    if run.get("presentation") != plan.presentation:
        return "claims, tables and figures of other code than the present; run: dexrepro draw"
    return ""
