"""The vocabulary of a chapter: what an experiment, a recording, a claim, a reference and an erratum are.

Everything here is a small value object without input or output. An experiment is a folder of three modules:
``experiment.py`` makes numbers, ``figures.py`` shows them, ``claims.py`` says what the book says of them; see
:class:`Experiment` for what each holds, and :mod:`dexrepro.chapters` for how they are found.
"""

from __future__ import annotations

import ast
import importlib
import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

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


@dataclass(frozen=True)
class Figure:
    """What surrounds a figure: caption (what was simulated, what the book shows) and one-sentence alternative text."""

    caption: str
    alt: str = ""


@dataclass(frozen=True)
class Film:
    """An animation of one case: the arms, and beside them a measured quantity over time.

    caption: what is seen, in one sentence. channel: what is drawn, times ``scale`` in the unit of ``label``; of a
    vector its length. camera: a ``physics.rendering.Camera``. reference: a value to compare with, dashed.
    span: the part of the run shown, (start, end) [s]; all of it by default.
    """

    case: str
    caption: str
    camera: Any
    channel: str
    label: str
    scale: float = 1.0
    reference: float | None = None
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

    ``figures.py`` may hold ``FIGURES``, ``TABLES``, ``FILM`` and

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
        text = ast.get_docstring(ast.parse((self.folder / "experiment.py").read_text("utf-8"))) or ""
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
        return tuple(getattr(importlib.import_module(self.package), "REQUIRES", ()))

    @property
    def figures(self) -> Mapping[str, Figure]:
        return self._part("figures", "FIGURES", {})

    @property
    def tables(self) -> Mapping[str, str]:
        return self._part("figures", "TABLES", {})

    @property
    def film(self) -> Film | None:
        return self._part("figures", "FILM", None)

    @property
    def claims(self) -> tuple[Claim, ...]:
        return self._part("claims", "CLAIMS", ())

    @property
    def references(self) -> tuple[Reference, ...]:
        return self._part("claims", "REFERENCES", ())

    def function(self, name: str) -> Callable[..., Any] | None:
        """One of the optional functions above, or None."""
        if name in ("draw", "tabulate"):
            return self._part("figures", name, None)
        return getattr(self.simulation, name, None)

    def _part(self, module: str, name: str, default: Any) -> Any:
        if not (self.folder / f"{module}.py").exists():
            return default
        return getattr(importlib.import_module(f"{self.package}.{module}"), name, default)


@dataclass(frozen=True)
class Predicate:
    """A statement about metrics.

    margin(metrics) is positive when the statement holds, negative when it fails, None when a metric is absent.
    """

    text: str
    metrics: tuple[str, ...]
    margin_of: Callable[[Sequence[float]], float]

    def margin(self, values: Mapping[str, float | int | None]) -> float | None:
        found = [values.get(name) for name in self.metrics]
        numbers = [float(value) for value in found if value is not None]
        return self.margin_of(numbers) if len(numbers) == len(found) else None

    def __str__(self) -> str:
        return self.text


def _relative_gap(smaller: float, larger: float) -> float:
    scale = max(abs(smaller), abs(larger))
    return (larger - smaller) / scale if scale > 0 else 0.0


def _operand(value: str | float, factor: float) -> str:
    if not isinstance(value, str):
        return f"{value * factor:g}"
    return value if factor == 1 else f"{factor:g} {value}"


def less(a: str, b: str | float, factor: float = 1.0) -> Predicate:
    """a < factor * b, where b is a metric or a number. Margin (factor b - a) / max(|a|, |factor b|).

    Against a bound of 0 the margin is 1 or -1, whatever a: it then tells the verdict alone.
    """
    if isinstance(b, str):
        return Predicate(f"{a} < {_operand(b, factor)}", (a, b), lambda v: _relative_gap(v[0], factor * v[1]))
    bound = factor * b
    return Predicate(f"{a} < {bound:g}", (a,), lambda v: _relative_gap(v[0], bound))


def greater(a: str, b: str | float, factor: float = 1.0) -> Predicate:
    """a > factor * b, where b is a metric or a number. Margin (a - factor b) / max(|a|, |factor b|); see ``less``."""
    if isinstance(b, str):
        return Predicate(f"{a} > {_operand(b, factor)}", (a, b), lambda v: _relative_gap(factor * v[1], v[0]))
    bound = factor * b
    return Predicate(f"{a} > {bound:g}", (a,), lambda v: _relative_gap(bound, v[0]))


def within(a: str, low: float, high: float) -> Predicate:
    """low <= a <= high. Margin: distance to the nearer bound over the width."""
    if not low < high:
        raise ValueError(f"within({a}): the lower bound {low} is not below the upper bound {high}")
    return Predicate(f"{low:g} <= {a} <= {high:g}", (a,), lambda v: min(v[0] - low, high - v[0]) / (high - low))


def ordered(*names: str) -> Predicate:
    """The metrics increase in the order given. Margin: the smallest of the neighbours' margins."""
    return Predicate(" < ".join(names), names, lambda v: min(_relative_gap(a, b) for a, b in itertools.pairwise(v)))


def every(*predicates: Predicate) -> Predicate:
    """All predicates hold. Margin: the smallest of their margins."""
    names = tuple(name for predicate in predicates for name in predicate.metrics)

    def margin_of(values: Sequence[float]) -> float:
        it: Iterator[float] = iter(values)
        return min(p.margin_of([next(it) for _ in p.metrics]) for p in predicates)

    return Predicate("; ".join(map(str, predicates)), names, margin_of)


REPRODUCED = "reproduced"
AFTER_CORRECTION = "after correction"
NOT_REPRODUCED = "not reproduced"
NOT_TESTABLE = "not testable"
NOT_EVALUATED = "not evaluated"


@dataclass(frozen=True)
class Claim:
    """What the book says (or, with source "ours", a test that it does not make), as a predicate over metrics.

    Metric names are ``experiment.case.metric`` or, from ``summarise``, ``experiment.metric``; all of a claim's metrics
    belong to one experiment. ``printed`` is the same statement about the printed form of an equation that an erratum
    corrects; where it fails and the corrected form holds, the verdict is "after correction". ``not_testable`` gives the
    reason why nothing can be measured; ``by_construction`` the generator that has the effect built in; ``note`` says
    what a reader must know beside the verdict.
    """

    id: str
    figure: str
    statement: str
    predicate: Predicate | None
    source: str = "book"
    printed: Predicate | None = None
    by_construction: str = ""
    not_testable: str = ""
    note: str = ""
    where: str = ""

    def __post_init__(self) -> None:
        if (self.predicate is None) != bool(self.not_testable):
            raise ValueError(f"{self.id}: give either a predicate or the reason why it cannot be tested")

    @property
    def metrics(self) -> tuple[str, ...]:
        printed = self.printed.metrics if self.printed else ()
        return (*self.predicate.metrics, *printed) if self.predicate else ()

    @property
    def experiment(self) -> str:
        """Name of the experiment whose metrics the claim is about ("" for one that is not testable)."""
        return self.metrics[0].partition(".")[0] if self.metrics else ""

    def evaluate(self, metrics: Mapping[str, float | int | None]) -> dict[str, Any]:
        """Verdict, margin and the values they rest on."""
        margin = self.predicate.margin(metrics) if self.predicate else None
        printed = self.printed.margin(metrics) if self.printed else None
        if self.predicate is None:
            verdict = NOT_TESTABLE
        elif margin is None or (self.printed and printed is None):
            verdict = NOT_EVALUATED
        elif not margin > 0:
            verdict = NOT_REPRODUCED
        elif printed is not None and not printed > 0:
            verdict = AFTER_CORRECTION
        else:
            verdict = REPRODUCED
        return {
            "id": self.id,
            "figure": self.figure,
            "statement": self.statement,
            "source": self.source,
            "where": self.where,
            "predicate": str(self.predicate or ""),
            "values": {name: metrics.get(name) for name in dict.fromkeys(self.metrics)},
            "verdict": verdict,
            "margin": margin,
            "printed_margin": printed,
            "by_construction": self.by_construction,
            "reason": self.not_testable,
            "note": self.note,
        }


@dataclass(frozen=True)
class Reference:
    """A number the book prints, to be shown beside the metric that corresponds to it."""

    metric: str
    value: float
    where: str
    unit: str = ""


ERRATUM_KINDS = ("error", "gap", "reading", "slip")


@dataclass(frozen=True)
class Erratum:
    """Something in the book that a reader who implements it must know.

    kind: "error" (inconsistent with the book's own equations), "gap" (something needed is not printed), "reading"
        (defensible as printed under the reading named) or "slip" (typesetting, possibly text extraction).
    switch: the exact override that selects the printed form ("" where it does not run).
    evidence: names of the metrics that show the effect.
    """

    id: str
    equation: str
    kind: str
    summary: str
    correction: str = ""
    switch: str = ""
    evidence: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.kind not in ERRATUM_KINDS:
            raise ValueError(f"{self.id}: kind '{self.kind}' is none of {', '.join(ERRATUM_KINDS)}")
