"""A case is made again when code it uses changes, and only then."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import ROOT, Command

from dexrepro import chapters, closure
from dexrepro.cache_key import READERS, code_digest, package_digest, presentation
from dexrepro.case import live, run, targets
from dexrepro.plan import plan_chapter

BAXTER = "dexrepro.robots.baxter"


def contents(chapter: str, only: str | None = None) -> dict[str, str]:
    plans, _ = plan_chapter(chapter, [f"only={only}"] if only else [], write=False)
    return {f"{plan.experiment}.{case}": content for plan in plans for case, content in plan.contents.items()}


@pytest.fixture
def edited(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[str, str, str], None]:
    """Let a module of the package read as if it had been edited."""
    file = closure._file

    def edit(module: str, pattern: str, replacement: str) -> None:
        text, count = re.subn(pattern, replacement, file(module).read_text(), count=1)
        assert count
        copy = tmp_path / file(module).name
        copy.write_text(text)
        for path in file(module).parent.iterdir():
            if path.suffix == ".yaml":
                (tmp_path / path.name).write_bytes(path.read_bytes())
        monkeypatch.setattr(closure, "cached", lambda _, make: make()[0])
        monkeypatch.setattr(closure, "_file", lambda name: copy if name == module else file(name))

    return edit


def test_a_docstring_of_baxter_changes_no_case(edited: Callable[[str, str, str], None]) -> None:
    before = contents("5") | contents("1", "hold_and_move")
    edited(BAXTER, '"""', '"""One more word. ')
    assert contents("5") | contents("1", "hold_and_move") == before


def test_what_reads_files_counts_where_a_file_is_named(edited: Callable[[str, str, str], None]) -> None:
    experiment = chapters.load("5").experiment("letter_accuracy")
    values = [{"demonstrations": named, "engine": "pybullet"} for named in (None, "letter.csv")]
    before = [code_digest(experiment, value) for value in values]
    edited("dexrepro.primitives.recorded", "FEWEST = 8", "FEWEST = 9")
    package_digest.cache_clear()
    after = [code_digest(experiment, value) for value in values]
    assert [a == b for a, b in zip(before, after, strict=True)] == [True, False]


def test_code_of_baxter_changes_the_cases_with_that_arm_alone(edited: Callable[[str, str, str], None]) -> None:
    before, with_baxter = contents("5"), contents("1", "hold_and_move")
    edited(BAXTER, r"(\n    return )", r"\n    print()\1")
    assert contents("5") == before
    assert not set(contents("1", "hold_and_move").items()) & set(with_baxter.items())


@pytest.mark.parametrize(
    ("before", "after", "same"),
    [
        ("x = 1\n", "x = 1  # a comment\n", True),
        ("x = 1\n", "x = 2\n", False),
        (
            "def f(a): return a\nx = f(1)\n",
            'def f(a: int) -> int:\n    "What it does."\n    return a\nx = f(1)\n',
            True,
        ),
        ("def f(a): return a\nx = f(1)\n", "def f(a): return -a\nx = f(1)\n", False),
        ("def f(): return 1\nx = 1\n", "def f(): return 2\nx = 1\n", True),
        ("x = {}\n", "x = {}\nx['a'] = 1\n", False),
        ("import math\nx = math.pi\n", "import cmath as math\nx = math.pi\n", False),
        ("class A:\n    y = 1\nx = A\n", "class A:\n    y = 2\nx = A\n", False),
        (
            "def x():\n    from mod_b import y\n    return y\n",
            "def x():\n    from mod_b import z\n    return z\n",
            False,
        ),
        ("from mod_b import y as x\n", "from mod_b import z as x\n", False),
        ("import mod_b\ndef x(): return mod_b.y\n", "import mod_b\ndef x(): return mod_b.z\n", False),
        ("try:\n    x = 1\nexcept ValueError:\n    x = 2\n", "try:\n    x = 1\nexcept ValueError:\n    x = 3\n", False),
        ("x = 'a'\n", "x = b'a'\n", False),
    ],
)
def test_what_changes_the_hash_of_a_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, before: str, after: str, same: bool
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "mod_b.py").write_text("y = 1\nz = 2\n")
    digests = []
    for text in (before, after):
        (tmp_path / "mod_a.py").write_text(text)
        closure._parsed.cache_clear()
        digests.append(closure.digest([("mod_a", "x")]))
    assert (digests[0] == digests[1]) == same


def test_the_hash_follows_names_into_the_modules_they_come_from(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "mod_c.py").write_text("from mod_d import used\ndef x(): return used()\n")
    digests = []
    for value, other in ((1, 1), (2, 1), (2, 2)):
        (tmp_path / "mod_d.py").write_text(f"def used(): return {value}\ndef other(): return {other}\n")
        closure._parsed.cache_clear()
        digests.append(closure.digest([("mod_c", "x")]))
    assert digests[0] != digests[1] == digests[2]


@pytest.mark.parametrize(
    ("chapter", "experiment", "overrides"),
    [
        ("2", "estimation_stability", []),
        ("2", "holding_comparison", ["holding_comparison.duration=0.3"]),
        ("4", "growth_cost", []),
        ("5", "incremental_update", []),
        ("6", "obstacle_terms", []),
        ("8", "sponge", ["sponge.duration=0.3"]),
    ],
)
def test_every_function_that_runs_is_in_the_hash(
    chapter: str, experiment: str, overrides: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    plans, _ = plan_chapter(chapter, [f"only={experiment}", *overrides], write=False)
    definition, job = chapters.load(chapter).experiment(experiment), plans[0].jobs[0]
    roots: list[closure.Name] = []
    monkeypatch.setattr(closure, "digest", lambda names, _: roots.extend(names) or "")
    package_digest.cache_clear()
    code_digest(definition, job.config)
    reached = closure._reached(roots, READERS)
    seen: set[closure.Name] = set()

    def watch(frame, event, argument) -> None:
        code = frame.f_code
        if event == "call" and code.co_filename.startswith(str(ROOT / "dexrepro")) and code.co_flags & 1:
            seen.add((frame.f_globals["__name__"], code.co_qualname.partition(".")[0]))

    definition.simulation  # noqa: B018  what its import runs is no part of a case
    sys.setprofile(watch)
    try:
        run(definition, live(job.config), 0)
    finally:
        sys.setprofile(None)
    beside = {("dexrepro.experiment", "Experiment")}  # it finds the modules
    assert not {name for name in seen if not name[1].startswith("<")} - set(reached) - beside
    assert len(seen) >= 8
    assert {closure.target(text) for text in targets(job.config)} <= set(reached)


# ---------------------------------------------------------------------------------------- the runner goes by the hash


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    closure._parsed.cache_clear()
    for name in [name for name in sys.modules if "chapter90" in name]:
        del sys.modules[name]
    chapters.forget()


@pytest.mark.parametrize(
    ("file", "old", "new", "simulated", "presented"),
    [
        ("experiment.py", '"""Something', '"""Once more: something', False, False),
        ("experiment.py", "def measure(", "# a comment\ndef measure(", False, False),
        ("experiment.py", '"ratio": ', '"ratio": 2 * ', False, True),
        ("experiment.py", '"final": ', '"final": 2 * ', True, True),
        ("experiment.py", "config.start +", "2 * config.start +", True, True),
        ("figures.py", "simulated decay", "a decay that was simulated", False, True),
        ("claims.py", "nothing grows", "nothing ever grows", False, True),
        ("config.yaml", "# m | chosen: any | 0.5..2", "# m | chosen: for no reason | 0.5..2", False, False),
        ("config.yaml", "start: 1.0", "start: 1.25", True, True),
    ],
)
def test_what_was_edited_decides_what_is_done_again(
    toy_result: Path, toy_book: Path, command: Command, file: str, old: str, new: str, simulated: bool, presented: bool
) -> None:
    before = (toy_result / "run.json").stat().st_mtime_ns
    edit(toy_book / "chapter90/decay" / file, old, new)
    status, said = command("run workers=1")
    assert status == 0, said
    assert ("decay.plain:" in said) == simulated
    assert ((toy_result / "run.json").stat().st_mtime_ns > before) == presented


def test_a_result_is_presented_anew_where_the_cache_is_gone(toy_result: Path, toy_book: Path, command: Command) -> None:
    shutil.rmtree("results/.cache")
    edit(toy_book / "chapter90/decay/experiment.py", '"ratio": ', '"ratio": 2 * ')
    edit(toy_book / "chapter90/decay/claims.py", "nothing grows", "nothing ever grows")
    before = json.loads((toy_result / "metrics.json").read_text())
    status, said = command("run workers=1")
    assert status == 0, said
    assert "decay.plain:" not in said
    assert "nothing ever grows" in (toy_result / "claims.json").read_text()
    after = json.loads((toy_result / "metrics.json").read_text())
    assert after == before | {"decay.ratio": 2 * before["decay.ratio"]}


def test_presentation_follows_the_style_of_figures(edited: Callable[[str, str, str], None]) -> None:
    experiment = chapters.load("2").experiment("holding_comparison")
    before = presentation(experiment)
    edited("dexrepro.report.style", r"\Z", "\nprint()\n")
    assert presentation(experiment) != before


# ------------------------------------------------------------------------------------------------------ a user's law

SESSION = """
import pathlib, sys, time
import dexrepro
LAW = "class L(float):\\n    def __new__(cls): return float.__new__(cls, {})\\n"
def final(target):
    result = dexrepro.run(90, [f"+decay.cases.mine.law._target_={target}"], only="decay", workers=1)["decay"]
    return round(result.metrics["decay.mine.largest"], 6)
"""
EDITED = """
for factor in (1, 2, 3):  # within the same second, of the same size
    pathlib.Path("edlaw.py").write_text(LAW.format(factor))
    import edlaw
    print(final("edlaw.L"))
"""
NOTEBOOK = """
for factor in (1, 2):
    exec(LAW.format(factor))
    print(final("__main__.L"))
print(len(list(pathlib.Path("results/.cache/decay").glob("mine-*"))))
"""


def session(folder: Path, script: str, beginning: str = SESSION) -> list[str]:
    """What a script prints; its processes may be spawned, which import it."""
    guarded = "if __name__ == '__main__':\n" + textwrap.indent(script, "    ")
    (folder / "session.py").write_text(f"{beginning}\n{guarded}")
    done = subprocess.run(
        [sys.executable, "session.py"], cwd=folder, env={**os.environ, "PYTHONPATH": f"{ROOT}"}, capture_output=True,
        text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_a_law_that_is_edited_in_a_session_never_gets_another_versions_result(toy: Path) -> None:
    assert session(toy, EDITED) == ["1.0", "2.0", "3.0"]
    assert session(toy, 'print(final("edlaw.L"))') == ["3.0"]


PLAIN = """
import pathlib
import dexrepro
LAW = '''class L:
    def __init__(self, gain, dt): self.gain, self.dt = {} * gain, dt
    def reset(self, position): self.reference = position
    def __call__(self, position, force):
        self.reference += self.gain * (force - 1.0) * self.dt
        return self.reference
'''
def rmse():
    given = ["~holding_comparison.cases", "holding_comparison.duration=2",
             "+holding_comparison.cases={mine: {law: {_target_: plain_law.L, gain: 0.02, dt: 0.001}}}"]
    result = dexrepro.run(2, given, only="holding_comparison", workers=1)["holding_comparison"]
    print(round(result.metrics["holding_comparison.mine.rmse_0"], 3))
"""


@pytest.mark.slow
def test_a_plain_law_that_is_edited_between_two_runs_of_a_real_comparison_gives_its_own_numbers(tmp_path: Path) -> None:
    both = "for factor in (1, 5):\n    pathlib.Path('plain_law.py').write_text(LAW.format(factor))\n    rmse()\n"
    assert session(tmp_path, both, PLAIN) == ["1.707", "0.57"]
    assert session(tmp_path, "rmse()\n", PLAIN) == ["0.57"], "a fresh process, the edited file"


def test_a_class_of_a_script_or_notebook_is_never_taken_from_the_cache(toy: Path) -> None:
    assert session(toy, NOTEBOOK) == ["1.0", "2.0", "2"]


def test_package_code_that_is_edited_in_a_session_is_the_code_that_runs(toy: Path, toy_book: Path) -> None:
    path = toy_book / "chapter90/decay/experiment.py"
    script = f"""
import dexrepro.chapters
dexrepro.chapters.load("90").experiment("decay").simulation
print(dexrepro.run(90, only="decay", workers=1)["decay"].metrics["decay.plain.largest"])
path = pathlib.Path({str(path)!r})
path.write_text(path.read_text().replace("config.start +", "3 * config.start +"))
print(dexrepro.run(90, only="decay", workers=1)["decay"].metrics["decay.plain.largest"])
"""
    assert session(toy, script) == ["0.5", "1.5"]
