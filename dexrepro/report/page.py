"""The HTML report: one folder that opens from disk, built from the files in results/ alone."""

from __future__ import annotations

import itertools
import json
import shutil
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jinja2

from dexrepro import __version__, chapters, crosscheck
from dexrepro.claims import TIE
from dexrepro.damage import check_result
from dexrepro.errors import InputError
from dexrepro.report import equations, explorer, studies, symbols, verdicts, words
from dexrepro.report.contents import Contents
from dexrepro.report.sources import Sources
from dexrepro.storage import read_json, whole_folder
from dexrepro.study import summaries

KINDS = {
    "error": "Inconsistent with the book's own equations: derived, with measured evidence.",
    "gap": "Something an implementation needs is not printed.",
    "reading": "Defensible as printed, under the reading named.",
    "slip": "Typesetting, or possibly the text extraction.",
}
HERE = Path(__file__).parent
SEARCH = "search-index.js"
Book = list[dict[str, Any]]


def build(results: Path) -> Path:
    """Write ``results/report/`` and return the path of its index.html. Raises InputError where it is somebody's own."""
    report = results / "report"
    if report.is_dir() and any(report.iterdir()) and not (report / SEARCH).exists():
        raise InputError(f"{report} holds files that are no report of ours; move them, or name another results=")
    with whole_folder(report) as folder:
        _Report(results, folder).write()
    return results / "report" / "index.html"


def templates() -> jinja2.Environment:
    """What the pages are made of."""
    loader = jinja2.PackageLoader("dexrepro.report", "templates")
    made = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    filters = (words.breakable, words.number, words.short_number, words.percent, words.prose, words.unit)
    made.filters |= {function.__name__: function for function in filters}
    made.globals |= {"VERDICTS": verdicts.VERDICTS, "MARKS": verdicts.MARKS, "option": chapters.option}
    return made


class _Report:
    """Collects what is in results/, copies what the pages show, and renders the pages."""

    def __init__(self, results: Path, folder: Path) -> None:
        self.results, self.folder = results, folder
        self.templates = templates()
        self.templates.globals |= {"book": chapters.book(), "KINDS": KINDS, "engines": crosscheck.verdicts(results)}
        self.search: list[tuple[str, str, str, str]] = []
        self.code = Sources(folder)

    def write(self) -> None:
        stored, runs = summaries.stored(self.results), self._own_runs()
        known = {item["experiment"]: {**item, "draws": studies.samples(item, self.results)} for item in stored}
        places = {number: _results(self.results / f"chapter{number}") for number in chapters.numbers()}
        book = [Contents(n, found, self.folder, self.code, known).page(runs) for n, found in places.items()]
        book = [chapter for chapter in book if chapter["experiments"]]
        claims = [claim for chapter in book for claim in chapter["claims"]]
        index = self._equations(book)
        self.templates.globals["known_equations"] = {row["equation"] for row in index}
        common: dict[str, Any] = {
            "chapters": book, "claims": claims, "provenance": self._provenance(book), "score": verdicts.score(claims),
        }  # fmt: skip
        self._page("index", here="index", **common, strips=[_strip(chapter) for chapter in book])
        for chapter in book:
            for name in ("chapter", "parameters"):
                self._page(f"{name}{chapter['number']}", name, here=chapter["number"], chapter=chapter, **common)
        for run in runs:
            self._page_of_run(run, common)
        self._page("claims", here="claims", **common)
        self._page("errata", here="errata", **common)
        agreeing = [key for key, pair in crosscheck.verdicts(self.results).items() if len(set(pair)) == 1]
        told: dict[str, Any] = {
            "examples": verdicts.examples(claims),
            "never": verdicts.never_failed(claims),
            "agreeing": agreeing,
            "tie": TIE,
        }
        self._page("verdicts", here="verdicts", **told, **common)
        self._page("symbols", here="symbols", **common)
        self._page("equations", here="equations", equations=index, **common)
        for number, rows in itertools.groupby(index, lambda row: row["chapter"]):
            self._page(
                f"equations{number}", "equations", here="equations", number=number, equations=list(rows), **common
            )
        self._write_sources(common["provenance"])
        self._write_assets(book)

    def _page(self, name: str, template: str | None = None, **values: Any) -> None:
        text = self.templates.get_template(f"{template or name}.html").render(**values)
        (self.folder / f"{name}.html").write_text(text, encoding="utf-8")

    def _write_sources(self, revision: str) -> None:
        (self.folder / "source").mkdir()
        for page in self.code.pages():
            self._page(page["target"].removesuffix(".html"), "source", revision=revision, **page)

    def _write_assets(self, book: Book) -> None:
        for path in (HERE / "templates").glob("*.[cj]s*"):
            shutil.copyfile(path, self.folder / path.name)
        shutil.copytree(HERE / "vendor", self.folder / "vendor")
        for chapter in book:
            for experiment in chapter["experiments"]:
                self._write_series(experiment["series"])
        self._index_search(book)
        (self.folder / SEARCH).write_text(words.script("window.SEARCH_INDEX", self.search), encoding="utf-8")

    # ------------------------------------------------------------------------------------------------------ the search

    def _index_search(self, book: Book) -> None:
        """What is found: (kind, text shown, target, further words it is found by)."""
        for chapter in book:
            page, number = f"chapter{chapter['number']}.html", chapter["number"]
            self._searchable("chapter", f"Chapter {number}: {chapter['title']}", page)
            for claim in chapter["claims"]:
                known = " ".join(claim[key] for key in ("verdict", "robustness", "where", "noticed", "experiment"))
                text = f"{claim['id']} {claim['verdict']}: {claim['statement']}"
                self._searchable("claim", text, f"{page}#{claim['id']}", f"{known} {claim['source']} {claim['figure']}")
            for item in chapter["errata"]:
                text = f"{item['id']} {item['equation']}: {item['summary']}"
                self._searchable("erratum", text, f"{page}#{item['id']}", f"{item['kind']} {item['switch']}")
            for experiment in chapter["experiments"]:
                self._index_experiment(experiment, page)
            for item in chapter["symbols"]:
                text = f"{symbols.text(item['plain'])}, chapter {number}: {item['key']}"
                self._searchable("symbol", text, f"symbols.html#symbol-{number}-{item['key']}")
        for chapter in book:
            for item in (row for experiment in chapter["experiments"] for row in experiment["parameters"]):
                text = f"{item['key']} = {textwrap.shorten(str(item['value']), 40)}"
                to = f"parameters{chapter['number']}.html#key-{item['key']}"
                self._searchable("parameter", text, to, item["kind"])

    def _index_experiment(self, experiment: Mapping[str, Any], page: str) -> None:
        self._searchable("experiment", experiment["summary"], f"{page}#{experiment['name']}", experiment["name"])
        for figure in experiment["figures"]:
            self._searchable("figure", f"Fig. {figure['id']}: {figure['caption']}", f"{page}#fig-{figure['id']}")
        for table in experiment["tables"]:
            self._searchable("table", f"Table {table['id']}: {table['title']}", f"{page}#tab-{table['id']}")
        for law in experiment["code"]["laws"]:
            self._searchable("law", f"{law['name']}, used by {experiment['name']}", law["to"], law["label"])

    def _searchable(self, kind: str, text: str, to: str, more: str = "") -> None:
        self.search.append((kind, text, to, more))

    # --------------------------------------------------------------------------------------------------- the equations

    def _equations(self, book: Book) -> list[dict[str, Any]]:
        """Each equation, typeset, with its mentions: ``code``, ``parameter``, and ``named``, the errata and claims."""
        shown = {
            item["id"]: f"chapter{chapter['number']}.html#{item['id']}"
            for chapter in book
            for item in [*chapter["claims"], *chapter["errata"]]
        }
        printed, rows = equations.printed(), dict[str, dict[str, Any]]()
        mentions = [mention for mention in equations.index() if not printed or mention.equation in printed]
        for name in sorted({*printed, *(mention.equation for mention in mentions)}, key=equations.place):
            section, latex = printed.get(name, ("", ""))
            rows[name] = {"equation": name, "chapter": equations.place(name)[0], "section": section}
            rows[name]["typeset"] = equations.typeset(latex)
            rows[name] |= {"code": [], "parameter": [], "named": {}}
        for mention in mentions:
            link = self.code.link(mention.path, mention.line)
            entry = {**mention._asdict(), **link, "to": shown.get(mention.name, link["to"])}
            row = rows[mention.equation]
            if mention.kind in ("erratum", "claim"):
                row["named"].setdefault(mention.name, entry)
            else:
                row[mention.kind].append(entry)
        for row in rows.values():
            row["named"] = list(row["named"].values())
            row["used"] = bool(row["code"] or row["named"] or row["parameter"])
            names = ", ".join(dict.fromkeys(m["name"] for m in [*row["code"], *row["named"]])) or (
                "parameters" if row["parameter"] else f"not used, Sect. {row['section']}"
            )
            to = f"equations{row['chapter']}.html#eq-{row['equation']}"
            self._searchable("equation", f"Eq. ({row['equation']}): {names}", to, f"{row['equation']} equation")
        return list(rows.values())

    # ---------------------------------------------------------------------------------------------------- runs at hand

    def _own_runs(self) -> list[dict[str, Any]]:
        runs = []
        for path in sorted(self.results.glob("runs/*/run.json")):
            check_result(path.parent)
            run = read_json(path)
            runs.append({
                "name": path.parent.name, "chapter": run["chapter"], "experiment": run["experiment"],
                "differs": "; ".join(run["differs"][:12]), "page": f"run-{path.parent.name}.html",
                "folder": path.parent,
            })  # fmt: skip
        return runs

    def _page_of_run(self, run: dict[str, Any], common: Mapping[str, Any]) -> None:
        """A run with other parameters beside the book's: its claims, and its series with those of the book."""
        contents = Contents(run["chapter"], {run["experiment"]: run["folder"]}, self.folder, self.code, {}).page([])
        (experiment,) = contents["experiments"]
        shown = {entry["name"]: entry for chapter in common["chapters"] for entry in chapter["experiments"]}
        if book := shown.get(run["experiment"]):
            run["changes"] = verdicts.changes(book["claims"], experiment["claims"])
            if experiment["series"] and book["series"]:
                explorer.beside(experiment["series"], book["series"])
        self._write_series(experiment["series"])
        self._page(run["page"].removesuffix(".html"), "run", here=run["chapter"], chapter=contents, run=run, **common)

    def _write_series(self, item: Mapping[str, Any] | None) -> None:
        if item:
            text = words.script(f"RECORDED[{json.dumps(item['name'])}]", item)
            (self.folder / "files" / item["name"] / "series.js").write_text(text, encoding="utf-8")

    def _provenance(self, book: Book) -> str:
        runs = [experiment["run"] for chapter in book for experiment in chapter["experiments"]]
        revisions = sorted({run["revision"] or "unknown" for run in runs})
        wall = sum(run["wall"] for run in runs)
        return (
            f"dexrepro {__version__}; results of revision {', '.join(revisions) or 'none'}; "
            f"{len(runs)} experiments, {wall:.0f} s of one core in all"
        )


def _results(chapter: Path) -> dict[str, Path]:
    """Results of a chapter by experiment."""
    return {path.parent.name: path.parent for path in chapter.glob("*/run.json")}


def _strip(chapter: Mapping[str, Any]) -> dict[str, Any]:
    """A chapter's figures in the order of the book: 2.9a after 2.9, those of our own (2.A) last."""
    figures = [figure for experiment in chapter["experiments"] for figure in experiment["figures"]]
    ordered = sorted(figures, key=lambda figure: chapters.natural(figure["id"]))
    return {"number": chapter["number"], "title": chapter["title"], "figures": ordered}
