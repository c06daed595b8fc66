"""A user's own demonstrations in the place of the synthetic ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from dexrepro.arrays import Array
from dexrepro.errors import InputError, nearest, refused
from dexrepro.experiment import Config
from dexrepro.primitives.recorded import Format, demonstrations, matching, read_corners


def recorded(files: str | Sequence[str], count: int, samples: int, config: Config, axes: int) -> list[Array]:
    """``count`` paths (samples, axes) [cm] from files; see :func:`dexrepro.primitives.recorded.demonstrations`.

    config: an experiment's, with what :class:`Format` knows. Their duration is scaled to that of the experiment; where
    nothing tells the unit, it is cm. Raises InputError where a file cannot be used.
    """
    _check_names(files, "demonstrations")
    try:
        style = Format(**{key: config[key] for key in ("unit", "time_unit", "duplicates", "encoding")})
        return [100 * path for path in demonstrations(files, count, samples, style, axes, "cm")]
    except ValueError as error:
        raise InputError(f"demonstrations: {error}") from error


def _check_names(files: Any, key: str) -> None:
    if isinstance(files, Mapping) or not all(isinstance(name, str) for name in files):
        raise refused(key, files, "be a file or a list of files")


def check_by_name(files: Any, key: str, name: Any) -> None:
    """Refuse what is no file by the name of what it shows, such as ``name``."""
    if files and not isinstance(files, Mapping):
        raise refused(key, files, f"be {{{name}: FILE, ...}}")


def by_name(files: Mapping[Any, Any] | None, known: Iterable[Any]) -> dict[str, Any]:
    """A user's files by what they show. Raises InputError where an experiment has no demonstration of that name."""
    names = [str(name) for name in known]
    check_by_name(files, "demonstrations", names[0])
    given = {str(name): value for name, value in (files or {}).items()}
    if unknown := [name for name in given if name not in names]:
        raise InputError(f"demonstrations: there is none of '{unknown[0]}': {nearest(unknown[0], names)}")
    return given


def corners(files: str | Sequence[str], config: Config, key: str) -> list[Array]:
    """Corners (n, 2) [cm] of polygons, one a file. Raises InputError, which names the key, where one cannot be used."""
    _check_names(files, key)
    try:
        style = Format(unit=config.unit, encoding=config.encoding)
        return [100 * read_corners(name, style, "cm") for name in matching(files)]
    except ValueError as error:
        raise InputError(f"{key}: {error}") from error
