"""What is typed, and what surrounds a command: one sentence, a status, and nothing lost."""

from __future__ import annotations

import ast
import shutil
from pathlib import Path

import pytest
from conftest import ROOT, Command, Shell, whole

from dexrepro import chapters

pytestmark = pytest.mark.usefixtures("bounded")
HUGE = "9" * 400


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("+decay.cases.q={each:nosuch}", "decay.cases.q.each: unknown key 'nosuch'"),
        ("+decay.cases.q={each:5}", "decay.cases.q.each: unknown key '5'"),
        ("~seed", "'seed' cannot be left out"),
        ("~results", "'results' cannot be left out"),
        ("~decay", "experiment 'decay' has no block"),
        ("decay=5", "decay = 5 is not allowed: it must hold keys with values"),
        (f"seed={HUGE}", "seed = 9999"),
        (f"decay.start={HUGE}", "decay.start = 9999"),
        (f"decay.start=-{HUGE}", "decay.start = -9999"),
        ("decay.start=inf", "decay.start = inf is not allowed: it must be a finite number"),
        ("decay.start=1e300", "decay.start = 1e+300 is not allowed: it must be 0, or 1e-50 to 1e+50 in size"),
        ("decay.start=-1e-300", "decay.start = -1e-300 is not allowed: it must be 0, or 1e-50 to 1e+50 in size"),
        ("+decay.cases.summary={}", "'summary' is not allowed as a name"),
        ("+decay.cases={a.b:{}}", "is not allowed"),
        (f"+decay.cases.{'q' * 61}={{}}", "is not allowed as a name: use up to 60 letters"),
        ("+decay.cases={../up:{}}", "is not"),
        ("+decay.nan=1", "unknown key 'decay.nan'"),
        ("+decay.1.5=1", "unknown key"),
        ("hydra=5", "must be a string or a list"),
        ("workers=60.5", "workers = 60.5 is not allowed"),
        ("case_timeout=-1", "case_timeout = -1 is not allowed"),
        ("case_timeout=never", "case_timeout = never is not allowed"),
        ("case_timeout=true", "case_timeout = True is not allowed"),
        ("seed=${nosuch}", "seed = ${nosuch} is not allowed"),
        ("decay.rate=${nosuch.key}", "decay"),
        ("decay.rate=${decay.rate}", "decay"),
        ("shared=null", "decay"),
        ("decay.start=\udcff", "is not"),
        ("decay.law._target_=os.system", "cannot build the objects"),
        ("decay.law._target_=nosuch.Law", "cannot build the objects"),
        ("decay.law._target_=5", "decay"),
        ("+decay.rate.z=1", "decay.rate = {'z': 1} is not allowed: it must be a number"),
        ("decay.start=true", "decay.start = True is not allowed: it must be a number"),
        ("decay.start=[1,2]", "differs from the book in: start=[1, 2] (book: 1.0)"),
        ("decay.start=null", "differs from the book in: start=None (book: 1.0)"),
        ("~decay.start", "no configuration key 'start'"),
        ("decay.start=${.start}", "decay"),
        ("decay.start=${oc.env:NO_SUCH_VARIABLE}", "decay.start"),
        ("decay.start=" + "[" * 400 + "]" * 400, "nested too deeply"),
        ("decay.start=" + "1" * 5000, "must be a number"),
        ("decay.start=nan", "must be a finite number"),
        ("decay.duration=-1", "decay.duration = -1 is not allowed: it must be greater than 0"),
        ("decay.step=", "decay.step = '' is not allowed: it must be a number"),
        ("+=", "'+=' is not an override of the form key=value"),
        ("+", "'+' is not an override of the form key=value"),
        ("decay.cases=[]", "decay.cases"),
        ("~decay.cases", "KeyError: 'plain'"),
        ("case=[]", "case = [] is not allowed: it must name a case"),
        ("workers=0", "workers = 0 is not allowed"),
        ("case_timeout=abc", "case_timeout = abc is not allowed"),
        ("seed=-1", "seed = -1 is not allowed"),
        ("results=~nobody-of-this-name/x", "it names no folder"),
        ("results=\0", "it names no folder"),
        ("results=" + "a" * 300, "File name too long"),
        ("results=loop/x", "Too many levels of symbolic links"),
        ("results=file", "results = file is not allowed"),
    ],
)
def test_what_cannot_be_run_says_so(toy: Path, command: Command, words: str, sentence: str) -> None:
    (toy / "loop").symlink_to("loop")
    (toy / "file").touch()
    status, said = command(f"run only=decay workers=1 {words}")
    assert status in (1, 2)
    assert sentence in " ".join(said.split())
    assert not list(toy.glob("results/*/decay*/metrics.json"))


@pytest.mark.parametrize("words", ["+decay.cases.mine=null", "~decay.cases.fast", "+decay.cases.mine.start=1.0"])
def test_another_set_of_cases_does_not_take_the_place_of_the_books_result(
    toy_result: Path, command: Command, words: str
) -> None:
    before = whole(toy_result)
    command(f"run only=decay workers=1 {words}")
    assert whole(toy_result) == before


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("check only=decai", "did you mean 'decay'?"),
        ("check chapter=91", "unknown chapter '91'"),
        ("check figure=90.11", "unknown figure '90.11'"),
        ("check --accept nosuch", "--accept nosuch has no meaning without --update"),
        (
            "check --update --accept C90.2",
            "--accept C90.2 is not allowed: these chapters have no such claim; did you mean",
        ),
        ("check --update --accept C90.02 chapter=91", "unknown chapter '91'"),
        ("check --update case=plain", "case=plain is not allowed with --update"),
        ("draw figure=T90.7", "unknown figure 'T90.7'"),
        ("study only=needs_more samples=1", "there is no claim that a study could test"),
        ("study only=decay samples=0", "samples = 0 is not allowed"),
        ("study only=decay samples=" + "9" * 5000, "1024 at most"),
        ("study only=decay workers=\u00b2", "workers = \u00b2 is not allowed"),
        ("tune case=decay.plain minimise=final budget=\u0663", "4096 at most"),
        ("study only=decay hours=-1", "hours = -1 is not allowed"),
        ("study only=decay jobs=99999999999999999999", "1024 at most"),
        ("run -m only=decay seed=range(0)", "'seed=range(0)' is not allowed: it makes 0 jobs"),
        ("run -m only=decay decay.start=range(1e9)", "it makes 1000000000 jobs, 100000 at most"),
        ("run -m only=decay decay.start=range(1,2,0)", "it makes 0 jobs"),
        ("run --resolve only=decay", "can only be used in conjunction with --cfg"),
        ("study only=decay jobs=0 hydra/launcher=basic", "jobs = 0 is not allowed"),
        ("tune case=decay.plain minimise=final budget=-3", "budget = -3 is not allowed"),
        ("compare laws=~nobody-of-this-name case=decay.plain minimise=final", "laws = '~nobody-of-this-name' is not"),
        ("show nosuch", "nosuch"),
        ("report results=loop", "results = loop is not allowed"),
        ("render nowhere", "nowhere holds no result"),
        ("draw nowhere", "nowhere holds no result"),
        ("check chapter=own", "chapter = own is not allowed for check: scenes of your own have no claims"),
        ("study chapter=own samples=1", "chapter = own is not allowed for study"),
        ("crosscheck chapter=own", "chapter = own is not allowed for crosscheck"),
        ("show C90.01 results=nowhere", "results = nowhere is not allowed: there is no such folder"),
        ("list --json --markdown", "--json and --markdown exclude each other"),
        ("render only=decay", "has no scene to render"),
        ("diff results/chapter90/decay nowhere", "nowhere holds no result"),
    ],
)
def test_a_selection_that_selects_nothing_is_named(
    toy_result: Path, command: Command, words: str, sentence: str
) -> None:
    before = whole(toy_result)
    status, said = command(words)
    assert status == 2
    assert sentence in " ".join(said.split())
    assert whole(toy_result) == before


@pytest.mark.parametrize(
    "words", ["study samples=1", "study --confirm", "study jobs=1 samples=1", "crosscheck only=decay"]
)
def test_what_is_shipped_is_not_renewed_by_what_is_the_users(
    toy: Path, command: Command, monkeypatch: pytest.MonkeyPatch, words: str
) -> None:
    for module in ("study.samples", "crosscheck"):
        monkeypatch.setattr(f"dexrepro.{module}.baseline_dir", lambda: toy / "shipped")
    status, said = command(f"{words} --update")
    assert status == 2
    assert "--update renews what is shipped, and chapter 90 is yours" in said
    assert not (toy / "shipped").exists()


@pytest.mark.parametrize("module", ["numbers", "pandas", "yaml", "json", "hydra"])
@pytest.mark.usefixtures("toy_result")
def test_a_file_of_the_user_does_not_take_the_place_of_a_package(toy: Path, shell: Shell, module: str) -> None:
    (toy / f"{module}.py").write_text("raise SystemExit('taken over')")
    done = shell("dexrepro check", timeout=55)
    assert "taken over" not in done.stdout + done.stderr
    assert "chapter 90: " in done.stdout


def test_a_law_beside_the_data_is_found(toy: Path, command: Command) -> None:
    (toy / "law_of_mine.py").write_text(
        "class Half(float):\n    def __new__(cls):\n        return super().__new__(cls, 0.5)\n"
    )
    assert command("run only=decay workers=1 +decay.cases.mine.law._target_=law_of_mine.Half")[0] == 0


@pytest.mark.parametrize(
    ("line", "environment"),
    [
        ("dexrepro check >&-", {}),
        ("dexrepro check 2>&-", {}),
        ("dexrepro check </dev/null >/dev/full", {}),
        ("dexrepro check | true", {}),
        ("dexrepro check", {"LC_ALL": "de_DE.iso88591", "PYTHONUTF8": "0"}),
        ("dexrepro check", {"LC_ALL": "C", "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}),
        ("dexrepro check", {"PYTHONOPTIMIZE": "2"}),
        ("dexrepro check", {"TERM": "dumb", "COLUMNS": "1"}),
        ("dexrepro report", {"LC_ALL": "de_DE.iso88591", "PYTHONUTF8": "0"}),
        ("dexrepro draw", {"LC_ALL": "C", "PYTHONUTF8": "0", "HOME": "/nonexistent", "MPLCONFIGDIR": "/dev/null/no"}),
    ],
)
def test_odd_surroundings_change_nothing(
    toy_result: Path, shell: Shell, line: str, environment: dict[str, str]
) -> None:
    before = (toy_result / "metrics.json").read_bytes()
    done = shell(line, timeout=55, **environment)
    assert "Traceback" not in done.stderr + done.stdout
    assert done.returncode in (0, 1, 2)
    assert (toy_result / "metrics.json").read_bytes() == before


FULL = """
from pathlib import Path

simulated = simulate


def simulate(config, rng):
    mkdir = Path.mkdir

    def full(path, *arguments, **options):
        if str(path).startswith({where!r}) and path.suffix == ".part":
            raise OSError(28, "No space left on device", str(path))
        mkdir(path, *arguments, **options)

    Path.mkdir = full
    return simulated(config, rng)
"""


def test_a_link_to_nowhere_is_named_as_one(toy: Path, command: Command) -> None:
    Path("dead").symlink_to("nowhere")
    for name in ("dead", "dead/deeper"):
        status, said = command(f"run only=decay workers=1 results={name}")
        sentence = f"results = {name} is not allowed: cannot write there (the link dead leads nowhere)"
        assert (status, sentence in said) == (2, True), said
    assert Path("dead").is_symlink()


@pytest.mark.parametrize("where", ["results/.cache", "results", "results/chapter90"])
def test_a_full_or_missing_disk_is_named(toy_result: Path, toy_book: Path, command: Command, where: str) -> None:
    """The disk is full for the process that simulates and stores, however that began."""
    before = whole(toy_result)
    with open(toy_book / "chapter90/decay/experiment.py", "a") as code:
        code.write(FULL.format(where=where))
    chapters.forget()
    status, said = command("run only=decay workers=1 force=true")
    assert status == 1
    assert "No space left on device" in said
    assert whole(toy_result) == before


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("DEXREPRO_BLAS_THREADS", "abc", "DEXREPRO_BLAS_THREADS = abc is not allowed"),
        ("DEXREPRO_BLAS_THREADS", "0", "DEXREPRO_BLAS_THREADS = 0 is not allowed"),
        ("DEXREPRO_START", "spwan", "DEXREPRO_START = spwan is not allowed: it must be one of"),
    ],
)
def test_a_variable_of_the_environment_with_a_wrong_value_is_named(
    toy: Path, command: Command, monkeypatch: pytest.MonkeyPatch, name: str, value: str, sentence: str
) -> None:
    monkeypatch.setenv(name, value)
    status, said = command("run only=decay workers=1")
    assert status == 2
    assert sentence in " ".join(said.split())


def test_every_text_file_is_utf8_by_decree() -> None:
    """Also where a system has another alphabet: no call leaves the encoding open."""
    left = []
    for path in (ROOT / "dexrepro").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            given = len(node.args) + any(keyword.arg == "encoding" for keyword in node.keywords)
            binary = any(isinstance(item, ast.Constant) and "b" in str(item.value) for item in node.args[1:2])
            if (name, given) in (("read_text", 0), ("write_text", 1)) or (
                name == "open"
                and isinstance(node.func, ast.Name)
                and given < 3
                and not binary
                and not any(keyword.arg == "encoding" for keyword in node.keywords)
            ):
                left.append(f"{path.name}:{node.lineno}")
    assert not left


def test_check_takes_experiments_of_several_chapters(toy_result: Path, toy_book: Path, command: Command) -> None:
    shutil.copytree(toy_book / "chapter90", toy_book / "chapter91")
    (toy_book / "chapter91/decay").rename(toy_book / "chapter91/other")
    (toy_book / "chapter91/other/claims.py").unlink()  # about decay
    chapters.forget()
    assert "no results of other" in command("check only=other,decay")[1]
    assert "unknown experiment 'othr'" in command("check only=[othr,decay]")[1]
    assert "chapter 90:" in command("check only=decay,needs_more")[1]


@pytest.mark.parametrize(
    "words", ["report results=results", "report results=", "draw results=", "study only=decay results="]
)
def test_a_folder_that_is_somebody_elses_stays(toy_result: Path, command: Command, words: str) -> None:
    """Such as a thesis in a folder called report, where a shell's variable for the results is empty, too."""
    for folder in (Path("report"), Path("results/report")):
        folder.mkdir()
        (folder / "index.html").write_text("mine")
    status, said = command(words)
    assert status == 2
    assert "results/report holds files that are no report" in said or "results = '' is not allowed" in said
    assert whole(Path("report")) == whole(Path("results/report")) == {"index.html": b"mine"}
    assert not Path("studies").exists()
