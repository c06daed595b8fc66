"""What Tab offers in a shell: commands, chapters, experiments, figures, cases, claims and every parameter."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator
from typing import Any

from dexrepro import chapters
from dexrepro.keys import SELECTION, TAKEN


def script(shell: str) -> str:
    """What the shell has to evaluate once, for example by ``eval "$(dexrepro completion bash)"``."""
    import argcomplete

    return str(argcomplete.shellcode(["dexrepro"], shell=shell))


def complete(parser: argparse.ArgumentParser) -> None:
    """Answer and exit where a shell asks; do nothing elsewhere."""
    import argcomplete

    argcomplete.autocomplete(parser, always_complete_options=False)


def words(prefix: str, parsed_args: argparse.Namespace, **_: Any) -> Iterator[str]:
    """Completions of a word ``key=value`` beside those given."""
    given = dict(word.partition("=")[::2] for word in getattr(parsed_args, "selection", None) or ())
    numbers = [number for number in chapters.numbers() if given.get("chapter", number).strip("'\"") == number]
    key, equals, _value = prefix.partition("=")
    if equals:
        yield from (f"{key}={value}" for value in _values(key, numbers, given, parsed_args))
    elif "." in prefix:
        yield from (f"{name}=" for number in numbers for name in _parameters(number, prefix))
    else:
        command = str(getattr(parsed_args, "command", ""))
        yield from (f"{key}=" for key in TAKEN.get(command, SELECTION))
        if command == "run":
            yield from (f"{name}." for number in numbers for name in chapters.names(number))


def _values(key: str, numbers: Iterable[str], given: dict[str, str], parsed: argparse.Namespace) -> Iterable[str]:
    if key == "chapter":
        return chapters.numbers()
    if key == "only":
        return [name for number in numbers for name in chapters.names(number)]
    if key == "format":
        return ("pdf", "png", "svg") if getattr(parsed, "command", "") == "draw" else ("gif", "mp4")
    if key == "style":
        return ("paper", "slides", "dark")
    if key not in ("figure", "claim", "case"):
        return ()
    loaded = [chapters.load(number) for number in numbers]
    if key == "claim":
        return [claim.id for chapter in loaded for claim in chapter.claims if claim.predicate]
    experiments = [e for chapter in loaded for e in chapter.experiments if given.get("only", e.name) == e.name]
    if key == "figure":
        return [name for experiment in experiments for name in (*experiment.figures, *experiment.tables)]
    from dexrepro.cases import experiment_cases
    from dexrepro.config import compose_chapter

    return [
        case
        for chapter in loaded
        for experiment in experiments
        if experiment in chapter.experiments
        for case in experiment_cases(compose_chapter(chapter.number), experiment.name)
    ]


def _parameters(number: str, prefix: str) -> Iterable[str]:
    from dexrepro.provenance import provenance

    experiment = prefix.partition(".")[0]
    return provenance(number) if experiment in (*chapters.names(number), "shared") else ()
