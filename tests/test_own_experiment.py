"""Experiments of a user's own: what a command says next can be typed as it stands."""

from __future__ import annotations

import copy
import os
import pickle
import shutil
import time
from pathlib import Path

import pytest
from conftest import TOY, Command

from dexrepro import chapters
from dexrepro.unread import Watched, unread


@pytest.fixture
def mine(command: Command, monkeypatch: pytest.MonkeyPatch) -> Command:
    """A folder ``more`` with a chapter ``lab`` of one claim, found by ``--experiments`` alone, beside the toy book."""
    monkeypatch.setattr(chapters, "NAMED", {})
    before = os.environ[chapters.ADDED]
    left = shutil.ignore_patterns("needs_more", "equations.yaml", "errata.py", "__pycache__")
    folder = shutil.copytree(TOY / "chapter90", Path("more/lab"), ignore=left)
    (folder / "decay").rename(folder / "fade")
    for name in ("claims.py", "figures.py", "experiment.py"):
        path = folder / "fade" / name
        path.write_text(path.read_text().replace("decay.", "fade.").replace("C90.0", "lab.0").replace("90.", "lab."))

    def run(text: str) -> tuple[int, str]:
        monkeypatch.setenv(chapters.ADDED, before)
        chapters.NAMED.clear()
        chapters.forget()
        return command(text)

    return run


@pytest.mark.parametrize("name", ["lab.01", "fade"])
def test_what_show_says_to_run_finds_the_experiment(mine: Command, name: str) -> None:
    status, said = mine(f"show {name} --experiments more")
    assert status == 0, said
    commands = [line.partition("$ dexrepro ")[2] for line in said.splitlines() if "$ dexrepro " in line]
    assert commands
    assert all(" --experiments more chapter=lab " in text for text in commands)
    run = commands[0].replace("'", "")  # as a shell reads it
    assert mine(f"{run} workers=1 quiet=true")[0] == 0


def test_show_says_where_a_claim_of_any_name_is_written(mine: Command) -> None:
    assert "written in  more/lab/fade/claims.py:" in mine("show lab.01 --experiments more")[1]


def test_missing_results_are_run_by_the_command_that_is_given(mine: Command) -> None:
    Path("there").mkdir()
    status, said = mine("check --experiments more chapter=lab only=fade results=there")
    assert status == 2
    assert "run: dexrepro run --experiments more chapter=lab only=fade results=there" in said
    status, said = mine("draw --experiments more only=fade style=slides results=there")
    assert status == 2
    assert said.rstrip().endswith("run first: dexrepro run --experiments more only=fade results=there")


def test_a_result_of_an_experiment_that_is_not_named_is_not_called_damaged(mine: Command) -> None:
    assert mine("run --experiments more only=fade workers=1 quiet=true")[0] == 0
    status, said = mine("diff results/chapterlab/fade results/chapterlab/fade")
    assert status == 2
    assert "name its folder, --experiments DIR" in said
    assert "delete" not in said
    assert mine("diff --experiments more results/chapterlab/fade results/chapterlab/fade")[0] == 0


def test_the_report_gives_commands_that_find_the_experiment(mine: Command) -> None:
    assert mine("run --experiments more only=fade workers=1 quiet=true")[0] == 0
    assert mine("report --experiments more")[0] == 0
    page = Path("results/report/chapterlab.html").read_text()
    assert "dexrepro run --experiments more chapter=lab only=fade" in page
    assert "dexrepro run chapter=lab" not in page


def test_a_folder_may_be_named_twice_and_one_that_adds_nothing_is_refused(
    mine: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert mine("list --experiments more --experiments more")[0] == 0
    shutil.copytree("more/lab", "again/lab")
    for name in ("again", "results"):
        Path(name).mkdir(exist_ok=True)
        status, said = mine(f"list --experiments more --experiments {name}")
        assert status == 2
        assert f"--experiments = {name} adds nothing" in said


def test_an_experiment_that_is_added_to_a_known_folder_is_found(mine: Command) -> None:
    for path in (Path("more"), *Path("more").rglob("*")):
        os.utime(path, (0, time.time() - 100))  # so that what follows from them is kept
    assert "fade:" in mine("--experiments more list chapter=lab")[1]
    shutil.copytree("more/lab/fade", "more/lab/glow")
    Path("more/lab/glow/claims.py").unlink()
    code, text = mine("--experiments more list chapter=lab")
    assert (code, "glow:" in text) == (0, True), text


CLAIM = "from dexrepro.claims import Claim, less\nclaim = Claim('lab.09', '', 'falls', less('fast.final', 1))\n"


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("lab/fade/experiment.py", "def simulate(:", "lab/fade/experiment.py:1: SyntaxError: invalid syntax"),
        ("lab/fade/claims.py", "\nCLAIMS = (1 / 0,)", "lab/fade/claims.py:2: ZeroDivisionError: division by zero"),
        ("lab/fade/figures.py", "import nosuch", "figures.py:1: ModuleNotFoundError: No module named 'nosuch'"),
        ("lab/__init__.py", "raise SystemExit(3)", "lab/__init__.py:1: SystemExit: 3"),
        (
            "lab/fade/claims.py",
            f"{CLAIM}CLAIMS = claim",
            "fade/claims.py: CLAIMS must be a tuple of Claim, a comma behind",
        ),
        (
            "lab/fade/claims.py",
            "CLAIMS = ('lab.01',)",
            "CLAIMS must be a tuple of Claim, a comma behind each; it has 'lab",
        ),
        ("lab/fade/claims.py", f"{CLAIM}CLAIMS = (claim,)", "lab.09 is about 'fast.final', and no experiment of the"),
        ("lab/fade/figures.py", "FIGURES = {'lab.10': 'falls'}", "FIGURES must have a Figure for each name; it has 'f"),
        ("lab/fade/figures.py", "FIGURES = ['lab.10']", "FIGURES must have a Figure for each name; it has ["),
        ("lab/fade/config.yaml", "a:\n\tb: 2\n", "that cannot start any token; a tab cannot indent, write spa"),
        ("lab/fade/config.yaml", "a: 1\na: 2\n", "is no YAML file: line 2: while constructing a mapping: found dupl"),
        ("lab/fade/config.yaml", None, "experiment 'fade' has no block in its chapter's configuration"),
    ],
)
def test_what_is_wrong_in_a_file_of_an_experiment_is_said_with_its_line(
    mine: Command, name: str, content: str | None, said: str
) -> None:
    path = Path("more", name)
    path.unlink(missing_ok=True)
    if content is not None:
        path.write_text(content)
    code, text = mine("--experiments more list chapter=lab")
    assert (code, said in text) == (2, True), text


def test_a_chapter_is_listed_alone_with_its_claims(mine: Command) -> None:
    status, said = mine("list --experiments more chapter=lab")
    assert status == 0, said
    assert "lab.01: the fast one decays more" in said
    assert "Chapter 90" not in said
    assert mine("check --experiments more chapter=lab --update")[0] == 0
    assert "lab.01 (reproduced): the fast one decays more" in mine("list --experiments more chapter=lab")[1]


def test_a_claim_says_of_which_chapter_it_is(mine: Command) -> None:
    status, said = mine("study --experiments more claim=lab.01 samples=1 workers=1")
    assert status == 0, said
    assert "lab.01: holds in" in said
    status, said = mine("study --experiments more chapter=90 claim=lab.01")
    assert status == 2
    assert "claim = lab.01 is of chapter lab, not of 90" in said


def test_a_value_that_a_case_does_not_set_yet_is_added_as_it_is_told(mine: Command) -> None:
    status, said = mine("run only=decay decay.cases.plain.start=0.5 case=plain workers=1")
    assert status == 2
    assert "add it, '+decay.cases.plain.start=0.5'" in said
    assert mine("run only=decay +decay.cases.plain.start=0.5 case=plain workers=1")[0] == 0


def test_without_a_film_to_renew_it_is_said_what_can_be_animated(mine: Command) -> None:
    assert "a FOLDER or only=EXPERIMENT" in mine("render --experiments more chapter=lab")[1]


MEASURE, DRAW = "    if not recording.series:", '    return {"lab.10": figure}'


@pytest.mark.parametrize(
    ("file", "line", "instead", "said"),
    [
        ("experiment", MEASURE, "    return", "measure gave None; it must return a dictionary of numbers"),
        ("experiment", MEASURE, "    return [2]", "measure gave [2]; it must return a dictionary of numbers"),
        ("experiment", MEASURE, '    return {"a": "b"}', "measure gave {'a': 'b'}; it must return a dictionary of"),
        ("experiment", MEASURE, '    return {"a": recording["x"]}', "measure gave {'a': array("),
        (
            "experiment",
            'return Recording({"time"',
            'Recording({"time"',
            "simulate gave None; it must return a Recording",
        ),
        ("experiment", '    return {"ratio"', '    {"ratio"', "summarise gave None; it must return a dictionary of"),
        ("figures", DRAW, "", "draw gave None; it must return a dictionary of figures"),
        ("figures", DRAW, '    return {"lab.10": axes}', "draw gave {'lab.10': <Axes"),
        ("figures", DRAW, '    return {"lab.9": figure}', "draw gave 'lab.9', not in FIGURES;"),
        ("figures", '    return {"Tlab.1"', '    {"Tlab.1"', "tabulate gave None; it must return a dictionary of data"),
    ],
)
def test_what_a_function_of_an_experiment_gives_is_named_where_it_is_of_no_use(
    mine: Command, file: str, line: str, instead: str, said: str
) -> None:
    path = Path("more/lab/fade", f"{file}.py")
    assert line in path.read_text()
    path.write_text(path.read_text().replace(line, instead + f"\n{line}" * (line == MEASURE), 1))
    status, text = mine("run --experiments more chapter=lab only=fade workers=1")
    assert (status, f"failed: {file}.py: {said}" in text) == (1, True), text
    assert "damaged" not in text


@pytest.mark.parametrize(
    ("file", "line", "code", "said"),
    [
        ("experiment", MEASURE, "1 / 0", "ZeroDivisionError: division by zero"),
        ("experiment", MEASURE, "assert not recording", "AssertionError: assert not recording"),
        ("experiment", MEASURE, "raise SystemExit(3)", "SystemExit: 3"),
        ("experiment", MEASURE, "return return", "SyntaxError: invalid syntax"),
        ("figures", DRAW, "1 / 0", "ZeroDivisionError: division by zero"),
    ],
)
def test_an_error_in_code_of_ones_own_is_said_with_its_line(
    mine: Command, file: str, line: str, code: str, said: str
) -> None:
    path = Path("more/lab/fade", f"{file}.py")
    before, _, after = path.read_text().partition(line)
    path.write_text(f"{before}    {code}\n{line}{after}")
    status, text = mine("run --experiments more chapter=lab only=fade workers=1")
    assert status == 1
    assert f"failed: {said} (more/lab/fade/{file}.py, line {before.count(chr(10)) + 1})" in text
    assert "in " in Path(text.rpartition("traceback: ")[2].split(";")[0].strip()).read_text()


def test_a_figure_that_is_not_drawn_is_named(mine: Command) -> None:
    path = Path("more/lab/fade/figures.py")
    path.write_text(path.read_text().replace(DRAW, "    return {}"))
    status, text = mine("run --experiments more chapter=lab only=fade workers=1")
    assert (status, "fade: draw in figures.py made no lab.10" in text) == (0, True), text


def test_a_key_that_nothing_reads_is_named(mine: Command) -> None:
    path = Path("more/lab/fade/config.yaml")
    path.write_text(f"{path.read_text()}raet: 3.0\nfigure: {{label: x}}\nbounds: {{low: 1, hihg: 2}}\n")
    code = Path("more/lab/fade/experiment.py")
    code.write_text(code.read_text().replace("    if config.pause:", "    config.bounds.low\n    if config.pause:"))
    figures = Path("more/lab/fade/figures.py")
    figures.write_text(figures.read_text().replace("label=case", "label=case + config.figure.label"))
    for _ in range(2):  # also when it is taken from the cache
        status, text = mine("run --experiments more chapter=lab only=fade workers=1")
        assert (status, "fade.raet, fade.bounds.hihg: no case that was run reads them" in text) == (0, True), text
    status, text = mine("run --experiments more only=fade fade.raet=2 case=plain workers=1")
    assert (status, "warning: fade.raet, " in text) == (0, True), text


def test_a_configuration_knows_what_was_read_of_it() -> None:
    config = Watched.of(
        {"a": {"b": 1, "c": 2}, "d": [{"e": 1, "f": 2}], "g": {"h": 1}, "i": {"j": {"k": 1}}, "seed": 0}
    )
    assert [*unread(config)] == ["a", "d", "g", "i"]
    assert (config.a.b, config["d"][0].get("e"), {**config.g}) == (1, 1, {"h": 1})
    assert dict(config.i) == {"j": {"k": 1}}
    assert "nothing" not in config
    assert config.get("nothing", 3) == 3
    assert [*unread(config)] == ["a.c", "d.0.f", "i.j.k"]
    assert copy.deepcopy(config) == pickle.loads(pickle.dumps(config)) == config
    assert [*unread(config)] == []


def test_a_claim_about_a_metric_that_is_not_there_is_named(mine: Command) -> None:
    path = Path("more/lab/fade/claims.py")
    path.write_text(path.read_text().replace("fade.fast.final", "fade.fats.final"))
    status, text = mine("run --experiments more chapter=lab only=fade workers=1")
    said = "lab.01 is not evaluated, there is no metric 'fade.fats.final': did you mean 'fade.fast.final'?"
    assert (status, said in text) == (0, True), text


def test_a_claim_that_is_there_twice_is_named(mine: Command) -> None:
    path = Path("more/lab/fade/claims.py")
    path.write_text(f"{path.read_text()}\nCLAIMS = 2 * tuple(CLAIMS)\n")
    status, text = mine("list --experiments more chapter=lab")
    assert (status, "lab.01 names more than one claim" in text) == (2, True), text


@pytest.mark.parametrize(("written", "instead"), [("010", "10 or 8"), ("1:30", "90"), ("007", ""), ('"010"', "")])
def test_what_yaml_takes_for_another_number_is_refused_with_its_line(mine: Command, written: str, instead: str) -> None:
    path = Path("more/lab/fade/config.yaml")
    path.write_text(path.read_text() + f"more: {written}\n")
    status, text = mine("run --experiments more chapter=lab only=fade case=plain workers=1")
    if instead:
        line = path.read_text().count("\n")
        assert status == 2
        assert f"lab/fade/config.yaml: line {line}: YAML takes {written} for" in text
        assert f"; write {instead}, or '{written}' in quotes where it is a text" in text
    else:
        assert status == 0, text
