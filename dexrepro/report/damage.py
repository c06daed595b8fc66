"""Is a result on disk whole? Asked before it is drawn, compared or shown; one sentence names the file that is not."""

from __future__ import annotations

import gzip
import zlib
from pathlib import Path
from typing import Any

import yaml

from dexrepro.config import InputError
from dexrepro.storage import read_json, read_yaml

KEYS = ("chapter", "experiment", "cases")


def check_result(folder: Path, *names: str, series: bool = False) -> None:
    """Raise InputError where one of a result's files cannot be used: run.json, ``names`` and, if asked, its series."""
    run = _read(folder / "run.json", dict)
    if missing := [key for key in KEYS if key not in run]:
        raise _damaged(folder / "run.json", f"it has no '{missing[0]}'")
    for name in names:
        _read(folder / name, list if name == "claims.json" else dict)
    if not series:
        return
    for case in run["cases"]:
        if not any((folder / "series").glob(f"{case}.*")):
            raise _damaged(folder, f"no series of the case '{case}'")
    for path in sorted((folder / "series").glob("*.gz")):
        try:
            with gzip.open(path) as file:
                while file.read(1 << 20):
                    pass
        except (OSError, EOFError, zlib.error) as error:
            raise _damaged(path, str(error)) from error


def _read(path: Path, kind: type) -> Any:
    try:
        data = read_yaml(path) if path.suffix == ".yaml" else read_json(path)
    except (OSError, ValueError, yaml.YAMLError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise _damaged(path, str(reason)) from error
    if not isinstance(data, kind):
        raise _damaged(path, f"it holds no {kind.__name__}")
    return data


def _damaged(path: Path, reason: str) -> InputError:
    return InputError(f"{path} cannot be used ({' '.join(reason.split())}); delete the result and run it again")
