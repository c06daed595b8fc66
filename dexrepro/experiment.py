"""The vocabulary of an experiment: configuration, recording, figures, film; claims are in :mod:`dexrepro.claims`.

Everything here is a small value object without input or output. An experiment is a folder of three modules:
``experiment.py`` makes numbers, ``figures.py`` shows them, ``claims.py`` says what the book says of them; see
:class:`Experiment` for what each holds, and :mod:`dexrepro.chapters` for how they are found.
"""

from __future__ import annotations

import ast
import importlib
import math
import textwrap
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeAlias

from dexrepro.errors import InputError, reading

if TYPE_CHECKING:
    import matplotlib.figure
    import numpy as np
    import pandas as pd
    from numpy.typing import NDArray

    from dexrepro.claims import Claim, Reference

Metrics = dict[str, float | int | None]


class Config(dict[str, Any]):
    """A resolved configuration: a dictionary whose keys are also attributes (``config.object.stiffness``)."""

    def __getattr__(self, key: str) -> Any:
        try:
            return self[key]
        except KeyError:
            raise AttributeError(f"no configuration key '{key}'; there are: {', '.join(self)}") from None

    @classmethod
    def of(cls, value: Any) -> Any:
        """Turn nested dictionaries (also those inside lists) into ``Config``; everything else is kept."""
        if isinstance(value, Mapping):
            return cls({key: cls.of(item) for key, item in value.items()})
        if isinstance(value, list):
            return [cls.of(item) for item in value]
        return value


ADDED = ("case", "seed", "perturbation", "engine")  # what a case is told beside its configuration


def changed(case: Mapping[str, Any], shared: Mapping[str, Any], prefix: str = "") -> set[str]:
    """Dotted keys in which a case differs from its experiment's own block: what the case is."""
    found: set[str] = set()
    for key, value in case.items():
        other = shared.get(key)
        if isinstance(value, Mapping) and isinstance(other, Mapping):
            found |= changed(value, other, f"{prefix}{key}.")
        elif value != other and (key in shared or key not in ADDED):
            found.add(f"{prefix}{key}")
    return found


@dataclass
class Recording:
    """What one case leaves behind.

    series: channels sampled at the instants ``series["time"]`` [s], each of shape (n,) or (n, k). ``measure`` sees the
        full rate; on disk they are kept at the experiment's ``RATE``.
    frames: anything else that ``draw`` or ``tabulate`` needs, as data frames (a sweep, a learning curve, a field).
    images: pictures of shape (height, width, 3), unsigned bytes.
    steps: physics (or algorithm) steps taken; simulated: simulated time [s], 0 where nothing moves in time.
    status: "finished", or the reason why a stop condition ended the run early.
    """

    series: dict[str, NDArray[Any]] = field(default_factory=dict)
    frames: dict[str, pd.DataFrame] = field(default_factory=dict)
    images: dict[str, NDArray[np.uint8]] = field(default_factory=dict)
    steps: int = 0
    simulated: float = 0.0
    status: str = "finished"

    def __getitem__(self, channel: str) -> NDArray[Any]:
        return self.series[channel]

    def __contains__(self, channel: str) -> bool:
        return channel in self.series

    @property
    def time(self) -> NDArray[np.float64]:
        """Sampling instants [s], shape (n,)."""
        return self.series["time"]

    def between(self, start: float, end: float = math.inf) -> NDArray[np.bool_]:
        """Mask of the samples with start <= time <= end [s]."""
        return (self.time >= start - 1e-9) & (self.time <= end + 1e-9)


Recordings = Mapping[str, Recording]  # by case
AllMetrics = Mapping[str, Metrics]  # by case
Drawing: TypeAlias = "matplotlib.figure.Figure"
Drawings: TypeAlias = "dict[str, matplotlib.figure.Figure]"  # by the number of the figure


@dataclass(frozen=True)
class Figure:
    """What surrounds a figure: caption (what was simulated, what the book shows) and one-sentence alternative text.

    ``{.case.metric:.3g}`` in them is filled from the result, ``{.key}`` from its configuration.
    """

    caption: str
    alt: str = ""

    def of(self, experiment: str) -> Figure:
        """The same, such names under that of the experiment whose folder holds it."""
        return Figure(*(text.replace("{.", f"{{{experiment}.") for text in (self.caption, self.alt)))


@dataclass(frozen=True)
class Film:
    """An animation of one case: the arms, and beside them a measured quantity over time.

    caption: what is seen, in one sentence that is filled as a figure's. channel: what is drawn, times ``scale`` in the
    unit of ``label``; of a vector its length. camera: a ``physics.rendering.Camera``. reference: key of the parameter
    to compare with, dashed. span: the part of the run shown, (start, end) [s]; all of it by default.
    """

    case: str
    caption: str
    camera: Any
    channel: str
    label: str
    scale: float = 1.0
    reference: str | None = None
    span: tuple[float, float] | None = None


@dataclass(frozen=True)
class Experiment:
    """One section's simulations: a folder, imported part by part when it is needed.

    ``experiment.py`` holds ``RATE`` [Hz] at which series are kept and these functions, of which the first two are
    needed:

    simulate(config, rng) -> Recording: one case. ``config`` is resolved, its ``_target_`` nodes are live objects,
        ``config.perturbation`` [rad, or share of the data's range] is to be added to the initial state, and ``rng``
        gives a generator for a named purpose: ``rng("noise")``. Compared cases share the noise of a purpose.
    measure(recording, config) -> {metric: number}: at the full rate, in the case's own process.
    summarise(metrics, config) -> {metric: number}: numbers over several cases, from ``{case: {metric: number}}``.
    scene(config) -> World: the scene without its laws, so that any recorded instant can be rendered.
    stage(world, recording, config) -> Recording: for a film, adds what is only seen to the scene and returns channels
        under the names that ``World.snapshot`` reads.

    ``figures.py`` may hold ``FIGURES``, ``TABLES``, ``FILM``, ``UNITS`` (of channels, by name) and

    draw(recordings, metrics, config) -> {figure id: matplotlib Figure}: from what is on disk alone. A figure whose
        cases are missing is left out.
    tabulate(recordings, metrics, config) -> {table id: DataFrame}: likewise.

    ``claims.py`` may hold ``CLAIMS`` and ``REFERENCES``, and the folder's ``__init__.py`` ``REQUIRES``: packages
    without which the experiment is skipped.
    """

    package: str
    folder: Path

    @property
    def name(self) -> str:
        return self.folder.name

    @cached_property
    def summary(self) -> str:
        """First line of what ``experiment.py`` says of itself."""
        path = self.folder / "experiment.py"
        with reading(self.folder):
            text = ast.get_docstring(ast.parse(path.read_text("utf-8"), str(path))) or ""
        return text.partition("\n")[0]

    @cached_property
    def simulation(self) -> ModuleType:
        """The module ``experiment.py``."""
        return importlib.import_module(f"{self.package}.experiment")

    @property
    def rate(self) -> float:
        return float(getattr(self.simulation, "RATE", 100.0))

    @property
    def requires(self) -> tuple[str, ...]:
        with reading(self.folder):
            return tuple(getattr(importlib.import_module(self.package), "REQUIRES", ()))

    @property
    def figures(self) -> Mapping[str, Figure]:
        given = self._part("figures", "FIGURES", {}, of=Figure)
        return {name: figure.of(self.name) for name, figure in given.items()}

    @property
    def tables(self) -> Mapping[str, str]:
        return self._part("figures", "TABLES", {}, of=str)

    @property
    def film(self) -> Film | None:
        film: Film | None = self._part("figures", "FILM", None)
        return film and replace(film, caption=film.caption.replace("{.", f"{{{self.name}."))

    @property
    def units(self) -> Mapping[str, str]:
        """Units of channels that are not the world's own, by name."""
        return self._part("figures", "UNITS", {}, of=str)

    @property
    def claims(self) -> tuple[Claim, ...]:
        from dexrepro.claims import Claim

        return tuple(claim.of(self.name) for claim in self._part("claims", "CLAIMS", (), of=Claim))

    @property
    def references(self) -> tuple[Reference, ...]:
        from dexrepro.claims import Reference

        return tuple(reference.of(self.name) for reference in self._part("claims", "REFERENCES", (), of=Reference))

    def function(self, name: str) -> Callable[..., Any] | None:
        """One of the optional functions above, or None."""
        if name in ("draw", "tabulate"):
            return self._part("figures", name, None)
        return getattr(self.simulation, name, None)

    def _part(self, module: str, name: str, default: Any, of: type | None = None) -> Any:
        """What a module of the folder calls by a name; of: what each must be, where it is many, as the default."""
        path = self.folder / f"{module}.py"
        if not path.exists():
            return default
        with reading(self.folder):
            found = getattr(importlib.import_module(f"{self.package}.{module}"), name, default)
        if of is not None:
            _check_each(found, of, isinstance(default, Mapping), f"{path}: {name}")
        return found


def _check_each(found: Any, of: type, named: bool, what: str) -> None:
    """Refuse what is no mapping from names to things of a class, or no tuple of them."""
    must = f"have a {of.__name__} for each name" if named else f"be a tuple of {of.__name__}, a comma behind each"
    many = isinstance(found, Mapping) if named else isinstance(found, tuple | list)
    items = (found.values() if named else found) if many else [found]
    for item in items:
        if not many or not isinstance(item, of):
            raise InputError(f"{what} must {must}; it has {textwrap.shorten(repr(item), 60)}")
