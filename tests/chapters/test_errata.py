"""What the switch of an erratum does: it selects the printed form of what the erratum is about, and nothing else."""

from __future__ import annotations

import re
import shlex
from typing import Any

import pytest

from dexrepro import chapters
from dexrepro.cases import experiment_cases
from dexrepro.checks import leaves
from dexrepro.claims import Erratum
from dexrepro.config import compose_chapter

SWITCHED = [
    (number, erratum) for number in chapters.numbers() for erratum in chapters.load(number).errata if erratum.switch
]


def resolved(number: str, overrides: list[str]) -> dict[str, Any]:
    """Every value of every case: "experiment.case.key" -> value."""
    composed = compose_chapter(number, overrides)
    return {
        f"{experiment.name}.{case}.{key}": value
        for experiment in chapters.load(number).experiments
        for case, values in experiment_cases(composed, experiment.name).items()
        for key, value in leaves(values)
    }


@pytest.fixture(scope="module")
def shipped() -> dict[str, dict[str, Any]]:
    return {number: resolved(number, []) for number in {number for number, _ in SWITCHED}}


@pytest.mark.parametrize(("number", "erratum"), SWITCHED, ids=lambda value: getattr(value, "id", value))
def test_a_switch_changes_the_keys_it_names_alone(
    number: str, erratum: Erratum, shipped: dict[str, dict[str, Any]]
) -> None:
    words = shlex.split(erratum.switch)
    keys = {word.lstrip("+").partition("=")[0] for word in words}
    now, before = resolved(number, words), shipped[number]
    changed = {name for name in now.keys() | before.keys() if now.get(name) != before.get(name)}
    parts = {part for key in keys for part in key.split(".")[-1:]}
    named = {name for name in changed if parts & set(name.split(".")[1:])}
    assert named, f"{erratum.switch} changes nothing"
    follow = {now.get(name) for name in named}  # by reference, under a name of their own
    assert not {name for name in changed - named if now.get(name) not in follow}
    experiments = {key.partition(".")[0] for key in keys} - {"shared"}
    reached = {name.partition(".")[0] for name in changed}
    assert experiments <= reached
    for experiment, case in re.findall(r"\+(\w+)\.cases\.(\w+)=", erratum.switch):
        merged = [name for name in before if name.startswith(f"{experiment}.{case}.")]
        assert not merged, "in a case that exists another erratum's printed form would run as well"
