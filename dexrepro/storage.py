"""Files that are whole or absent, and locks: every text is UTF-8, and what counts is on the disk before it counts."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import math
import os
import re
import shutil
import uuid
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import yaml
from filelock import FileLock, Timeout

LARGEST = 1 << 26  # bytes of a text that is read
_PART = re.compile(r"\.(?P<target>.+)-[0-9a-f]{12}\.part")


@contextlib.contextmanager
def whole_folder(target: Path) -> Iterator[Path]:
    """A new folder that replaces ``target`` when the block ends well and leaves no trace when it does not.

    A lock beside it, which the system frees when this process dies, tells others that it is being worked on.
    Raises OSError where ``target`` is a file, which is somebody's own.
    """
    if target.exists() and not target.is_dir():
        raise FileExistsError(errno.EEXIST, "it is no folder", str(target))
    target.parent.mkdir(parents=True, exist_ok=True)
    folder = target.parent / f".{target.name}-{uuid.uuid4().hex[:12]}.part"
    old = folder.with_suffix(".old")
    with FileLock(folder.with_suffix(".lock")):
        try:
            folder.mkdir()
            yield folder
            with locked(target.parent):
                if target.exists():
                    target.rename(old)
                folder.rename(target)
        finally:
            _clear(folder, old, target)


def _clear(folder: Path, old: Path, target: Path) -> None:
    """Remove what is left of a replacement; put back the old folder where the new one has not taken its place."""
    if old.exists() and not target.exists():
        old.rename(target)
    for path in (folder, old):
        shutil.rmtree(path, ignore_errors=True)
    with contextlib.suppress(OSError):  # where an open file cannot be removed, the next run does it
        folder.with_suffix(".lock").unlink(missing_ok=True)


def remove_leftovers(parent: Path) -> None:
    """Clear what processes that died have left in a folder, on whatever machine they were."""
    for path in {
        *parent.glob(".*.part"),
        *(p.with_suffix(".part") for k in ("lock", "old") for p in parent.glob(f".*.{k}")),
    }:
        if (match := _PART.fullmatch(path.name)) is None:
            continue
        with contextlib.suppress(Timeout, OSError), FileLock(path.with_suffix(".lock"), timeout=0), locked(parent):
            _clear(path, path.with_suffix(".old"), parent / match["target"])
    for path in parent.glob(".*.claim"):
        with contextlib.suppress(Timeout, OSError), FileLock(path, timeout=0):
            path.unlink(missing_ok=True)


def sync(folder: Path) -> None:
    """Have the disk hold the files of a folder: after a loss of power, what counts as finished is there."""
    for path in (path for path in folder.rglob("*") if path.is_file()):
        with contextlib.suppress(OSError), open(path, "rb+") as file:
            os.fsync(file.fileno())


def copy(source: str | Path, target: str | Path) -> None:
    """Copy a file with its times; where the file system can share the content until one changes, it does."""
    source, target = Path(source), Path(target)
    try:
        with opened(source) as old, open(target, "wb") as new:
            while os.copy_file_range(old.fileno(), new.fileno(), 1 << 30):
                pass
        shutil.copystat(source, target)
    except (AttributeError, OSError):  # not on this system, or not between these file systems
        shutil.copy2(source, target)


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Exclude other processes that use the same lock; the system frees it when a process dies."""
    with FileLock(folder / ".lock"):
        yield


@contextlib.contextmanager
def claimed(folder: Path, name: str, wait: bool = True) -> Iterator[bool]:
    """Whether this process alone works on the thing of that name, among all that share the folder, on any machine.

    The system frees a claim when its process dies.
    """
    path = folder / f".{name}.claim"
    try:
        with FileLock(path, timeout=-1 if wait else 0):
            yield True
            with contextlib.suppress(OSError):
                path.unlink()  # who waits for it notices, and makes a new one
    except Timeout:
        yield False


def opened(path: Path) -> BinaryIO:
    """A file to be read. Raises OSError where it is none, such as a pipe, on which one would wait for ever."""
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "it is no file", str(path))
    return open(path, "rb")


def read_text(path: Path) -> str:
    """The content of a text file. Raises ValueError beyond ``LARGEST`` bytes: nothing written here is so large."""
    with opened(path) as file:
        content = file.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise ValueError(f"it is larger than {LARGEST >> 20} MB")
    return content.decode()


def read_yaml(path: Path) -> Any:
    """The content of a YAML file, parsed in C where the library has it; ValueError where aliases make it explode."""
    try:
        data = yaml.load(read_text(path), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    _count(data)
    return data


def _count(data: Any) -> None:
    """Raise ValueError where nested data, aliases written out, hold more than a million values."""
    todo, seen = [iter([data])], 0
    while todo:
        for item in todo[-1]:
            seen += 1
            if seen > 1_000_000 or len(todo) > 200:
                raise ValueError("it is nested too deeply or stands for more than a million values")
            if isinstance(item, Mapping | list):
                todo.append(iter(item.values() if isinstance(item, Mapping) else item))
                break
        else:
            todo.pop()


def write_yaml(path: Path, data: Any) -> None:
    """Write YAML, keys in the order given."""
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    path.write_text(yaml.dump(finite(data), Dumper=dumper, sort_keys=False, allow_unicode=True), encoding="utf-8")


def write_json(path: Path, data: Any) -> None:
    """Write JSON in one move; numbers that are not finite become null."""
    write_text(path, json.dumps(finite(data), indent=1) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write a file in one move: the old text or the new, never a part."""
    temporary = path.with_name(f".{path.name}-{uuid.uuid4().hex[:12]}")
    try:
        with open(temporary, "w", encoding="utf-8", errors="backslashreplace") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def read_json(path: Path) -> Any:
    """The content of a JSON file. Raises ValueError where it is none."""
    try:
        return json.loads(read_text(path), parse_int=_whole)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None


def _whole(digits: str) -> int:
    if len(digits) > 300:
        raise ValueError("it holds a number of more than 300 digits")
    return int(digits)


def require(data: Any, kinds: Mapping[str, Any], where: str = "") -> None:
    """Raise ValueError where data is no dict that has these keys, each of its kind; true is no number."""
    if not isinstance(data, dict):
        raise ValueError(f"{where.rstrip('.') or 'it'} holds no dict")
    for key, kind in kinds.items():
        if key not in data:
            raise ValueError(f"it has no '{where}{key}'")
        if not isinstance(data[key], kind) or isinstance(data[key], bool):
            raise ValueError(f"{where}{key} = {str(data[key])[:40]!r} is of another kind")


def finite(data: Any) -> Any:
    """Plain Python numbers, with null for what is not finite."""
    if isinstance(data, Mapping):
        return {str(key): finite(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [finite(value) for value in data]
    if isinstance(data, np.generic):
        data = data.item()
    if isinstance(data, float) and not math.isfinite(data):
        return None
    return data


def digest_of(data: Any) -> str:
    """A hash that changes with any value in the data."""
    return hashlib.sha1(json.dumps(finite(data), sort_keys=True, default=str).encode()).hexdigest()
