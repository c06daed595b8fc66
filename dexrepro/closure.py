"""What a number depends on: the code behind a name, as a hash that no comment, docstring or type hint changes.

The closure of a function holds every definition that it can reach: names of its own module, names it imports from
modules of this package or of the user (also inside functions), and whatever a module does when it is imported. What is
installed beside this package is known by its version instead.
"""

from __future__ import annotations

import ast
import hashlib
import importlib.util
import sys
import sysconfig
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path

from dexrepro.disk_cache import cached

Name = tuple[str, str]
"""A module and a name in it; "" stands for all that the module holds."""

PACKAGE = __name__.partition(".")[0]
_SKIPPED = {"ctx", "type_comment", "kind", "annotation", "returns", "type_params"}


def digest(roots: Iterable[Name], without: Iterable[Name] = ()) -> str:
    """Hash of all code that the roots can reach; ``without``: names that are not run, whatever refers to them."""
    roots, without = sorted(set(roots)), sorted(without)
    return str(cached(f"closure {roots} {without}", lambda: _digest(roots, without)))


def _digest(roots: Sequence[Name], without: Sequence[Name]) -> tuple[str, set[Path] | None]:
    """The hash, and the files and folders it follows from; None where the user's are among them, which may move."""
    reached, files = _reached(roots, without), {Path(__file__)}
    parts = sorted(f"{module}:{name}:{text}" for (module, name), text in reached.items())
    for module in {module for module, _ in reached}:
        if (path := _file(module)) is not None:
            parsed = _module(module)
            files |= {path, path.parent}
            if parsed and parsed.data:
                files |= {item for item in path.parent.iterdir() if item.is_file()}
    ours = all(path.is_relative_to(Path(__file__).parent) for path in files)
    return hashlib.sha1("\n".join(parts).encode()).hexdigest(), files if ours else None


def sources(roots: Iterable[Name]) -> set[Path]:
    """Files that hold the code that the roots can reach."""
    found = {_file(module) for module, _ in _reached(roots)}
    return {path for path in found if path is not None}


def reaches(roots: Iterable[Name], name: Name) -> bool:
    """Whether the roots can reach a name."""
    return name in _reached(roots)


def target(text: str) -> Name:
    """The module and the name that a ``_target_`` such as ``dexrepro.control.gravity_pd.GravityPD`` means."""
    parts = text.split(".")
    for count in range(len(parts) - 1, 0, -1):
        if _file(".".join(parts[:count])):
            return ".".join(parts[:count]), parts[count]
    return parts[0], ".".join(parts[1:])


def _reached(roots: Iterable[Name], without: Iterable[Name] = ()) -> dict[Name, str]:
    found: dict[Name, str] = {}
    left = {*without}
    todo = list(roots)
    while todo:
        module, name = todo.pop()
        if (module, name) in found or (module, name) in left or (parsed := _module(module)) is None:
            continue
        if name == "":
            todo += [(module, defined) for defined in (*parsed.definitions, *parsed.imports)]
        found[module, name] = parsed.text(name)
        todo += [(module, _ALWAYS), *parsed.uses(name)]
    return found


# ----------------------------------------------------------------------------------------------------- one module

_ALWAYS = "<import>"  # stands for what a module does when it is imported
_BINDING = "<binding>"  # before a name: the module it is bound to, without what that holds


@dataclass
class _Module:
    """The definitions of one source file, by name, and what each of them uses."""

    name: str
    is_package: bool
    definitions: dict[str, list[ast.stmt]] = field(default_factory=dict)
    imports: dict[str, Name] = field(default_factory=dict)
    data: str = ""
    _texts: dict[str, str] = field(default_factory=dict)
    _uses: dict[str, list[Name]] = field(default_factory=dict)

    def text(self, name: str) -> str:
        """A definition without what changes no number."""
        if name not in self._texts:
            nodes = self.definitions.get(name, [])
            content = "".join("".join(_canonical(node)) for node in nodes) + str(
                self.imports.get(name.removeprefix(_BINDING), "")
            )
            content += self.data if name == _ALWAYS else ""
            self._texts[name] = hashlib.sha1(content.encode()).hexdigest()
        return self._texts[name]

    def uses(self, name: str) -> list[Name]:
        """The names that a definition refers to."""
        if name not in self._uses:
            used = [self.imports[name]] if name in self.imports else []
            for node in self.definitions.get(name, []):
                used += self._used(node)
            self._uses[name] = [item for item in dict.fromkeys(used) if _followed(item[0])]
        return self._uses[name]

    def _used(self, node: ast.AST) -> Iterator[Name]:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from self._imported(node).values()
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and self._is_module(node.value.id):
            yield self.name, _BINDING + node.value.id
            yield self.imports[node.value.id][0], node.attr
        elif isinstance(node, ast.Name) and (node.id in self.imports or node.id in self.definitions):
            yield self.name, node.id
        else:
            for key, value in ast.iter_fields(node):
                for child in value if isinstance(value, list) else [value]:
                    if key not in _SKIPPED and isinstance(child, ast.AST):
                        yield from self._used(child)

    def _is_module(self, name: str) -> bool:
        return name in self.imports and self.imports[name][1] == ""

    def _imported(self, node: ast.Import | ast.ImportFrom) -> dict[str, Name]:
        """What an import binds: a module, or a name of one."""
        if isinstance(node, ast.Import):
            return {alias.asname or alias.name: (alias.name, "") for alias in node.names}
        module = node.module or ""
        if node.level:
            parents = self.name.split(".")
            parents = parents[: len(parents) - node.level + self.is_package]
            module = ".".join([*parents, module] if module else parents)
        bound = {}
        for alias in node.names:
            whole = f"{module}.{alias.name}"
            inside = _followed(module) and alias.name != "*" and _file(whole) is not None
            bound[alias.asname or alias.name] = (whole, "") if inside else (module, alias.name.replace("*", ""))
        return bound

    def read(self, statement: ast.stmt) -> None:
        """Sort a statement of the module in."""
        if isinstance(statement, ast.Import | ast.ImportFrom):
            self.imports |= self._imported(statement)
            plain = isinstance(statement, ast.Import) and any("." in a.name and not a.asname for a in statement.names)
            if plain or any(alias.name == "*" for alias in statement.names):
                self.definitions.setdefault(_ALWAYS, []).append(statement)
        elif isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            self.definitions.setdefault(statement.name, []).append(statement)
        elif isinstance(statement, ast.Assign | ast.AnnAssign) and (bound := _bound(statement)):
            for name in bound:
                self.definitions.setdefault(name, []).append(statement)
        elif not _is_docstring(statement) and not _for_types_alone(statement):
            self.definitions.setdefault(_ALWAYS, []).append(statement)
            for inner in ast.walk(statement):
                if isinstance(inner, ast.Import | ast.ImportFrom):
                    self.imports |= self._imported(inner)
                elif isinstance(inner, ast.stmt) and not isinstance(inner, ast.If | ast.Try | ast.Expr):
                    for name in filter(None, [str(getattr(inner, "name", "")), *_bound(inner)]):
                        self.definitions.setdefault(name, []).append(inner)


def _bound(statement: ast.AST) -> list[str]:
    """Plain names that an assignment binds; none where it also changes something else."""
    targets = getattr(statement, "targets", None) or [getattr(statement, "target", None)]
    flat = [item for one in targets for item in (one.elts if isinstance(one, ast.Tuple | ast.List) else [one])]
    names = [item.id for item in flat if isinstance(item, ast.Name)]
    return names if len(names) == len(flat) else []


def _is_docstring(statement: ast.AST) -> bool:
    return (
        isinstance(statement, ast.Expr)
        and isinstance(statement.value, ast.Constant)
        and isinstance(statement.value.value, str)
    )


def _for_types_alone(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.If) and "TYPE_CHECKING" in ast.dump(statement.test)


def _canonical(node: ast.AST) -> Iterator[str]:
    """The tree of a definition as text, the same in all versions of Python: no docstrings or annotations."""
    yield f"({type(node).__name__}"
    for key, value in ast.iter_fields(node):
        if key in _SKIPPED or value is None or value == []:
            continue
        yield f" {key}="
        for item in value if isinstance(value, list) else [value]:
            if not isinstance(item, ast.AST):
                yield repr(item)
            elif not _is_docstring(item) and not isinstance(item, ast.Pass):
                yield from _canonical(item)
    yield ")"


def _module(name: str) -> _Module | None:
    path = _file(name)
    if path is None:
        return None
    stat = path.stat()
    return _parsed(name, path, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=2000)
def _parsed(name: str, path: Path, changed: int, size: int) -> _Module | None:
    text = path.read_bytes()
    module = _Module(name, path.name == "__init__.py")
    if b"__file__" in text or b"importlib.resources" in text:  # it reads what lies beside it
        beside = [
            item for item in sorted(path.parent.iterdir()) if item.is_file() and item.suffix not in (".py", ".pyc")
        ]
        module.data = "".join(f"{item.name}{hashlib.sha1(item.read_bytes()).hexdigest()}" for item in beside)
    try:
        for statement in ast.parse(text).body:
            module.read(statement)
    except (SyntaxError, ValueError):  # the import says more; the key follows the text
        module.data += hashlib.sha1(text).hexdigest()
        module.definitions = {_ALWAYS: []}
    return module


# ------------------------------------------------------------------------------------------------------ where it is


def _file(module: str) -> Path | None:
    """The source file of a module that is followed; None where there is none."""
    place = _place(module) if module and _followed(module) else None
    return Path(place) if place and place.endswith(".py") else None


def _place(module: str) -> str | None:
    """Where a module lies: its file, or the folder of a package without one."""
    loaded, parent = sys.modules.get(module), module.rpartition(".")[0]
    if (
        loaded is None
        and parent
        and str(_place(parent)).endswith(".py")
        and not str(_place(parent)).endswith("__init__.py")
    ):
        return None  # a name of a module, which need not be imported to say so
    try:
        spec = getattr(loaded, "__spec__", None) or importlib.util.find_spec(module)
    except (ImportError, AttributeError, ValueError):
        return None
    if spec is None:
        return None
    return spec.origin if spec.has_location else next(iter(spec.submodule_search_locations or ()), None)


def _followed(module: str) -> bool:
    """Whether a module is of this package or of the user: the others are known by their version."""
    top = module.partition(".")[0]
    if top == PACKAGE:
        return True
    if top in sys.builtin_module_names or top in sys.stdlib_module_names or top == "__main__":
        return False
    place = _place(top)
    return place is not None and not is_installed(Path(place))


def is_users(path: Path) -> bool:
    """Whether there is such a file and it is neither of this package nor installed."""
    return path.is_file() and not path.is_relative_to(Path(__file__).parent) and not is_installed(path)


@cache
def is_installed(path: Path) -> bool:
    """Whether a file lies where Python or its packages are installed."""
    places = [Path(sysconfig.get_path(name)) for name in ("stdlib", "purelib", "platlib")]
    return any(map(path.is_relative_to, places)) or any(next(p.glob("*.dist-info"), None) for p in path.parents)
