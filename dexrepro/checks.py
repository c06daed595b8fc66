"""Checks of values: range, type, length and word, each refused in one sentence that names key, value and range."""

from __future__ import annotations

import math
import numbers
import os
import re
import sys
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from dexrepro.errors import InputError, nearest, refused

FILES = ("demonstrations", "reactions", "csv", "file", "path", "files", "obstacle_files", "block_file")
"""Keys whose values are names of files."""


def check_words(config: Mapping[str, Any], words: Mapping[str, tuple[str, ...]], where: str) -> None:
    """Refuse a word that no branch of the code knows, naming those there are."""
    for key, value in leaves(config):
        if isinstance(value, str) and value not in words.get(key, (value,)):
            raise refused(f"{where}.{key}", value, f"be one of {', '.join(words[key])}")


_POSITIVE = re.compile(
    r"(^|_)(mass|masses|lengths?|period|step|duration|inertia|samples|repetitions|substeps|time_constant|radius|frequency)$"
)
_NOT_NEGATIVE = re.compile(r"(^|_)(stiffness|damping|friction|noise|noise_std|delay|width|height|cutoff|tolerance)$")


_COUNT = re.compile(r"(^|_)(samples|steps|substeps|count|repetitions|trials|iterations|generations|places|nodes)$")
_STEP = re.compile(r"(^|_)(step|dt|control_period)$")
LARGEST = 1e50  # of what powers and products are taken
MOST = 10_000_000  # steps of one simulation; what is recorded of them takes some gigabytes


def check_sizes(config: Mapping[str, Any], times: Iterable[str], where: str) -> None:
    """Refuse a time [s] of more steps than can be simulated and recorded, and a count beyond that.

    times: keys of lengths of time; what is called a duration is one in any case."""
    given = {key: value for key, value in leaves(config) if is_number(value)}
    steps = {key: value for key, value in given.items() if _STEP.search(key) and value > 0}
    least = min(steps, key=steps.__getitem__) if steps else ""
    step, times = steps.get(least, 1e-3), {*times}
    for key, value in given.items():
        name = next((part for part in reversed(key.split(".")) if not part.isdigit()), key)
        if _COUNT.search(name) and value > MOST:
            raise refused(f"{where}.{key}", f"{value:g}", f"be {MOST} at most")
        if (key in times or name == "duration") and value > MOST * step:
            of = f" of {where}.{least} = {step:g} s" if least else ""
            raise refused(f"{where}.{key}", f"{value:g}", f"be {MOST * step:g} s at most, {MOST} steps{of}")


def check_values(config: Mapping[str, Any], where: str) -> None:
    """Refuse values outside their physical range, in one sentence that names key, value and range."""
    values = {key: value for key, value in leaves(config) if is_number(value)}
    for key, value in values.items():
        name = next((part for part in reversed(key.split(".")) if not part.isdigit()), key)
        if not abs(value) < math.inf or abs(value) > sys.float_info.max:
            raise refused(f"{where}.{key}", str(value)[:20], "be a finite number")
        if value and not 1 / LARGEST <= abs(value) <= LARGEST:
            raise refused(f"{where}.{key}", value, f"be 0, or {1 / LARGEST:g} to {LARGEST:g} in size")
        if _POSITIVE.search(name) and value <= 0:
            raise refused(f"{where}.{key}", value, "be greater than 0")
        if _NOT_NEGATIVE.search(name) and value < 0:
            raise refused(f"{where}.{key}", value, "be 0 or greater")
    steps = [value for key, value in values.items() if key.rpartition(".")[2] in ("control_period", "step")]
    for key, value in values.items():
        if key.rpartition(".")[2] == "duration" and steps and value < min(steps):
            raise refused(f"{where}.{key}", value, f"be at least one step of {min(steps):g} s")


def check_keys(config: Mapping[str, Any], shipped: Mapping[str, Any], where: str) -> None:
    """Refuse keys that the shipped configuration does not have; those of an object are for its class to know."""
    for key, value in config.items():
        if key not in shipped:
            if key == where:
                raise InputError(
                    f"unknown key '{where}.{key}': what is below '{where}:' in the file stands there without"
                )
            raise InputError(f"unknown key '{where}.{key}': {nearest(key, shipped)}")
        book = shipped[key]
        if isinstance(value, Mapping) and isinstance(book, Mapping) and "_target_" not in {*value, *book}:
            check_keys(value, book, f"{where}.{key}")


def check_types(config: Mapping[str, Any], shipped: Mapping[str, Any], where: str) -> None:
    """Refuse what is no number, or neither true nor false, where the shipped configuration has that, or has numbers in
    lists; and a word in place of an object.

    null stays possible, for it turns many a thing off, but not for what is a quantity by its name.
    """
    for key, book in shipped.items():
        if key not in config:
            continue
        value = config[key]
        if isinstance(book, Mapping) and isinstance(value, Mapping):
            check_types(value, book, f"{where}.{key}")
        if isinstance(book, Mapping) and (is_number(value) or isinstance(value, bool)):
            raise refused(f"{where}.{key}", value, "hold keys with values")
        if isinstance(book, Mapping) and "_target_" in book and isinstance(value, str):
            raise refused(
                f"{where}.{key}", repr(value), "hold keys with values, as {_target_: MODULE.CLASS, KEY: VALUE}"
            )
        if isinstance(book, bool) and not isinstance(value, bool | None):
            raise refused(f"{where}.{key}", repr(value), "be true or false")
        numbers = [is_number(item) for _, item in leaves(book)]
        if not isinstance(book, Mapping) and numbers and all(numbers):
            alone = is_number(book) and (key == "duration" or _STEP.search(key))  # others may be a list, one a case
            if isinstance(value, Mapping) or (alone and isinstance(value, list)):
                raise refused(f"{where}.{key}", value, "be a number")
            for place, item in leaves(value):
                quantity = _POSITIVE.search(key) or _NOT_NEGATIVE.search(key)
                if not is_number(item) and (item is not None or quantity):
                    dotted = f"{where}.{key}.{place}".rstrip(".")
                    shown = "null" if item is None else repr(item)
                    raise refused(dotted, shown, "be a number")


def check_files(config: Mapping[str, Any], shipped: Mapping[str, Any], where: str) -> None:
    """Refuse what names no file, or none that every case can read, where the shipped configuration has none."""
    for key in [key for key, book in leaves(shipped) if book is None and key.rpartition(".")[2] in FILES]:
        given = value_at(config, key)
        if isinstance(given, Mapping) and "file" in given:  # what else it says of the file is no name
            key, given = f"{key}.file", given["file"]
        for place, name in [*leaves(given)] or [("", given)]:
            dotted = f"{where}.{key}.{place}".rstrip(".")
            if name is not None and not (isinstance(name, str) and name):
                raise refused(dotted, repr(name), "name a file or files of yours, or be null")
            if name and os.path.exists(name) and not (os.path.isfile(name) or os.path.isdir(name)):
                raise refused(dotted, name, "be a file that can be read again, no pipe or device")


def check_unread(
    keys: Iterable[str], cases: Iterable[Mapping[str, Any]], shipped: Mapping[str, Any], where: str
) -> None:
    """Refuse what is said of files where no case names one. keys: of the changed values."""
    files = [key for key, book in leaves(shipped) if book is None and key.rpartition(".")[2] in FILES]
    said = [key for key in keys if key in ("unit", "time_unit", "duplicates", "encoding")]
    if said and files and not any(value_at(values, key) for values in cases for key in files):
        named = " or ".join(f"{where}.{key}" for key in files)
        raise InputError(f"{where}.{said[0]} has no effect: no file is named by {named}")


_A_LINK = ("lengths", "masses", "inertias", "centres")  # one value a link each
_VECTOR = re.compile(r"(^|_)(base|centre|place|offset|force|gravity|semi_axes|position|pose|start|goal)$")


def check_lengths(config: Mapping[str, Any], shipped: Mapping[str, Any], where: str) -> None:
    """Refuse lists that do not have as many numbers as what they describe has, a link, an axis, a joint, and what is no
    list of counts, or no range."""
    links = {key: len(config[key]) for key in _A_LINK if isinstance(config.get(key), list)}
    if len(set(links.values())) > 1:
        shown = ", ".join(f"{key} has {count}" for key, count in links.items())
        raise InputError(f"{where}: {shown} values: each must have one for every link")
    for key, value in config.items():
        book = shipped.get(key)
        if isinstance(value, Mapping) and isinstance(book, Mapping):
            check_lengths(value, book, f"{where}.{key}")
        elif isinstance(book, list) and (_VECTOR.search(key) or key in _A_LINK):
            other = isinstance(value, list) and len(value) != len(book) and key not in _A_LINK
            if other or is_number(value):
                raise refused(f"{where}.{key}", value, f"have {len(book)} values")
        elif isinstance(book, list) and key == "counts":
            if not (isinstance(value, list) and value and all(is_whole(count) and count > 0 for count in value)):
                raise refused(f"{where}.{key}", value, "be a list of whole numbers, each 1 or greater")
        elif isinstance(book, list) and key.endswith("_range"):
            numbers = isinstance(value, list) and len(value) == 2 and all(map(is_number, value))
            if not (numbers and value[0] < value[1]):
                raise refused(f"{where}.{key}", value, "be [LOW, HIGH], low before high")


def returned(thing: Any, function: str, must: str, kind: type = Mapping, of: type | tuple[type, ...] = object) -> Any:
    """What a function of an experiment gave, if it is of a kind and, of a dictionary, all in it of another."""
    wrong = [] if isinstance(thing, kind) else [repr(thing)]
    if not wrong and isinstance(thing, Mapping):
        wrong = [f"{{{key!r}: {value!r}}}" for key, value in thing.items() if not isinstance(value, of)]
    if wrong:
        raise InputError(f"{function} gave {textwrap.shorten(wrong[0], 60, placeholder=' …')}; it must return {must}")
    return thing


def returned_numbers(thing: Any, function: str) -> Any:
    """The same of metrics."""
    return returned(thing, function, "a dictionary of numbers", of=(numbers.Real, np.bool_, type(None)))


def is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def leaves(node: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """(dotted key, value) of everything in nested dictionaries and lists."""
    below: Iterable[tuple[Any, Any]]
    if isinstance(node, list):
        below = enumerate(node)
    elif isinstance(node, dict | Mapping):
        below = node.items()
    else:
        yield prefix, node
        return
    for key, value in below:
        name = f"{prefix}.{key}" if prefix else str(key)
        if isinstance(value, float | str | int):  # most are: it saves half of the time
            yield name, value
        else:
            yield from leaves(value, name)


def value_at(node: Any, dotted: str) -> Any:
    """The value of a dotted key in nested dictionaries and lists, None where there is none."""
    for part in dotted.split("."):
        if isinstance(node, list):
            node = node[int(part)] if part.isdigit() and int(part) < len(node) else None
        else:
            node = node.get(part) if isinstance(node, Mapping) else None
    return node


def set_value(node: Any, dotted: str, value: Any) -> None:
    """Set the value of a dotted key that is there."""
    *parents, last = (int(part) if part.isdigit() else part for part in dotted.split("."))
    for part in parents:
        node = node[part]
    node[last] = value


def same(a: Any, b: Any) -> bool:
    """Whether two values are equal, where true is no number."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(same, a, b))
    return bool(a == b) and isinstance(a, bool) == isinstance(b, bool)


def differences(config: Mapping[str, Any], shipped: Mapping[str, Any], prefix: str = "") -> list[str]:
    """Keys in which two configurations differ, as ``key=value (book: value)``."""
    found: list[str] = []
    for key in dict.fromkeys([*config, *shipped]):
        mine, theirs = config.get(key), shipped.get(key)
        if isinstance(mine, Mapping) and isinstance(theirs, Mapping):
            found += differences(mine, theirs, f"{prefix}{key}.")
        elif key not in config:
            found.append(f"{prefix}{key} left out")
        elif key not in shipped or not same(mine, theirs):
            found.append(f"{prefix}{key}={mine} (book: {theirs if key in shipped else 'absent'})")
    return found
