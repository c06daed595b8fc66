"""What is claimed, and when a verdict on it is evidence: predicates over metrics, claims, references, errata.

A claim counts as tested only where its control fails: the same statement about the run from which what the claim
credits has been taken away. How often it holds when what the book does not print varies is the study's word.
"""

from __future__ import annotations

import itertools
import math
import re
import shlex
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from types import MappingProxyType
from typing import Any

Metrics = Mapping[str, float | int | None]


@dataclass(frozen=True)
class Predicate:
    """A statement about metrics.

    margin(metrics) is positive when the statement holds, negative when it fails, None when a metric is absent. A metric
    that is there and undefined (null: its run diverged, or never got so far) makes it fail, with a margin of -1.
    """

    text: str
    metrics: tuple[str, ...]
    margin_of: Callable[[Sequence[float]], float]

    def margin(self, values: Metrics) -> float | None:
        if any(name not in values for name in self.metrics):
            return None
        numbers = [float(value) for name in self.metrics if (value := values[name]) is not None]
        return self.margin_of(numbers) if len(numbers) == len(self.metrics) else -1.0

    def of(self, experiment: str) -> Predicate:
        """The same, its metrics such as ``.case.metric`` under the name of their experiment."""
        names = tuple(f"{experiment}{name}" if name.startswith(".") else name for name in self.metrics)
        return replace(self, text=re.sub(r"(?<!\w)(?=\.\w)", experiment, self.text), metrics=names)

    def __str__(self) -> str:
        return self.text


TIE = 0.01
"""Two numbers of runs that are said to be in order, and by no factor, tie where they differ by less than this share of
the larger; a tie does not hold, in a claim, its control, its printed form and its readings alike."""


STOPPED = "a run is stopped at its bound, so that 1 says that it was met and is no measured number"
"""Why claims turn about the bound at which a run ends."""


def _relative_gap(smaller: float, larger: float) -> float:
    scale = max(abs(smaller), abs(larger))
    return (larger - smaller) / scale if scale > 0 else 0.0


def _operand(value: str | float, factor: float) -> str:
    if not isinstance(value, str):
        return f"{value * factor:g}"
    return value if factor == 1 else f"{factor:g} {value}"


def less(a: str, b: str | float, factor: float = 1.0) -> Predicate:
    """a < factor * b, where b is a metric or a number. Margin (factor b - a) / max(|a|, |factor b|).

    Of two metrics without a factor the margin is ``TIE`` less. Against a bound of 0 it is 1 or -1, whatever a: it then
    tells the verdict alone.
    """
    if isinstance(b, str):
        tie = TIE if factor == 1 else 0.0
        return Predicate(f"{a} < {_operand(b, factor)}", (a, b), lambda v: _relative_gap(v[0], factor * v[1]) - tie)
    bound = factor * b
    return Predicate(f"{a} < {bound:g}", (a,), lambda v: _relative_gap(v[0], bound))


def greater(a: str, b: str | float, factor: float = 1.0) -> Predicate:
    """a > factor * b, where b is a metric or a number. Margin (a - factor b) / max(|a|, |factor b|); see ``less``."""
    if isinstance(b, str):
        tie = TIE if factor == 1 else 0.0
        return Predicate(f"{a} > {_operand(b, factor)}", (a, b), lambda v: _relative_gap(factor * v[1], v[0]) - tie)
    bound = factor * b
    return Predicate(f"{a} > {bound:g}", (a,), lambda v: _relative_gap(bound, v[0]))


def within(a: str, low: float, high: float) -> Predicate:
    """low <= a <= high. Margin: distance to the nearer bound over the width."""
    if not low < high:
        raise ValueError(f"within({a}): the lower bound {low} is not below the upper bound {high}")
    return Predicate(f"{low:g} <= {a} <= {high:g}", (a,), lambda v: min(v[0] - low, high - v[0]) / (high - low))


def ordered(*names: str) -> Predicate:
    """The metrics increase in the order given, without a ``TIE``. Margin: the smallest of the neighbours' margins."""
    text = " < ".join(names)
    return Predicate(text, names, lambda v: min(_relative_gap(a, b) - TIE for a, b in itertools.pairwise(v)))


def every(*predicates: Predicate) -> Predicate:
    """All predicates hold. Margin: the smallest of their margins."""
    names = tuple(name for predicate in predicates for name in predicate.metrics)

    def margin_of(values: Sequence[float]) -> float:
        it: Iterator[float] = iter(values)
        return min(p.margin_of([next(it) for _ in p.metrics]) for p in predicates)

    return Predicate("; ".join(map(str, predicates)), names, margin_of)


REPRODUCED = "reproduced"
AFTER_CORRECTION = "after correction"
NOT_ATTRIBUTED = "not attributed"
READING_DEPENDENT = "reading-dependent"
BY_CONSTRUCTION = "by construction"
NOT_REPRODUCED = "not reproduced"
NOT_TESTABLE = "not testable"
NOT_EVALUATED = "not evaluated"

VERDICTS = {
    REPRODUCED: "holds, with the printed form too where an erratum touches it",
    AFTER_CORRECTION: "holds only with a corrected equation",
    NOT_ATTRIBUTED: "is observed, and just as well without what the claim credits",
    READING_DEPENDENT: "holds under one defensible reading and fails under another",
    BY_CONSTRUCTION: "holds because a generator of ours has the effect built in",
    NOT_REPRODUCED: "does not hold, nor under another choice of ours that was searched",
    NOT_TESTABLE: "cannot be measured here, for the reason given",
}
"""Every verdict that a claim can end with, and what it says; counted apart in every table."""


@dataclass(frozen=True)
class Evaluation:
    """A claim on the metrics of one run: verdict, margins, and the values they rest on; what claims.json holds.

    ``control`` and ``printed`` are the predicates' texts (None without one), ``severe`` says whether the claim could
    have failed as tested: it has a control, and the control fails. ``readings`` gives the margin under each.
    """

    id: str
    figure: str
    statement: str
    source: str
    where: str
    predicate: str
    values: dict[str, float | int | None]
    verdict: str
    margin: float | None
    control: str | None
    control_margin: float | None
    no_control: str
    credits: str
    severe: bool
    printed: str | None
    printed_margin: float | None
    readings: dict[str, float | None]
    searched: str
    by_construction: str
    reason: str
    turns: str
    note: str

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


@dataclass(frozen=True)
class Claim:
    """What the book says (or, with source "ours", a test that it does not make), as a predicate over metrics.

    Metric names are ``.case.metric`` or, from ``summarise``, ``.metric``; ``of`` puts the name of the experiment whose
    folder holds the claim before the dot. A sentence of the book is one claim.

    control: the same statement about the run without what the claim credits, or about the rival it speaks of; it must
        fail, or the claim was not tested. no_control: the reason why none can exist (an identity, a definition).
    credits: what the book names as the cause ("the network", "the re-fixing"), "" where it names none. With a cause, a
        control that holds as well makes the verdict "not attributed".
    printed: the same statement about the printed form of an equation that an erratum corrects; where it fails and the
        corrected form holds, the verdict is "after correction".
    readings: the statement under other choices that are as defensible as ours, by what they change; where they do not
        all agree with the predicate the verdict is "reading-dependent". searched: over which choices of ours a failure
        was searched before it stands.
    by_construction: the generator that has the effect built in. not_testable: why nothing can be measured.
    turns: why it is no doubt of the verdict that a predicate turns within the stored tolerances of its numbers (""
        where none does).
    note: what a reader must know beside the verdict; ``{experiment.case.metric:.3g}`` in it is filled from the run, a
        parameter ``{experiment.key}`` or ``{experiment.cases.case.key}`` from its configuration; ``{.case.metric}`` is
        one of the claim's own experiment.
    beside: what another experiment of the chapter shows of it, filled likewise where that was run, else left out.
    """

    id: str
    figure: str
    statement: str
    predicate: Predicate | None
    source: str = "book"
    control: Predicate | None = None
    no_control: str = ""
    credits: str = ""
    printed: Predicate | None = None
    readings: Mapping[str, Predicate] = field(default_factory=dict)
    searched: str = ""
    by_construction: str = ""
    not_testable: str = ""
    turns: str = ""
    note: str = ""
    where: str = ""
    beside: str = ""

    def __post_init__(self) -> None:
        if (self.predicate is None) != bool(self.not_testable):
            raise ValueError(f"{self.id}: give either a predicate or the reason why it cannot be tested")
        if self.control is not None and self.no_control:
            raise ValueError(f"{self.id}: it has a control, so there is no reason why it could have none")
        object.__setattr__(self, "note", self.note.replace("{.", f"{{{self.experiment}."))

    def of(self, experiment: str) -> Claim:
        """The same under the name of the experiment whose folder holds it."""
        parts = vars(self).items()
        named: dict[str, Any] = {key: part.of(experiment) for key, part in parts if isinstance(part, Predicate)}
        return replace(self, **named, readings={text: item.of(experiment) for text, item in self.readings.items()})

    @property
    def predicates(self) -> tuple[Predicate, ...]:
        found = (self.predicate, self.control, self.printed, *self.readings.values())
        return tuple(predicate for predicate in found if predicate is not None)

    @property
    def metrics(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(name for predicate in self.predicates for name in predicate.metrics))

    @property
    def experiment(self) -> str:
        """Name of the experiment whose metrics the claim is about ("" for one that is not testable)."""
        return self.metrics[0].partition(".")[0] if self.metrics else ""

    def evaluate(self, metrics: Metrics, settings: Mapping[str, Any] = MappingProxyType({})) -> Evaluation:
        """Verdict, margins and the values they rest on; ``settings`` are the parameters that the note may name."""

        def of(predicate: Predicate | None) -> float | None:
            return predicate.margin(metrics) if predicate else None

        margin, control, printed = of(self.predicate), of(self.control), of(self.printed)
        readings = {text: of(predicate) for text, predicate in self.readings.items()}
        values = {name: metrics.get(name) for name in self.metrics}
        return Evaluation(
            id=self.id,
            figure=self.figure,
            statement=self.statement,
            source=self.source,
            where=self.where,
            predicate=str(self.predicate or ""),
            values=values,
            verdict=self._verdict(margin, control, printed, readings),
            margin=margin,
            control=str(self.control) if self.control else None,
            control_margin=control,
            no_control=self.no_control,
            credits=self.credits,
            severe=control is not None and control <= 0,
            printed=str(self.printed) if self.printed else None,
            printed_margin=printed,
            readings=readings,
            searched=self.searched,
            by_construction=self.by_construction,
            reason=self.not_testable,
            turns=self.turns,
            note=filled(self.note, {**settings, **metrics}),
        )

    def _verdict(
        self, margin: float | None, control: float | None, printed: float | None, readings: Mapping[str, float | None]
    ) -> str:
        if self.predicate is None:
            return NOT_TESTABLE
        needed = [margin, *readings.values()]
        needed += [*([printed] if self.printed else []), *([control] if self.control else [])]
        if any(value is None for value in needed):
            return NOT_EVALUATED
        assert margin is not None
        outcomes = {margin > 0, *(value > 0 for value in readings.values() if value is not None)}
        if len(outcomes) == 2:
            return READING_DEPENDENT
        if not margin > 0:
            return NOT_REPRODUCED
        if self.by_construction:
            return BY_CONSTRUCTION
        if self.credits and control is not None and control > 0:
            return NOT_ATTRIBUTED
        return AFTER_CORRECTION if printed is not None and not printed > 0 else REPRODUCED


def about(figure: str, where: str = "", source: str = "book") -> Callable[..., Claim]:
    """``Claim`` for one figure and place in the book: called without them, it takes what else a claim takes."""

    def claim(id: str, statement: str, predicate: Predicate | None, **more: Any) -> Claim:
        return Claim(id, figure, statement, predicate, **{"where": where, "source": source, **more})

    return claim


def cases_in(metrics: Iterable[str]) -> tuple[list[str], bool]:
    """The cases that metrics are of, each once, and whether a number over several cases is among them."""
    parts = [name.split(".") for name in metrics]
    return list(dict.fromkeys(part[1] for part in parts if len(part) > 2)), any(len(part) == 2 for part in parts)


def filled(text: str, values: Mapping[str, Any]) -> str:
    """A text whose ``{experiment.case.metric:format}`` are replaced by the run's numbers ("?" where absent)."""

    def number(match: re.Match[str]) -> str:
        value = values.get(match[1])
        return "?" if value is None else format(value, match[2] or ".3g") if not isinstance(value, str) else value

    return re.sub(r"\{(\w+(?:\.\w+)+)(?::([^{}]*))?\}", number, text)


ROBUST, FRAGILE, OPEN = "robust", "fragile", "open"
SHARE = 0.85
"""A claim is robust where it holds in at least this share of what the book leaves open."""
LOOKS = (16, 20, 26, 32, 39, 50, 60, 70, 79, 89, 100)
"""Numbers of draws after which a study looks at its claims: from enough to tell what decides a fragile one, and where
one failure more may leave it robust (26 without any, 39, 50, ...)."""
SEEN = 8
"""Draws in which a study runs the cases of controls and other readings, too, which decide no word."""
CHANCES = {ROBUST: 1 / 64, FRAGILE: 1 / 100}
"""Of a wrong word at any one number of draws; over all numbers up to 100 together less than 0.05 for each word."""


def robustness(holds: int, samples: int) -> str:
    """ "robust", "fragile" or "open": what a claim that held in so many samples is shown to be ("" without samples).

    Robust is what holds in so many that, were its share below ``SHARE``, so many or more would by a chance of at most
    1/64; fragile what holds in so few that, were its share ``SHARE``, so few or fewer would by at most 1/100. The
    binomial tails are exact and hold together at every number of draws up to 100: a study may end at any.
    26 of 26 is robust, 16 of 16 is open, 9 of 16 is fragile.
    """
    if samples == 0:
        return ""

    def chance(counts: range) -> float:
        return sum(math.comb(samples, k) * SHARE**k * (1 - SHARE) ** (samples - k) for k in counts)

    if chance(range(holds, samples + 1)) <= CHANCES[ROBUST]:
        return ROBUST
    return FRAGILE if chance(range(holds + 1)) <= CHANCES[FRAGILE] else OPEN


@dataclass(frozen=True)
class Reference:
    """A number the book prints, to be shown beside the metric that corresponds to it, named as in a ``Claim``."""

    metric: str
    value: float
    where: str
    unit: str = ""

    def of(self, experiment: str) -> Reference:
        """The same under the name of the experiment whose folder holds it."""
        return replace(self, metric=re.sub(r"^(?=\.)", experiment, self.metric))


ERRATUM_KINDS = ("error", "gap", "reading", "slip")


@dataclass(frozen=True)
class Erratum:
    """Something in the book that a reader who implements it must know.

    kind: "error" (inconsistent with the book's own equations), "gap" (something needed is not printed), "reading"
        (defensible as printed under the reading named) or "slip" (typesetting, possibly text extraction).
    summary, correction: may hold numbers of a run, as a claim's note does.
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

    @property
    def typed(self) -> str:
        """The switch as it is typed in a shell."""
        return shlex.join(self.switch.split())


def _of_kind(kind: str) -> Callable[..., Erratum]:
    def erratum(id: str, equation: str, *more: Any, **named: Any) -> Erratum:
        return Erratum(id, equation, kind, *more, **named)

    return erratum


error, gap, reading, slip = map(_of_kind, ERRATUM_KINDS)
"""An ``Erratum`` of each kind, called without it."""
