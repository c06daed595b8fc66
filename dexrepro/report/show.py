"""All there is about one thing, for the terminal: a claim, figure, table, experiment, erratum, equation, symbol, law or
parameter."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from dexrepro import baselines, chapters, tune
from dexrepro.cases import experiment_cases, resolved_block, settings
from dexrepro.claims import Claim, Erratum, cases_in, filled
from dexrepro.config import compose_chapter
from dexrepro.damage import check_result
from dexrepro.errors import InputError, nearest
from dexrepro.overrides import selecting
from dexrepro.plan import plan_chapter
from dexrepro.provenance import provenance
from dexrepro.report import equations, parameters, relations, sources, verdicts, words
from dexrepro.report.listing import chapter_listing
from dexrepro.selection import matches, quoted
from dexrepro.storage import read_json
from dexrepro.study import draws, summaries


def show(word: str, results: Path) -> Iterator[str]:
    """Lines about whatever has this name. Raises InputError with the nearest names where nothing has."""
    kinds = r"^((claim|only|figure)(=|\s+)|(eqs?|fig|table|figure|equation)\.?\s*)"
    asked = re.sub(kinds, "", word.strip(), flags=re.IGNORECASE).strip("() ")
    only_equation = word.strip().lower().startswith(("eq", "("))
    found = False
    for kind in (_equation,) if only_equation else KINDS:
        for line in kind(asked, results):
            found = True
            yield line
    if not found:
        near = nearest(asked, _names())
        known = "name a claim, figure, table, equation, symbol, law, parameter, experiment or erratum: dexrepro list"
        if chapter := re.fullmatch(r"chapter\W*(\w+)", word.strip(), flags=re.IGNORECASE):
            near = known = f"see: dexrepro list chapter={chapter[1]}"
        raise InputError(f"nothing is called '{word}': {near if near.startswith('did') else known}")


def _names() -> list[str]:
    """What can be asked for, for a suggestion."""
    listed = [chapter_listing(number) for number in chapters.numbers()]
    names = [item["id"] for chapter in listed for item in (*chapter["claims"], *chapter["errata"])]
    for chapter in listed:
        for experiment in chapter["experiments"]:
            names += [experiment["name"], *experiment["figures"], *experiment["tables"]]
        for key, origin in provenance(chapter["chapter"]).items():
            names += [key, *([origin.symbol] if origin.symbol else [])]
    return [*dict.fromkeys([*names, *_laws()])]


# ------------------------------------------------------------------------------------------------------------ claims


def _claim(word: str, results: Path) -> Iterator[str]:
    for number in chapters.numbers():
        for claim in chapters.load(number).claims:
            if claim.id.lower() == word.lower():
                yield from _about_claim(number, claim, results)


def _about_claim(number: str, claim: Claim, results: Path) -> Iterator[str]:
    name, chapter, composed = claim.experiment, chapters.load(number), compose_chapter(number)
    cases, over_several = cases_in(claim.metrics)
    where, metrics = _metrics(number, name, results, () if over_several else cases) if name else ("", {})
    row = next((s["claims"].get(claim.id) for s in summaries.stored(results) if s["experiment"] == name), None)
    shown: dict[str, Any] = claim.evaluate(metrics, settings(composed, name) if name else {}).as_dict()
    shown |= {"study": row, "robustness": verdicts.robustness(row)}
    place = ", ".join(filter(None, [f"Fig. {claim.figure}" if claim.figure else "", words.section(claim.where), name]))
    yield f"{claim.id}  {shown['verdict']}{_margin(shown['margin'])}  ({place or 'no experiment'})"
    yield f"  {claim.statement}{'' if claim.source == 'book' else '  (ours, not the book)'}"
    if claim.not_testable:
        yield f"  not testable: {claim.not_testable}"
    else:
        yield f"  holds if    {claim.predicate}"
        yield f"  values      {', '.join(f'{key} = {_number(value)}' for key, value in shown['values'].items())}"
        yield f"              {where}"
        if claim.credits:
            yield f"  credits     {claim.credits}"
        if claim.control:
            yield f"  control     {claim.control}{_margin(shown['control_margin'])}"
        yield f"  tested      {verdicts.noticed(shown)}"
        yield f"  study       {verdicts.often(shown)}"
        if row and row["parameter"]:
            yield f"              its margin follows {row['parameter']} most"
    if claim.printed:
        yield f"  as printed  {claim.printed}{_margin(shown['printed_margin'])}"
    for text, margin in shown["readings"].items():
        yield f"  reading     {text}{_margin(margin)}"
    for label in ("searched", "by_construction", "note"):
        if shown[label]:
            yield f"  {label.replace('_', ' '):<11} {shown[label]}"
    errata = relations.errata_of(claim, chapter.errata, composed)
    numbers = _numbers(number, chapters.names(number), results) if errata else {}
    for erratum in errata:
        yield f"  erratum     {erratum.id} {erratum.equation}: {filled(erratum.summary, numbers)}"
    texts = " ".join([claim.statement, shown["note"], claim.where, *(erratum.equation for erratum in errata)])
    if mentioned := equations.numbers(texts):
        yield f"  equations   {', '.join(f'({equation})' for equation in mentioned)}"
    if name:
        for key, origin in draws.parameters(number, name).items():
            row = {"key": key, "value": parameters.value_of(composed, key), **parameters.shown(origin)}
            yield f"  varies      {_parameter(row)}"
    yield from _written(number, claim.id)
    if name:
        yield from _code(number, name)
        some = "" if over_several else f" 'case=[{','.join(sorted(cases))}]'"
        own = chapters.option(number)
        yield f"  $ dexrepro run{own} chapter={number} only={name}{some}"
        yield f"  $ dexrepro check{own} chapter={number} claim={claim.id}"
        yield f"  $ dexrepro study{own} chapter={number} claim={claim.id}"


def _metrics(number: str, name: str, results: Path, cases: Sequence[str] = ()) -> tuple[str, dict[str, Any]]:
    """The metrics of an experiment's result here, or of a run of some ``cases``, else those stored; which they are."""
    folders = [results / f"chapter{number}" / name]
    if cases and (results / "runs").exists():
        words = [*selecting(results, [name]), quoted(f"case=[{','.join(cases)}]")]
        folders += [plan.folder for plan in plan_chapter(number, words, write=False)[0]]
    for folder in folders:
        if (folder / "metrics.json").exists():
            check_result(folder, "metrics.json")
            return f"as run here, {folder}", read_json(folder / "metrics.json")
    return "as stored with dexrepro", baselines.Baseline.of(number, name).values


def _numbers(number: str, names: Iterable[str], results: Path) -> dict[str, Any]:
    """Parameters and metrics of experiments, as texts name them."""
    composed, found = compose_chapter(number), dict[str, Any]()
    for name in names:
        found |= settings(composed, name) | _metrics(number, name, results)[1]
    return found


def _margin(value: float | None) -> str:
    return "" if value is None else f", margin {value:+.3g}"


def _number(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else "undefined" if value is None else str(value)


# ------------------------------------------------------------------------------- experiments, figures, tables, errata


def _made(word: str, results: Path) -> Iterator[str]:
    """An experiment by its name, or the one that makes a figure or table."""
    for number in chapters.numbers():
        for entry in chapter_listing(number)["experiments"]:
            made = [*entry["figures"], *entry["tables"]]
            asked = [identifier for identifier in made if matches(word, identifier)]
            if word == entry["name"] or asked:
                yield from _about_experiment(number, entry, asked, results)


def _about_experiment(number: str, entry: dict[str, Any], asked: list[str], results: Path) -> Iterator[str]:
    experiment = chapters.load(number).experiment(entry["name"])
    yield f"{', '.join(asked) or entry['name']}  of chapter {number}: {entry['summary']}"
    texts = {**{name: figure.caption for name, figure in experiment.figures.items()}, **experiment.tables}
    numbers = _numbers(number, [experiment.name], results)
    for identifier in asked or texts:
        yield f"  {identifier:<10}  {filled(texts[identifier], numbers)}"
    folder = results / f"chapter{number}" / entry["name"]
    if folder.exists():
        yield f"  result      {folder}"
    yield f"  cases       {', '.join(entry['cases'])}"
    _, metrics = _metrics(number, entry["name"], results)
    claims = chapters.load(number).claims_of(entry["name"])
    about = [claim for claim in claims if any(relations.concerns(claim.figure, identifier) for identifier in asked)]
    if asked and claims and not about:
        yield f"  no claim names {', '.join(asked)}; the same runs decide:"
    for claim in about or claims:
        found = claim.evaluate(metrics)
        yield f"  {claim.id:<10}  {found.verdict}{_margin(found.margin)}: {claim.statement}"
    if not asked:
        composed, origins = compose_chapter(number), provenance(number)
        for row in parameters.table(entry["name"], composed, origins, {}):
            yield f"  parameter   {_parameter(row)}"
    yield from _code(number, entry["name"])
    what = f"figure={asked[0]}" if asked else f"chapter={number} only={experiment.name}"
    yield f"  $ dexrepro run{chapters.option(number)} {what}"


def _erratum(word: str, results: Path) -> Iterator[str]:
    for number in chapters.numbers():
        for erratum in chapters.load(number).errata:
            if erratum.id.lower() == word.lower():
                yield from _about_erratum(number, erratum, results)


def _about_erratum(number: str, erratum: Erratum, results: Path) -> Iterator[str]:
    yield f"{erratum.id}  {erratum.kind} in {erratum.equation}"
    numbers = _numbers(number, chapters.names(number), results)
    yield f"  {filled(erratum.summary, numbers)}"
    if erratum.correction:
        yield f"  correction  {filled(erratum.correction, numbers)}"
    for name in erratum.evidence:
        value = _metrics(number, name.partition(".")[0], results)[1].get(name)
        yield f"  shown by    {name} = {_number(value)}"
    composed, claims = compose_chapter(number), chapters.load(number).claims
    if touching := [claim.id for claim in claims if relations.errata_of(claim, [erratum], composed)]:
        yield f"  touches     {', '.join(touching)}"
    yield from _written(number, erratum.id)
    if erratum.switch:
        yield f"  $ dexrepro run{chapters.option(number)} chapter={number} {erratum.typed}"


# ------------------------------------------------------------------------------- equations, symbols, parameters, laws


def _equation(word: str, results: Path) -> Iterator[str]:
    if re.fullmatch(r"\d+\.\d+[a-z]?", word):
        mentions = [mention for mention in equations.index() if mention.equation == word]
        section, latex = equations.printed().get(word, ("", ""))
        yield from (
            [f"Equation ({word})" + (f", Sect. {section}:  {latex}" if latex else "")] if mentions or latex else []
        )
        for mention in mentions:
            yield f"  {mention.kind:<10}  {sources.label(mention.path)}:{mention.line}  {mention.name}: {mention.text}"


def _set(word: str, results: Path) -> Iterator[str]:
    """A parameter by its key or the end of it, those of a block, a symbol by how the configuration writes it."""
    experiment = word.partition(".")[0]
    for number in chapters.numbers():
        composed, origins = compose_chapter(number), provenance(number)
        inside = "." in word and word not in origins and experiment in chapters.names(number)
        for row in parameters.table(experiment, composed, origins, {}) if inside else ():
            if f"{row['key']}.".startswith(f"{word}."):  # also what it inherits
                yield f"{_parameter(row)}  (chapter {number})"
        keys = {key for key in origins if word in (key, key.partition(".")[2]) or key.endswith(f".{word}")}
        for key in [key for key in origins if key in keys]:
            row = {"key": key, "value": parameters.value_of(composed, key), **parameters.shown(origins[key])}
            yield f"{_parameter(row)}  (chapter {number})"
            yield from _search(key)
        for row in parameters.index(composed, origins, ()):
            if row["plain"] == word and row["key"] not in keys:
                yield f"{_parameter(row)}  (chapter {number})"


def _search(key: str) -> Iterator[str]:
    """How the best values of a case were found."""
    if words := tune.words_of(key.replace(".cases.", ".")):
        yield f"  searched    {', '.join(words)}; again: dexrepro tune --update case={key.replace('.cases.', '.')}"


def _parameter(row: dict[str, Any]) -> str:
    said = "; ".join(filter(None, [f"{row['kind']} {row['text']}".strip(), row["range"]]))
    symbol = f"{row['plain']} = " if row["plain"] else ""
    return f"{row['key']} = {symbol}{row['value']} {row['unit']}  [{said}]"


def _laws() -> dict[str, dict[str, list[str]]]:
    """Classes and functions that configurations name, by their own name: {dotted name: experiments that use it}."""
    found: dict[str, dict[str, list[str]]] = {}
    for number in chapters.numbers():
        composed = compose_chapter(number)
        for name in chapters.names(number):
            text = str([composed[name], resolved_block(composed, name)])
            for target in dict.fromkeys(re.findall(r"'_target_': '(dexrepro[\w.]+)'", text)):
                found.setdefault(target.rpartition(".")[2], {}).setdefault(target, []).append(name)
    return found


def _law(word: str, results: Path) -> Iterator[str]:
    for target, experiments in _laws().get(word.rpartition(".")[2], {}).items():
        (thing,) = relations.laws({"_target_": target}) or (None,)
        if thing is None or (word != target and "." in word):
            continue
        file, line = sources.place(thing)
        yield f"{target}  {sources.label(file)}:{line}"
        yield from (f"  {text}".rstrip() for text in (inspect.getdoc(thing) or "").splitlines())
        yield f"  used by     {', '.join(experiments)}"


# -------------------------------------------------------------------------------------------------------------- code


def _written(number: str, identifier: str) -> Iterator[str]:
    if found := relations.definitions(chapters.load(number).folder).get(identifier):
        yield f"  written in  {sources.label(found[0])}:{found[1]}"


def _code(number: str, name: str) -> Iterator[str]:
    """Lines of the configuration, the experiment and the laws that it names."""
    from dexrepro.config import config_files

    experiment, composed = chapters.load(number).experiment(name), compose_chapter(number)
    yield f"  values in   {sources.label(config_files(number)[name])}"
    yield f"  simulation  {sources.label(experiment.folder / 'experiment.py')}"
    for thing in relations.laws([resolved_block(composed, name), experiment_cases(composed, name)]):
        file, line = sources.place(thing)
        yield f"  uses        {thing.__qualname__}, {sources.label(file)}:{line}"


KINDS: tuple[Callable[[str, Path], Iterator[str]], ...] = (_claim, _erratum, _made, _equation, _law, _set)
