"""Words such as ``chapter=2`` and ``movement_estimation.period=5`` as Hydra's grammar of overrides reads them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dexrepro import chapters
from dexrepro.checks import FILES, is_number, value_at
from dexrepro.errors import InputError, nearest, refused

if TYPE_CHECKING:  # Hydra is imported where it is needed: it takes as long as a whole command may
    from hydra.core.override_parser.types import Override

LARGEST_SWEEP = 100_000  # jobs


def parsed(text: str) -> Override | None:
    """What Hydra's grammar makes of a word, None where it is none of its overrides."""
    from hydra.core.override_parser.overrides_parser import OverridesParser
    from hydra.errors import HydraException

    try:
        return OverridesParser.create().parse_override(text)
    except (HydraException, ValueError, RecursionError):  # the latter for thousands of digits or brackets
        return None


def in_quotes(text: str) -> str:
    """A text that Hydra's grammar takes as it is."""
    return "'" + text.replace("'", "\\'") + ("\\'" if text.endswith("\\") else "'")


def selecting(results: Path, only: Sequence[str] = ()) -> list[str]:
    """Overrides that name the folder of the results and the experiments (none: all)."""
    return [f"results={in_quotes(str(results))}", *([f"only=[{','.join(only)}]"] if only else [])]


def forced(overrides: Sequence[str], raw: Mapping[str, Any]) -> list[str]:
    """Overrides of inherited keys, which the files do not spell out, as Hydra takes them."""
    keys, result = set(keys_in(raw)), list[str]()
    for text in overrides:
        key, _, value = text.partition("=")
        inherits = re.match(r"[A-Za-z_]\w*\.", text) and key not in keys and not text.startswith("hydra")
        if key == "scene.elastic" and isinstance(value_at(raw, key), Mapping) and value.startswith("["):  # several now
            result += [f"~{key}", f"+{text}"]
        else:
            result.append(f"++{text}" if inherits else text)
    return result


def understood(overrides: Sequence[str]) -> list[Override]:
    """Overrides as Hydra reads them. Raises InputError for a word that is none of them or names no key."""
    found = []
    for text in overrides:
        override = parsed(text)
        if override is None or not override.key_or_group:
            foreign = "" if text.partition("=")[0].isascii() else "; a key has letters from a to z alone"
            raise InputError(
                f"'{text[:200]}' is not an override of the form key=value, such as chapter=2, only=EXPERIMENT or "
                f"figure=2.7{foreign}"
            )
        if override.is_range_sweep():
            sweep: Any = override.value()
            count = math.ceil((sweep.stop - sweep.start) / sweep.step) if sweep.step else 0
            if not 0 < count <= LARGEST_SWEEP:
                raise InputError(f"'{text}' is not allowed: it makes {max(count, 0)} jobs, {LARGEST_SWEEP} at most")
        found.append(override)
    return found


def refuse_sweeps(overrides: Sequence[str], shipped: Mapping[str, Any]) -> None:
    """Refuse several values in place of one, and say how one list is written where there is one, or a number."""
    for override in understood(overrides):
        if override.is_sweep_override():
            key, _, values = str(override.input_line).partition("=")
            now, listed = value_at(shipped, key), ""
            if isinstance(now, list) or key.rpartition(".")[2] in FILES:
                listed = f"; one list is written {key}=[{values}]"
            elif isinstance(now, float) and re.fullmatch(r"-?\d+,\d+", values):
                listed = f"; one number is written {key}={values.replace(',', '.')}"
            raise InputError(f"'{key}={values}' is a sweep, which needs -m, a run for each value{listed}")


def check_overrides(overrides: Sequence[str], shipped: Mapping[str, Any]) -> None:
    """Refuse overrides that do not parse or whose key the shipped configuration does not have."""
    keys = list(keys_in(shipped))
    for override in understood(overrides):
        key = override.key_or_group
        if override.is_add() or override.is_force_add() or "/" in key or key.startswith("hydra"):
            continue
        if key not in keys:
            listed = re.sub(r"(\.\d+)(\..*)?$", "", key)
            if isinstance(value_at(shipped, listed), list):
                raise InputError(f"'{key}' lies in a list, which is given whole: '{listed}=[…]'")
            if (new := re.fullmatch(r"(\w+)\.cases\.(\w+)", key)) and f"{new[1]}.cases" in keys:
                near = nearest(new[2], value_at(shipped, f"{new[1]}.cases") or ())
                raise InputError(f"{new[1]} has no case '{new[2]}': add it, '+{override.input_line}'; {near}")
            of_case = re.fullmatch(r"(\w+)\.(cases\.\w+)\.(.+)", key)
            if of_case and {f"{of_case[1]}.{of_case[2]}", f"{of_case[1]}.{of_case[3]}"} <= {*keys}:
                raise InputError(
                    f"{of_case[1]}.{of_case[2]} does not set '{of_case[3]}' yet: add it, '+{override.input_line}'"
                )
            owner = {name: number for number in chapters.numbers() for name in chapters.names(number)}
            if (name := key.partition(".")[0]) not in shipped and (other := owner.get(name)):
                raise InputError(f"'{key}' is of chapter {other}, which is not selected")
            raise InputError(f"unknown key '{key}': {nearest(key, keys if '.' in key else shipped)}")
        value = None if override.is_delete() or override.is_sweep_override() else override.value()
        block = isinstance(value_at(shipped, key), Mapping) and not key.endswith(".cases")
        if block and (is_number(value) or isinstance(value, bool)):
            raise refused(key, value, "hold keys with values")


def keys_in(node: Mapping[str, Any], prefix: str = "") -> Iterator[str]:
    """Every key of a configuration with those above it, such as ``shared.arm.kp``."""
    for key, value in node.items():
        yield f"{prefix}{key}"
        if isinstance(value, Mapping):
            yield from keys_in(value, f"{prefix}{key}.")
