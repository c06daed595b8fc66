"""The pages of the reference, written as the manual is built: API, commands, configuration, file formats."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from dexrepro import chapters, cli, crosscheck, tune
from dexrepro.provenance import commented_leaves, parse_provenance
from dexrepro.storage import read_json

ROOT = Path(__file__).parents[1]
LIBRARY = {
    "control": "Control laws and what they are given",
    "physics": "The world in which arms are simulated",
    "robots": "Arms and their kinematics",
    "primitives": "Movement primitives",
    "networks": "Networks that adapt",
    "humans": "Synthetic people",
    "vision": "What chapter 3 sees",
}
TOOL = ("__init__", "case", "claims", "experiment", "measures", "recordings", "result", "storage", "study",
        "study.draws", "study.samples", "study.sampling", "study.summaries", "report.style")  # fmt: skip
ARGUMENT = re.compile(r"(\w[^:\n]*?):(?=\s)")  # "gain: m/N", "simulate(config) -> Recording: one case"
Pages = Iterator[tuple[str, str]]
CODE = re.compile(r"(``.*?``|:\w+:`.*?`|::$)", re.DOTALL)


def write(docs: Path) -> None:
    """Write all pages into docs/reference; one that is as it was stays untouched."""
    for name, content in (*_api(), *_commands(), *_configuration(), *_formats(docs), *_engines(), *_searches()):
        page = docs / "reference" / f"{name}.md"
        page.parent.mkdir(exist_ok=True)
        if not page.exists() or page.read_text("utf-8") != content:
            page.write_text(content, encoding="utf-8")


def as_prose(app: Any, what: str, name: str, item: Any, options: Any, lines: list[str]) -> None:
    """Make a list of what explains arguments, and escape what is markup only by accident: |G|^2 is no substitution.

    A paragraph of lines "name: text", continued with an indent, is a list; code and roles stay as they are.
    """
    parts = CODE.split("\n".join(lines))
    parts[::2] = [re.sub(r"([*|]|(?<=\w)_(?!\w))", r"\\\1", part) for part in parts[::2]]
    parts[2::2] = [re.sub(r"^(?=[\w(\[])", r"\\ ", part) for part in parts[2::2]]  # ``force``(time)
    paragraphs = "".join(parts).split("\n\n")
    lines[:] = "\n\n".join(
        _list(text) if ARGUMENT.match(text) and "\n    " in text else text for text in paragraphs
    ).split("\n")


def _list(paragraph: str) -> str:
    items = re.split(r"\n(?=\S)", paragraph)
    return "\n".join(ARGUMENT.sub(r"- **\1**:", " ".join(item.split()), count=1) for item in items)


def _toctree(*names: str) -> str:
    return "\n```{toctree}\n:hidden:\n\n" + "\n".join(names) + "\n```\n"


def _api() -> Pages:
    rows = []
    for folder, title in LIBRARY.items():
        names = [p.stem for p in sorted((ROOT / "dexrepro" / folder).glob("*.py")) if p.stem != "__init__"]
        yield f"api/{folder}", _members(title, [f"dexrepro.{folder}.{name}" for name in names])
        rows.append(f"| [`dexrepro.{folder}`]({folder}.md) | {title} |")
    names = ["dexrepro" + ("" if name == "__init__" else f".{name}") for name in TOOL]
    yield "api/tool", _members("Running, results, claims and studies", names)
    rows.append("| [`dexrepro`](tool.md) | Running, results, claims and studies |")
    head = "# API\n\nFrom the docstrings, which give shapes, units and the book's equations.\n\n"
    head += "| module | holds |\n| --- | --- |\n"
    yield "api/index", head + "\n".join(rows) + "\n" + _toctree(*LIBRARY, "tool")


def _members(title: str, modules: Iterable[str]) -> str:
    parts = [f"## {module}\n\n```{{eval-rst}}\n.. automodule:: {module}\n```" for module in modules]
    return f"# {title}\n\n" + "\n\n".join(parts) + "\n"


def _commands() -> Pages:
    (commands,) = (action for action in cli._parser()._actions if action.dest == "command")
    text = ["# Commands", "As each command tells it by `--help`."]
    text += ["| exit status | means |", "| --- | --- |"]
    text += [f"| {status} | {meaning} |" for status, meaning in cli.STATUSES.items()]
    text = ["\n\n".join(text[:2]), "\n".join(text[2:])]
    for command in commands.choices or ():
        told = subprocess.run(
            [sys.executable, "-m", "dexrepro", command, "--help"], cwd=ROOT, capture_output=True, text=True,
            check=True, env={**os.environ, "COLUMNS": "100"},
        ).stdout  # fmt: skip
        text.append(f"## dexrepro {command}\n\n```text\n{told.strip()}\n```")
    yield "commands", "\n\n".join(text) + "\n"


def _configuration() -> Pages:
    rows = []
    for number in (*chapters.numbers(), "own"):
        title = chapters.load(number).title
        yield f"configuration/{number}", _parameters(number, title)
        rows.append(f"| [{number}]({number}.md) | {title} |")
    head = (
        "# Configuration\n\nEvery parameter of every experiment, as `conf/` has it: the book's symbol, the unit,\n"
        "where the value comes from (printed in the book, derived from it, or chosen by us), and the range in which a\n"
        "study draws it.\n\n"
    )
    table = head + "| chapter | title |\n| --- | --- |\n" + "\n".join(rows) + "\n"
    yield "configuration/index", table + _toctree(*chapters.numbers(), "own")


def _parameters(number: str, title: str) -> str:
    text, open_ = [f"# Chapter {number}: {title}"], ""
    for key, value, comment in commented_leaves(number):
        experiment, _, rest = key.partition(".")
        if experiment != open_:
            text.append(
                f"\n## {experiment}\n\n| parameter | value | symbol | unit | from | varied |\n| {'--- | ' * 6}".strip()
            )
            open_ = experiment
        cells = (f"`{rest}`", f"`{value}`", "", "", comment, "")
        if found := parse_provenance(comment):
            words = ", ".join(found.words)
            varied = found.bounds.replace(" to ", " … ") or words
            origin = f"{found.kind}{' ' if found.kind == 'printed' else ': '}{found.text}".strip()
            cells = (*cells[:2], found.symbol or "", found.unit, origin, varied)
        text.append("| " + " | ".join(_escaped(cell) for cell in cells) + " |")
    return "\n".join(text) + "\n"


def _escaped(text: str) -> str:
    return (
        text
        if text.startswith("`")
        else text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("_", "\\_")
    )


def _formats(docs: Path) -> Pages:
    text = ["# File formats", "Each file that the package writes, with the JSON schema that tests hold it to."]
    for path in sorted((docs / "schemas").glob("*.json")):
        schema = json.loads(path.read_text("utf-8"))
        text.append(f"## {schema['title']}\n\n{schema['description']} {{download}}`Schema <../schemas/{path.name}>`")
        rows = list(_properties(schema))
        if rows:
            text.append("| key | type | |\n| --- | --- | --- |\n" + "\n".join(rows))
    yield "formats", "\n\n".join(text) + "\n"


def _engines() -> Pages:
    found = crosscheck.stored(crosscheck.table(Path(), shipped=True))
    claims = sum(len(item.claims) for item in found)
    turned = [f"{key} is {item.claims[key][0]} under PyBullet, {item.claims[key][1]} under MuJoCo"
              for item in found for key in item.turned]  # fmt: skip
    text = (
        f"# The engines compared\n\n{len(found)} experiments simulate arms. Of {sum(item.compared for item in found)} "
        f"numbers, {sum(len(item.metrics) for item in found)} leave the tolerance of their baseline under MuJoCo; of "
        f"{claims} claims, {claims - len(turned)} have the same verdict under both engines"
        f"{': ' if turned else ''}{'; '.join(turned)}. Why: [Two physics engines](../how-to/engines.md).\n"
    )
    for item in found:
        text += f"\n## {item.experiment}\n\nChapter {item.chapter}, MuJoCo {item.version}: {item.compared} numbers, "
        text += f"{len(item.metrics)} outside their tolerance; {len(item.claims)} claims, {len(item.turned)} differ.\n"
        if item.metrics:
            text += "\n| number | PyBullet | MuJoCo | among a study's samples |\n| --- | --- | --- | --- |\n"
        for entry in item.metrics:
            spread = "{:.4g} … {:.4g}".format(*entry.spread) if entry.spread else ""
            values = (f"{value:.4g}" if value is not None else "undefined" for value in (entry.reference, entry.other))
            text += f"| `{entry.name.removeprefix(item.experiment + '.')}` | {' | '.join(values)} | {spread} |\n"
    yield "engines", text


def _searches() -> Pages:
    text = (
        "# Searches for the best values\n\nCases whose gains are said to be the best of a search, and that search: "
        "each is shipped with all its runs in `results/baselines/tuning` and made again, in minutes, by `dexrepro tune "
        "--update`. Rivals of one comparison have as many runs. Chapters 1, 2, 3 and 6 search in experiments "
        "of their own, whose tables stand in the report.\n\n"
        "| case | what is best | runs | over | found |\n| --- | --- | --- | --- | --- |\n"
    )
    for case in tune.searched():
        stored = read_json(tune.shipped(case))
        goal, limits = ("least" if stored["sign"] == 1 else "greatest"), stored.get("limits", {})
        bounds = "".join(f", {name} at most {most:g}" for name, most in limits.items())
        spans = ", ".join(f"{key} {low:g} … {high:g}" for key, (low, high) in stored["ranges"].items())
        row = (f"`{case}`", f"{goal} {stored['metric']}{bounds}", len(stored["runs"]), spans, f"{stored['best']:.3g}")
        text += f"| {' | '.join(map(str, row))} |\n"
    yield "searches", text


def _properties(schema: dict[str, Any], outer: str = "") -> Iterator[str]:
    """A row for each key of a schema; those of inner objects and of lists of objects with their path."""
    inner = [*schema.get("properties", {}).items(), ("…", schema.get("additionalProperties"))]
    for name, value in ((name, value) for name, value in inner if isinstance(value, dict)):
        kind = value.get("type", " or ".join(map(str, value.get("enum", ()))))
        kind = ", ".join(kind) if isinstance(kind, list) else kind
        yield f"| `{outer}{name}` | {kind} | {value.get('description', '')} |"
        yield from _properties(value, f"{outer}{name}.")
        if isinstance(value.get("items"), dict):
            yield from _properties(value["items"], f"{outer}{name}[].")
