"""What there is: chapters, experiments, cases, figures, tables, claims and errata, as plain data."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dexrepro import baselines, chapters
from dexrepro.cases import experiment_cases, settings
from dexrepro.claims import filled
from dexrepro.config import compose_chapter, config_files
from dexrepro.disk_cache import cached
from dexrepro.study.summaries import robustness_of


def listing() -> dict[str, Any]:
    """The data behind ``dexrepro list --json``."""
    found = [chapter_listing(number) for number in chapters.numbers()]
    for chapter in found:
        words = robustness_of(chapter["chapter"])
        chapter["claims"] = [{**claim, "robustness": words.get(claim["id"], "")} for claim in chapter["claims"]]
    return {"chapters": found}


def chapter_listing(number: str) -> dict[str, Any]:
    """One chapter, without what studies show of its claims; its figures are imported when its files have changed."""

    def listed() -> tuple[dict[str, Any], set[Path]]:
        home, folder, package = Path(chapters.__file__).parent, chapters.folders()[number], Path(__file__).parents[1]
        files = {*folder.rglob("*.py"), *home.glob("*.py"), *package.glob("*.py"), *config_files(number).values()}
        files |= {Path(__file__), *(baselines.baseline_file(number, name) for name in chapters.names(number))}
        files |= {path.parent for path in files}
        return _listed(number), {path for path in files if path.exists()}

    return dict(cached(f"list {number} of {chapters.folders()[number]}", listed))


def _listed(number: str) -> dict[str, Any]:
    chapter, composed = chapters.load(number), compose_chapter(number)
    metrics: dict[str, Any] = baselines.stored_values(number)
    for experiment in chapter.experiments:
        metrics |= settings(composed, experiment.name)
    return {
        "chapter": number,
        "title": chapter.title,
        "experiments": [
            {
                "name": experiment.name,
                "summary": experiment.summary,
                "cases": list(experiment_cases(composed, experiment.name)),
                "figures": list(experiment.figures),
                "tables": list(experiment.tables),
            }
            for experiment in chapter.experiments
        ],
        "claims": [
            {
                "id": claim.id,
                "figure": claim.figure,
                "statement": claim.statement,
                "predicate": str(claim.predicate or f"not testable: {claim.not_testable}"),
                "source": claim.source,
                "where": claim.where,
                "control": str(claim.control) if claim.control else None,
                "no_control": claim.no_control or claim.by_construction or claim.not_testable,
                "credits": claim.credits,
                "by_construction": claim.by_construction,
            }
            for claim in chapter.claims
        ],
        "errata": [
            {
                "id": erratum.id,
                "equation": erratum.equation,
                "kind": erratum.kind,
                "summary": filled(erratum.summary, metrics),
                "switch": erratum.switch,
            }
            for erratum in chapter.errata
        ],
    }
