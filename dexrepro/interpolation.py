"""How blocks of a configuration refer to one another: ``inherits: shared.law`` and ``${shared.dt}``."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterator, Mapping
from typing import Any

from dexrepro.checks import value_at
from dexrepro.errors import InputError, nearest, one_line

INHERITS = "inherits"


def inherited(composed: Mapping[str, Any]) -> dict[str, Any]:
    """The same with every block that says ``inherits: shared.law`` filled in.

    What the block named has and the inheriting block lacks is referred to leaf by leaf (``gain: ${shared.law.gain}``;
    ``_target_`` is copied), so that an override of either key works. Several blocks are a list, a later one wins;
    ``{shared.law: [gain, rate]}`` names what is taken of a block.
    """
    return {key: value if key == "hydra" else _inherited(value, composed, ()) for key, value in composed.items()}


def _inherited(node: Any, composed: Mapping[str, Any], within: tuple[str, ...]) -> Any:
    if not isinstance(node, Mapping):
        return copy.deepcopy(node)
    result: dict[str, Any] = {}
    for parent, taken in _parents(node.get(INHERITS, [])):
        base = value_at(composed, parent)
        this = f"{parent}: {', '.join(taken)}" if taken else parent
        if not isinstance(base, Mapping):
            raise InputError(f"{parent} = {base} is not allowed: it must hold keys with values, which others inherit")
        if this in within:
            raise InputError(
                f"{INHERITS}: {this} is not allowed: it must name a block that does not inherit from this one"
            )
        part_of = {key: value for key, value in base.items() if not taken or key in (*taken, INHERITS)}
        found = _inherited(part_of, composed, (*within, this))
        if missing := [key for key in taken if key not in found]:
            raise InputError(f"{INHERITS}: {parent} has no '{missing[0]}': {nearest(missing[0], {**base, **found})}")
        result = _laid_over(result, _forwarded({key: found[key] for key in taken or found}, parent))
    own = {key: _inherited(value, composed, within) for key, value in node.items() if key != INHERITS}
    return _laid_over(result, own)


def _parents(named: Any) -> Iterator[tuple[str, list[str]]]:
    """Blocks to inherit from, each with the keys that are taken of it (none: all)."""
    for item in named if isinstance(named, list) else [named]:
        yield from item.items() if isinstance(item, Mapping) else [(item, [])]


def _forwarded(node: Mapping[str, Any], prefix: str) -> dict[str, Any]:
    return {
        key: _forwarded(value, f"{prefix}.{key}") if isinstance(value, Mapping)
        else value if key.startswith("_") else f"${{{prefix}.{key}}}"
        for key, value in node.items()
        if key != "cases"
    }  # fmt: skip


def _laid_over(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    result = dict(base)
    for key, value in own.items():
        both = isinstance(value, Mapping) and isinstance(result.get(key), Mapping)
        result[key] = _laid_over(result[key], value) if both and "_target_" not in value else value
    return result


def names_of(composed: Mapping[str, Any]) -> dict[str, Any]:
    """What interpolations may refer to."""
    blocks = {key: value for key, value in composed.items() if key != "hydra"}
    for key, value in blocks.items():
        if isinstance(value, Mapping):
            blocks[key] = {name: item for name, item in value.items() if name != "cases"}
    return blocks


def resolved(names: Mapping[str, Any], experiment: str, block: Mapping[str, Any]) -> dict[str, Any]:
    """A block with every interpolation replaced by what it refers to.

    ``${dotted.name}`` or ``${list.0}`` standing alone, as all of conf/ has it, is looked up here, 50 times faster than
    by OmegaConf; whatever else OmegaConf's grammar knows is left to OmegaConf.
    """
    names = {**names, experiment: block}
    try:
        return _looked_up(block, names, ())
    except _NotPlainError:
        pass
    from omegaconf import OmegaConf
    from omegaconf.errors import OmegaConfBaseException

    config = OmegaConf.create(names)
    try:
        return OmegaConf.to_container(config[experiment], resolve=True)  # type: ignore[return-value]
    except OmegaConfBaseException as error:
        raise InputError(f"{experiment}: {one_line(error)}") from error


class _NotPlainError(Exception):
    """An interpolation that is more than a name, or leads nowhere."""


_PLAIN = re.compile(r"\$\{([A-Za-z_][\w.]*)\}")


def _looked_up(node: Any, names: Mapping[str, Any], within: tuple[str, ...]) -> Any:
    if isinstance(node, list):
        return [_looked_up(value, names, within) for value in node]
    if not isinstance(node, str | int | float) and isinstance(node, Mapping):
        return {key: _looked_up(value, names, within) for key, value in node.items()}
    if not isinstance(node, str) or "${" not in node:
        return node
    match = _PLAIN.fullmatch(node)
    if not match or match[1] in within:
        raise _NotPlainError
    target: Any = names
    for part in match[1].split("."):
        if isinstance(target, str) and _PLAIN.fullmatch(target):
            target = _looked_up(target, names, (*within, match[1]))
        if isinstance(target, list) and part.isdecimal() and int(part) < len(target):
            target = target[int(part)]
        elif isinstance(target, Mapping) and part in target:
            target = target[part]
        else:
            raise _NotPlainError
    return _looked_up(target, names, (*within, match[1]))
