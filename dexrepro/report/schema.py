"""A JSON schema of the configuration, for editors: made from the values and the comments of conf/."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dexrepro import chapters
from dexrepro.cases import resolved_block
from dexrepro.config import SETTINGS, compose_chapter
from dexrepro.keys import KEYS
from dexrepro.provenance import Provenance, origin_of, provenance

NUMBER = ["number", "array"]
TYPES: dict[type, Any] = {bool: "boolean", int: NUMBER, float: NUMBER, str: "string", list: "array"}


def schema() -> dict[str, Any]:
    """What a file such as ``mine/own/compare.yaml`` may say: settings, and every parameter of every experiment.

    A parameter has its type, its words where those are declared, and its symbol, unit, origin and range as text. Cases
    are free, as is what a ``_target_`` of the user's own takes.
    """
    properties: dict[str, Any] = {key: {"description": KEYS[key][1]} for key in SETTINGS}
    for number in chapters.numbers():
        composed, origins = compose_chapter(number), provenance(number)
        for name in chapters.names(number):
            properties[name] = _block(resolved_block(composed, name), name, composed, origins)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Configuration of dexrepro",
            "type": "object", "properties": properties}  # fmt: skip


def _block(
    node: Mapping[str, Any], key: str, composed: Mapping[str, Any], origins: Mapping[str, Provenance]
) -> dict[str, Any]:
    """A block of parameters; every one may also refer to another, as ``${shared.rate}``."""
    found: dict[str, Any] = {}
    for name, value in node.items():
        origin = origin_of(f"{key}.{name}", composed, origins)[0]
        if name == "cases" and "." not in key:
            found[name] = {"type": "object", "description": "Names, with what each changes."}
        elif isinstance(value, Mapping):
            found[name] = _block(value, f"{key}.{name}", composed, origins)
        elif name != "_target_":
            words = {"enum": [*origin.words]} if origin and origin.words else {}
            plain = {**({"type": TYPES[type(value)]} if type(value) in TYPES else {}), **words}
            found[name] = {"anyOf": [plain, {"type": "string", "pattern": r"\$\{"}, {"type": "null"}]} if plain else {}
            if origin:
                bounds = f" ({origin.bounds})" if origin.bounds else ""
                symbol = f"{origin.symbol} " if origin.symbol else ""
                found[name]["description"] = f"{symbol}[{origin.unit}] {origin.kind}: {origin.text}{bounds}"
    return {"type": ["object", "string", "null"], "properties": found}
