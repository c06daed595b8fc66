"""An index from the book's equations to the code, read off the docstrings: "Eq. (2.32)" -> function and source line."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

_EQUATIONS = re.compile(r"Eqs?\.\s*((?:\(\d+\.\d+[a-z]?\)(?:\s*(?:,|and|to|-|–)\s*)?)+)")
_NUMBER = re.compile(r"\((\d+)\.(\d+)([a-z]?)\)")


def index(root: Path | None = None) -> list[dict[str, Any]]:
    """Entries {equation, name, file, line}, in the order of the book. root: the package's folder."""
    root = root or Path(__file__).parent.parent
    found = [entry for path in sorted(root.rglob("*.py")) for entry in _of_file(path, root)]
    return [entry for _, entry in sorted(found, key=lambda pair: (pair[0], pair[1]["file"], pair[1]["line"]))]


def _of_file(path: Path, root: Path) -> Iterator[tuple[tuple[int, int, str], dict[str, Any]]]:
    file = str(path.relative_to(root.parent))
    tree = ast.parse(path.read_text())
    for node, name in _documented(tree, path.stem):
        seen = set()
        for group in _EQUATIONS.finditer(ast.get_docstring(node) or ""):
            for chapter, number, letter in _NUMBER.findall(group[1]):
                key = (int(chapter), int(number), letter)
                if key not in seen:
                    seen.add(key)
                    line = getattr(node, "lineno", 1)
                    yield key, {"equation": f"{chapter}.{number}{letter}", "name": name, "file": file, "line": line}


def _documented(tree: ast.Module, name: str) -> Iterator[tuple[Any, str]]:
    yield tree, name
    for node in tree.body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            yield node, node.name
        if isinstance(node, ast.ClassDef):
            for method in node.body:
                if isinstance(method, ast.FunctionDef):
                    yield method, f"{node.name}.{method.name}"
