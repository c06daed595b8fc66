"""What a study varies, and the values of each draw."""

from __future__ import annotations

import json
import re
import zlib
from collections.abc import Mapping
from functools import cache
from typing import Any

from dexrepro.arrays import Array
from dexrepro.cases import experiment_cases, resolved_block
from dexrepro.checks import is_number, leaves, set_value, value_at
from dexrepro.config import compose_chapter
from dexrepro.provenance import Provenance, provenance


def parameters(chapter: str, experiment: str) -> dict[str, Provenance]:
    """Parameters that a study of an experiment varies: chosen ones, its own and the shared ones that it refers to.

    A list of numbers is varied element by element, under the keys ``list.0``, ``list.1``, ... What is derived, as the
    best gain of a search, is not: a rival with any other gain is a weaker rival.
    """
    return {key: origin for key, origin in ranged(chapter, experiment).items() if origin.kind == "chosen"}


def varied(chapter: str, experiment: str) -> dict[str, list[Any]]:
    """The same as a summary has it: the words, or the ends of the range, by key."""
    found = parameters(chapter, experiment).items()
    return {key: list(origin.words) if origin.drawn else [origin.low, origin.high] for key, origin in found}


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
    values, composed = _drawn(chapter, experiment, index)
    return values, {**resolved_block(composed, experiment), "cases": experiment_cases(composed, experiment)}


def drawn(chapter: str, experiment: str, index: int) -> dict[str, float | str]:
    """The values drawn for sample number ``index`` alone."""
    return _drawn(chapter, experiment, index)[0]


def _drawn(chapter: str, experiment: str, index: int) -> tuple[dict[str, float | str], dict[str, Any]]:
    """The values drawn, and the chapter's configuration under them."""
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
    return values, composed


def within(share: float, low: float, high: float, whole: bool = False) -> float:
    """The value at a share of a range, to six digits; a range over a decade is covered evenly in the logarithm."""
    value = low * (high / low) ** share if low > 0 and high / low >= 10 else low + (high - low) * share
    return round(value) if whole else float(f"{value:.6g}")
