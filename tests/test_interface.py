"""What the library's folders offer is documented and typed: no public name without a docstring, none with ``Any``."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import ROOT

FOLDERS = ("control", "humans", "networks", "physics", "primitives", "robots", "vision")
Definition = ast.ClassDef | ast.FunctionDef


def public(body: list[ast.stmt], prefix: str = "") -> Iterator[tuple[str, Definition]]:
    """Public classes, functions and methods with their dotted names; ``__init__`` and ``__call__`` are public."""
    for node in body:
        if isinstance(node, Definition) and (not node.name.startswith("_") or node.name in ("__init__", "__call__")):
            yield prefix + node.name, node
            if isinstance(node, ast.ClassDef):
                yield from public(node.body, f"{prefix}{node.name}.")


def says_any(node: ast.AST | None) -> bool:
    names = (n.id if isinstance(n, ast.Name) else getattr(n, "attr", "") for n in ast.walk(node or ast.Pass()))
    return "Any" in names


def annotations(node: Definition) -> Iterator[ast.AST | None]:
    """Types that a caller meets: arguments and result of a function, attributes of a class."""
    if isinstance(node, ast.ClassDef):
        yield from (item.annotation for item in node.body if isinstance(item, ast.AnnAssign))
        return
    arguments = node.args
    every = (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg)
    yield from (argument.annotation for argument in every if argument is not None)
    yield node.returns


def documented_methods(trees: list[ast.Module]) -> set[str]:
    """Names of methods that a protocol or a base class documents once for all that implement it."""
    classes = [node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
    bases = {ast.unparse(base).partition("[")[0] for node in classes for base in node.bases}
    shared = [node for node in classes if node.name in bases or any(ast.unparse(b) == "Protocol" for b in node.bases)]
    return {
        item.name
        for node in shared
        for item in node.body
        if isinstance(item, ast.FunctionDef) and ast.get_docstring(item)
    }


def faults(source: str, known: set[str]) -> list[str]:
    """What a module's public names lack; ``known``: methods documented elsewhere."""
    tree = ast.parse(source)
    found = [] if ast.get_docstring(tree) else ["the module has no docstring"]
    for alias in (node for node in tree.body if isinstance(node, ast.Assign | ast.AnnAssign)):
        if says_any(alias):
            found.append(f"line {alias.lineno}: '{ast.unparse(alias)}' says Any")
    for name, node in public(tree.body):
        method = "." in name and (node.name in known or node.name.startswith("__"))
        method |= any(ast.unparse(item).endswith(".setter") for item in node.decorator_list)  # as its property says
        if not method and not ast.get_docstring(node):
            found.append(f"line {node.lineno}: {name} has no docstring")
        if any(map(says_any, annotations(node))):
            found.append(f"line {node.lineno}: {name} has Any in its signature")
    return found


@pytest.mark.parametrize("folder", FOLDERS)
def test_public_names_are_documented_and_typed(folder: str) -> None:
    files = sorted((ROOT / "dexrepro" / folder).rglob("*.py"))
    sources = {path: path.read_text(encoding="utf-8") for path in files}
    known = documented_methods([ast.parse(source) for source in sources.values()])
    found = [
        f"{path.relative_to(ROOT)}, {fault}" for path, source in sources.items() for fault in faults(source, known)
    ]
    assert found == []


def test_a_name_without_docstring_or_with_any_is_found() -> None:
    source = '''"""Doc."""
Alias = dict[str, Any]
def free(x: typing.Any) -> int: "Doc."
def bare(x: int) -> int: ...
class Law:
    """Doc."""
    gain: list[Any]
    def reset(self) -> None: ...
    def __call__(self, q: float) -> Any: ...
    def _private(self, q: Any) -> Any: ...
'''
    assert [fault.partition(": ")[2] for fault in faults(source, {"reset"})] == [
        "'Alias = dict[str, Any]' says Any", "free has Any in its signature", "bare has no docstring",
        "Law has Any in its signature", "Law.__call__ has Any in its signature",
    ]  # fmt: skip
    assert any("Law.reset has no docstring" in fault for fault in faults(source, set()))


SIGNATURES = {
    "simulate": ["(config: Config, rng: Rng) -> Recording"],
    "measure": ["(recording: Recording, config: Config) -> Metrics"],
    "summarise": ["(metrics: AllMetrics, config: Config) -> Metrics"],
    "draw": ["(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings"],
}


@pytest.mark.parametrize(
    "module", sorted(ROOT.glob("dexrepro/chapters/*/*/*.py")), ids=lambda m: f"{m.parent.name}.{m.stem}"
)
def test_what_an_experiment_offers_has_the_types_of_the_vocabulary(module: Path) -> None:
    for node in ast.parse(module.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef) and node.name in SIGNATURES:
            assert f"({ast.unparse(node.args)}) -> {ast.unparse(node.returns)}" in SIGNATURES[node.name], node.name


DECODING = re.compile(
    r"\bcase(\.(startswith|endswith|r?partition|split|remove(prefix|suffix))\(|\[|\.case\b)|config\.case\b"
)


def test_no_chapter_takes_a_name_of_a_case_apart() -> None:
    """A name is a label: what a case is stands in its configuration."""
    chapters = (ROOT / "dexrepro" / "chapters").rglob("*.py")
    assert [f"{path}: {found[0]}" for path in chapters if (found := DECODING.search(path.read_text("utf-8")))] == []
    assert DECODING.search('if case.startswith("k"):')
    assert not DECODING.search("config.cases[case].law")
