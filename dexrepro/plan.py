"""What a configuration asks for: experiments, their cases with all values, where the results go, what is cached."""

from __future__ import annotations

import contextlib
import fnmatch
import glob
import hashlib
import importlib.util
import inspect
import os
import sys
import tempfile
import uuid
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from dexrepro import chapters, closure
from dexrepro.case import targets
from dexrepro.checks import (
    FILES,
    check_files,
    check_lengths,
    check_sizes,
    check_types,
    check_unread,
    check_words,
    differences,
    leaves,
    same,
    value_at,
)
from dexrepro.config import SETTINGS, compose_chapter, experiment_cases, resolved_block
from dexrepro.control.contract import KINDS, takes
from dexrepro.errors import InputError, folder_named, nearest, refused
from dexrepro.experiment import Experiment
from dexrepro.physics.engine import REFERENCE, default
from dexrepro.provenance import times_of, words_of
from dexrepro.storage import digest_of

NUMERICAL = ("numpy", "scipy")  # packages whose version can change a number, beside the engine
ENGINE = "dexrepro.physics.engine", "engine"  # what every scene and model is made by
READERS = (("dexrepro.chapters.demonstrations", "recorded"), ("dexrepro.chapters.demonstrations", "corners"),
           ("dexrepro.primitives.recorded", "read_path"))  # fmt: skip
PARTIAL = "case="  # begins the word by which a result of some cases differs from the whole one


@dataclass(frozen=True)
class Job:
    """One case to simulate and measure.

    content: hash of its values and of all code and files that it uses; own: of the user's files among them.
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
    _code_digest.cache_clear()
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
    wanted = matching(patterns, [job.case for plan in plans for job in plan.jobs])
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
    return [name for name in names if any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)]


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
    for key in block:
        if key not in shipped[name]:
            if key == name:
                raise InputError(
                    f"unknown key '{name}.{key}': what is below '{name}:' in the file stands there without"
                )
            raise InputError(f"unknown key '{name}.{key}': {nearest(key, shipped[name])}")
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
    for case, values in cases.items():
        values = case_values(values, case, seed, told, perturbation)
        own = own_digest(values)
        content = content_of(experiment, values, own)
        cached = results / ".cache" / name / f"{case}-{digest_of([content, versions])[:16]}"
        plan.jobs.append(Job(chapter, name, case, values, seed, content, own, str(cached), bool(config["gui"]),
                             config["case_timeout"]))  # fmt: skip
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
    for case, values in cases.items():
        check_types(values, book.get(case, next(iter(book.values()))), name)
        check_lengths(values, book.get(case, next(iter(book.values()))), name)
        check_files(values, book.get(case, next(iter(book.values()))), name)
    changed = [key for key, value in config[name].items() if not same(value, shipped[name].get(key))]
    check_unread(changed, cases.values(), next(iter(book.values())), name)
    own = {_key(text): text for text in differences(block, resolved_block(shipped, name))}
    listed = differences({"cases": config[name].get("cases")}, {"cases": shipped[name].get("cases")})
    reached: dict[str, str] = {}  # what changes in a case, by its key there; the first case that has it
    for text in differences(cases, book):
        case, _, key = _key(text).partition(".")
        if f"cases.{case}.{key}" not in map(_key, listed):
            reached.setdefault(key, text)
    for key in own.keys() - reached.keys() if "" not in reached else ():
        own[key] += ", without effect: every case sets its own"
    # A shared value that only a case refers to is named where that case has it.
    beside = [text for key, text in reached.items() if key and key not in own]
    seed = differences({"seed": config["seed"]}, {"seed": shipped["seed"]})
    return [*own.values(), *seed, *listed, *beside]


def _key(difference: str) -> str:
    """The key that a line of ``differences`` is about."""
    return difference.partition("=")[0].removesuffix(" left out")


def select(chapter: str, only: str | Sequence[str] | None, figure: Any) -> list[Experiment]:
    """The experiments of a chapter named by ``only``, which may name others' too, that make ``figure`` (or table)."""
    experiments = chapters.load(chapter).experiments
    names = [experiment.name for experiment in experiments]
    wanted = names if only is None else [only] if isinstance(only, str) else list(only)
    everywhere = {name for number in chapters.numbers() for name in chapters.names(number)}
    for name in wanted:
        if name not in names and (name not in everywhere or not set(wanted) & set(names)):
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
        dead = [path for path in (results, *results.parents) if path.is_symlink() and not path.exists()]
        reason = f"the link {dead[0]} leads nowhere" if dead else error.strerror
        raise InputError(f"results = {results} is not allowed: cannot write there ({reason})") from error
    return results


# ------------------------------------------------------------------------------------------- what a result depends on


def content_of(experiment: Experiment, values: Mapping[str, Any], own: str | None = None) -> str:
    """What the numbers of a case depend on but for the versions of packages: values, code, and files of the user."""
    return digest_of([experiment.name, values, own or own_digest(values), code_digest(experiment, values)])


def code_digest(experiment: Experiment, values: Mapping[str, Any]) -> str:
    """Hash of the code of this package that a case uses: its simulation and the laws that its values name; of what
    reads files of the user only where the values name one."""
    named = frozenset(text for text in targets(values) if text.startswith("dexrepro."))
    reads = any(isinstance(text, str) and {*FILES} & {*key.split(".")} for key, text in leaves(values))
    return _code_digest(experiment.package, named, values.get("engine", REFERENCE), reads)


@lru_cache(maxsize=256)  # emptied before each planning: a session may edit files
def _code_digest(package: str, named: frozenset[str], engine: str, reads: bool) -> str:
    roots = [(f"{package}.experiment", name) for name in ("simulate", "measure", "RATE")]
    roots += [("dexrepro.case", "run"), ("dexrepro.case", "live"), ("dexrepro.recordings", "save_recording")]
    roots += map(closure.target, named)
    engines = [(f"dexrepro.physics.engines.{engine}", "")] if closure.reaches(roots, ENGINE) else []
    return closure.digest([*roots, *engines], () if reads else READERS)


@lru_cache(maxsize=256)
def uses_engine(experiment: Experiment) -> bool:
    """Whether an experiment simulates arms."""
    return closure.reaches([(f"{experiment.package}.experiment", name) for name in ("simulate", "measure")], ENGINE)


def presentation(experiment: Experiment) -> str:
    """Hash of the code that makes claims, tables and figures of the numbers of an experiment."""
    roots = [(f"{experiment.package}.{part}", "") for part in ("figures", "claims")]
    roots += [(f"{experiment.package}.experiment", "summarise"), ("dexrepro.report.style", "")]
    return closure.digest([*roots, *(("dexrepro.result", name) for name in ("present", "summarise", "flat"))])


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


def own_digest(values: Mapping[str, Any]) -> str:
    """Hash of the user's files that a configuration names: data, and modules of classes with what is beside them.

    What a class of a notebook or script (``__main__``) does, no file tells: it is never the same again.
    """
    paths = own_modules(values)
    for key, text in leaves(values):
        named = "." in str(text) or {*FILES} & {*key.split(".")}
        if isinstance(text, str) and named and key.rpartition(".")[2] != "_target_":
            name = os.path.expanduser(text)
            paths.update(path for found in (name, *glob.glob(name)) if (path := Path(found)).is_file())
    if any(text.startswith("__main__.") for text in targets(values)):
        return uuid.uuid4().hex
    return digest_of([[str(path), _file_digest(path)] for path in sorted(paths)])


def own_modules(values: Mapping[str, Any]) -> set[Path]:
    """Source files of the classes that a configuration names: the user's with all beside them, others alone."""
    paths: set[Path] = set()
    for text in targets(values):
        module = text.rpartition(".")[0]
        if text.startswith("dexrepro."):
            continue
        for path in closure.sources([closure.target(text)]):
            paths.update(path.parent.glob("*.py"))
        with contextlib.suppress(ImportError, AttributeError, ValueError):
            place = Path(str(importlib.util.find_spec(module).origin))  # type: ignore[union-attr]
            paths.update([place] if place.is_file() else [])
    return paths


def import_anew(values: Mapping[str, Any]) -> None:
    """Forget the user's modules that a configuration names where this process read them before they were edited."""
    paths = {path for path in own_modules(values) if not closure.is_installed(path)}
    state = {path: _file_digest(path) for path in paths}
    if all(_imported.get(path) == digest for path, digest in state.items()):
        return
    _imported.update(state)
    for name, module in list(sys.modules.items()):
        place = getattr(module, "__file__", None)
        if name != "__main__" and place and Path(place) in paths:
            del sys.modules[name]
            # Kept bytecode of the same second and size would pass for new; an interpreter may keep none.
            with contextlib.suppress(OSError, NotImplementedError):
                Path(importlib.util.cache_from_source(place)).unlink()
    importlib.invalidate_caches()


def check_own(values: Mapping[str, Any]) -> None:
    """Refuse a class of the user's that is not where a configuration says, and a law that nobody could call."""
    for key, text in leaves(values):
        name, _, last = str(text).rpartition(".")
        if key.rpartition(".")[2] != "_target_" or name in ("", "__main__"):
            continue
        try:
            module = importlib.import_module(name)
        except ImportError as error:
            if "relative import" not in str(error):
                continue  # what builds the objects says it well
            raise InputError(f"{text}: {error}; name the law with its folder, or import without the dot") from error
        except Exception:
            continue
        if not hasattr(module, last):
            file, own = getattr(module, "__file__", None) or "built in", Path(*name.split(".")).with_suffix(".py")
            places = {(Path(folder) / own).resolve() for folder in sys.path} - {Path(file).resolve()}
            if hidden := [place for place in places if place.is_file()]:
                raise InputError(f"{text}: '{name}' is a module already ({file}); rename {hidden[0]}")
            names = [key for key, thing in vars(module).items() if getattr(thing, "__module__", None) == name]
            raise InputError(f"{text}: {file} has no '{last}'; {nearest(last, names)}")
        law, where = getattr(module, last), key.rpartition(".")[0]
        block = value_at(values, where) or {}
        parameters = inspect.signature(law).parameters if inspect.isclass(law) or inspect.isfunction(law) else {}
        for part in parameters.keys() & block.keys():
            wanted, value = parameters[part].annotation, block[part]
            wrong = _NO_NUMBER.get(getattr(wanted, "__name__", wanted))
            if wrong and isinstance(value, wrong) and value != parameters[part].default:
                raise refused(f"{where}.{part}", "null" if value is None else repr(value), "be a number")
        if not inspect.isclass(law) or (kind := getattr(law, "kind", None)) not in KINDS:
            continue
        for method, given in {
            "reset": ["measured"],
            "__call__": ["measured", "desired"][: 1 + (kind != "holding")],
        }.items():
            if not takes(law, method, *given):
                raise InputError(f"{text} is no law of kind '{kind}': it must have {method}(self, {', '.join(given)})")


_NO_NUMBER = {"float": str | list | None, "int": str | list | None, "Real": str | None}
"""What a parameter of a law cannot be, by its annotation."""
_imported: dict[Path, str] = {}
"""Files of the user's modules as this process last read them."""


def _file_digest(path: Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha1").hexdigest()
