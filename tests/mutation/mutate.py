"""Wrong laws that the tests have to notice: one small change of the library at a time, its folder's tests against it.

    python tests/mutation/mutate.py networks control/holding --share 0.2

Each argument is a folder or a module of dexrepro/. A change turns a sign, an operator, a comparison, a factor or a
function, drops an assignment, or swaps two that write to one place. Tests that import the module run first, the others
of its folder after them; parameters' defaults, messages and annotations are left alone. What survives is printed,
unless ``accepted.txt`` says of it, or of its line, why it changes nothing; the exit status is 1 where the share
killed is below ``--least``.
"""

from __future__ import annotations

import argparse
import ast
import copy
import importlib.abc
import importlib.util
import os
import random
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, ModuleType

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
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
    if isinstance(node, ast.BinOp | ast.AugAssign) and type(node.op) in OPERATORS:
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


def mutants(path: Path) -> Iterator[tuple[int, str, CodeType]]:
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


def passes(name: str, path: Path, code: CodeType | None, tests: list[Path], limit: float) -> bool:
    """Whether tests pass, in a process of their own and within a time [s]."""
    if not tests:
        return True
    child = os.fork()
    if child == 0:
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, limit)
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1), os.dup2(null, 2)
        sys.meta_path.insert(0, Mutated(name, path, code))
        options = ["-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-m", "not slow"]
        os._exit(int(pytest.main([*options, *map(str, tests)])))
    return os.waitpid(child, 0)[1] == 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("places", nargs="+", help="folders or modules of dexrepro/: networks, control/holding")
    parser.add_argument("--share", type=float, default=1.0, help="share of the mutants to try, drawn with a fixed seed")
    parser.add_argument("--least", type=float, default=0.9, help="smallest share of killed mutants")
    options = parser.parse_args()
    import hypothesis
    import numpy  # noqa: F401

    hypothesis.settings.register_profile(
        "mutation",
        database=None,
        deadline=None,
        derandomize=True,
        phases=[hypothesis.Phase.explicit, hypothesis.Phase.generate],
    )
    hypothesis.settings.load_profile("mutation")
    os.chdir(ROOT)
    accepted = [line.rpartition("  # ")[0] for line in (HERE / "accepted.txt").read_text("utf-8").splitlines()]
    tried = killed = 0
    for place in options.places:
        at = ROOT / "dexrepro" / place
        for path in sorted(at.rglob("*.py")) if at.is_dir() else [at.with_suffix(".py")]:
            relative = path.relative_to(ROOT / "dexrepro")
            a, b = survey(path, relative, options.share, accepted)
            tried, killed = tried + a, killed + b
    print(f"{killed} of {tried} wrong laws noticed ({100 * killed / max(tried, 1):.1f} %)")
    return int(killed < options.least * tried)


def survey(path: Path, relative: Path, share: float, accepted: list[str]) -> tuple[int, int]:
    """Number of mutants of one module that were tried and that its tests killed."""
    name = ".".join(("dexrepro", *relative.with_suffix("").parts))
    beside = sorted((ROOT / "tests" / relative.parts[0]).glob("test_*.py"))
    near = [test for test in beside if name in test.read_text("utf-8") or f"_{relative.stem}.py" in test.name]
    far = [test for test in beside if test not in near]
    draw = random.Random(str(relative))
    chosen = [mutant for mutant in mutants(path) if draw.random() < share]
    chosen = [(line, text, code) for line, text, code in chosen
              if not {f"{relative}: {text}", f"{relative}: {text.partition('  [')[0]}"} & set(accepted)]  # fmt: skip
    if not chosen:
        return 0, 0
    times = []
    for tests in (near, far):
        start = time.perf_counter()
        if not passes(name, path, None, tests, 600.0):
            print(f"{relative}: left out, failing as it is: {', '.join(t.name for t in tests)}", flush=True)
            tests.clear()
        times.append(3 * (time.perf_counter() - start) + 5)
    killed = 0
    for line, text, code in chosen:
        if all(passes(name, path, code, tests, limit) for tests, limit in zip((near, far), times)):
            print(f"{relative}:{line}: {text}", flush=True)
        else:
            killed += 1
    print(f"{relative}: {killed} of {len(chosen)}", flush=True)
    return len(chosen), killed


if __name__ == "__main__":
    sys.exit(main())
