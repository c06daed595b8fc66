"""What there is: chapters, experiments, cases, figures, tables, claims and errata, as plain data."""

from __future__ import annotations

from typing import Any

from dexrepro import baselines, chapters
from dexrepro.claims import filled
from dexrepro.config import compose_chapter, experiment_cases
from dexrepro.study import robustness_of


def listing() -> dict[str, Any]:
    """The data behind ``dexrepro list --json``."""
    return {"chapters": [_chapter(number) for number in chapters.numbers()]}


def _chapter(number: str) -> dict[str, Any]:
    chapter, composed = chapters.load(number), compose_chapter(number)
    words = robustness_of(number)
    metrics = {
        name: entry["value"] for item in baselines.stored(number).values() for name, entry in item.metrics.items()
    }
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
                "robustness": words.get(claim.id, ""),
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
