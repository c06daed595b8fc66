"""What a user is told: one sentence that says what would be right."""

from __future__ import annotations

import difflib
import re
import sys
import traceback
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

COMPLETES = "the same command completes what is missing"


class InputError(Exception):
    """Something the user wrote cannot be used; the message is one sentence that says what would be right."""


def one_line(thing: object) -> str:
    """What an error, or anything else, says of itself, without breaks."""
    return " ".join(str(thing).split())


@contextmanager
def reading(folder: Path) -> Iterator[None]:
    """While modules of a folder are imported: what is wrong in them is an InputError with the file and the line."""
    try:
        yield
    except InputError:
        raise
    except (Exception, SystemExit) as error:
        frames = [(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__)]
        inside = [place for place in frames if place[0].startswith(str(folder))] or [(str(folder), None)]
        file, line = (error.filename, error.lineno) if isinstance(error, SyntaxError) else inside[-1]
        where = f"{file}:{line}" if line else file
        raise InputError(f"{where}: {type(error).__name__}: {one_line(getattr(error, 'msg', error))}") from error


def refused(key: str, value: object, must: str) -> InputError:
    """The error of a value that is not allowed; must: what would be right, such as "be greater than 0"."""
    return InputError(f"{key} = {value} is not allowed: it must {must}")


def folder_named(name: str, key: str = "results") -> Path:
    """A folder as the user names it, "~" being the home. Raises InputError where no folder can have the name."""
    if not name:
        raise refused(key, "''", "be the name of a folder")
    try:
        path = Path(name).expanduser()
        with suppress(FileNotFoundError, NotADirectoryError):
            path.stat()
    except (RuntimeError, ValueError, OSError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{key} = {name[:80]!r} is not allowed: it names no folder ({reason})") from error
    return path


def existing_folder(name: str | Path, key: str) -> Path:
    """The same of a folder that has to be there."""
    if not (folder := folder_named(str(name), key)).is_dir():
        raise InputError(f"{key} = {name} is not allowed: there is no such folder")
    return folder


def importable(name: str | Path, key: str) -> Path:
    """The same; its modules can be imported, by processes started from here, too, behind all that is installed."""
    folder = existing_folder(name, key)
    if (path := str(folder.resolve())) not in sys.path:
        sys.path.append(path)
    return folder


def whole_number(key: str, text: str, least: int, most: int) -> int:
    """A whole number as the user writes it. Raises InputError for another word and beyond least..most."""
    if re.fullmatch("[0-9]{1,12}", text) and least <= int(text) <= most:
        return int(text)
    raise refused(key, text[:80] or "null", f"be a whole number of {least} or greater, {most} at most")


def nearest(name: str, valid: Iterable[str]) -> str:
    """Half a sentence that helps with a misspelt name."""
    valid = list(valid)
    close = difflib.get_close_matches(name, valid, n=1, cutoff=0.5)
    if not close and "." in name:  # the right key under another parent
        close = [key for key in valid if key.rpartition(".")[2] == name.rpartition(".")[2]][:1]
    if close:
        return f"did you mean '{close[0]}'?"
    return f"there are: {', '.join(valid[:30])}{', ...' if len(valid) > 30 else ''}"
