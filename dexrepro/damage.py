"""Is a result on disk whole, and is it data? Asked before it is drawn, compared or shown; one sentence names the file
that is not."""

from __future__ import annotations

import gzip
import re
import warnings
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO
from xml.parsers import expat

import yaml

from dexrepro import chapters
from dexrepro.cases import CASE
from dexrepro.errors import InputError, one_line
from dexrepro.experiment import Experiment
from dexrepro.storage import opened, read_json, read_text, read_yaml, require

if TYPE_CHECKING:
    import pandas as pd
    from PIL import Image

LARGEST = 1 << 28  # bytes of a series when it is unpacked
BLOCK = 1 << 20  # bytes, of which no line has so many
ENTRY = {"status": str, "steps": int, "simulated": (int, float), "wall": (int, float)}
RUN = {"chapter": str, "experiment": str, "cases": dict, "differs": list, "packages": dict, "wall": (int, float)}
CLAIM = {"id": str, "figure": str, "statement": str, "source": str, "verdict": str, "values": dict}


def check_result(folder: Path, *names: str, series: bool = False) -> Experiment:
    """The experiment that a result is of.

    Raises InputError where one of its files cannot be used: run.json, ``names`` and, if asked, its series.
    """
    if not (folder / "run.json").exists():
        raise InputError(f"{folder} holds no result (no run.json)")
    run = _read(folder / "run.json")
    experiment = _check_run(folder / "run.json", run)
    for name in names:
        data = _read(folder / name)
        if name == "claims.json":
            _check_claims(folder / name, data)
        elif not isinstance(data, dict):
            raise _damaged(folder / name, "it holds no dict")
        for key, value in data.items() if name == "metrics.json" else ():
            if not isinstance(value, int | float | None) or not key.startswith(f"{experiment.name}."):
                raise _damaged(folder / name, f"{key} is no number of {experiment.name}")
    if series:
        _check_recordings(folder, run["cases"])
    return experiment


def _check_run(path: Path, run: Any) -> Experiment:
    _require(path, run, RUN)
    for case, entry in run["cases"].items():
        _require(path, entry, ENTRY, f"cases.{case}.")
        if not re.fullmatch(CASE, case):
            raise _damaged(path, f"cases: {case[:40]!r} is no name of a case")
    number, name = run["chapter"], run["experiment"]
    if number not in (*chapters.numbers(), chapters.OWN):
        raise InputError(
            f"{path} is of '{name}' in a chapter '{number}', which is not here: if it is one of yours, name its "
            "folder, --experiments DIR"
        )
    for experiment in chapters.load(number).experiments:
        if experiment.name == name:
            return experiment
    raise _damaged(path, f"there is no experiment '{name}' in a chapter '{number}'")


def _check_claims(path: Path, claims: Any) -> None:
    for place, claim in enumerate(claims if isinstance(claims, list) else [claims]):
        _require(path, claim, CLAIM, f"{place}.")
        if not isinstance(claim.get("margin"), int | float | None):
            raise _damaged(path, f"{place}.margin is no number")


def _check_recordings(folder: Path, cases: Mapping[str, Any]) -> None:
    for case, entry in cases.items():
        ended_at_once = entry["status"] != "finished" and not entry["steps"]  # there was nothing to record
        if not ended_at_once and not any((folder / "series").glob(f"{case}.*")):
            raise _damaged(folder, f"no series of the case '{case}'")
    for path in sorted((folder / "series").glob("*.gz")):
        check_series(path)
    for path in sorted((folder / "series").glob("*.png")):
        read_picture(path)


def check_series(path: Path) -> None:
    try:
        with opened(path) as packed, gzip.open(packed) as file:
            _check_lines(file)
    except (OSError, EOFError, zlib.error) as error:
        raise _damaged(path, error) from error


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
        with opened(path) as file:
            _check_lines(file)
        return read_frame(path)
    except (OSError, ValueError) as error:
        reason = one_line(error)
        raise InputError(f"{path} cannot be used ({reason}); draw it again: dexrepro draw") from error


def read_picture(path: Path) -> Image.Image:
    """A picture of a result. Raises InputError where it is none, or of more pixels than any screen has."""
    from PIL import Image

    try:
        with opened(path) as file, warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            return Image.open(file).convert("RGB")
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError, Image.DecompressionBombWarning) as error:
        raise _damaged(path, error) from error


SVG = "http://www.w3.org/2000/svg"
DRAWN = (SVG, *(f"http://{name}" for name in ("creativecommons.org/ns#", "purl.org/dc/elements/1.1/",
                                              "www.w3.org/1999/02/22-rdf-syntax-ns#")))  # fmt: skip
SHAPES = re.compile(
    "svg|g|defs|use|symbol|path|rect|circle|ellipse|line|polyline|polygon|text|tspan|image|clipPath|mask|pattern|"
    "marker|linearGradient|radialGradient|stop|style|title|desc|metadata"
)


def is_safe(svg: Path) -> bool:
    """Whether there is a picture that is only a picture: known shapes, nothing that runs, nothing from elsewhere."""
    parser = expat.ParserCreate(namespace_separator=" ")
    styles: list[str] = []

    def begin(element: str, attributes: dict[str, str]) -> None:
        space, _, name = element.rpartition(" ")
        if space not in DRAWN or (space == SVG and not SHAPES.fullmatch(name)):
            raise ValueError(f"<{name}>")
        parser.CharacterDataHandler = styles.append if name == "style" else None
        for key, value in attributes.items():
            name = key.rpartition(" ")[2].lower()
            linked = name == "href" and not re.match(r"#|data:image/(png|jpeg);base64,[\w+/=\s]*$", value)
            if name.startswith("on") or linked:
                raise ValueError(f"{name} = {value[:40]}")
            if name != "href":
                styles.append(value)

    def refuse(*_: object) -> None:
        raise ValueError("an entity or a processing instruction")

    parser.StartElementHandler = begin
    parser.EntityDeclHandler = parser.ProcessingInstructionHandler = refuse
    try:
        parser.Parse(read_text(svg).encode(), True)
    except (OSError, ValueError, expat.ExpatError):
        return False
    return not re.search(r"url\(\s*[\"']?(?!#)[^\s\"']|@import|javascript:|\\", "".join(styles), re.IGNORECASE)


def _require(path: Path, data: Any, kinds: Mapping[str, Any], where: str = "") -> None:
    try:
        require(data, kinds, where)
    except ValueError as error:
        raise _damaged(path, error) from error


def _read(path: Path) -> Any:
    read: Callable[[Path], Any] = read_yaml if path.suffix == ".yaml" else read_json
    try:
        return read(path)
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise _damaged(path, error) from error


def _damaged(path: Path, reason: object) -> InputError:
    reason = one_line(getattr(reason, "strerror", None) or reason)
    return InputError(f"{path} cannot be used ({reason}); delete the result and run it again")
