"""What a hurried user types, or finds on a damaged disk, gets one sentence and leaves the results as they are."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from dexrepro import cli
from dexrepro.checks import check_keys, check_lengths, check_types
from dexrepro.commands.run import run_command
from dexrepro.errors import InputError
from dexrepro.plan import plan_chapter

RESULT = Path("results/chapter90/decay")


@pytest.fixture
def result(toy: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The toy chapter has been run in this folder."""
    monkeypatch.setattr(sys, "path", [*sys.path])
    assert cli.main(["run", "workers=1", "quiet=true"]) == 0
    return toy / RESULT


@pytest.mark.parametrize(
    ("override", "sentence"),
    [
        ("seed=-1", "seed = -1 is not allowed: it must be a whole number of 0 or greater"),
        ("seed=true", "seed = True is not allowed"),
        ("workers=true", "workers = True is not allowed"),
        ("results=null", "results = None is not allowed: it must be the name of a folder"),
        ("force=perhaps", "force = perhaps is not allowed: it must be true or false"),
        ("figure=[90.1,90.2]", "it must be one figure or table"),
        ("+decai.rate=2", "unknown key 'decai': did you mean 'decay'?"),
        ("decay.cases=5", "decay.cases = 5 is not allowed: cases are names with what each changes"),
        ("+decay.cases.mine=5", "decay.cases.mine = 5 is not allowed"),
        ("+scene=squeeze", "needs --config-dir FOLDER, the folder that holds scene/squeeze.yaml"),
        ("decay.gains=[]", "a list that a case is made of is empty"),
        ("decay.duration=null", "decay.duration = null is not allowed: it must be a number"),
        ("decay.start=false", "decay.start = False is not allowed: it must be a number"),
        ("decay.gains=[1,two]", "decay.gains.1 = 'two' is not allowed: it must be a number"),
        (
            "decay.duration=1e30",
            "decay.duration = 1e+30 is not allowed: it must be 100000 s at most, 10000000 steps of",
        ),
        ("decay.pause=1e30", "decay.pause = 1e+30 is not allowed: it must be 100000 s at most"),
        (
            "decay.step=1e-30",
            "decay.duration = 2 is not allowed: it must be 1e-23 s at most, 10000000 steps of decay.step",
        ),
        ("decay.step=[0.1,0.2]", "decay.step = [0.1, 0.2] is not allowed: it must be a number"),
        ("decay", "'decay' is not an override of the form key=value, such as"),
        ("+decay.cases.größe={}", "; a key has letters from a to z alone"),
        ("decay.cases.mine={rate: 3}", "decay has no case 'mine': add it, '+decay.cases.mine={rate: 3}'"),
        ("decay.rate=1,2", "'decay.rate=1,2' is a sweep, which needs -m, a run for each value"),
        ("sed=3", "unknown key 'sed': did you mean 'seed'?"),
        ("claim=C90.1", "unknown claim 'C90.1': did you mean 'C90.01'?"),
    ],
)
def test_a_wrong_value_names_its_key_and_what_is_allowed(toy: Path, override: str, sentence: str) -> None:
    cut = ["decay.cases={}", "~decay.cases.plain", "~decay.cases.fast", "~decay.cases.halved"]
    with pytest.raises(InputError) as caught:
        run_command([*(cut if "[]" in override else []), "only=decay", override])
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("check", "given", "sentence"),
    [
        (check_types, {"on": 1}, "e.on = 1 is not allowed: it must be true or false"),
        (check_types, {"on": "maybe"}, "e.on = 'maybe' is not allowed: it must be true or false"),
        (check_types, {"law": "my_law.Mine"}, "e.law = 'my_law.Mine' is not allowed: it must hold keys with values"),
        (check_lengths, {"place": 1}, "e.place = 1 is not allowed: it must have 2 values"),
        (check_lengths, {"lengths": 1}, "e.lengths = 1 is not allowed: it must have 2 values"),
        (check_keys, {"figure": {"wide": 3}}, "unknown key 'e.figure.wide': did you mean 'width'?"),
    ],
)
def test_a_value_of_another_kind_or_a_key_that_is_not_there_is_refused(
    check: Callable[..., None], given: dict[str, object], sentence: str
) -> None:
    shipped = {"on": True, "law": {"_target_": "a.B"}, "place": [0, 1], "lengths": [1, 1], "figure": {"width": 2}}
    with pytest.raises(InputError) as caught:
        check(given, shipped, "e")
    assert sentence in str(caught.value)
    check({"on": False, "law": {"_target_": "a.C", "gain": 1}, "place": [2, 3], "lengths": [1]}, shipped, "e")


def test_a_value_that_the_cases_to_run_do_not_have_is_said_to_be_without_effect(toy: Path) -> None:
    differs = {case: plan_chapter("90", ["only=decay", "decay.rate=3", f"case={case}"])[0][0].differs
               for case in ("fast", "plain")}  # fmt: skip
    assert differs["fast"][0].endswith("(book: 2.0), without effect: every case that is run sets its own")
    assert differs["plain"][0] == "rate=3 (book: 2.0)"


def test_null_still_turns_a_number_off_that_is_no_quantity(toy: Path) -> None:
    plans, _ = plan_chapter("90", ["only=decay", "decay.gain=null"])
    assert plans[0].jobs[0].config["gain"] is None


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"only: [a\n b: c: d\n", "bad.yaml is no YAML file: line 2: while parsing a flow sequence"),
        (b"\tonly: decay\n", "bad.yaml is no YAML file"),
        (b"# mine\nonly: caf\xe9\n", "bad.yaml: line 2 is not UTF-8; save the file as UTF-8"),
        (b"- a\n", "bad.yaml holds no keys"),
        (
            b"a0: &a0 [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n"
            + b"".join(b"a%d: &a%d [%s]\n" % (n, n, b", ".join([b"*a%d" % (n - 1)] * 10)) for n in range(1, 9)),
            "bad.yaml is no YAML file: it is nested too deeply or stands for more than a million values",
        ),
    ],
)
def test_a_file_of_the_user_that_is_no_yaml_is_named(toy: Path, content: bytes, sentence: str) -> None:
    (toy / "mine $=1/own").mkdir(parents=True)
    (toy / "mine $=1/own/bad.yaml").write_bytes(content)
    with pytest.raises(InputError) as caught:
        run_command(["--config-dir", "mine $=1", "+own=bad"])
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def cut_short(name: str) -> Callable[[Path], object]:
    return lambda folder: (folder / name).write_bytes((folder / name).read_bytes()[:60])


@pytest.mark.parametrize(
    ("damage", "commands", "sentence"),
    [
        (cut_short("run.json"), ("draw", "report", f"render {RESULT}", f"diff {RESULT} {RESULT}", "check"), "run.json"),
        (cut_short("metrics.json"), ("draw", "report", f"diff {RESULT} {RESULT}", "check"), "metrics.json cannot be"),
        (lambda folder: (folder / "claims.json").unlink(), ("report", "check"), "claims.json cannot be used (No such"),
        (lambda folder: (folder / "run.json").write_text("{}"), ("draw", "report"), "it has no 'chapter'"),
        (lambda folder: (folder / "metrics.json").write_text("[1]"), ("draw", "check"), "it holds no dict"),
        (lambda folder: (folder / "config.yaml").write_text("a: [b"), ("draw", f"diff {RESULT} {RESULT}"), "g.yaml c"),
        (cut_short("series/plain.csv.gz"), ("draw", f"diff {RESULT} {RESULT}"), "plain.csv.gz cannot be used"),
        (lambda folder: (folder / "series/plain.csv.gz").unlink(), ("draw",), "no series of the case 'plain'"),
    ],
)  # fmt: skip
def test_a_damaged_result_is_named(
    result: Path, damage: Callable[[Path], object], commands: tuple[str, ...], sentence: str
) -> None:
    damage(result)
    left = sorted(Path("results").rglob("*.*"))
    for command in commands:
        with pytest.raises(InputError) as caught:
            cli._dispatch([*command.split()])
        assert sentence in str(caught.value), command
        assert "delete the result and run it again" in str(caught.value)
        assert "\n" not in str(caught.value)
    assert sorted(Path("results").rglob("*.*")) == left


def test_a_result_that_cannot_be_drawn_is_named_and_stays(
    result: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def lacking(*_: object) -> None:
        raise AttributeError("no configuration key 'demonstrations'")

    monkeypatch.setattr("dexrepro.result.present", lacking)
    before = {path: path.read_bytes() for path in result.rglob("*.*")}
    assert cli.main(["draw"]) == 1
    assert "decay cannot be drawn, run it again: AttributeError: no configuration key" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in result.rglob("*.*")} == before


@pytest.mark.parametrize(
    ("command", "sentence"),
    [
        ("draw results=nowhere", "results = nowhere is not allowed: there is no such folder"),
        ("report results=nowhere", "results = nowhere is not allowed"),
        ("draw only=decay results=.", "there is no such result in ."),
        ("diff a b --html metrics.json", "--html = metrics.json is not allowed: it must be the name of a page"),
        ("draw figure=90.77", "unknown figure '90.77'"),
        ("check workers=two", "workers = two is not allowed"),
        ("render case=plain", "of which experiment?"),
        ("study only=decai samples=1", "did you mean 'decay'?"),
        ("study claim=C90.99", "unknown claim 'C90.99': did you mean 'C90.0"),
        ("study samples=0", "samples = 0 is not allowed: it must be a whole number of 1 or greater"),
        ("study samples=-3", "samples = -3 is not allowed"),
        ("study hours=nan", "hours = nan is not allowed: it must be a number greater than 0"),
        ("study hours=-1", "hours = -1 is not allowed"),
        ("study smaples=3", "there are: chapter=N, only=EXPERIMENT, figure=ID, results=DIR, case=NAME, claim=ID, "),
        ("new controller Random", "random.py would hide the module 'random'"),
        ("new controller None", "it must be a class name such as MyLaw"),
    ],
)
def test_a_wrong_argument_of_another_command_is_refused(toy: Path, command: str, sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        cli._dispatch(command.split())
    assert sentence in str(caught.value)
    assert not list(toy.iterdir()), "nothing has been written"


def test_a_file_that_cannot_be_written_is_named(
    result: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device", "results/report")

    monkeypatch.setattr("dexrepro.report.page.whole_folder", full)
    assert cli.main(["report"]) == 2
    assert capsys.readouterr().err == "dexrepro: results/report: No space left on device\n"


def test_a_folder_that_cannot_be_copied_is_named_by_its_first_file(
    result: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*_: object, **__: object) -> None:
        raise shutil.Error([(name, name, f"[Errno 28] No space left on device: '{name}'") for name in ("a.js", "b.js")])

    monkeypatch.setattr("dexrepro.report.page.whole_folder", full)
    assert cli.main(["report"]) == 2
    assert capsys.readouterr().err == "dexrepro: cannot copy files: [Errno 28] No space left on device: 'a.js'\n"


def test_check_of_one_experiment_needs_no_other(toy: Path) -> None:
    assert cli.main(["check", "chapter=90"]) == 2, "nothing has been run"
    assert cli.main(["check", "only=needs_more"]) == 0, "it is skipped here, and decay was not asked for"


def test_diff_names_the_other_result_and_shortens_what_is_long(toy: Path, capfd: pytest.CaptureFixture[str]) -> None:
    long = f"decay.gains=[{','.join(map(str, range(1, 99)))}]"
    for more in ("{rate: 3}",), ("{rate: 4}", long):
        words = [f"+decay.cases.book={more[0]}", *more[1:]]
        assert cli.main(["run", "only=decay", "case=book", *words, "workers=1", "quiet=true"]) == 0
    first, second = sorted(Path("results/runs").glob("decay-*"), key=lambda path: path.stat().st_mtime)
    capfd.readouterr()
    assert cli.main(["diff", str(second), str(first)]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert f"config   cases.book.rate=4 ({first}: 3)" in lines, "a case may be called book"
    (gains,) = (line for line in lines if line.startswith("config   gains=[1, 2, 3,"))
    assert gains.endswith(f" ... ({first}: [1, 2])")


def test_drawing_a_result_that_is_in_no_figure_says_so(
    result: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("dexrepro.report.export.export", lambda *_: [])
    assert cli.main(["draw", str(RESULT), "style=dark"]) == 0
    assert f"{RESULT}: none of its figures shows the cases that were run" in capfd.readouterr().out
