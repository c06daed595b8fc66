"""What experiments there are: the chapters of the book and those a user adds, all found by their folders.

A chapter is a folder of experiments with, where it has them, ``TITLE``, ``ORDER`` and ``FAIRNESS`` in its
``__init__.py``, ``errata.py`` and ``claims.py`` (claims that no experiment can test); an experiment is a folder that
holds ``experiment.py``, see :class:`dexrepro.experiment.Experiment`. Folders outside the package are named by
``--experiments`` or the environment variable ``DEXREPRO_EXPERIMENTS``. Such a folder holds chapters, or is itself one;
it adds to the book, or, with a ``book.yaml`` (title, authors) in it, takes its place.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import re
import shlex
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

import yaml

from dexrepro.claims import Claim, Erratum, Reference
from dexrepro.errors import InputError, reading
from dexrepro.experiment import Experiment

ADDED = "DEXREPRO_EXPERIMENTS"
"""The environment variable with the folders of experiments outside the package, as PATH lists folders."""
NAMED: dict[Path, Path] = {}
"""Folders that were added here, as they were named."""
OWN = "own"
"""Beside the chapters: the scene that a user describes; it is listed, drawn and checked with none of them."""


@dataclass(frozen=True)
class Book:
    """What the pages say of the book: title and authors ("" where no book is behind the experiments)."""

    title: str
    authors: str = ""


@dataclass(frozen=True)
class Chapter:
    """What a chapter's folder offers; claims in the order of their numbers.

    fairness: which settings are made equal between the rivals that its claims are judged by.
    """

    number: str
    title: str
    folder: Path
    experiments: tuple[Experiment, ...]
    claims: tuple[Claim, ...]
    references: tuple[Reference, ...]
    errata: tuple[Erratum, ...]
    fairness: str = ""

    def experiment(self, name: str) -> Experiment:
        return next(experiment for experiment in self.experiments if experiment.name == name)

    def claims_of(self, experiment: str) -> list[Claim]:
        return [claim for claim in self.claims if claim.experiment == experiment]


def add(folder: Path) -> None:
    """Look for experiments in a folder outside the package too, here and in processes started from here."""
    known = [str(path) for path in _added()]
    os.environ[ADDED] = os.pathsep.join(dict.fromkeys([*known, str(folder.resolve())]))
    NAMED[folder.resolve()] = folder
    forget()


def forget() -> None:
    """Look again at what there is."""
    for function in (book, folders, load):
        function.cache_clear()


def is_added(number: str) -> bool:
    """Whether a chapter lives outside the package; its configuration and baseline then stand in its own folder."""
    return folders()[number].parent != Path(__file__).parent


def option(number: str) -> str:
    """What a command needs to find a chapter as this one did, " --experiments FOLDER"; "" where it needs nothing."""
    folder = folders().get(number)
    name = folder and (NAMED.get(folder) or NAMED.get(folder.parent))
    return f" --experiments {shlex.quote(str(name))}" if name else ""


@cache
def book() -> Book:
    """The book that the chapters are about: that of the package, or of an added folder with a ``book.yaml``."""
    home = next((path for path in _added() if (path / "book.yaml").exists()), Path(__file__).parent)
    with reading(path := home / "book.yaml"):
        entries = yaml.safe_load(path.read_text("utf-8"))
    if not isinstance(entries, dict) or "title" not in entries:
        raise InputError(f"{path} has no title: such a file says 'title: ...' and may say 'authors: ...'")
    return Book(str(entries["title"]), str(entries.get("authors", "")))


@cache
def folders() -> dict[str, Path]:
    """Folder of each chapter, by its number as text (the name of the folder without ``chapter``)."""
    homes = [path for path in _added() if (path / "book.yaml").exists()] or [Path(__file__).parent]
    found: dict[str, Path] = {}
    for home in (*homes, *(path for path in _added() if path not in homes)):
        for folder in [home] if _experiments(home) else sorted(path for path in home.iterdir() if _experiments(path)):
            if folder.name != OWN:
                found.setdefault(folder.name.removeprefix("chapter"), folder)
    return found


def numbers() -> tuple[str, ...]:
    """Numbers of the chapters there are, as text, in their order."""
    return tuple(sorted(folders(), key=natural))


def names(number: str) -> list[str]:
    """Names of a chapter's experiments, found without importing any."""
    return sorted(_experiments(folders()[number]))


def natural(text: str) -> list[tuple[int, str]]:
    """Sorting key under which C1.9 comes before C1.10."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", text)]


@cache
def load(number: str) -> Chapter:
    """Import one chapter, or what is beside them."""
    folder = Path(__file__).parent / OWN if number == OWN else folders()[number]
    with reading(folder):
        package = _package(folder)
    order = list(getattr(package, "ORDER", ()))
    found = sorted(_experiments(folder), key=lambda name: (order.index(name) if name in order else len(order), name))
    experiments = tuple(Experiment(f"{package.__name__}.{name}", folder / name) for name in found)
    claims = [claim for experiment in experiments for claim in experiment.claims]
    claims += _part(package, folder, "claims", "CLAIMS")
    if twice := [name for name, count in Counter(claim.id for claim in claims).items() if count > 1]:
        raise InputError(f"{folder}: {twice[0]} names more than one claim; give each an id of its own")
    for claim in claims:
        if lost := [name for name in claim.metrics if name.partition(".")[0] not in found]:
            raise InputError(
                f"{folder}: {claim.id} is about '{lost[0]}', and no experiment of the chapter has that name; a metric "
                f"of the claim's own begins with a dot, '.{lost[0]}'"
            )
    return Chapter(
        number,
        str(getattr(package, "TITLE", folder.name)),
        folder,
        experiments,
        tuple(sorted(claims, key=lambda claim: natural(claim.id))),
        tuple(reference for experiment in experiments for reference in experiment.references),
        tuple(_part(package, folder, "errata", "ERRATA")),
        str(getattr(package, "FAIRNESS", "")),
    )


def _part(package: ModuleType, folder: Path, module: str, name: str) -> tuple[Any, ...]:
    if not (folder / f"{module}.py").exists():
        return ()
    with reading(folder):
        return tuple(getattr(importlib.import_module(f"{package.__name__}.{module}"), name))


def _experiments(folder: Path) -> list[str]:
    return [path.parent.name for path in folder.glob("*/experiment.py")] if folder.is_dir() else []


def _added() -> Iterator[Path]:
    return (Path(text) for text in os.environ.get(ADDED, "").split(os.pathsep) if text)


def _package(folder: Path) -> ModuleType:
    """The chapter's package; one outside of ours is imported as if it stood among them."""
    name = f"{__name__}.{folder.name}"
    if folder.parent != Path(__file__).parent and getattr(sys.modules.get(name), "__path__", None) != [str(folder)]:
        for known in [key for key in sys.modules if key == name or key.startswith(f"{name}.")]:
            del sys.modules[known]  # another folder of the same name
        init = folder / "__init__.py"
        spec: ModuleSpec | None = ModuleSpec(name, None, is_package=True)
        if init.exists():
            spec = importlib.util.spec_from_file_location(name, init, submodule_search_locations=[str(folder)])
        assert spec is not None
        spec.submodule_search_locations = [str(folder)]
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        if spec.loader:
            spec.loader.exec_module(module)
    return importlib.import_module(name)
