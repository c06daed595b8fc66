"""A user's own demonstrations in the place of the synthetic ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from numpy.typing import NDArray

from dexrepro.config import InputError
from dexrepro.primitives.recorded import demonstrations


def recorded(files: str | Sequence[str], count: int, samples: int, unit: str, axes: int) -> list[NDArray[Any]]:
    """``count`` paths (samples, axes) [cm] from CSV files; see :func:`dexrepro.primitives.recorded.demonstrations`.

    Their duration is scaled to that of the experiment. Raises InputError where a file cannot be used.
    """
    try:
        return [100 * path for path in demonstrations(files, count, samples, unit, axes)]
    except ValueError as error:
        raise InputError(f"demonstrations: {error}") from error
