"""The commands: each is declared where its code stands, with what it is for, the keys and the options it takes."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from rich.console import Console
from rich.table import Table

from dexrepro.keys import TAKEN

SHOWN = 8  # names in one line
OK, FAILED, WRONG, INTERRUPTED = 0, 1, 2, 130

for name in ("stdout", "stderr"):  # closed, or of an alphabet that lacks a sign: no reason to fail
    stream: Any = getattr(sys, name) or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  as long as we run
    setattr(sys, name, stream)
    if hasattr(stream, "reconfigure"):
        stream.reconfigure(errors="backslashreplace")
out = Console(highlight=False, soft_wrap=True, width=None if sys.stdout.isatty() else 160)
err = Console(stderr=True, highlight=False, soft_wrap=True)


def say(text: object) -> None:
    """A line of output as it is, brackets and all."""
    out.print(str(text), markup=False)


def warn(text: object) -> None:
    """The same of what went wrong, where errors are said."""
    err.print(str(text), markup=False)


def show_table(table: Table) -> None:
    """A table at the width it needs: a narrow terminal wraps its lines, and no name or folder is cut short."""
    needed = out.measure(table, options=out.options.update(width=10_000)).maximum
    Console(highlight=False, width=max(out.width, needed)).print(table, crop=False, soft_wrap=True)


class Command(NamedTuple):
    """What ``dexrepro NAME`` does; options: names and settings for ``add_argument``."""

    help: str
    run: Callable[[Any], int]
    options: Sequence[tuple[Sequence[str], dict[str, Any]]]
    more: str
    metavar: str


COMMANDS: dict[str, Command] = {}


def command(
    help: str, keys: Sequence[str] | None, *options: Any, more: str = "", metavar: str = "key=value"
) -> Callable[[Callable[[Any], int]], Callable[[Any], int]]:
    """Declare that ``NAME_command`` is ``dexrepro NAME``.

    keys: those it takes as ``key=value`` (None: no such words), named ``metavar`` in its usage. more: further help.
    """

    def declare(run: Callable[[Any], int]) -> Callable[[Any], int]:
        name = run.__name__.removesuffix("_command")
        COMMANDS[name] = Command(help, run, options, more, metavar)
        if keys is not None:
            TAKEN[name] = tuple(keys)
        return run

    return declare


def option(*names: str, **settings: Any) -> tuple[Sequence[str], dict[str, Any]]:
    """An option of a command; one that says nothing but its help is a flag."""
    return names, {"action": "store_true", **settings} if set(settings) == {"help"} else settings
