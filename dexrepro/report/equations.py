"""An index from the book's equations to the lines that implement or discuss them: "(2.32)" -> code, parameter, erratum.

The equations themselves stand in the chapters' ``equations.yaml``. An equation is mentioned by its number in
parentheses, in a docstring, a comment or any other text of the code, or in the comment of a configuration; "(5.46) to
(5.48)" and "(2.1)-(2.4)" mention all of the range.
"""

from __future__ import annotations

import ast
import io
import re
import textwrap
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import yaml
from latex2mathml import converter
from markupsafe import escape

from dexrepro import chapters
from dexrepro.config import config_files
from dexrepro.errors import InputError, one_line
from dexrepro.storage import read_yaml

_NUMBER = r"\(([1-9]\d?)\.([1-9]\d{0,2})([a-z]?)\)"
_MENTION = re.compile(rf"{_NUMBER}(?:\s*(?:-|\u2013|\bto\b)\s*{_NUMBER})?")
_LONGEST = 60  # equations a range may hold; more is no range
_BREAK = "\0"  # stands where one text ends and the next begins
_SENTENCE = re.compile(rf"(?<!Eq)(?<!Eqs)[.;]\s|\n *\n|{_BREAK}")
_IDENTIFIER = re.compile(r"([CE])\d+\.\w+$")
KINDS = {"code": "implements or uses it", "parameter": "parameter", "erratum": "erratum", "claim": "claim"}


class Mention(NamedTuple):
    """One equation at one line. kind: one of KINDS; name: a function, class, parameter, erratum or claim."""

    equation: str
    kind: str
    name: str
    path: Path
    line: int
    text: str


def index(folder: Path | None = None) -> list[Mention]:
    """Every mention, in the order of the book, code first; of all code and configurations, or in a folder alone."""
    files = {path: path.stem for kind in ("*.py", "*.yaml") for path in folder.rglob(kind)} if folder else _files()
    found = {mention for path, name in files.items() for mention in _of_file(path, name)}
    return sorted(found, key=lambda m: (*place(m.equation), list(KINDS).index(m.kind), m.path, m.line))


def printed() -> dict[str, tuple[str, str]]:
    """Every equation of the book: its section, and itself in LaTeX, from the ``equations.yaml`` of each chapter.

    Raises InputError where such a file is no map of sections to equations.
    """
    found: dict[str, tuple[str, str]] = {}
    for number in chapters.numbers():
        path = chapters.load(number).folder / "equations.yaml"
        try:
            sections = read_yaml(path) if path.exists() else {}
            new = {name: (section, latex) for section, texts in sections.items() for name, latex in texts.items()}
        except (OSError, ValueError, TypeError, AttributeError, yaml.YAMLError) as error:
            reason = one_line(error)
            raise InputError(f"{path} must hold sections, and in each equations by number ({reason})") from error
        for name, (section, latex) in new.items():
            if not re.fullmatch(r"\d+\.\d+\w?", str(name)) or not isinstance(latex, str) or not isinstance(name, str):
                raise InputError(
                    f"{path}: {section}.{name} = {str(latex)[:40]!r} must be LaTeX under a number as '2.32'"
                )
        found |= new
    return found


def typeset(latex: str) -> str:
    """An equation as MathML, "" of none. Raises InputError where it is no LaTeX."""
    try:
        made = converter.convert(latex.replace("{aligned}", "{align*}"), display="block") if latex else ""
    except Exception as error:
        raise InputError(f"the equation {latex[:80]!r} cannot be typeset ({type(error).__name__})") from error
    made = re.sub("&#x0*([0-9A-F]{2,});", lambda code: escape(chr(int(code[1], 16))), made)
    made = made.replace(' xmlns="http://www.w3.org/1998/Math/MathML"', "")  # within a page it goes without saying
    return re.sub(r"<mrow>(<(m[ion])[^>]*>[^<]*</\2>)</mrow>", r"\1", made)


def numbers(text: str) -> list[str]:
    """The equations that a text mentions, each once, ranges expanded."""
    return list(dict.fromkeys(equation for match in _MENTION.finditer(text) for equation in _expanded(match)))


def _files() -> dict[Path, str]:
    """Files with the name their contents stand under; the library's too, unless all chapters are another book's."""
    library = Path(__file__).parent.parent
    found = {}
    if not all(map(chapters.is_added, chapters.numbers())):
        apart = (library / "chapters", library / "report")  # the report's own mentions are examples
        found = {path: path.stem for path in library.rglob("*.py") if not any(map(path.is_relative_to, apart))}
    for number in chapters.numbers():
        found |= {path: path.stem for path in chapters.load(number).folder.rglob("*.py")}
        found |= {path: name for name, path in config_files(number).items()}
    return found


def _of_file(path: Path, name: str) -> Iterator[Mention]:
    source = path.read_text("utf-8")
    text, homes = (_prose(source), _definitions(source, name)) if path.suffix == ".py" else _keyed(source, name)
    for match in _MENTION.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        home = homes[line - 1]
        given = _IDENTIFIER.match(home)
        kind = {"C": "claim", "E": "erratum"}[given[1]] if given else "code" if path.suffix == ".py" else "parameter"
        for equation in _expanded(match):
            yield Mention(equation, kind, home, path, line, _sentence(text, match))


def _expanded(match: re.Match[str]) -> list[str]:
    chapter, first, letter, chapter_2, last, letter_2 = match.groups()
    ends = [f"{chapter}.{first}{letter}", *([f"{chapter_2}.{last}{letter_2}"] if last else [])]
    if last and chapter == chapter_2 and int(first) < int(last) < int(first) + _LONGEST:
        return [ends[0], *(f"{chapter}.{number}" for number in range(int(first) + 1, int(last))), ends[1]]
    return ends


def place(equation: str) -> tuple[int, int, str]:
    """Where an equation's number stands in the book: "2.9" comes before "2.10"."""
    chapter, number, letter = re.match(r"(\d+)\.(\d+)(\w?)", equation).groups()  # type: ignore[union-attr]
    return int(chapter), int(number), letter


def _sentence(text: str, match: re.Match[str]) -> str:
    """The sentence that holds the mention."""
    start = max((m.end() for m in _SENTENCE.finditer(text, 0, match.start())), default=0)
    end = _SENTENCE.search(text, match.end())
    return textwrap.shorten(text[start : end.start() if end else None], 240, placeholder=" \u2026")


# --------------------------------------------------------------------------------------- Python: texts and their homes


def _prose(source: str) -> str:
    """The source with everything but the text of strings and comments turned into blanks, line by line."""
    lines = [[" "] * (len(line) + 1) for line in source.split("\n")]
    kinds = {tokenize.STRING, tokenize.COMMENT, getattr(tokenize, "FSTRING_MIDDLE", tokenize.STRING)}
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        row, column = token.start
        if token.type in kinds:
            body = re.sub(r"^\w*['\"]+|['\"]+$|^#+", lambda quotes: " " * len(quotes[0]), token.string)
            for offset, part in enumerate(body.split("\n")):
                start = 0 if offset else column
                lines[row - 1 + offset][start : start + len(part)] = part
        separate = token.string in (",", ":") or token.type == tokenize.NEWLINE
        if separate or (token.type == tokenize.COMMENT and token.line[:column].strip()):
            lines[row - 1][column] = _BREAK
    return "\n".join(map("".join, lines)) + "\n"


def _definitions(source: str, module: str) -> list[str]:
    """For each line what it belongs to: a claim's or erratum's id, a method as Class.method, or the module."""
    homes = [module] * (source.count("\n") + 2)
    _fill(ast.parse(source), "", homes)
    return homes


def _fill(node: ast.AST, outer: str, homes: list[str]) -> None:
    for child in ast.iter_child_nodes(node):
        name = outer
        if isinstance(child, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            name = f"{outer}.{child.name}" if outer else child.name
        elif isinstance(child, ast.Call) and child.args and isinstance(child.args[0], ast.Constant):
            given = str(child.args[0].value)
            name = given if _IDENTIFIER.match(given) else outer
        if name != outer:
            first, last = child.lineno, child.end_lineno or child.lineno  # type: ignore[attr-defined]
            homes[first - 1 : last] = [name] * (last - first + 1)
        _fill(child, name, homes)


# ---------------------------------------------------------------------------------------------- YAML: comments and keys


def _keyed(source: str, name: str) -> tuple[str, list[str]]:
    """The comments of a configuration, and each line's key; a comment on a line of its own has the next one's."""
    homes = [""] * (source.count("\n") + 2)
    _keys(yaml.compose(source), name, homes)
    for line in range(len(homes) - 2, -1, -1):
        homes[line] = homes[line] or homes[line + 1]
    comments = (re.match(r"(\s*)#(.*)|(.*?)(?: #(.*))?$", line) for line in source.splitlines())
    return "".join(f"{c[2] or ''}\n" if c[2] else f"{_BREAK}{c[4] or ''}\n" for c in comments if c), homes


def _keys(node: yaml.Node | None, outer: str, homes: list[str]) -> None:
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            name = f"{outer}.{key.value}" if outer else key.value
            if not homes[key.start_mark.line]:
                homes[key.start_mark.line] = name
            _keys(value, name, homes)
