"""Wrong laws that the tests have to notice: one small change of the library at a time, its tests against it.

    python tests/mutation/mutate.py networks control/holding --share 0.2

Each argument is a folder or a module of dexrepro/. A change turns a sign, an operator, a comparison, a factor or a
function, drops an assignment, or swaps two that write to one place; parameters' defaults, messages and annotations are
left alone. The tests beside a folder are collected once; for each change those run that call the changed function,
shortest first, in a process of their own. What survives is printed, unless ``accepted.txt`` says of it, or of its line,
why it changes nothing; the exit status is 1 where the share killed is below ``--least``.
"""

from __future__ import annotations

import argparse
import ast
import copy
import gc
import importlib.abc
import importlib.util
import inspect
import os
import pickle
import random
import signal
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import CodeType, FrameType, FunctionType, ModuleType

import pytest
from _pytest.runner import runtestprotocol

Key = tuple[str, str, int]
"""File, name and line of a function."""
Mutant = tuple[int, str, CodeType]
"""Line, description and code of a module with one change."""

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PACKAGE = str(ROOT / "dexrepro")
OPTIONS = ("-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-m", "not slow")
SCORE = ROOT / "docs/mutation.md"
HEAD = """# Mutation score of the library

Small changes that make a law another (a sign, a factor, an operator, a dropped line; see `tests/mutation/mutate.py`),
and how many of them the tests notice. Changes that `tests/mutation/accepted.txt` says, with a reason, to change nothing
are not tried. Written by `make mutation`.

| folder | tried | noticed | equivalent | score |
| --- | --- | --- | --- | --- |"""
PARTS = """
Share: how many of the possible changes of a module were drawn, with a fixed seed.

| module | share | tried | noticed | equivalent | score |
| --- | --- | --- | --- | --- | --- |"""
FRESH = """
Changes that were drawn with another seed after the tests had been written (`--seed`), scored as found: the score above
is of changes for whose survivors tests were written, this one is of changes that nobody had seen. Tests for survivors
of these draws, too, came later.

| draw | folder | share | tried | noticed | equivalent | score |
| --- | --- | --- | --- | --- | --- | --- |"""
OPERATORS = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult}
COMPARISONS = {
    ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
FUNCTIONS = dict([*(pair := (("sin", "cos"), ("minimum", "maximum"), ("min", "max"), ("argmin", "argmax"),
                             ("floor", "ceil"), ("all", "any"), ("cumsum", "cumprod"))),
                  *((b, a) for a, b in pair), ("tanh", "arctan"), ("sum", "mean"), ("mean", "sum")])  # fmt: skip
SMALL = 1e-5  # constants below it are guards against division by zero


def changes(node: ast.AST) -> Iterator[tuple[str, object]]:
    """Fields of a node with their replacements, each a wrong law of its own."""
    if isinstance(node, ast.BinOp | ast.AugAssign) and type(node.op) in OPERATORS and not _guards(node):
        yield "op", OPERATORS[type(node.op)]()
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield "op", ast.UAdd() if isinstance(node.op, ast.USub) else None
    elif isinstance(node, ast.Compare) and type(node.ops[0]) in COMPARISONS:
        yield "ops", [COMPARISONS[type(node.ops[0])](), *node.ops[1:]]
    elif isinstance(node, ast.BoolOp):
        yield "op", ast.Or() if isinstance(node.op, ast.And) else ast.And()
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float) and not 0 < abs(node.value) < SMALL:
        yield "value", 1 if node.value == 0 else (node.value + 1 if type(node.value) is int else 1.5 * node.value)
    elif isinstance(node, ast.Attribute) and node.attr in FUNCTIONS:
        yield "attr", FUNCTIONS[node.attr]
    elif isinstance(node, ast.Name) and node.id in FUNCTIONS:
        yield "id", FUNCTIONS[node.id]
    body = getattr(node, "body", None)
    if isinstance(node, ast.FunctionDef | ast.If | ast.For | ast.While | ast.With) and isinstance(body, list):
        for k, item in enumerate(body):
            plain = isinstance(item, ast.Expr) and isinstance(item.value, ast.Call)
            if isinstance(item, ast.AugAssign) or plain or (isinstance(item, ast.Assign) and _stores(item)):
                yield "body", [*body[:k], ast.copy_location(ast.Pass(), item), *body[k + 1 :]]
            if k and _root(body[k - 1]) is not None and _root(body[k - 1]) == _root(item):
                yield "body", [*body[: k - 1], item, body[k - 1], *body[k + 1 :]]


def _guards(node: ast.BinOp | ast.AugAssign) -> bool:
    """Whether a tiny constant is added, so that nothing is divided by zero."""
    value = getattr(getattr(node, "right", None), "value", None)
    return isinstance(value, float) and 0 < abs(value) < SMALL and isinstance(node.op, ast.Add | ast.Sub)


def _root(statement: ast.stmt) -> str | None:
    """What a statement writes to, without its index: ``self.regressor`` of ``self.regressor[1] = position``."""
    target = statement.targets[0] if isinstance(statement, ast.Assign) else getattr(statement, "target", None)
    return ast.unparse(target).partition("[")[0] if isinstance(target, ast.Attribute | ast.Subscript) else None


def _stores(statement: ast.Assign) -> bool:
    """Whether something outlives the function that makes the assignment; a local name missed is an error anyway."""
    return _root(statement) is not None


def sites(tree: ast.AST) -> Iterator[ast.AST]:
    """Nodes that say what is computed."""
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "defaults", "kw_defaults", "decorator_list", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if not isinstance(child, ast.AST) or isinstance(child, ast.Raise | ast.Assert | ast.JoinedStr):
                continue
            if isinstance(tree, ast.ClassDef) and isinstance(child, ast.AnnAssign):
                continue  # a dataclass's defaults
            if name == "args" and isinstance(tree, ast.Call) and getattr(tree.func, "attr", "") == "reshape":
                continue  # numpy takes every negative length for -1
            yield child
            yield from sites(child)


def mutants(path: Path) -> Iterator[Mutant]:
    """Line, description and code of every mutant of a file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    lines = path.read_text(encoding="utf-8").splitlines()
    for node in list(sites(tree)):
        for field, value in list(changes(node)):
            old, kept = getattr(node, field), copy.copy(node)
            before = _text(node, value, field)
            if value is None:  # drop a negation: double it
                node.operand = ast.copy_location(ast.UnaryOp(ast.Not(), node.operand), node)
            else:
                setattr(node, field, value)
            after = _text(node, old, field)
            code = compile(ast.fix_missing_locations(tree), str(path), "exec")
            if value is None:
                node.operand = kept.operand
            else:
                setattr(node, field, old)
            line = getattr(node, "lineno", 0)
            if field == "body":
                line = next(a.lineno for a, b in zip(old, value) if a is not b)
            yield line, f"{lines[line - 1].strip()}  [{before} -> {after}]", code


def _text(node: ast.AST, other: object, field: str) -> str:
    if field != "body":
        return ast.unparse(node)
    return "; ".join(ast.unparse(a) for a, b in zip(node.body, other) if a is not b)


class Mutated(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Gives one module another code."""

    def __init__(self, name: str, path: Path, code: CodeType | None) -> None:
        self.name, self.path, self.code = name, path, code

    def find_spec(self, fullname: str, path: object, target: object = None) -> object:
        if fullname == self.name and self.code is not None:
            return importlib.util.spec_from_file_location(fullname, self.path, loader=self)
        return None

    def exec_module(self, module: ModuleType) -> None:
        exec(self.code, module.__dict__)


def in_a_process(work: Callable[[], object], limit: float) -> object:
    """What a function returns in a process of its own; None where it takes more than a time [s] of the processor."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_PROF, limit)
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1), os.dup2(null, 2)
        with open(writer, "wb") as pipe:
            pickle.dump(work(), pipe)
        os._exit(0)
    os.close(writer)
    with open(reader, "rb") as pipe:
        said = pipe.read()
    return pickle.loads(said) if os.waitpid(child, 0)[1] == 0 else None


def passes(name: str, path: Path, code: CodeType | None, tests: list[Path], limit: float) -> bool:
    """Whether tests pass with a module that is imported with another code, within a time [s]."""

    def work() -> int:
        sys.meta_path.insert(0, Mutated(name, path, code))
        return int(pytest.main([*OPTIONS, "-x", *map(str, tests)]))

    return in_a_process(work, limit) == 0


# ----------------------------------------------------------------------------------- changing functions where they are


def changed(old: CodeType, new: CodeType) -> CodeType | None:
    """The function that a change of its module is in; None where it is in what runs when the module is imported."""

    def inner(code: CodeType) -> list[CodeType]:
        return [item for item in code.co_consts if isinstance(item, CodeType)]

    def plain(code: CodeType) -> tuple[object, ...]:
        return code.co_code, code.co_names, [item for item in code.co_consts if not isinstance(item, CodeType)]

    if old.co_flags & inspect.CO_OPTIMIZED:
        return new
    if plain(old) != plain(new):
        return None
    return next((changed(a, b) for a, b in zip(inner(old), inner(new), strict=True) if a != b), None)


def key_of(code: CodeType) -> Key:
    return code.co_filename, code.co_qualname, code.co_firstlineno


class Survey:
    """A plugin of pytest: collects tests once, and runs for each mutant those that call the changed function."""

    def __init__(self, modules: list[tuple[Path, list[Mutant]]]) -> None:
        self.modules = modules
        self.at_import: set[Key] = set()
        self.survived: dict[tuple[Path, int], str] = {}  # path and number of a mutant: "import" where that may kill it
        self.failing: list[str] = []
        self.out = os.dup(1)

    def begin(self) -> None:
        """Watch which functions are called while modules are imported and tests collected."""
        sys.settrace(self._imported)

    def _imported(self, frame: FrameType, event: str, _: object) -> None:
        self.at_import.add(key_of(frame.f_code))

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        sys.settrace(None)
        runs = in_a_process(lambda: [self._trace(item) for item in session.items], 1800.0)
        live: dict[Key, list[FunctionType]] = {}
        for function in gc.get_objects():
            if isinstance(function, FunctionType) and PACKAGE in function.__code__.co_filename:
                live.setdefault(key_of(function.__code__), []).append(function)
        self.failing = [item.nodeid for item, (passed, *_) in zip(session.items, runs) if not passed]
        for path, found in self.modules:
            old = compile(path.read_text(encoding="utf-8"), str(path), "exec")
            for number, (_, _, code) in enumerate(found):
                function = changed(old, code)
                key = None if function is None else key_of(function)
                tests = sorted(
                    (duration, k) for k, (passed, duration, called) in enumerate(runs) if passed and key in called
                )
                limit = 5 + 4 * sum(duration for duration, _ in tests)
                items = [session.items[k] for _, k in tests]
                if key is None or not live.get(key):
                    self.survived[path, number] = "import"
                elif not items or in_a_process(lambda: _hold(live[key], function, items), limit):  # noqa: B023
                    self.survived[path, number] = "import" if key in self.at_import else ""
                    if key not in self.at_import:
                        os.write(self.out, said(path, found[number]).encode())
        return True

    def _trace(self, item: pytest.Item) -> tuple[bool, float, set[Key]]:
        """Whether a test passes, its time [s] of the processor, and the functions of the package that it calls."""
        called: set[Key] = set()

        def trace(frame: FrameType, event: str, _: object) -> None:
            if PACKAGE in frame.f_code.co_filename:
                called.add(key_of(frame.f_code))

        start = time.process_time()
        sys.settrace(trace)
        passed = _run(item)
        sys.settrace(None)
        return passed, time.process_time() - start, called


def _run(item: pytest.Item) -> bool:
    return all(report.outcome != "failed" for report in runtestprotocol(item, log=False, nextitem=None))


def _hold(functions: list[FunctionType], code: CodeType, items: list[pytest.Item]) -> bool:
    """Whether tests hold with another code in the place of a function's."""
    for function in functions:
        function.__code__ = code
    return all(_run(item) for item in items)


# ------------------------------------------------------------------------------------------------------------ the score


def survey(folder: str, modules: list[tuple[Path, list[Mutant]]]) -> tuple[list[str], dict[tuple[Path, int], str]]:
    """Tests that fail as they are, and the mutants of modules of one folder that no test notices."""
    beside = ROOT / "tests" / folder
    plugin = Survey(modules)

    def work() -> object:
        plugin.begin()
        pytest.main([*OPTIONS, str(beside)], plugins=[plugin])
        return plugin.failing, plugin.survived

    failing, survived = in_a_process(work, 1e6)
    tests = {test: test.read_text("utf-8") for test in sorted(beside.glob("test_*.py"))}
    for (path, number), why in list(survived.items()):
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        near = [test for test, text in tests.items() if name in text or f"_{path.stem}.py" in test.name] or [*tests]
        mutant = dict(modules)[path][number]
        if why and not passes(name, path, mutant[2], near, 300.0):
            del survived[path, number]
        elif why:
            print(said(path, mutant), end="", flush=True)
    return failing, survived


def said(path: Path, mutant: Mutant) -> str:
    return f"{path.relative_to(ROOT / 'dexrepro')}:{mutant[0]}: {mutant[1]}\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("places", nargs="+", help="folders or modules of dexrepro/: networks, control/holding")
    parser.add_argument("--share", type=float, default=1.0, help="share of the mutants to try, drawn with a fixed seed")
    parser.add_argument("--seed", default="", help="another draw, which nobody has seen: how well do tests generalise?")
    parser.add_argument("--least", type=float, default=0.9, help="smallest share of killed mutants")
    parser.add_argument("--write", action="store_true", help=f"the score into {SCORE.relative_to(ROOT)}")
    options = parser.parse_args()
    os.environ |= {"OPENBLAS_NUM_THREADS": "1"}
    import hypothesis
    import numpy  # noqa: F401

    phases = [hypothesis.Phase.explicit, hypothesis.Phase.generate]
    hypothesis.settings.register_profile("mutation", database=None, deadline=None, derandomize=True, phases=phases)
    hypothesis.settings.load_profile("mutation")
    os.chdir(ROOT)
    accepted = {line.rpartition("  # ")[0] for line in (HERE / "accepted.txt").read_text("utf-8").splitlines()}
    scores: dict[str, tuple[int, int, int]] = {}
    for folder in dict.fromkeys(Path(place).parts[0] for place in options.places):
        modules, equivalent = [], {}
        places = [ROOT / "dexrepro" / place for place in options.places if Path(place).parts[0] == folder]
        for path in [
            p for at in places for p in (sorted(at.rglob("*.py")) if at.is_dir() else [at.with_suffix(".py")])
        ]:
            relative = path.relative_to(ROOT / "dexrepro")
            draw = random.Random(f"{relative}{options.seed}")
            chosen = [mutant for mutant in mutants(path) if draw.random() < options.share]
            left = [(line, text, code) for line, text, code in chosen
                    if not {f"{relative}: {text}", f"{relative}: {text.partition('  [')[0]}"} & accepted]  # fmt: skip
            modules.append((path, left))
            equivalent[path] = len(chosen) - len(left)
        failing, survived = survey(folder, modules)
        for test in failing:
            print(f"left out, failing as it is: {test}")
        for path, found in modules:
            relative = path.relative_to(ROOT / "dexrepro")
            killed = sum((path, number) not in survived for number in range(len(found)))
            if found or equivalent[path]:
                scores[str(relative)] = (len(found), killed, equivalent[path])
                print(f"{relative}: {killed} of {len(found)}", flush=True)
    tried, killed = (sum(score[k] for score in scores.values()) for k in (0, 1))
    print(f"{killed} of {tried} wrong laws noticed ({100 * killed / max(tried, 1):.1f} %)")
    if options.write:
        write_score(scores, options.share, options.seed)
    return int(killed < options.least * tried)


def write_score(scores: dict[str, tuple[int, int, int]], share: float, seed: str = "") -> None:
    """Renew the lines of the modules that were tried in the table of docs/; those of a fresh draw have their own."""
    written = SCORE.read_text("utf-8").splitlines() if SCORE.exists() else []
    fresh = [line for line in written if line.startswith("| fresh ")]
    if seed:
        for folder in dict.fromkeys(name.partition("/")[0] for name in scores):
            tried, killed, equal = (sum(row[k] for name, row in scores.items() if name.partition("/")[0] == folder)
                                    for k in range(3))  # fmt: skip
            begin = f"| fresh {seed} | {folder} |"
            fresh = [line for line in fresh if not line.startswith(begin)]
            percent = 100 * killed / max(tried, 1)
            fresh.append(f"{begin} {100 * share:.0f} % | {tried} | {killed} | {equal} | {percent:.1f} % |")
        scores = {}
    known = {line.split(" | ")[0].lstrip("| `").rstrip("`"): line for line in written if line.startswith("| `")}
    for name, numbers in scores.items():
        cells = (
            f"`{name}`",
            f"{100 * share:.0f} %",
            *map(str, numbers),
            f"{100 * numbers[1] / max(numbers[0], 1):.0f} %",
        )
        known[name] = f"| {' | '.join(cells)} |"
    lines = [known[name] for name in sorted(known) if (ROOT / "dexrepro" / name).exists()]
    folders = {}
    for line in lines:
        name, _, tried, killed, equal, _ = (cell.strip(" `") for cell in line.strip("|").split("|"))
        for folder in (name.partition("/")[0], "all"):
            folders[folder] = [a + int(b) for a, b in zip(folders.get(folder, [0, 0, 0]), (tried, killed, equal))]
    sums = [f"| {name} | {tried} | {killed} | {equal} | {100 * killed / max(tried, 1):.1f} % |"
            for name, (tried, killed, equal) in sorted(folders.items(), key=lambda item: item[0] == "all")]  # fmt: skip
    parts = [HEAD, *sums, FRESH, *sorted(fresh), PARTS, *lines, ""]
    SCORE.write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
