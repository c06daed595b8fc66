"""What belongs together: errata, equations, code and commands of a claim; the laws of an experiment."""

from __future__ import annotations

import ast
import pkgutil
import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from dexrepro.case import targets
from dexrepro.checks import leaves
from dexrepro.claims import Claim, Erratum


def errata_of(claim: Claim, errata: Iterable[Erratum], composed: Mapping[str, Any]) -> list[Erratum]:
    """Errata that touch a claim.

    Its text names them, a metric is evidence of both, or a case of the claim's printed form is evidence or sets what
    the erratum's switch sets.
    """
    named = set(re.findall(r"\bE\d+\.\w+", f"{claim.statement} {claim.note}"))
    printed = {_case(name) for name in (claim.printed.metrics if claim.printed else ())}
    printed -= {_case(name) for name in (claim.predicate.metrics if claim.predicate else ())}
    overrides = set[tuple[str, str]]().union(*(_overrides(composed, name) for name in printed))
    return [
        erratum
        for erratum in errata
        if erratum.id in named
        or set(erratum.evidence) & set(claim.metrics)
        or printed & {_case(name) for name in erratum.evidence}
        or (erratum.switch and _settings(erratum.switch.split()) <= overrides)
    ]


def _overrides(composed: Mapping[str, Any], case: str) -> set[tuple[str, str]]:
    """What a case sets, as (last part of the key, value)."""
    experiment, _, name = case.partition(".")
    cases = composed.get(experiment, {}).get("cases") or {}
    return {(key.rpartition(".")[2], str(value).lower()) for key, value in leaves(cases.get(name) or {})}


def _settings(words: Iterable[str]) -> set[tuple[str, str]]:
    pairs = (word.partition("=") for word in words)
    return {(key.rpartition(".")[2], value.lower()) for key, _, value in pairs}


def _case(metric: str) -> str:
    """ "experiment.case.metric" -> "experiment.case"; of a number over several cases the experiment alone."""
    return ".".join(metric.split(".")[:2]) if metric.count(".") > 1 else metric


def concerns(claimed: str, identifier: str) -> bool:
    """Whether a claim about "2.8a" or "2.8, 2.9" is about the figure "2.8", and one about "2.8" about "2.8a"."""
    parts = [part.strip() for part in claimed.replace(";", ",").split(",")]
    panels = "abcdefgh"
    return any(identifier in (part, part.rstrip(panels)) or identifier.rstrip(panels) == part for part in parts)


def laws(node: Any) -> list[Any]:
    """Classes and functions that a configuration names by ``_target_``, each once, as far as they can be imported."""
    things = []
    for name in sorted(set(targets(node))):
        with suppress(ImportError, AttributeError):
            things.append(pkgutil.resolve_name(name))
    return [thing for thing in things if hasattr(thing, "__module__")]


@cache
def definitions(folder: Path) -> dict[str, tuple[Path, int]]:
    """Where each claim and erratum of a chapter's folder is written, of whatever name: id -> file, line."""
    found: dict[str, tuple[Path, int]] = {}
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
                name = node.args[0].value
                if isinstance(name, str):
                    found.setdefault(name, (path, node.lineno))
    return found
