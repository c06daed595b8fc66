"""What rivals share has one home: set from the command line, it reaches every case of the experiment."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import pytest

from dexrepro import chapters
from dexrepro.cases import experiment_cases, resolved_block
from dexrepro.checks import is_number, leaves, value_at
from dexrepro.config import compose_chapter
from dexrepro.provenance import commented_leaves, parse_provenance
from dexrepro.study.draws import parameters

ALIASES = {"control_period": ("dt",), "step": ("dt",), "speed_limit": ("speed",)}
"""Names under which a law takes what the experiment calls otherwise."""


def shared_keys(block: Mapping[str, Any], cases: Mapping[str, Mapping[str, Any]]) -> Iterator[tuple[str, list[str]]]:
    """Numbers of an experiment that a law in one of its cases has too: key and the paths of its copies."""
    for key, value in block.items():
        if not isinstance(value, float) or (key == "step" and "control_period" in block):
            continue
        names = (key, *ALIASES.get(key, ()))
        paths = {
            path
            for case in cases.values()
            for path, found in leaves(case)
            if path.startswith("law") and path.rpartition(".")[2] in names and found == value == case.get(key)
        }
        if paths:
            yield key, sorted(paths)


@pytest.mark.parametrize("number", chapters.numbers())
def test_a_value_that_rivals_share_reaches_all_of_them_when_it_is_set(number: str) -> None:
    shipped = compose_chapter(number)
    found = {}
    for experiment in chapters.load(number).experiments:
        block, cases = resolved_block(shipped, experiment.name), experiment_cases(shipped, experiment.name)
        for key, paths in shared_keys(block, cases):
            found[f"{experiment.name}.{key}"] = (experiment.name, key, 0.99 * block[key], block[key], paths, cases)
    changed = compose_chapter(number, [f"{name}={entry[2]!r}" for name, entry in found.items()])
    apart = []
    for name, (experiment, key, value, before, paths, cases) in found.items():
        reached = {}
        for case, now in experiment_cases(changed, experiment).items():
            old, new = dict(leaves(cases[case])), dict(leaves(now))
            copies = [path for path in paths if old.get(path) == old.get(key) == before]
            reached |= {f"{case}.{path}": new[path] == value for path in copies}
        if len(set(reached.values())) > 1:
            apart.append(f"{name} does not reach {[copy for copy, reaches in reached.items() if not reaches]}")
    assert not apart


@pytest.mark.parametrize("number", chapters.numbers())
def test_a_number_that_a_study_draws_reaches_the_laws_of_all_cases(number: str) -> None:
    """A rival with a copy of it in its own law would stay where it is."""
    shipped, apart = compose_chapter(number), []
    for experiment in chapters.load(number).experiments:
        drawn = {key: value_at(shipped, key) for key in parameters(number, experiment.name)}
        drawn = {key: value for key, value in drawn.items() if is_number(value) and not key[-1].isdigit()}
        changed = compose_chapter(number, [f"{key}={value + 1}" for key, value in drawn.items()])
        now = experiment_cases(changed, experiment.name)
        for case, before in experiment_cases(shipped, experiment.name).items():
            after = dict(leaves(now[case]))
            for path, value in leaves(before):
                same = [
                    key for key in drawn if key.rpartition(".")[2] == path.rpartition(".")[2] and drawn[key] == value
                ]
                if path.startswith("law") and same and after[path] == value:
                    apart.append(f"{same[0]} does not reach {experiment.name}.{case}.{path}")
    assert not apart


@pytest.mark.parametrize("number", chapters.numbers())
def test_a_number_that_the_book_prints_in_one_place_stands_in_one_place(number: str) -> None:
    found: dict[tuple[str, str, str], list[str]] = {}
    for key, value, comment in commented_leaves(number):
        origin = parse_provenance(comment)
        if origin and origin.kind == "printed" and ".cases." not in key and value[0] in "0123456789-[":
            found.setdefault((key.rpartition(".")[2], value, origin.text), []).append(key)
    assert [keys for keys in found.values() if len(keys) > 1] == []
