"""Is a result on disk whole, and is it data? Asked before it is drawn, compared or shown; one sentence names the file
that is not."""

from __future__ import annotations

import gzip
import re
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import yaml

from dexrepro import chapters
from dexrepro.errors import InputError
from dexrepro.experiment import Experiment
from dexrepro.storage import read_json, read_text, read_yaml

if TYPE_CHECKING:
    import pandas as pd

LARGEST = 1 << 28  # bytes of a series when it is unpacked
BLOCK = 1 << 20  # bytes, of which no line has so many
ENTRY = {"status": str, "steps": int, "simulated": (int, float), "wall": (int, float)}
RUN = {"chapter": str, "experiment": str, "cases": dict, "differs": list, "packages": dict, "wall": (int, float)}
CLAIM = {"id": str, "figure": str, "statement": str, "source": str, "verdict": str, "values": dict}


def check_result(folder: Path, *names: str, series: bool = False) -> Experiment:
    """The experiment that a result is of.

    Raises InputError where one of its files cannot be used: run.json, ``names`` and, if asked, its series.
    """
    run = _read(folder / "run.json")
    _require(folder / "run.json", run, RUN)
    for case, entry in run["cases"].items():
        _require(folder / "run.json", entry, ENTRY, f"cases.{case}.")
    number, name = run["chapter"], run["experiment"]
    known = (
        {e.name: e for e in chapters.load(number).experiments} if number in (*chapters.numbers(), chapters.OWN) else {}
    )
    if name not in known:
        raise _damaged(folder / "run.json", f"there is no experiment '{name}' in a chapter '{number}'")
    for file in names:
        data = _read(folder / file)
        if file == "claims.json":
            for place, claim in enumerate(data if isinstance(data, list) else [data]):
                _require(folder / file, claim, CLAIM, f"{place}.")
                if not isinstance(claim.get("margin"), int | float | None):
                    raise _damaged(folder / file, f"{place}.margin is no number")
        elif not isinstance(data, dict):
            raise _damaged(folder / file, "it holds no dict")
        for key, value in data.items() if file == "metrics.json" else ():
            if not isinstance(value, int | float | None) or not key.startswith(f"{name}."):
                raise _damaged(folder / file, f"{key} is no number of {name}")
    if series:
        for case in run["cases"]:
            if not any((folder / "series").glob(f"{case}.*")):
                raise _damaged(folder, f"no series of the case '{case}'")
        for path in sorted((folder / "series").glob("*.gz")):
            check_series(path)
    return known[name]


def check_series(path: Path) -> None:
    try:
        with gzip.open(path) as file:
            _check_lines(file)
    except (OSError, EOFError, zlib.error) as error:
        raise _damaged(path, str(error)) from error


def _check_lines(file: BinaryIO | gzip.GzipFile) -> None:
    read = 0
    while block := file.read(BLOCK):
        if (read := read + len(block)) > LARGEST:
            raise OSError(f"it holds more than {LARGEST >> 20} MB")
        if len(block) == BLOCK and b"\n" not in block:
            raise OSError("it has a line of more than a million letters")


def read_table(path: Path) -> pd.DataFrame:
    """A table of a result. Raises InputError where it is none."""
    from dexrepro.recordings import read_frame

    try:
        with open(path, "rb") as file:
            _check_lines(file)
        return read_frame(path)
    except (OSError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{path} cannot be used ({reason}); draw it again: dexrepro draw") from error


def is_safe(svg: Path) -> bool:
    """Whether there is a picture that is only a picture: no script, no event, nothing from elsewhere."""
    try:
        text = read_text(svg)
    except (OSError, ValueError):
        return False
    return not re.search(
        r"<\s*(script|foreignObject|iframe|object|embed|!ENTITY)|\son\w+\s*=|javascript:|href\s*=\s*[\"']?\s*(https?:|//|data:text)",
        text, re.IGNORECASE,
    )  # fmt: skip


def _require(path: Path, data: Any, kinds: dict[str, Any], where: str = "") -> None:
    if not isinstance(data, dict):
        raise _damaged(path, f"{where.rstrip('.') or 'it'} holds no dict")
    for key, kind in kinds.items():
        if key not in data:
            raise _damaged(path, f"it has no '{where}{key}'")
        if not isinstance(data[key], kind) or isinstance(data[key], bool):
            raise _damaged(path, f"{where}{key} = {str(data[key])[:40]!r} is of another kind")


def _read(path: Path) -> Any:
    read: Callable[[Path], Any] = read_yaml if path.suffix == ".yaml" else read_json
    try:
        return read(path)
    except (OSError, ValueError, yaml.YAMLError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise _damaged(path, str(reason)) from error


def _damaged(path: Path, reason: str) -> InputError:
    return InputError(f"{path} cannot be used ({' '.join(reason.split())}); delete the result and run it again")
