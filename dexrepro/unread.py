"""Keys of a configuration that nothing reads: of the user's own experiment, or changed in one of the book's."""

from __future__ import annotations

import inspect
import re
from collections.abc import ItemsView, Iterator, KeysView, Mapping, ValuesView
from typing import Any, Self

from dexrepro import chapters
from dexrepro.checks import leaves
from dexrepro.config import as_written, config_files
from dexrepro.experiment import ADDED, Config, Experiment
from dexrepro.interpolation import INHERITS
from dexrepro.plan import PARTIAL, key_of


class Watched(Config):
    """A configuration that knows which of its keys were read; whoever goes through all of them reads all."""

    def __new__(cls, *_: Any) -> Self:
        made = super().__new__(cls)
        made.__dict__["read"] = set()
        return made

    def __getitem__(self, key: str) -> Any:
        self.__dict__["read"].add(key)
        return super().__getitem__(key)

    def __contains__(self, key: object) -> bool:
        self.__dict__["read"].add(key)
        return super().__contains__(key)

    def get(self, key: str, default: Any = None) -> Any:
        """As of every dictionary."""
        self.__dict__["read"].add(key)
        return super().get(key, default)

    def pop(self, key: str, *default: Any) -> Any:
        """As of every dictionary."""
        self.__dict__["read"].add(key)
        return super().pop(key, *default)

    def __iter__(self) -> Iterator[str]:
        self.__dict__["read"].update(super().keys())
        return super().__iter__()

    def keys(self) -> KeysView[str]:  # type: ignore[override]
        """As of every dictionary."""
        return KeysView(self)

    def values(self) -> ValuesView[Any]:  # type: ignore[override]
        """As of every dictionary."""
        return ValuesView(self)

    def items(self) -> ItemsView[str, Any]:  # type: ignore[override]
        """As of every dictionary."""
        return ItemsView(self)


def unread(node: Any, prefix: str = "") -> Iterator[str]:
    """Dotted keys that were not read, without those below them."""
    if isinstance(node, list):
        for place, item in enumerate(node):
            yield from unread(item, f"{prefix}{place}.")
    elif isinstance(node, Watched):
        for key, value in dict.items(node):
            if key in node.__dict__["read"]:
                yield from unread(value, f"{prefix}{key}.")
            elif prefix or key not in ADDED:
                yield f"{prefix}{key}"


def without_effect(run: Mapping[str, Any]) -> list[str]:
    """Keys that no case of a result (its run.json) reads, no figure, table or claim names, and no value refers to:
    those that were changed, and all that stand in the file of a user's own experiment."""
    chapter, name = run["chapter"], run["experiment"]
    kept = [entry["unread"] for entry in run["cases"].values() if entry.get("unread") is not None]
    if not kept:
        return []
    asked = [key_of(text) for text in run["differs"] if not text.startswith(("cases.", "seed", "engine", PARTIAL))]
    if chapters.is_added(chapter):
        block = as_written(chapter)[name]
        asked += [key for key, _ in leaves({k: v for k, v in block.items() if k != "cases"}) if INHERITS not in key]
    named = _named(chapters.load(chapter).experiment(name))
    files = "\n".join(path.read_text("utf-8") for path in config_files(chapter).values())
    found = []
    for key in dict.fromkeys(asked):
        above = [".".join(key.split(".")[:depth]) for depth in range(1, key.count(".") + 2)]
        last = next((part for part in reversed(key.split(".")) if not part.isdigit()), key)
        referred = any(re.search(rf"\b({name}\.|each: *){re.escape(part)}\b", files) for part in above)
        if all({*above} & {*keys} for keys in kept) and not referred and not re.search(rf"\b{last}\b", named):
            found.append(f"{name}.{key}")
    return found


def _named(experiment: Experiment) -> str:
    """The code that makes figures, tables, claims and numbers over several cases."""
    paths = [experiment.folder / f"{part}.py" for part in ("figures", "claims")]
    summarise = experiment.function("summarise")
    texts = [path.read_text("utf-8") for path in paths if path.exists()]
    return "\n".join([*texts, inspect.getsource(summarise) if summarise else ""])
