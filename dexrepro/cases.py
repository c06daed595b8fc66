"""The cases of an experiment: each the values of its block with what the case changes, resolved and checked."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator, Mapping
from typing import Any

from dexrepro.checks import check_values, leaves
from dexrepro.errors import InputError, nearest
from dexrepro.interpolation import names_of, resolved

CASE = r"[\w+-]+"  # what names a case, and its files
LONGEST = 60  # letters; with what is written behind and beside it, no name is too long for a disk


def experiment_cases(composed: Mapping[str, Any], experiment: str) -> dict[str, dict[str, Any]]:
    """Resolved configuration of every case of an experiment, checked: ``{case: plain dictionary}``."""
    base, given = _block(composed, experiment)
    names = names_of(composed)
    result: dict[str, dict[str, Any]] = {}
    for name, case in (given if isinstance(given, Mapping) else {"": given}).items():
        if not name or not isinstance(case, Mapping | None):
            where = f"{experiment}.cases.{name}".rstrip(".")
            raise InputError(f"{where} = {case} is not allowed: cases are names with what each changes")
    for name, overrides in _expanded(given or {"default": {}}, names, experiment, base):
        if name == "summary" or not re.fullmatch(CASE, name) or len(name) > LONGEST:
            raise InputError(
                f"{experiment}.cases: '{name[:80]}' is not allowed as a name: use up to {LONGEST} letters, digits and "
                "'_', and not 'summary'"
            )
        if twin := next((known for known in result if known != name and known.lower() == name.lower()), None):
            raise InputError(
                f"{experiment}.cases: '{name}' and '{twin}' differ in case alone: not every disk keeps both"
            )
        merged = copy.deepcopy(base)
        for key, value in overrides.items():
            _assign(merged, key, copy.deepcopy(value), f"{experiment}.cases.{name}")
        result[name] = resolved(names, experiment, merged)
        check_values(result[name], experiment)
    if not result:
        raise InputError(
            f"{experiment}.cases = {', '.join(given)} makes no case: a list that a case is made of is empty"
        )
    return result


def settings(composed: Mapping[str, Any], experiment: str) -> dict[str, Any]:
    """Every parameter of an experiment and of its cases by its full name, as texts name them."""
    block = {**resolved_block(composed, experiment), "cases": experiment_cases(composed, experiment)}
    return dict(leaves({experiment: block}))


def resolved_block(composed: Mapping[str, Any], experiment: str) -> dict[str, Any]:
    """The experiment's own block, resolved, without its cases."""
    return resolved(names_of(composed), experiment, _block(composed, experiment)[0])


def _block(composed: Mapping[str, Any], experiment: str) -> tuple[dict[str, Any], Any]:
    """The experiment's own values, and its cases."""
    if not isinstance(block := composed.get(experiment), Mapping):
        raise InputError(
            f"experiment '{experiment}' has no block in its chapter's configuration (of one of your own: config.yaml "
            "in its folder)"
        )
    return {key: value for key, value in block.items() if key != "cases"}, block.get("cases", {})


def _expanded(
    cases: Mapping[str, Any], names: Mapping[str, Any], experiment: str, base: Mapping[str, Any]
) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for name, overrides in cases.items():
        overrides = overrides or {}
        if "each" not in overrides:
            yield str(name), overrides
            continue
        key = str(overrides["each"])
        rest = {other: value for other, value in overrides.items() if other != "each"}
        values: Any = resolved(names, experiment, base)
        for part in key.split("."):
            if not isinstance(values, Mapping) or part not in values:
                known = [name for name, value in leaves(base) if not name.endswith("_target_")]
                raise InputError(f"{experiment}.cases.{name}.each: unknown key '{key}': {nearest(key, known)}")
            values = values[part]
        for value in values if isinstance(values, list) else [values]:
            yield f"{name}{_label(value)}", {**rest, key: value}


def _label(value: Any) -> str:
    return (f"{value:g}" if isinstance(value, float) else str(value)).replace(".", "p").replace("-", "m")


def _assign(node: dict[str, Any], dotted: str, value: Any, where: str) -> None:
    *parents, last = dotted.split(".")
    for part in parents:
        if not isinstance(node.get(part), dict):
            raise InputError(f"{where}: unknown key '{dotted}': {nearest(part, node)}")
        node = node[part]
    if last not in node:
        raise InputError(f"{where}: unknown key '{dotted}': {nearest(last, node)}")
    if isinstance(value, dict) and isinstance(node[last], dict) and "_target_" not in value:
        for key, item in value.items():
            _assign(node[last], key, item, f"{where}.{last}")
    else:
        node[last] = value
