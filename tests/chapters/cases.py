"""One case as its experiment sees it, for the tests of all chapters."""

from __future__ import annotations

import copy
from functools import cache, partial
from typing import Any

from dexrepro.arrays import Rng
from dexrepro.case import generator, live
from dexrepro.cases import experiment_cases
from dexrepro.checks import set_value
from dexrepro.config import compose_chapter
from dexrepro.experiment import Config


@cache
def resolved(chapter: str, experiment: str, name: str = "default", *overrides: str) -> dict[str, Any]:
    """The plain values of a case under overrides as typed; of the others none is resolved, which may take seconds."""
    composed = compose_chapter(chapter, overrides)
    cases = composed[experiment].get("cases") or {}
    chosen = {"cases": {name: cases[name]}} if name in cases else {}
    return experiment_cases(composed | {experiment: composed[experiment] | chosen}, experiment)[name]


def case(chapter: str, experiment: str, name: str = "default", *overrides: str, **changes: Any) -> Config:
    """The case with live objects, some of its keys changed: ``leader__amplitude=0.3``."""
    values = copy.deepcopy(resolved(chapter, experiment, name, *overrides))
    for key, value in {"perturbation": 0.0, "seed": 0, "case": name, **changes}.items():
        set_value(values, key.replace("__", "."), value)
    return live(values)


def rng(experiment: str, seed: int = 0) -> Rng:
    """The random numbers of an experiment, by purpose."""
    return partial(generator, seed, experiment)
