"""Blocks of a scene: their keys, and what each holds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from dexrepro.checks import is_number
from dexrepro.errors import InputError, nearest, refused


def vector(value: Any, length: int = 3) -> bool:
    """Whether a value is a list of so many numbers."""
    return isinstance(value, list) and len(value) == length and all(map(is_number, value))


NAME, NUMBER, VECTOR, PLACE = "a name", "a number", "three numbers", "three numbers, or leader"
ANY = "anything"  # who takes it says what is wrong
FITS: dict[str, Callable[[Any], bool]] = {
    NAME: lambda value: isinstance(value, str),
    NUMBER: is_number,
    VECTOR: vector,
    ANY: lambda _: True,
    PLACE: lambda value: value == "leader" or vector(value),
}


def checked(block: Any, where: str, keys: Mapping[str, str], needed: Iterable[str] = ()) -> dict[str, Any]:
    """A block whose keys hold what they must. Raises InputError with key, value and what is allowed."""
    if not isinstance(block, dict):
        raise refused(where, block, f"have {', '.join(keys)}")
    if unknown := [key for key in block if key not in keys]:
        raise InputError(f"unknown key '{where}.{unknown[0]}': {nearest(unknown[0], keys)}")
    for key in (*needed, *block):
        if not FITS[keys[key]](value := block.get(key)):
            raise refused(f"{where}.{key}", "null" if value is None else repr(value), f"be {keys[key]}")
    return dict(block)
