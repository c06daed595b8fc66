"""A user's own demonstrations in the place of the synthetic ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from dexrepro.arrays import Array
from dexrepro.errors import InputError, nearest
from dexrepro.experiment import Config
from dexrepro.primitives.recorded import Format, demonstrations, matching, read_corners


def recorded(files: str | Sequence[str], count: int, samples: int, config: Config, axes: int) -> list[Array]:
    """``count`` paths (samples, axes) [cm] from files; see :func:`dexrepro.primitives.recorded.demonstrations`.

    config: an experiment's, with what :class:`Format` knows. Their duration is scaled to that of the experiment; where
    nothing tells the unit, it is cm. Raises InputError where a file cannot be used.
    """
    try:
        style = Format(**{key: config[key] for key in ("unit", "time_unit", "duplicates", "encoding")})
        return [100 * path for path in demonstrations(files, count, samples, style, axes, "cm")]
    except ValueError as error:
        raise InputError(f"demonstrations: {error}") from error


def by_name(files: Mapping[Any, Any] | None, known: Iterable[Any]) -> dict[str, Any]:
    """A user's files by what they show. Raises InputError where an experiment has no demonstration of that name."""
    given, names = {str(name): value for name, value in (files or {}).items()}, [str(name) for name in known]
    if unknown := [name for name in given if name not in names]:
        raise InputError(f"demonstrations: there is none of '{unknown[0]}': {nearest(unknown[0], names)}")
    return given


def corners(files: str | Sequence[str], config: Config, key: str) -> list[Array]:
    """Corners (n, 2) [cm] of polygons, one a file. Raises InputError, which names the key, where one cannot be used."""
    try:
        style = Format(unit=config.unit, encoding=config.encoding)
        return [100 * read_corners(name, style, "cm") for name in matching(files)]
    except ValueError as error:
        raise InputError(f"{key}: {error}") from error
