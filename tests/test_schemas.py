"""Every file the package writes is as its schema in docs/schemas says, and a schema notices what is wrong."""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT
from jsonschema import Draft202012Validator, ValidationError

from dexrepro import chapters, cli
from dexrepro.config import compose_chapter
from dexrepro.plan import plan_chapter
from dexrepro.report.listing import listing
from dexrepro.report.schema import schema
from dexrepro.runner import run_plans
from dexrepro.study import samples, sampling

SCHEMAS = {path.name.partition(".")[0]: path for path in (ROOT / "docs/schemas").glob("*.json")}


def valid(name: str, data: Any) -> Any:
    Draft202012Validator(json.loads(SCHEMAS[name].read_text("utf-8"))).validate(data)
    return data


def test_the_schemas_are_schemas() -> None:
    assert set(SCHEMAS) == {"metrics", "claims", "run", "baseline", "study", "sample", "list", "check", "crosscheck"}
    for path in SCHEMAS.values():
        Draft202012Validator.check_schema(json.loads(path.read_text("utf-8")))


def test_a_result_a_study_and_the_check_are_as_their_schemas_say(
    toy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(samples, "baseline_dir", lambda: toy / "shipped")
    run_plans(plan_chapter("90")[0], workers=1, force=False)
    for name in ("metrics", "claims", "run"):
        valid(name, json.loads(Path(f"results/chapter90/decay/{name}.json").read_text("utf-8")))
    summary = sampling.run("90", "decay", 9, Path("results"), workers=1)
    valid("study", json.loads(summary.read_text("utf-8")))
    for line in summary.with_suffix(".jsonl").read_text("utf-8").splitlines():
        valid("sample", json.loads(line))
    capsys.readouterr()
    cli.main(["check", "chapter=90", "--json"])
    assert valid("check", json.loads(capsys.readouterr().out))["chapters"][0]["new"]


def test_what_is_shipped_and_listed_is_as_the_schemas_say() -> None:
    valid("list", listing())
    stored = list((ROOT / "results/baselines").glob("chapter*/*.json"))
    assert stored
    for path in stored:
        valid("baseline", json.loads(path.read_text("utf-8")))
    valid("crosscheck", json.loads((ROOT / "results/baselines/crosscheck.json").read_text("utf-8")))
    for path in (ROOT / "results/baselines/study").glob("*.json"):
        valid("study", json.loads(path.read_text("utf-8")))


def test_the_configuration_is_as_its_schema_says_and_a_mistake_is_not() -> None:
    """The schema that an editor gets for files of the user's own."""
    found = Draft202012Validator(schema())
    found.check_schema(found.schema)
    for number in chapters.numbers():
        found.validate({key: value for key, value in compose_chapter(number).items() if key != "hydra"})
    for wrong in (
        {"movement_estimation": {"duration": "long"}},
        {"force_tracking": {"motion": "jump"}},
        {"movement_estimation": 3},
    ):
        assert not found.is_valid(wrong)
    described = found.schema["properties"]["movement_estimation"]["properties"]["rest_length"]["description"]
    assert re.fullmatch(r"\[m\] chosen: .+ \([\d.]+ to [\d.]+\)", described)


STORED = {"value": 1, "rtol": 0, "atol": 0}


@pytest.mark.parametrize(
    ("name", "data", "keys", "wrong"),
    [
        ("metrics", {"decay.plain.end": 1.0}, ["decay.plain.end"], "1.0"),
        ("metrics", {"decay.plain.end": None}, ["no name of a metric"], 1.0),
        ("baseline", {"metrics": {"a.b": STORED}, "claims": {}}, ["metrics", "a.b", "rtol"], -1),
        ("sample", {"index": 0, "values": {}, "cases": {"a": {"content": "", "seconds": 1}}}, ["index"], -1),
    ],
)  # fmt: skip
def test_what_is_wrong_is_noticed(name: str, data: dict[str, Any], keys: list[str], wrong: Any) -> None:
    valid(name, data)
    spoilt = inner = copy.deepcopy(data)
    for key in keys[:-1]:
        inner = inner[key]
    inner[keys[-1]] = wrong
    with pytest.raises(ValidationError):
        valid(name, spoilt)
