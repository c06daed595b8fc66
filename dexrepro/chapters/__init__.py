"""The chapters of the book, found by their folders: chapter1, chapter2, ..."""

from __future__ import annotations

import importlib
import pkgutil
from dataclasses import dataclass
from functools import cache

from dexrepro.experiment import Claim, Erratum, Experiment, Reference


@dataclass(frozen=True)
class Chapter:
    """What a chapter package offers; see :mod:`dexrepro.experiment`."""

    number: str
    title: str
    experiments: tuple[Experiment, ...]
    claims: tuple[Claim, ...]
    references: tuple[Reference, ...]
    errata: tuple[Erratum, ...]

    def experiment(self, name: str) -> Experiment:
        return next(experiment for experiment in self.experiments if experiment.name == name)

    def claims_of(self, experiment: str) -> list[Claim]:
        return [claim for claim in self.claims if claim.experiment == experiment]


OWN = "own"
"""Beside the chapters: the scene that a user describes; it is listed, drawn and checked with none of them."""


@cache
def numbers() -> tuple[str, ...]:
    """Numbers of the chapters there are, as text."""
    names = (module.name for module in pkgutil.iter_modules(__path__) if module.ispkg)
    return tuple(sorted(name.removeprefix("chapter") for name in names if name != OWN))


@cache
def load(number: str) -> Chapter:
    """Import one chapter, or what is beside them."""
    package = importlib.import_module(f"{__name__}.{OWN if number == OWN else f'chapter{number}'}")
    return Chapter(
        number=number,
        title=package.TITLE,
        experiments=tuple(package.EXPERIMENTS),
        claims=tuple(package.CLAIMS),
        references=tuple(package.REFERENCES),
        errata=tuple(package.ERRATA),
    )
