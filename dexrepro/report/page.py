"""The HTML report: one folder that opens from disk, built from the files in results/ alone."""

from __future__ import annotations

import json
import os
import re
import shutil
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jinja2
import pandas as pd
from markupsafe import Markup

from dexrepro import __version__, chapters, study
from dexrepro.claims import AFTER_CORRECTION, NOT_EVALUATED, REPRODUCED, VERDICTS
from dexrepro.config import compose_chapter, provenance
from dexrepro.experiment import Experiment
from dexrepro.report import equations, parameters, studies, symbols
from dexrepro.report.damage import check_result
from dexrepro.report.sources import Sources
from dexrepro.report.style import file_stem
from dexrepro.storage import read_json, whole_folder

SCALE = 1.7  # pixels a point of a figure
KINDS = {
    "error": "Inconsistent with the book's own equations: derived, with measured evidence.",
    "gap": "Something an implementation needs is not printed.",
    "reading": "Defensible as printed, under the reading named.",
    "slip": "Typesetting, or possibly the text extraction.",
}


def build(results: Path) -> Path:
    """Write ``results/report/`` and return the path of its index.html."""
    with whole_folder(results / "report") as folder:
        _Report(results, folder).write()
    return results / "report" / "index.html"


class _Report:
    """Collects what is in results/, copies what the pages show, and renders the pages."""

    def __init__(self, results: Path, folder: Path) -> None:
        self.results, self.folder = results, folder
        loader = jinja2.PackageLoader("dexrepro.report", "templates")
        self.templates = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True)
        self.templates.filters["breakable"] = _breakable
        self.search: list[dict[str, str]] = []
        self.sources = Sources(folder)
        self.studies = {item["experiment"]: item for item in study.stored(results)}

    def write(self) -> None:
        book = [self._chapter(number) for number in chapters.numbers()]
        book = [chapter for chapter in book if chapter["experiments"]]
        index = self._equations(book)
        self._search_parameters(book)
        common: dict[str, Any] = {"about": chapters.book(), "chapters": book, "provenance": self._provenance(book)}
        self._page("index", here="index", **common, **self._front(book))
        for chapter in book:
            self._page(f"chapter{chapter['number']}", "chapter", here=chapter["number"], chapter=chapter, **common)
        self._page("symbols", here="symbols", **common)
        self._page("equations", here="equations", equations=index, **common)
        (self.folder / "source").mkdir()
        for page in self.sources.pages():
            self._page(page["target"].removesuffix(".html"), "source", revision=common["provenance"], **page)
        for name in ("style.css", "app.js"):
            shutil.copyfile(Path(__file__).parent / "templates" / name, self.folder / name)
        data = json.dumps(self.search, separators=(",", ":")).replace("<", "\\u003c")
        (self.folder / "search-index.js").write_text(f"const SEARCH_INDEX = {data};\n")

    def _page(self, name: str, template: str | None = None, **values: Any) -> None:
        text = self.templates.get_template(f"{template or name}.html").render(**values)
        (self.folder / f"{name}.html").write_text(text)

    def _searchable(self, text: str, to: str) -> None:
        self.search.append({"text": text, "to": to})

    def _equations(self, book: list[dict[str, Any]]) -> list[dict[str, Any]]:
        """For each equation its mentions: ``code``, ``parameter``, and ``named``, the errata and claims."""
        shown = {item["id"]: f"chapter{c['number']}.html#{item['id']}" for c in book for item in _identified(c)}
        rows: dict[str, dict[str, Any]] = {}
        for mention in equations.index():
            link = self.sources.link(mention.path, mention.line)
            entry = {**mention._asdict(), **link, "to": shown.get(mention.name, link["to"])}
            row = rows.setdefault(
                mention.equation, {"equation": mention.equation, "code": [], "parameter": [], "named": {}}
            )
            if mention.kind in ("erratum", "claim"):
                row["named"].setdefault(mention.name, entry)
            else:
                row[mention.kind].append(entry)
        for row in rows.values():
            row["named"] = list(row["named"].values())
            words = ", ".join(dict.fromkeys(m["name"] for m in [*row["code"], *row["named"]]))
            self._searchable(f"Eq. ({row['equation']}): {words}", f"equations.html#eq-{row['equation']}")
        return list(rows.values())

    def _search_parameters(self, book: list[dict[str, Any]]) -> None:
        for chapter in book:
            for item in chapter["symbols"]:
                text = f"{symbols.text(item['plain'])}, chapter {chapter['number']}: {item['key']}"
                self._searchable(text, f"symbols.html#symbol-{chapter['number']}-{item['key']}")
        for chapter in book:
            for item in (row for experiment in chapter["experiments"] for row in experiment["parameters"]):
                value = textwrap.shorten(str(item["value"]), 40)
                self._searchable(f"{item['key']} = {value}", f"chapter{chapter['number']}.html#key-{item['key']}")

    # ------------------------------------------------------------------------------------------------- the chapters

    def _chapter(self, number: str) -> dict[str, Any]:
        chapter = chapters.load(number)
        place = self.results / f"chapter{number}"
        composed, origins = compose_chapter(number), provenance(number)
        made = [e for e in chapter.experiments if (place / e.name / "run.json").exists()]
        metrics: dict[str, Any] = {}
        for experiment in made:
            check_result(place / experiment.name, "metrics.json", "claims.json")
            metrics |= read_json(place / experiment.name / "metrics.json")
        experiments = []
        for experiment in made:
            entry = self._experiment(number, experiment, place / experiment.name)
            entry["parameters"] = parameters.table(experiment.name, composed, origins)
            entry["references"] = [
                {**vars(item), "ours": metrics.get(item.metric)}
                for item in chapter.references
                if item.metric.partition(".")[0] == experiment.name
            ]
            experiments.append(entry)
        errata = []
        for item in chapter.errata:
            evidence = [(name, metrics.get(name)) for name in item.evidence]
            errata.append({**vars(item), "evidence": evidence})
            self._searchable(f"{item.id} {item.equation}: {item.summary}", f"chapter{number}.html#{item.id}")
        rows = [row for entry in experiments for row in entry["parameters"]]
        untestable = [claim.evaluate({}).as_dict() for claim in chapter.claims if claim.not_testable]
        runs = [run for run in self._own_runs() if run["chapter"] == number]
        return {
            "number": number,
            "title": chapter.title,
            "experiments": experiments,
            "symbols": parameters.index(composed, origins, rows),
            "errata": errata,
            "untestable": untestable,
            "runs": runs,
        }

    def _experiment(self, number: str, experiment: Experiment, place: Path) -> dict[str, Any]:
        run, claims = read_json(place / "run.json"), read_json(place / "claims.json")
        target = self.folder / "files" / experiment.name
        target.mkdir(parents=True)
        files = []
        for path in sorted([*place.glob("*.json"), place / "config.yaml", *place.glob("series/*")]):
            _copy(path, target / path.name)
            files.append({"name": path.name, "path": f"files/{experiment.name}/{path.name}"})
        for claim in claims:
            self._searchable(f"{claim['id']} {claim['statement']}", f"chapter{number}.html#{claim['id']}")
        factor = f", {run['real_time_factor']:.1f} times real time" if run["real_time_factor"] else ""
        packages = ", ".join(f"{name} {version}" for name, version in run["packages"].items())
        return {
            "name": experiment.name,
            "summary": experiment.summary,
            "claims": claims,
            "figures": [
                self._figure(number, identifier, figure.caption, figure.alt, place, target, claims)
                for identifier, figure in experiment.figures.items()
                if (place / "figures" / f"{file_stem(identifier)}.svg").exists()
            ],
            "tables": [
                self._table(number, identifier, title, place / "tables" / f"{identifier}.csv", target)
                for identifier, title in experiment.tables.items()
                if (place / "tables" / f"{identifier}.csv").exists()
            ],
            "films": [
                self._film(path, experiment, target)
                for path in sorted(place.glob("animation/*.gif"))
                if path.with_suffix(".png").exists()
            ],
            "study": self._study(experiment.name, target),
            "files": files,
            "run": run,
            "provenance": (
                f"dexrepro {run['version']}, revision {run['revision'] or 'unknown'}, seed {run['seed']}; {packages}; "
                f"Python {run['python']}; {run['machine']}; {run['wall']:.1f} s of one core{factor}"
            ),
        }

    def _film(self, path: Path, experiment: Experiment, target: Path) -> dict[str, str]:
        for suffix in (".gif", ".png"):
            _copy(path.with_suffix(suffix), target / f"film_{path.stem}{suffix}")
        film, link = experiment.film, f"files/{target.name}/film_{path.stem}"
        return {
            "case": path.stem,
            "caption": film.caption if film and film.case == path.stem else "The arms, from the recording.",
            "alt": f"The simulated arms, and {film.label} over time" if film else "The simulated arms",
            "gif": f"{link}.gif",
            "still": f"{link}.png",
        }

    def _study(self, experiment: str, target: Path) -> dict[str, Any] | None:
        found = self.studies.get(experiment)
        if not found or not found["claims"]:
            return None
        path = studies.save(found, target / "study.svg")
        return {**found, "svg": f"files/{target.name}/{path.name}", "finding": studies.finding(found)}

    def _figure(
        self, number: str, identifier: str, caption: str, alt: str, place: Path, target: Path, claims: list[Any]
    ) -> dict[str, Any]:
        stem = file_stem(identifier)
        for suffix in (".svg", ".png"):
            _copy(place / "figures" / f"{stem}{suffix}", target / f"{stem}{suffix}")
        self._searchable(f"Fig. {identifier}: {caption}", f"chapter{number}.html#fig-{identifier}")
        return {
            "id": identifier,
            "chapter": number,
            "caption": caption,
            "alt": alt or caption,
            "svg": f"files/{target.name}/{stem}.svg",
            "width": _width(target / f"{stem}.svg"),
            "png": f"files/{target.name}/{stem}.png",
            "claims": [claim for claim in claims if _concerns(claim["figure"], identifier)],
        }

    def _table(self, number: str, identifier: str, title: str, path: Path, target: Path) -> dict[str, Any]:
        frame = pd.read_csv(path)
        _copy(path, target / path.name)
        (target / f"{identifier}.tex").write_text(frame.to_latex(index=False, float_format="%.4g", escape=True))
        self._searchable(f"Table {identifier}: {title}", f"chapter{number}.html#tab-{identifier}")
        base = f"files/{target.name}/{identifier}"
        return {
            "id": identifier,
            "title": title,
            "columns": [(name, _column_kind(frame[name])) for name in frame],
            "rows": [[_cell(value) for value in row] for row in frame.astype(object).to_numpy().tolist()],
            "csv": f"{base}.csv",
            "tex": f"{base}.tex",
        }

    def _own_runs(self) -> list[dict[str, Any]]:
        runs = []
        for path in sorted(self.results.glob("runs/*/run.json")):
            check_result(path.parent)
            run = read_json(path)
            runs.append(
                {"name": path.parent.name, "chapter": run["chapter"], "differs": "; ".join(run["differs"][:12])}
            )
        return runs

    # ------------------------------------------------------------------------------------------------ the front page

    def _front(self, book: list[dict[str, Any]]) -> dict[str, Any]:
        rows = [_score(chapter) for chapter in book]
        ours = [row["own"] for row in rows]
        totals = {
            "counts": [sum(column) for column in zip(*(row["counts"] for row in rows), strict=True)],
            "built_in": sum(row["built_in"] for row in rows),
            "ours": f"{sum(held for held, _ in ours)} of {sum(made for _, made in ours)}",
        }
        errata = [
            (kind, meaning, [item for chapter in book for item in chapter["errata"] if item["kind"] == kind])
            for kind, meaning in KINDS.items()
        ]
        return {
            "verdicts": VERDICTS,
            "scoreboard": rows,
            "totals": totals,
            "gallery": [figure for c in book for figure in _in_book_order(c)],
            "errata": errata,
            "studies": [
                {"claim": claim, "chapter": chapter["number"], **experiment["study"]["claims"][claim["id"]]}
                for chapter in book
                for experiment in chapter["experiments"]
                for claim in experiment["claims"]
                if experiment["study"] and claim["id"] in experiment["study"]["claims"]
            ],
        }

    def _provenance(self, book: list[dict[str, Any]]) -> str:
        runs = [experiment["run"] for chapter in book for experiment in chapter["experiments"]]
        revisions = sorted({run["revision"] or "unknown" for run in runs})
        wall = sum(run["wall"] for run in runs)
        return (
            f"dexrepro {__version__}; results of revision {', '.join(revisions) or 'none'}; "
            f"{len(runs)} experiments, {wall:.0f} s of one core in all"
        )


def _score(chapter: Mapping[str, Any]) -> dict[str, Any]:
    claims = [claim for experiment in chapter["experiments"] for claim in experiment["claims"]] + chapter["untestable"]
    book = [claim for claim in claims if claim["source"] == "book"]
    own = [claim for claim in claims if claim["source"] != "book" and claim["verdict"] != NOT_EVALUATED]
    held = sum(claim["verdict"] in (REPRODUCED, AFTER_CORRECTION) for claim in own)
    return {
        "number": chapter["number"],
        "title": chapter["title"],
        "counts": [sum(claim["verdict"] == verdict for claim in book) for verdict in VERDICTS],
        "built_in": sum(bool(claim["by_construction"]) for claim in book),
        "own": (held, len(own)),
        "ours": f"{held} of {len(own)}",
    }


def _identified(chapter: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Claims and errata that a chapter's page shows."""
    claims = [claim for experiment in chapter["experiments"] for claim in experiment["claims"]]
    return [*claims, *chapter["untestable"], *chapter["errata"]]


def _in_book_order(chapter: Mapping[str, Any]) -> list[dict[str, Any]]:
    figures = [figure for experiment in chapter["experiments"] for figure in experiment["figures"]]

    def place(figure: Mapping[str, Any]) -> tuple[int, str]:
        rest = figure["id"].partition(".")[2]
        digits = "".join(character for character in rest if character.isdigit())
        return (int(digits) if digits else 999, rest)

    return sorted(figures, key=place)


def _concerns(claimed: str, identifier: str) -> bool:
    """Whether a claim about "2.8a" or "2.8, 2.9" is about the figure "2.8", and one about "2.8" about "2.8a"."""
    parts = [part.strip() for part in claimed.replace(";", ",").split(",")]
    panels = "abcdefgh"
    return any(identifier in (part, part.rstrip(panels)) or identifier.rstrip(panels) == part for part in parts)


def _breakable(name: str) -> Markup:
    """A dotted name that may be broken between its parts, and only there."""
    return Markup("<wbr>").join(re.split(r"(?<=[._=,])(?=\w)", name))


def _width(svg: Path) -> int:
    """How wide a figure is shown [pixels], so that its letters have one size whether it has one column or two."""
    found = re.search(r'<svg[^>]*? width="([\d.]+)pt"', svg.read_text()[:2000])
    return round(SCALE * float(found[1])) if found else 800


def _column_kind(column: pd.Series[Any]) -> str:
    """How a table's column is set: "number", "words" (some cell is a phrase, so that it needs width) or ""."""
    if column.dtype.kind in "if":
        return "number"
    return "words" if column.astype(str).str.len().max() > 24 else ""


def _cell(value: Any) -> str:
    """A table's entry: a minus sign at which no line is broken, words in place of ``True`` and of a key."""
    if pd.isna(value):
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str) and re.fullmatch(r"[a-z][a-z0-9]+(_[a-z0-9]+)+", value):
        return value.replace("_", " ")
    if isinstance(value, float):
        return (f"{value:.0f}" if 1e4 <= abs(value) < 1e6 else f"{value:.4g}").replace("-", "\u2212")
    return str(value)


def _copy(source: Path, target: Path) -> None:
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)
