"""No text of the book's pages types a number that a run or the configuration gives."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from dexrepro import chapters
from dexrepro.checks import leaves, value_at
from dexrepro.claims import Claim
from dexrepro.config import compose_chapter
from dexrepro.experiment import Experiment
from dexrepro.provenance import provenance

UNITS = {
    "%": 1e-2, "µm": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1, "ms": 1e-3, "s": 1, "N": 1, "rad": 1, "mrad": 1e-3,
    "degrees": 1, "deg": 1, "Hz": 1, "kHz": 1e3, "kg": 1, "g": 1e-3, "times": 1, "cm^2": 1,
}  # fmt: skip
_UNIT = "|".join(re.escape(unit) for unit in sorted(UNITS, key=len, reverse=True))
NUMBER = re.compile(
    r"(?<![\w.^])(?P<value>\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w.]*\d)"
    rf"(?:(?= ?(?P<unit>{_UNIT})(?!\w))|(?=(?:(?: to| and| or|,) \d[\d.]*)+ ?(?P<later>{_UNIT})(?!\w)))?"
)
NO_NUMBERS = (
    r"\{[^{}]*\}",  # filled from the run
    r"\$[^$]*\$",
    r"\(\d+\.\d+[^()]*\)",  # equations
    r"\b\d+\.\d+\.\d+[\w.]*|\b[A-Z]\d\.\w+",  # sections, figures, claims, errata
    r"\[\d+\]|#[\da-f]{6}",  # references, colours
    r"\b(?:[Ff]igs?\.|[Tt]able|[Ll]ines?|[Ss]ect\.|Lemma|[Rr]emark|[Cc]hapter|[Tt]heorem|[Aa]lgorithm|Traj\.|[Cc]ases?|[Cc]onditions?|Assumption"
    r"|Step|subsection) \d[\d.]*\w?(?:(?:,| and| to| or) \d[\d.]*)*",
)
QUOTED = {
    "C1.27": {16.0},  # operations of a general product
    "C5.19": {0.01},  # an end of what was searched
    "C6.28": {30.0},  # points of an obstacle that [16] is given
    **dict.fromkeys(("C4.24", "C6.38", "C8.08t", "C8.16"), frozenset({1.0})),  # ms or kHz, the control period
    **dict.fromkeys(
        ("C4.03", "C4.19", "skill_reuse", "barrier_and_switch"), frozenset({10.0})
    ),  # ms, of a definition of ours
    "2.10": {0.25},  # the book's, and what it may have meant
    "6.1": {16.0, 20.0},
    "E6.14": {16.0, 34.0, 35.0},
    "E7.27": {21.0},
    "E4.07": {0.638},  # where the largest E of (4.26) is 1
}
"""Numbers that follow from a definition, or are the book's and no parameter of ours."""
CONVENTIONS = frozenset({0.9, 0.95})
"""Quantiles and intervals that are shown."""


def numbers(text: str) -> list[tuple[float, float]]:
    """Decimal numbers, numbers with a unit, and whole numbers above twelve, with the size of the unit."""
    for pattern in NO_NUMBERS:
        text = re.sub(pattern, "", text)
    found = []
    for match in NUMBER.finditer(text):
        unit, value = match["unit"] or match["later"], float(match["value"])
        if unit or value > 12 or not match["value"].isdigit():
            found.append((value, UNITS.get(unit, 1)))
    return found


def typed(text: str, known: frozenset[float]) -> list[float]:
    """Numbers of a text that are not known: in SI units, or as they stand where no prefix says otherwise."""
    return [
        v
        for v, unit in numbers(text)
        if not {_rounded(v * unit), _rounded(v if unit in (1, 0.01) else v * unit)} & known
    ]


def _rounded(value: float) -> float:
    return float(f"{value:.6g}")


@cache
def printed(number: str, experiment: str = "") -> frozenset[float]:
    """What the book prints, by the configuration (of an experiment) and the references: a text may quote it."""
    composed = compose_chapter(number)
    keys = [key for key, origin in provenance(number).items() if origin.kind == "printed"]
    keys = [key for key in keys if not experiment or key.startswith((f"{experiment}.", "shared."))]
    values = [value for key in keys for _, value in leaves(value_at(composed, key))]
    values += [reference.value for reference in chapters.load(number).references]
    return frozenset(_rounded(abs(value)) for value in values if isinstance(value, int | float))


@cache
def own(folder: Path) -> frozenset[float]:
    """Bounds and windows: numbers in the code of an experiment, which decide what it measures and claims."""
    trees = [
        ast.parse((folder / name).read_text()) for name in ("experiment.py", "claims.py") if (folder / name).exists()
    ]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    values = [n.value for n in nodes if isinstance(n, ast.Constant)]
    return frozenset(_rounded(value) for value in values if isinstance(value, int | float))


@cache
def named(folder: Path) -> frozenset[float]:
    """Numbers that the code of an experiment gives a name: windows, tolerances."""
    trees = [
        ast.parse((folder / part).read_text()) for part in ("experiment.py", "claims.py") if (folder / part).exists()
    ]
    values = {getattr(a.targets[0], "id", ""): a.value for t in trees for a in t.body if isinstance(a, ast.Assign)}
    values = {name: value for name, value in values.items() if name not in ("CLAIMS", "REFERENCES")}
    nodes = [n.value for value in values.values() for n in ast.walk(value) if isinstance(n, ast.Constant)]
    return frozenset(_rounded(value) for value in nodes if isinstance(value, int | float))


def judged_by(claim: Claim) -> frozenset[float]:
    """Numbers of a claim's statement and predicates."""
    predicates = [part for part in (claim.predicate, claim.control, claim.printed, *claim.readings.values()) if part]
    bounds = [float(text) for part in predicates for text in re.findall(r"\d+\.?\d*(?:e-?\d+)?", str(part))]
    stated = [size for value, unit in numbers(claim.statement) for size in (value, value * unit)]
    return frozenset(map(_rounded, (*bounds, *stated)))


def texts_of(experiment: Experiment) -> Iterator[tuple[str, str]]:
    for identifier, figure in experiment.figures.items():
        yield from ((identifier, figure.caption), (identifier, figure.alt))
    yield from experiment.tables.items()
    if experiment.film:
        yield experiment.name, experiment.film.caption


def texts_about(claim: Claim) -> tuple[str, ...]:
    return (claim.note, claim.beside, claim.searched, claim.no_control, claim.by_construction, *claim.readings)


def labels_of(path: Path) -> Iterator[tuple[str, str]]:
    """Titles, labels and rows that a module writes; docstrings and identifiers of figures and tables are none."""
    tree = ast.parse(path.read_text())
    assigned = [node for node in tree.body if isinstance(node, ast.Assign)]
    texts = {n for a in assigned if getattr(a.targets[0], "id", "") in ("FIGURES", "TABLES") for n in ast.walk(a)}
    parts = {value for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for value in node.values}
    docs = {node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if node in texts or node in docs or node in parts:
            continue
        if isinstance(node, ast.JoinedStr):
            written = (v.value if isinstance(v, ast.Constant) else "{}" for v in node.values)
            yield f"{path.parent.name}:{node.lineno}", "".join(map(str, written))
        elif isinstance(value := getattr(node, "value", None), str) and not re.fullmatch(r"T?\d+\.\w+", value):
            yield f"{path.parent.name}:{node.lineno}", node.value


@pytest.mark.parametrize("number", chapters.numbers())
def test_no_caption_title_note_or_label_types_a_number_of_a_run_or_a_parameter(number: str) -> None:
    """They come from metrics or parameters by placeholders; the book's and those of the tests themselves may stand."""
    chapter, found = chapters.load(number), []
    for experiment in chapter.experiments:
        folder = chapter.folder / experiment.name
        known = printed(number, experiment.name) | own(folder) | CONVENTIONS
        for place, text in (*texts_of(experiment), *labels_of(folder / "figures.py")):
            quoted = QUOTED.get(place.partition(":")[0], set())
            found += [(place, text[:70], item) for item in typed(text, known) if item not in quoted]
        for claim in chapter.claims_of(experiment.name):
            known = printed(number, experiment.name) | named(folder) | judged_by(claim) | CONVENTIONS
            items = [(text, item) for text in texts_about(claim) for item in typed(text, known)]
            found += [(claim.id, text[:70], item) for text, item in items if item not in QUOTED.get(claim.id, set())]
    shared = [label for path in chapter.folder.glob("*.py") if path.name != "errata.py" for label in labels_of(path)]
    found += [(place, text[:70], item) for place, text in shared for item in typed(text, printed(number) | CONVENTIONS)]
    for item in chapter.errata:
        for text in (item.summary, item.correction):
            values = set(typed(text, printed(number))) - QUOTED.get(item.id, set())
            found += [(item.id, text[:70], value) for value in values]
    assert not found, "\n".join(map(str, found))


@pytest.mark.parametrize("number", chapters.numbers())
def test_a_sentence_has_a_number_where_it_has_a_unit(number: str) -> None:
    """Brackets about a unit belong to axes, columns and docstrings."""
    chapter = chapters.load(number)
    texts = [(claim.id, text) for claim in chapter.claims for text in (claim.statement, claim.note, claim.beside)]
    texts += [(item.id, text) for item in chapter.errata for text in (item.summary, item.correction)]
    assert not [pair for pair in texts if re.search(r" \[(?:m|cm|mm|s|ms|N|N m|rad|1/s)\]", pair[1])]


def test_numbers_are_told_from_equations_sections_and_placeholders() -> None:
    text = "By (6.3), Sect. 4.5 and T4.S, after {e.a.x:.1f} s: 12 of 20 in 0.5 or 3 % and 5 to 6 mm in Cases 1 and 2."
    assert numbers(text) == [(20, 1), (0.5, 0.01), (3, 0.01), (5, 1e-3), (6, 1e-3)]
    assert typed(text, frozenset({20.0, 0.005, 0.03, 5.0})) == [6]
