"""What a configuration asks for: experiments, their cases with all values, where the results go, what is cached."""

from __future__ import annotations

import contextlib
import glob
import hashlib
import importlib.util
import os
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from dexrepro import __version__, chapters
from dexrepro.config import (
    SETTINGS,
    InputError,
    check_types,
    compose_chapter,
    differences,
    experiment_cases,
    leaves,
    nearest,
    resolved_block,
)
from dexrepro.experiment import Experiment
from dexrepro.storage import digest_of

# Modules that change no result.
COMMANDS = ("cli.py", "baselines.py", "progress.py", "study.py", "scaffold.py", "selection.py", "sweep.py")
NUMERICAL = ("numpy", "scipy", "pybullet")  # packages whose version can change a number


@dataclass(frozen=True)
class Job:
    """One case to simulate and measure."""

    chapter: str
    experiment: str
    case: str
    config: dict[str, Any]
    seed: int
    folder: str
    gui: bool = False

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
    differs: list[str] = field(default_factory=list)

    @property
    def fingerprint(self) -> str:
        """Changes with anything a result depends on, drawing code included."""
        keys = [Path(job.folder).name for job in self.jobs]
        return digest_of([keys, source_digest(self.chapter, with_report=True), __version__])


def plan_chapter(
    chapter: str,
    overrides: Sequence[str] = (),
    *,
    composed: Mapping[str, Any] | None = None,
    perturbation: float = 0.0,
    extra_dir: str | None = None,
) -> tuple[list[Plan], dict[str, str]]:
    """Plans of the experiments that the configuration selects, and those skipped with the reason."""
    if chapter not in (*chapters.numbers(), chapters.OWN):
        raise InputError(f"unknown chapter '{chapter}'; chapters: {', '.join(chapters.numbers())}")
    config = composed if composed is not None else compose_chapter(chapter, overrides, extra_dir)
    shipped = compose_chapter(chapter)
    if config["gui"]:
        _require_display()
    results = writable(Path(config["results"]))
    plans, skipped = [], {}
    for experiment in select(chapter, config["only"], config["figure"]):
        absent = [name for name in experiment.requires if importlib.util.find_spec(name) is None]
        if absent:
            skipped[experiment.name] = f"needs {', '.join(absent)} (an optional extra of dexrepro)"
            continue
        plans.append(_plan(chapter, experiment.name, config, shipped, results, perturbation))
    return plans, skipped


def _require_display() -> None:
    from dexrepro.physics.loading import can_open_window

    if not can_open_window():
        shown = os.environ.get("DISPLAY")
        why = f"DISPLAY = {shown} cannot be opened" if shown else "DISPLAY is not set"
        raise InputError(f"gui = true is not allowed: it needs a display, and there is none ({why})")


def _plan(
    chapter: str,
    name: str,
    config: Mapping[str, Any],
    shipped: Mapping[str, Any],
    results: Path,
    perturbation: float,
) -> Plan:
    seed = config["seed"]
    if not isinstance(seed, int):
        raise InputError(f"seed = {seed!r} is not allowed: it must be a whole number of 0 or greater")
    cases, block = experiment_cases(config, name), resolved_block(config, name)
    for key in block:
        if key not in shipped[name]:
            raise InputError(f"unknown key '{name}.{key}': {nearest(key, shipped[name])}")
    differs = [] if _as_shipped(config, shipped) else _differs(name, config, shipped, cases, block)
    folder = results / f"chapter{chapter}" / name
    if differs:
        label = block["name"] if chapter == chapters.OWN else name
        folder = results / "runs" / f"{label}-{digest_of([cases, seed])[:10]}"
    jobs, code = [], [source_digest(chapter), [version(package) for package in NUMERICAL]]
    for case, values in cases.items():
        values = {**values, "perturbation": perturbation, "seed": seed, "case": case}
        key = digest_of([name, values, own_digest(values), *code])
        cached = results / ".cache" / name / f"{case}-{key[:16]}"
        jobs.append(Job(chapter, name, case, values, seed, str(cached), bool(config["gui"])))
    return Plan(chapter, name, block, jobs, folder, seed, differs)


def _as_shipped(config: Mapping[str, Any], shipped: Mapping[str, Any]) -> bool:
    return all(config.get(key) == shipped.get(key) for key in {*config, *shipped} - {*SETTINGS, "hydra"} | {"seed"})


def _differs(
    name: str, config: Mapping[str, Any], shipped: Mapping[str, Any], cases: Mapping[str, Any], block: Mapping[str, Any]
) -> list[str]:
    """In what an experiment differs from the book. Raises InputError where a text stands for a number."""
    book = experiment_cases(shipped, name)
    for case, values in cases.items():
        check_types(values, book.get(case, next(iter(book.values()))), name)
    differs = differences(block, resolved_block(shipped, name))
    differs += differences({"cases": config[name].get("cases")}, {"cases": shipped[name].get("cases")})
    differs = differs or differences(cases, book)  # a shared value that only a case refers to
    return differs + differences({"seed": config["seed"]}, {"seed": shipped["seed"]})


def select(chapter: str, only: str | Sequence[str] | None, figure: Any) -> list[Experiment]:
    """The experiments of a chapter named by ``only`` and those that make ``figure`` (a figure or table id)."""
    experiments = chapters.load(chapter).experiments
    names = [experiment.name for experiment in experiments]
    wanted = names if only is None else [only] if isinstance(only, str) else list(only)
    for name in wanted:
        if name not in names:
            raise InputError(f"unknown experiment '{name}' in chapter {chapter}: {nearest(str(name), names)}")
    selected = [experiment for experiment in experiments if experiment.name in wanted]
    if figure is None:
        return selected
    made = [e for e in selected if any(matches(str(figure), i) for i in (*e.figures, *e.tables))]
    if not made:
        kind = "tables" if str(figure).startswith("T") else "figures"
        ids = [identifier for e in selected for identifier in getattr(e, kind)]
        raise InputError(f"unknown figure '{figure}' in chapter {chapter}: {nearest(str(figure), ids)}")
    return made


def matches(wanted: str, identifier: str) -> bool:
    """Whether "2.9" or "2.9a" names the figure "2.9a" (a number names all its panels)."""
    return wanted == identifier or (identifier.startswith(wanted) and identifier[len(wanted) :].isalpha())


def writable(results: Path) -> Path:
    """The results folder, made if needed. Raises InputError where nothing can be written."""
    try:
        (results / ".cache").mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=results / ".cache").close()
    except OSError as error:
        raise InputError(f"results = {results} is not allowed: cannot write there ({error.strerror})") from error
    return results


@cache
def source_digest(chapter: str, with_report: bool = False) -> str:
    """Hash of the code a case depends on: everything but other chapters, and but report/ unless asked for."""
    root = Path(__file__).parent
    digest = hashlib.sha1()
    if chapter != chapters.OWN and chapters.is_added(chapter):
        for path in sorted(chapters.load(chapter).folder.rglob("*.py")):
            digest.update(path.read_bytes())
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).parts
        if parts[0] == "chapters" and len(parts) > 2 and parts[1] not in (chapter, f"chapter{chapter}"):
            continue
        if parts[0] in COMMANDS or (parts[0] == "report" and not with_report):
            continue
        digest.update(str(parts).encode() + path.read_bytes())
    return digest.hexdigest()


def own_digest(values: Mapping[str, Any]) -> str:
    """Hash of the user's files that a configuration names: data, and modules of classes with what is beside them."""
    paths: set[Path] = set()
    for key, text in leaves(values):
        if not isinstance(text, str) or "." not in text:
            continue
        if key.rpartition(".")[2] != "_target_":
            paths.update(map(Path, glob.glob(text)))
        elif not text.startswith("dexrepro."):
            with contextlib.suppress(ImportError, AttributeError, ValueError):
                module = Path(str(importlib.util.find_spec(text.rpartition(".")[0]).origin))  # type: ignore[union-attr]
                installed = module.is_relative_to(sys.prefix) or module.is_relative_to(sys.base_prefix)
                paths.update([module] if installed else module.parent.glob("*.py"))
    return digest_of([[str(path), path.read_bytes().hex()] for path in sorted(paths) if path.is_file()])
