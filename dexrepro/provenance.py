"""Where each parameter comes from: one grammar for the comments of conf/.

Provenance: each leaf of conf/chapter/N/EXPERIMENT.yaml says on its line where it comes from, in one grammar::

    stiffness: 45   # k_o [N/m] | printed 2.4.1.1
    rest_length: 0.55   # m | chosen: equals the printed initial estimate | 0.5..0.65
    rates: [0, 0.5, 10]   # 1/s | chosen: not printed | -, 0.1..1, 1..50
    rate: 30   # 1/s | derived: sqrt of stiffness over mass
    motion: ramp   # - | printed 1.5.1 | one of ramp, sine
    inertia_about: centre   # - | chosen: the text leaves it open | drawn from centre, joint

The book's symbol, where it has one, stands before the unit, which is then in brackets. A list of numbers has one range
for all its elements, or one each, ``-`` for those that stay.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from dexrepro.cases import resolved_block
from dexrepro.checks import is_number, leaves
from dexrepro.config import compose_chapter, config_files


@dataclass(frozen=True)
class Provenance:
    """Where a parameter comes from: unit, kind (printed, chosen or derived), text, and the range worth varying.

    words: those that a parameter which is a word may take ("| one of ramp, sine"; "| any" leaves it free). drawn: each
    of them is as good a reading of the book, so a study draws among them ("| drawn from centre, joint").
    symbol: the book's, in plain letters: ``lambda_1``, ``khat_o(0)``, ``rho_{1,0}``; None where it has none.
    spans: the ranges of a list's elements, where each has its own; low and high are then those of all.
    """

    unit: str
    kind: str
    text: str
    low: float | None = None
    high: float | None = None
    symbol: str | None = None
    words: tuple[str, ...] = ()
    drawn: bool = False
    spans: tuple[tuple[float, float] | None, ...] = ()

    def of(self, place: str) -> Provenance:
        """That of an element of a list by its place, such as ``2`` or ``0.1``; of all by an empty one."""
        if not self.spans or not place:
            return self
        low, high = self.spans[int(place.partition(".")[0])] or (None, None)
        return replace(self, low=low, high=high, spans=())

    @property
    def bounds(self) -> str:
        """The range or ranges in words, empty where there is none."""
        if self.low is None:
            return ""
        spans = self.spans or ((self.low, self.high),)
        return ", ".join(f"{span[0]:g} to {span[1]:g}" if span else "-" for span in spans)


_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_SPAN = rf"(?:{_NUMBER}\s*\.\.\s*{_NUMBER}|-)"
_COMMENT = re.compile(
    r"^(?:(?P<symbol>[^|\[]+?)\s*\[)?(?P<unit>[^|\]]*?)\]?\s*"
    r"\|\s*(?P<kind>printed|chosen|derived)\b:?\s*(?P<text>[^|]*?)\s*"
    rf"(?:\|\s*(?:(?P<spans>{_SPAN}(?:\s*,\s*{_SPAN})*)"
    r"|(?P<one>one of|drawn from) (?P<words>[\w, ]+)|any)\s*)?$"
)
_LINE = re.compile(r"^(?P<indent> *)(?P<key>[\w.\-]+|'[^']+'|\"[^\"]+\"):(?:\s+(?P<rest>.*))?$")


def parse_provenance(comment: str) -> Provenance | None:
    """One comment in the grammar above, or None where it does not follow it."""
    match = _COMMENT.match(comment.strip())
    if not match:
        return None
    ends = [part.split("..") for part in (match["spans"] or "").split(",")]
    spans = tuple((float(pair[0]), float(pair[1])) if len(pair) == 2 else None for pair in ends)
    known = [span for span in spans if span]
    return Provenance(
        match["unit"].strip(),
        match["kind"],
        match["text"],
        min(low for low, _ in known) if known else None,
        max(high for _, high in known) if known else None,
        match["symbol"],
        tuple(word.strip() for word in (match["words"] or "").split(",") if word.strip()),
        match["one"] == "drawn from",
        spans if len(spans) > 1 else (),
    )


def leaves_with_comments(text: str) -> Iterator[tuple[str, str, str]]:
    """(dotted key, value text, comment) of every leaf of a YAML text whose leaves stand on one line each."""
    stack: list[tuple[int, str]] = []
    depth = 0
    for line in text.splitlines():
        if depth > 0:  # the rest of a bracket opened on an earlier line
            body = line.partition(" #")[0]
            depth += sum(body.count(c) for c in "[{") - sum(body.count(c) for c in "]}")
            continue
        match = _LINE.match(line)
        if not match:
            continue
        indent, key = len(match["indent"]), match["key"].strip("'\"")
        while stack and stack[-1][0] >= indent:
            stack.pop()
        value, _, comment = (" " + (match["rest"] or "")).partition(" #")
        value = value.strip()
        dotted = ".".join([name for _, name in stack] + [key])
        if value:
            depth = sum(value.count(c) for c in "[{") - sum(value.count(c) for c in "]}")
            yield dotted, value, comment.strip()
        else:
            stack.append((indent, key))


def provenance(chapter: str) -> dict[str, Provenance]:
    """Provenance of every leaf of a chapter's configuration that states one."""
    return {key: found for key, _, comment in commented_leaves(chapter) if (found := parse_provenance(comment))}


def commented_leaves(chapter: str) -> Iterator[tuple[str, str, str]]:
    """(dotted key, value text, comment) of every leaf of a chapter's configuration."""
    for name, path in config_files(chapter).items():
        for key, value, comment in leaves_with_comments(path.read_text("utf-8")):
            yield f"{name}.{key}", value, comment


def origin_of(
    key: str, composed: Mapping[str, Any], origins: Mapping[str, Provenance]
) -> tuple[Provenance | None, str | None]:
    """A parameter's own comment, completed by that of the parameter or block it refers to; and the symbol's home."""
    parts = key.split(".")
    nearest = next((".".join(parts[:n]) for n in range(len(parts), 1, -1) if ".".join(parts[:n]) in origins), None)
    own = origins[nearest] if nearest else None
    if own and own.symbol:
        return own, nearest
    node: Any = composed
    for depth, part in enumerate(parts, 1):
        node = node.get(part) if isinstance(node, Mapping) else None
        if isinstance(node, str) and node.startswith("${") and node.endswith("}"):
            further, home = origin_of(".".join([node[2:-1], *parts[depth:]]), composed, origins)
            if own and further:
                return replace(own, symbol=further.symbol, words=own.words or further.words), home
            return own or further, home
    return own, None


@cache
def times_of(chapter: str, experiment: str) -> frozenset[str]:
    """Parameters of an experiment in seconds, by key within the experiment."""
    composed, origins = compose_chapter(chapter), provenance(chapter)
    found = {key: origin_of(f"{experiment}.{key}", composed, origins)[0]
             for key, value in leaves(resolved_block(composed, experiment)) if is_number(value)}  # fmt: skip
    return frozenset(key for key, origin in found.items() if origin and origin.unit == "s")


@cache
def words_of(chapter: str, experiment: str) -> dict[str, tuple[str, ...]]:
    """Words that the parameters of an experiment may take, by key within the experiment, where they are declared."""
    composed, origins = compose_chapter(chapter), provenance(chapter)
    found = {}
    for key, value in leaves(resolved_block(composed, experiment)):
        if isinstance(value, str):
            origin, _ = origin_of(f"{experiment}.{key}", composed, origins)
            if origin and origin.words:
                found[key] = origin.words
    return found
