"""Names of the types that pass between the library's parts: arrays of floats, pictures, masks, random generators."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Floats; docstrings give shape and unit."""

Mask = NDArray[np.bool_]
"""Truth values, one an element."""

Image = NDArray[np.uint8]
"""A picture (height, width, 3)."""

Real = float | Array
"""A number, or an array to be worked on element by element."""

Number = TypeVar("Number", float, Array)
"""The same where what comes back is of the kind that was given."""

Held = TypeVar("Held", covariant=True)


class Row(Protocol[Held]):
    """Numbers by index: a list or tuple of floats, or the rows of an array."""

    def __getitem__(self, index: int, /) -> Held:
        """The number of an index."""


Rng = Callable[[str], np.random.Generator]
"""``rng("noise")``: the generator of a named purpose. Compared cases share what they draw for one purpose."""
