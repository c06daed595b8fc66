"""Words of the command line select chapters and experiments."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from dexrepro.cli import main
from dexrepro.overrides import parsed
from dexrepro.result import Result
from dexrepro.selection import chapters_of, needs_of, of_chapter, quoted
from dexrepro.storage import read_json


def test_experiments_of_several_chapters_go_each_to_its_own() -> None:
    numbers, rest = chapters_of(["only=lyapunov,keep_out,hand_over", "workers=1"])
    assert numbers == ["1", "6"]
    assert of_chapter("1", numbers, rest) == ["only=[lyapunov,hand_over]", "workers=1"]
    assert of_chapter("6", numbers, rest) == ["only=[keep_out]", "workers=1"]


def test_a_name_that_no_chapter_has_is_left_to_be_refused() -> None:
    assert of_chapter("1", ["1", "6"], ["only=[lyapunof,keep_out]"]) == ["only=[lyapunof]"]
    both = ["keep_out.step=1", "+hand_over.cases.a.step=2", "shared.step=3"]
    assert of_chapter("1", ["1", "6"], both) == both[1:], "a value reaches the chapter whose experiment has it"


NAMES = ["letter (1).csv", "Übung_größe.csv", "a=b.csv", "trial[1].csv", "Öl & Büro (neu)/x.csv", "it's #1.csv",
         "~/x", "/data/run (2)/res", "a;b.csv", 'a "b".csv', "x{1}.csv", "文.csv"]  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("key", ["results", "letter_accuracy.demonstrations", "scene.arm.path", "+scene"])
def test_names_of_files_are_typed_as_in_any_shell_tool(key: str, name: str) -> None:
    override = parsed(quoted(f"{key}={name}"))
    assert override is not None
    assert override.value() == name


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("a.demonstrations={w: letter (1).csv, a: größe=1.csv}", {"w": "letter (1).csv", "a": "größe=1.csv"}),
        ("a.demonstrations=[a (1).csv, b.csv]", ["a (1).csv", "b.csv"]),
        ("scene.leader={csv: {file: trial (1).csv, unit: cm}}", {"csv": {"file": "trial (1).csv", "unit": "cm"}}),
        ("results=2026", "2026"),
        ("results=1e3", "1e3"),
        ("+scene=7", "7"),
        ("results='a b'", "a b"),
        ("a.duration = 2", 2),
    ],
)
def test_lists_of_names_and_names_like_numbers_are_understood(word: str, value: Any) -> None:
    override = parsed(quoted(word))
    assert override is not None
    assert override.value() == value


def test_a_name_with_a_comma_is_a_name_where_there_is_such_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for word in ("a.demonstrations=one,two.csv", "seed=1", "a.path=2026"):
        assert quoted(word) == word
        (tmp_path / word.partition("=")[2]).touch()
    assert quoted("a.demonstrations=one,two.csv") == "a.demonstrations='one,two.csv'"
    assert quoted("a.path=2026") == "a.path='2026'"
    assert quoted("seed=1") == "seed=1"


@pytest.mark.parametrize(
    "word",
    ["seed=range(10)", "only=a,b", "a.x=[1,2", "a.x='b", "quiet=true", "a.x=1e-3", "-m", "--config-dir=Öl",
     "a.law={_target_: m.L}", "+s.cases={a: {b: ${s.c}}}", "~a.b", "results=a,b"],
)  # fmt: skip
def test_hydras_own_grammar_is_left_alone(word: str) -> None:
    assert quoted(word) == word


@pytest.mark.parametrize("command", ["run", "check", "study", "draw"])
def test_a_case_is_not_looked_for_in_the_whole_book(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "case=sigma10"]) == 2
    assert "case = sigma10: of which experiment? add only=EXPERIMENT" in capsys.readouterr().err


def test_a_claim_is_run_by_its_cases(toy: Path) -> None:
    assert needs_of(["claim=C90.01", "seed=1"]) == ["seed=1", "only=decay", "case=[fast,plain]"]
    assert needs_of(["claim=C90.01", "case=gain*"]) == ["case=gain*", "only=decay"]
    assert main(["run", "claim='C90.01'", "quiet=true", "workers=1"]) == 0
    (folder,) = Path("results/runs").glob("decay-*")
    verdicts = {claim["id"]: claim["verdict"] for claim in Result(folder).claims}
    assert verdicts["C90.01"] == "reproduced"
    assert verdicts["C90.03"] == "not evaluated"


def test_some_cases_run_alone_as_a_result_of_their_own(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "chapter=90", "only=decay", "cases=gain*", "case_timeout=null", "workers=1"]) == 0
    text = capsys.readouterr().out
    assert "decay.gain1" in text
    assert "decay.plain" not in text
    (result,) = Path("results/runs").glob("decay-*/run.json")
    assert sorted(read_json(result)["cases"]) == ["gain1", "gain2"]
    assert not Path("results/chapter90/decay").exists(), "some cases do not stand for the whole result"
    assert main(["check", "chapter=90", "only=decay", "cases=gain*"]) == 1, "all is new without a baseline"
    assert "0 missing" in capsys.readouterr().out
    assert main(["draw", "chapter=90", "only=decay", "cases=gain*"]) == 0
    assert main(["run", "chapter=90", "only=decay", "case=fast,plain", "workers=1"]) == 0
    assert main(["run", "chapter=90", "only=decay", "case=gain7"]) == 2
    assert "unknown case 'gain7' of decay: did you mean 'gain" in capsys.readouterr().err
    assert main(["run", "chapter=90", "only=decay", "case=*", "workers=1"]) == 0
    assert Path("results/chapter90/decay/run.json").exists(), "all cases are the whole result"
