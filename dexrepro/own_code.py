"""Modules of the user's that a configuration names by ``_target_``: where they are, read anew, refused."""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import inspect
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dexrepro import closure
from dexrepro.case import targets
from dexrepro.checks import leaves, value_at
from dexrepro.control.contract import KINDS, takes
from dexrepro.errors import InputError, nearest, refused

_NO_NUMBER = {"float": str | list | None, "int": str | list | None, "Real": str | None}
"""What a parameter of a law cannot be, by its annotation."""
_imported: dict[Path, str] = {}
"""Files of the user's modules as this process last read them."""


def own_modules(values: Mapping[str, Any]) -> set[Path]:
    """Source files of the classes that a configuration names: the user's with all beside them, others alone."""
    paths: set[Path] = set()
    for text in targets(values):
        module = text.rpartition(".")[0]
        if text.startswith("dexrepro."):
            continue
        for path in closure.sources([closure.target(text)]):
            paths.update(path.parent.glob("*.py"))
        with contextlib.suppress(ImportError, AttributeError, ValueError):
            place = Path(str(importlib.util.find_spec(module).origin))  # type: ignore[union-attr]
            paths.update([place] if place.is_file() else [])
    return paths


def import_anew(values: Mapping[str, Any]) -> None:
    """Forget the user's modules that a configuration names where this process read them before they were edited."""
    paths = {path for path in own_modules(values) if not closure.is_installed(path)}
    state = {path: file_digest(path) for path in paths}
    if all(_imported.get(path) == digest for path, digest in state.items()):
        return
    _imported.update(state)
    for name, module in list(sys.modules.items()):
        place = getattr(module, "__file__", None)
        if name != "__main__" and place and Path(place) in paths:
            del sys.modules[name]
            # Kept bytecode of the same second and size would pass for new; an interpreter may keep none.
            with contextlib.suppress(OSError, NotImplementedError):
                Path(importlib.util.cache_from_source(place)).unlink()
    importlib.invalidate_caches()


def check_own(values: Mapping[str, Any]) -> None:
    """Refuse a class of the user's that is not where a configuration says, and a law that nobody could call."""
    for key, text in leaves(values):
        name, _, last = str(text).rpartition(".")
        if key.rpartition(".")[2] != "_target_" or name in ("", "__main__"):
            continue
        try:
            module = importlib.import_module(name)
        except ImportError as error:
            if "relative import" not in str(error):
                continue  # what builds the objects says it well
            raise InputError(f"{text}: {error}; name the law with its folder, or import without the dot") from error
        except Exception:
            continue
        if not hasattr(module, last):
            file, own = getattr(module, "__file__", None) or "built in", Path(*name.split(".")).with_suffix(".py")
            places = {(Path(folder) / own).resolve() for folder in sys.path} - {Path(file).resolve()}
            if hidden := [place for place in places if place.is_file()]:
                raise InputError(f"{text}: '{name}' is a module already ({file}); rename {hidden[0]}")
            names = [key for key, thing in vars(module).items() if getattr(thing, "__module__", None) == name]
            raise InputError(f"{text}: {file} has no '{last}'; {nearest(last, names)}")
        law, where = getattr(module, last), key.rpartition(".")[0]
        block = value_at(values, where) or {}
        parameters = inspect.signature(law).parameters if inspect.isclass(law) or inspect.isfunction(law) else {}
        for part in parameters.keys() & block.keys():
            wanted, value = parameters[part].annotation, block[part]
            wrong = _NO_NUMBER.get(getattr(wanted, "__name__", wanted))
            if wrong and isinstance(value, wrong) and value != parameters[part].default:
                raise refused(f"{where}.{part}", "null" if value is None else repr(value), "be a number")
        if not inspect.isclass(law) or (kind := getattr(law, "kind", None)) not in KINDS:
            continue
        called = ["measured"] if kind == "holding" else ["measured", "desired"]
        for method, given in {"reset": ["measured"], "__call__": called}.items():
            if not takes(law, method, *given):
                raise InputError(f"{text} is no law of kind '{kind}': it must have {method}(self, {', '.join(given)})")


def file_digest(path: Path) -> str:
    """Hash of what a file holds."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha1").hexdigest()
