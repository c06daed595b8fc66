"""What a command works on: chapters, experiments, results and workers, from words such as ``chapter=2 only=NAME``."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from dexrepro import chapters
from dexrepro.checks import FILES, is_whole
from dexrepro.claims import cases_in
from dexrepro.config import SETTINGS, as_written, compose_chapter, offer, own_keys
from dexrepro.errors import InputError, existing_folder, folder_named, nearest, refused
from dexrepro.experiment import Experiment
from dexrepro.keys import KEYS, SELECTION, TAKEN
from dexrepro.overrides import check_overrides, forced, in_quotes, parsed


class Selection(NamedTuple):
    """Numbers of the chapters, names of the experiments (none: all), folder of the results, processes (None: one a
    core), and the values of the words that only the command at hand knows."""

    chapters: list[str]
    only: list[str]
    results: Path
    workers: int | None
    extra: dict[str, str]


def selected(words: Iterable[str], command: str) -> Selection:
    """What the words ``key=value`` of a command select."""
    overrides = [re.sub("^cases=", "case=", text) for text in words]
    for text in overrides:
        if text.partition("=")[0] not in TAKEN[command]:
            known = ", ".join(f"{key}={KEYS[key][0]}" for key in TAKEN[command])
            raise InputError(f"'{text}' has no meaning here; there are: {known}")
    extra = [key for key in TAKEN[command] if key not in (*SELECTION, "workers")]
    values = dict(text.partition("=")[::2] for text in overrides)
    numbers, _ = chapters_of([text for text in overrides if text.partition("=")[0] not in extra])
    if chapters.OWN in numbers and command in ("check", "crosscheck", "study"):
        raise InputError(f"chapter = {chapters.OWN} is not allowed for {command}: scenes of your own have no claims")
    if "claim" in extra and "claim" in values:
        numbers = _with_claim(values["claim"].strip("'\""), numbers)
    if command != "render":  # which may have the folder of a result
        check_owner(overrides, numbers)
    only = [*filter(None, listed(values.get("only", "")))]
    if only or "figure" in values:
        figure = values.get("figure", "").strip("'\"") or None
        only = [experiment.name for number in numbers for experiment in select(number, only or None, figure)]
    return Selection(
        numbers,
        only,
        folder_named(values.get("results", "results").strip("'\"")),
        positive_workers(values.get("workers")),
        {key: value for key, value in values.items() if key in extra},
    )


def _with_claim(claim: str, numbers: list[str]) -> list[str]:
    """The one of the chapters that has a claim."""
    owner = {known.id: number for number in chapters.numbers() for known in chapters.load(number).claims}
    if claim not in owner:
        near = [key for key, number in owner.items() if number in numbers]
        raise InputError(f"unknown claim '{claim}': {nearest(claim, near)}")
    if owner[claim] not in numbers:
        raise InputError(f"claim = {claim} is of chapter {owner[claim]}, not of {', '.join(numbers)}")
    return [owner[claim]]


def needs_of(words: Sequence[str]) -> list[str]:
    """Words of which ``claim=ID`` is replaced by the experiment and the cases that the claim is about."""
    found = [word for word in words if not word.startswith("claim=")]
    for name in [word.partition("=")[2].strip("'\"") for word in words if word not in found]:
        chapter = chapters.load(_with_claim(name, chapters_of(found)[0])[0])
        claim = next(claim for claim in chapter.claims if claim.id == name)
        if not claim.experiment:
            raise InputError(f"claim = {name} is not testable: {claim.not_testable}")
        cases, over_several = cases_in(claim.metrics)
        given = over_several or any(word.startswith("case=") for word in found)
        found += [f"only={claim.experiment}", *([] if given else [f"case=[{','.join(cases)}]"])]
    return found


def select(chapter: str, only: str | Sequence[str] | None, figure: Any) -> list[Experiment]:
    """The experiments of a chapter named by ``only``, which may name others' too, that make ``figure`` (or table)."""
    experiments = chapters.load(chapter).experiments
    names = [experiment.name for experiment in experiments]
    wanted = names if only is None else [only] if isinstance(only, str) else list(only)
    everywhere = {name for number in chapters.numbers() for name in chapters.names(number)}
    for name in wanted:
        if name not in names and (name not in everywhere or not set(wanted) & set(names)):
            raise InputError(f"unknown experiment '{name}' in chapter {chapter}: {nearest(str(name), names)}")
    selected = [experiment for experiment in experiments if experiment.name in wanted]
    if figure is None:
        return selected
    made = [e for e in selected if any(matches(str(figure), i) for i in (*e.figures, *e.tables))]
    if not made:
        kind = "tables" if str(figure).startswith("T") else "figures"
        ids = [identifier for e in selected for identifier in getattr(e, kind)]
        raise InputError(f"unknown figure '{figure}' in chapter {chapter}: {nearest(str(figure), ids)}")
    return made


def matches(wanted: str, identifier: str) -> bool:
    """Whether "2.9" or "2.9a" names the figure "2.9a" (a number names all its panels)."""
    return wanted == identifier or (identifier.startswith(wanted) and identifier[len(wanted) :].isalpha())


def listed(value: str) -> list[str]:
    """The names in a value such as ``a``, ``a,b`` or ``['a', 'b']``."""
    return [part.strip("'\"[] ") for part in value.split(",")]


def chapters_of(overrides: Iterable[str], extra_dir: str | None = None) -> tuple[list[str], list[str]]:
    """Chapters that overrides select, and the other overrides.

    Without ``chapter=`` the chapter follows from the figure, the experiment or the keys named, also in the user's own
    files of ``extra_dir``; else it is the book.
    """
    chosen: list[str] = []
    rest: list[str] = []
    for text in overrides:
        key, _, value = text.partition("=")
        if key == "chapter":
            chosen = listed(value)
        else:
            rest.append(text)
    for number in chosen:
        if number not in (*chapters.numbers(), chapters.OWN):
            raise InputError(f"unknown chapter '{number}'; chapters: {', '.join(chapters.numbers())}")
    if chosen:
        return chosen, rest
    return _implied_chapters(rest, extra_dir) or list(chapters.numbers()), rest


def _implied_chapters(overrides: Sequence[str], extra_dir: str | None) -> list[str]:
    values = dict(text.partition("=")[::2] for text in overrides)
    figure = values.get("figure", "null").strip("'\"")
    if figure != "null":
        number = figure.lstrip("[T'").partition(".")[0]
        if number not in chapters.numbers():
            raise InputError(f"unknown figure '{figure}': no chapter {number}")
        return [number]
    owner = {name: number for number in chapters.numbers() for name in chapters.names(number)}
    named = [name for name in listed(values.get("only", "null")) if name != "null"]
    for name in named:
        if name not in owner:
            raise InputError(f"unknown experiment '{name}': {nearest(name, owner)}")
    named += [key.lstrip("+~").partition(".")[0] for key in values]
    named += own_keys(overrides, extra_dir) if extra_dir else []
    if "scene" in named:
        return [chapters.OWN]
    return list(dict.fromkeys(owner[name] for name in named if name in owner))


def check_owner(overrides: Iterable[str], numbers: Sequence[str]) -> None:
    """Refuse to look for a case in the whole book. Raises InputError."""
    case = next((text.partition("=")[2] for text in overrides if re.match("cases?=", text)), "null")
    if case != "null" and len(numbers) == len(chapters.numbers()) > 1:
        raise InputError(f"case = {case}: of which experiment? add only=EXPERIMENT")


def of_chapter(number: str, numbers: Sequence[str], overrides: Sequence[str]) -> list[str]:
    """The overrides for one of several chapters: without values of the experiments of the others, and ``only=a,b`` as a
    list without these."""
    others = {name for other in numbers if other != number for name in chapters.names(other)}
    result = []
    for text in overrides:
        key, _, value = text.partition("=")
        if key.lstrip("+~").partition(".")[0] in others:
            continue
        if key == "only" and "," in value:
            text = f"only=[{','.join(name for name in listed(value) if name not in others)}]"
        result.append(text)
    return result


def for_hydra(arguments: Sequence[str], overrides: Sequence[str], extra_dir: str | None) -> list[str]:
    """Arguments of a sweep as Hydra takes them, with the chapter where overrides only imply it.

    Raises InputError for what no job could use, before Hydra starts any.
    """
    numbers, rest = chapters_of(overrides, extra_dir)
    for number in numbers:
        offer(number)
    if extra_dir is None:  # what its files add is known to Hydra alone
        check_overrides(rest, {key: value for number in numbers for key, value in compose_chapter(number).items()})
    named = any(re.match(r"chapter=|figure=.*,", text) for text in overrides)
    implied = [f"chapter='{numbers[0]}'"] if len(numbers) == 1 and not named else []
    return [
        *forced(arguments, {key: value for number in numbers for key, value in as_written(number).items()}),
        *implied,
    ]


def quoted(argument: str) -> str:
    """A word as Hydra's grammar wants it: it refuses an int as a group choice, reads 2.10 as 2.1, and keeps for itself
    many characters of file names, such as brackets, ``=``, commas, ``~`` and all beyond ASCII."""
    argument = re.sub(r"^([+~]*\w[\w.]*)\s+=\s*", r"\1=", argument)  # spaces are no part of a key
    if match := re.fullmatch(r"(chapter|figure)=([\w.]+(?:,[\w.]+)*)", argument):
        values = match[2].split(",")
        return argument if match[2] == "null" else f"{match[1]}=" + ",".join(f"'{value}'" for value in values)
    key, mark, value = argument.partition("=")
    if key in SETTINGS and key != "results" and re.fullmatch(r"[A-Za-z0-9_]+", value):
        return argument  # a plain word or number, for which Hydra's grammar need not be loaded
    if key in ("case", "cases") and mark:
        key, argument = "case", f"case=[{value}]" if "," in value and value[0] not in "['\"" else f"case={value}"
    if not mark or not value or key.startswith("-"):
        return argument
    understood = parsed(argument)
    text = understood.value() if understood and not understood.is_sweep_override() else None
    if understood and (text == value or not _names_file(key, value)):
        return argument
    if not understood and value[0] in "[{" and parsed(inside := f"{key}={_ITEM.sub(_quoted_item, value)}"):
        return inside
    return argument if value[0] in "[{'\"" and not os.path.exists(value) else f"{key}={in_quotes(value)}"


def _names_file(key: str, value: str) -> bool:
    """Whether a value that Hydra reads as a number, a list or the like is meant as a name."""
    if key == "results" or re.fullmatch(r"\+\w+", key):
        return value != "null" and value[0] not in "'\"[{" and "," not in value
    return ("," in value or key.rpartition(".")[2] in FILES) and os.path.exists(os.path.expanduser(value))


_ITEM = re.compile(r"(?<=[:,\[{])(\s*)([^'\"\[\]{},:\s][^'\"\[\]{},:]*?)(?=\s*[,}\]])")


def _quoted_item(item: re.Match[str]) -> str:
    return item[1] + (item[2] if parsed(f"key={item[2]}") else in_quotes(item[2]))


def positive_workers(value: Any) -> int | None:
    """The number of processes, None for one a core."""
    if isinstance(value, str) and re.fullmatch("[0-9]{1,12}", value):
        value = int(value)
    if value is None or (is_whole(value) and value > 0):
        return value
    raise refused("workers", value, "be a whole number of 1 or greater")


def existing(results: Path) -> Path:
    """A results folder from which something is to be read."""
    return results if str(results) == "results" else existing_folder(results, "results")
