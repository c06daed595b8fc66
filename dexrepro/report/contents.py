"""What the page of a chapter shows, gathered from its results: experiments, figures, claims, errata, runs."""

from __future__ import annotations

import base64
import io
import json
import os
import re
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from PIL import Image

from dexrepro import chapters
from dexrepro.cases import experiment_cases, resolved_block, settings
from dexrepro.checks import leaves
from dexrepro.claims import Claim, Erratum, cases_in, filled
from dexrepro.config import compose_chapter
from dexrepro.damage import check_result, is_safe, read_picture, read_table
from dexrepro.experiment import Experiment
from dexrepro.plan import lacking, outdated, plan_chapter
from dexrepro.provenance import provenance
from dexrepro.report import equations, explorer, parameters, relations, sources, studies, verdicts, words
from dexrepro.report.style import file_stem
from dexrepro.storage import read_json, read_yaml

SCALE = 1.7  # pixels a point of a figure
THUMBNAIL = 240  # pixels
OPEN_ROWS = 8  # a longer table is folded


class Contents:
    """One chapter, of the results in ``places`` by experiment; pages point at lines of the code through ``code``."""

    def __init__(
        self, number: str, places: Mapping[str, Path], folder: Path, code: sources.Sources, studies: Mapping[str, Any]
    ) -> None:
        self.number, self.places, self.folder, self.code, self.studies = number, places, folder, code, studies
        self.chapter = chapters.load(number)
        self.composed, self.origins = compose_chapter(number), provenance(number)
        self.metrics: dict[str, Any] = {}
        self.settings: dict[str, Any] = {}
        self.experiments: list[dict[str, Any]] = []
        made = [experiment for experiment in self.chapter.experiments if experiment.name in places]
        self.absent = [
            {"name": e.name, "number": number, "why": lacking(e)} for e in self.chapter.experiments if e not in made
        ]
        for experiment in made:
            check_result(places[experiment.name], "metrics.json", "claims.json", "config.yaml")
            self.metrics |= read_json(places[experiment.name] / "metrics.json")
            self.settings |= settings(self.composed, experiment.name)
        as_shipped = [experiment.name for experiment in made if places[experiment.name].name == experiment.name]
        plans = plan_chapter(number, write=False)[0] if as_shipped else []
        self.plans = {plan.experiment: plan for plan in plans if plan.experiment in as_shipped}
        self.definitions = relations.definitions(self.chapter.folder) if made else {}
        self.errata = {item.id: self._erratum(item) for item in self.chapter.errata} if made else {}
        for experiment in made:
            self.experiments.append(self._experiment(experiment))
        self.untestable = [
            self._claim(claim.evaluate({}).as_dict(), claim) for claim in self.chapter.claims if claim.not_testable
        ]

    def page(self, runs: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
        """The values of the chapter's template."""
        claims = [claim for entry in self.experiments for claim in entry["claims"]] + self.untestable
        rows = [row for entry in self.experiments for row in entry["parameters"]]
        placed = {item["id"] for entry in self.experiments for item in entry["errata"]}
        return {
            "number": self.number,
            "title": self.chapter.title,
            "fairness": self.chapter.fairness,
            "experiments": self.experiments,
            "absent": self.absent,
            "claims": claims,
            "score": verdicts.score(claims),
            "symbols": parameters.index(self.composed, self.origins, rows),
            "errata": list(self.errata.values()),
            "other_errata": [item for item in self.errata.values() if item["id"] not in placed],
            "untestable": self.untestable,
            "runs": [run for run in runs if run["chapter"] == self.number],
        }

    def _line(self, identifier: str) -> dict[str, Any] | None:
        found = self.definitions.get(identifier)
        return self.code.link(*found) if found else None

    # ------------------------------------------------------------------------------------------------- one experiment

    def _experiment(self, experiment: Experiment) -> dict[str, Any]:
        place = self.places[experiment.name]
        target = self.folder / "files" / place.name
        target.mkdir(parents=True)
        run, study = read_json(place / "run.json"), self._study(experiment.name, target)
        files = []
        for path in sorted([*place.glob("*.json"), place / "config.yaml", *place.glob("series/*")]):
            _link(path, target / path.name)
            files.append({"name": path.name, "path": f"files/{target.name}/{path.name}"})
        used = leaves({experiment.name: read_yaml(place / "config.yaml")})
        numbers = {**dict(used), **self.metrics}
        written = {claim.id: claim for claim in self.chapter.claims}
        claims = [
            self._claim(entry, written.get(entry["id"]), study["claims"].get(entry["id"]) if study else None)
            for entry in read_json(place / "claims.json")
        ]
        figures = [
            self._figure(identifier, filled(figure.caption, numbers), filled(figure.alt, numbers), place, target)
            for identifier, figure in experiment.figures.items()
            if is_safe(place / "figures" / f"{file_stem(identifier)}.svg")
        ]
        series = explorer.write(place, target, run["cases"], experiment.film, experiment.units)
        if series:
            series["scene"] = explorer.scene(place, target, experiment)
        factor = f", {run['real_time_factor']:.1f} times real time" if run["real_time_factor"] else ""
        packages = ", ".join(f"{name} {version}" for name, version in run["packages"].items())
        return {
            "name": experiment.name,
            "chapter": self.number,
            "summary": experiment.summary,
            "answer": verdicts.answer(claims),
            "claims": claims,
            "figures": _with_claims(figures, claims),
            "other_claims": [c for c in claims if not any(relations.concerns(c["figure"], f["id"]) for f in figures)],
            "tables": [
                self._table(identifier, title, place / "tables" / f"{identifier}.csv", target)
                for identifier, title in experiment.tables.items()
                if (place / "tables" / f"{identifier}.csv").exists()
            ],
            "films": [
                _film(path, experiment, target, numbers)
                for path in sorted(place.glob("animation/*.gif"))
                if path.with_suffix(".png").exists()
            ],
            "study": study,
            "series": series,
            "parameters": parameters.table(
                experiment.name, self.composed, self.origins, read_yaml(place / "config.yaml")
            ),
            "outdated": outdated(self.plans[experiment.name], run) if experiment.name in self.plans else "",
            "references": [
                {**vars(item), "ours": self.metrics.get(item.metric)}
                for item in self.chapter.references
                if item.metric.partition(".")[0] == experiment.name
            ],
            "errata": self._errata_of(experiment, claims),
            "code": self._code(experiment),
            "files": files,
            "run": run,
            "provenance": (
                f"dexrepro {run['version']}, revision {run['revision'] or 'unknown'}, seed {run['seed']}; {packages}; "
                f"Python {run['python']}; {run['machine']}; {run['wall']:.1f} s of one core{factor}"
            ),
        }

    def _claim(
        self, entry: Mapping[str, Any], claim: Claim | None, row: Mapping[str, Any] | None = None
    ) -> dict[str, Any]:
        """A claim as evaluated, with all that belongs to it."""
        touching = relations.errata_of(claim, self.chapter.errata, self.composed) if claim else []
        text = " ".join([entry["statement"], entry["note"], entry["where"], *(item.equation for item in touching)])
        cases, over_several = cases_in(entry["values"])
        shown = {**entry, "study": row, "robustness": verdicts.robustness(row), "chapter": self.number}
        beside = filled(claim.beside, self.metrics) if claim else ""
        return {
            **shown,
            "strength": verdicts.strength(shown),
            "severe": verdicts.is_severe(shown),
            "noticed": verdicts.noticed(shown),
            "often": verdicts.often(shown),
            "beside": "" if "?" in beside else beside,  # its numbers are not there
            "where": words.section(entry["where"]),
            "errata": touching,
            "equations": equations.numbers(text),
            "cases": cases,
            "over_cases": over_several,
            "line": self._line(entry["id"]),
            "experiment": next(iter(entry["values"]), "").partition(".")[0],
        }

    def _erratum(self, item: Erratum) -> dict[str, Any]:
        evidence = [(name, self.metrics.get(name)) for name in item.evidence]
        numbers = {**self.settings, **self.metrics}
        return {
            **vars(item), "switch": item.typed, "evidence": evidence,
            "summary": filled(item.summary, numbers), "correction": filled(item.correction, numbers),
            "equations": equations.numbers(item.equation),
            "line": self._line(item.id), "chapter": self.number,
        }  # fmt: skip

    def _errata_of(self, experiment: Experiment, claims: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        """Errata that touch a claim of the experiment or rest on its metrics, without those of an earlier one."""
        touching = {item.id for claim in claims for item in claim["errata"]}
        before = {item["id"] for entry in self.experiments for item in entry["errata"]}
        mine = [
            item for item in self.errata.values()
            if item["id"] in touching or any(name.startswith(f"{experiment.name}.") for name, _ in item["evidence"])
        ]  # fmt: skip
        return [item for item in mine if item["id"] not in before]

    def _code(self, experiment: Experiment) -> dict[str, Any]:
        """Lines of the experiment's functions and of the laws it names, and the equations that these mention."""
        functions = [experiment.function(name) for name in ("scene", "simulate", "measure")]
        block = [resolved_block(self.composed, experiment.name), experiment_cases(self.composed, experiment.name)]
        laws = relations.laws(block)
        own = {sources.place(thing) for thing in functions if thing}
        texts = [path.read_text("utf-8") for path in {path for path, _ in own}] + [law.__doc__ or "" for law in laws]
        return {
            "functions": [
                {"name": thing.__name__, **self.code.link(*sources.place(thing))} for thing in functions if thing
            ],
            "laws": [{"name": law.__qualname__, **self.code.link(*sources.place(law))} for law in laws],
            "equations": sorted(equations.numbers("\n\n".join(texts)), key=equations.place),
        }

    def _study(self, experiment: str, target: Path) -> dict[str, Any] | None:
        found = self.studies.get(experiment)
        if not found or not found["claims"]:
            return None
        path = studies.save(found, target / "study.svg")
        if found["draws"]:
            said = {claim.id: claim.statement for claim in self.chapter.claims}
            data = {
                "chapter": self.number, "option": chapters.option(self.number), "experiment": experiment,
                "draws": found["draws"], "varied": found["varied"],
                "claims": [{"id": key, "statement": said.get(key, ""), "parameter": row["parameter"]}
                           for key, row in found["claims"].items()],
            }  # fmt: skip
            (target / "study.js").write_text(words.script(f"STUDIES[{json.dumps(target.name)}]", data), "utf-8")
        return {**found, "svg": f"files/{target.name}/{path.name}", "finding": studies.finding(found)}

    def _figure(self, identifier: str, caption: str, alt: str, place: Path, target: Path) -> dict[str, Any]:
        stem = file_stem(identifier)
        _link(place / "figures" / f"{stem}.png", target / f"{stem}.png")
        _thumbnail(place / "figures" / f"{stem}.png", target / f"{stem}.webp")
        drawing = _light((place / "figures" / f"{stem}.svg").read_text("utf-8"))
        (target / f"{stem}.svg").write_text(drawing, encoding="utf-8")
        return {
            "id": identifier,
            "chapter": self.number,
            "caption": caption,
            "alt": alt or caption,
            "svg": f"files/{target.name}/{stem}.svg",
            "png": f"files/{target.name}/{stem}.png",
            "thumbnail": f"files/{target.name}/{stem}.webp",
            "kind": "picture" if "<image" in drawing else "plot",
            "size": _size(drawing),
        }

    def _table(self, identifier: str, title: str, path: Path, target: Path) -> dict[str, Any]:
        frame = read_table(path)
        _link(path, target / path.name)
        (target / f"{identifier}.tex").write_text(
            frame.to_latex(index=False, float_format="%.4g", escape=True), encoding="utf-8"
        )
        base = f"files/{target.name}/{identifier}"
        return {
            "id": identifier,
            "title": title,
            "columns": [(words.cell(name), words.column_kind(frame[name])) for name in frame],
            "rows": [[words.cell(value) for value in row] for row in frame.astype(object).to_numpy().tolist()],
            "folded": len(frame) > OPEN_ROWS,
            "csv": f"{base}.csv",
            "tex": f"{base}.tex",
        }


def _link(source: Path, target: Path) -> None:
    """A hard link, or a copy on another file system."""
    try:
        os.link(source, target)
    except OSError:
        shutil.copyfile(source, target)


def _with_claims(figures: Sequence[dict[str, Any]], claims: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Each claim stands beside the first figure it is about; the others only refer to it."""
    seen: set[str] = set()
    for figure in figures:
        about = [claim for claim in claims if relations.concerns(claim["figure"], figure["id"])]
        figure["claims"] = [claim for claim in about if claim["id"] not in seen]
        figure["mentioned"] = [claim for claim in about if claim["id"] in seen]
        seen |= {claim["id"] for claim in about}
    return list(figures)


def _film(path: Path, experiment: Experiment, target: Path, numbers: Mapping[str, Any]) -> dict[str, str]:
    for suffix in (".gif", ".png"):
        _link(path.with_suffix(suffix), target / f"film_{path.stem}{suffix}")
    film, link = experiment.film, f"files/{target.name}/film_{path.stem}"
    caption = film.caption if film and film.case == path.stem else "The arms, from the recording."
    return {
        "case": path.stem,
        "caption": filled(caption, numbers),
        "alt": f"The simulated arms, and {film.label} over time" if film else "The simulated arms",
        "gif": f"{link}.gif",
        "still": f"{link}.png",
    }


def _thumbnail(source: Path, target: Path) -> None:
    picture = read_picture(source)
    picture.thumbnail((THUMBNAIL, THUMBNAIL), Image.Resampling.LANCZOS)
    picture.save(target, quality=70, method=4)


def _light(svg: str) -> str:
    """A drawing at a third of its weight, which nobody sees: paths to a hundredth of a point, 256 colours a picture."""

    def rounded(path: re.Match[str]) -> str:
        return " ".join(re.sub(r"-?\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}", path[0]).split())

    def few_colours(picture: re.Match[str]) -> str:
        with Image.open(io.BytesIO(base64.b64decode(picture[0]))) as image:
            opaque = image.mode != "RGBA" or image.getchannel("A").getextrema() == (255, 255)
            palette = image.convert("RGB" if opaque else "RGBA").quantize(256, dither=Image.Dither.NONE)
        palette.save(packed := io.BytesIO(), "PNG", optimize=True)
        return min(base64.b64encode(packed.getvalue()).decode(), picture[0], key=len)

    return re.sub(r"(?<=data:image/png;base64,)[^\"]+", few_colours, re.sub(r'(?<= d=")[^"]*', rounded, svg))


def _size(svg: str) -> tuple[int, int]:
    """How large a figure is shown [pixels], so that its letters have one size whether it has one column or two."""
    found = re.search(r'<svg[^>]*? width="([\d.]+)pt" height="([\d.]+)pt"', svg[:2000])
    return (round(SCALE * float(found[1])), round(SCALE * float(found[2]))) if found else (800, 400)
