"""The claims of the book counted: by verdict, and how many of them are reproduced, severely tested and robust.

Counted from the stored baselines and studies alone, so that README, pages and tests have the same numbers.
"""

from __future__ import annotations

from typing import Any

from dexrepro import baselines, chapters, study
from dexrepro.claims import AFTER_CORRECTION, FRAGILE, OPEN, REPRODUCED, ROBUST, VERDICTS
from dexrepro.report.listing import chapter_listing

WORDS = (ROBUST, FRAGILE, OPEN)  # what studies show of the claims that hold


def rows() -> list[dict[str, Any]]:
    """One row a chapter: what it has, its claims of the book by verdict, those severely tested, and the headline."""
    return [_row(number) for number in chapters.numbers()]


def _row(number: str) -> dict[str, Any]:
    chapter, listed = chapters.load(number), chapter_listing(number)["experiments"]
    stored = baselines.stored(number).values()
    metrics = {name: entry["value"] for baseline in stored for name, entry in baseline.metrics.items()}
    evaluated = [claim.evaluate(metrics) for claim in chapter.claims if claim.source == "book"]
    words = study.robustness_of(number)
    hold = [item for item in evaluated if item.verdict in (REPRODUCED, AFTER_CORRECTION)]
    severe = [item for item in hold if item.severe]
    shown = [words.get(item.id, OPEN) for item in hold]
    return {
        "chapter": number,
        "title": chapter.title,
        "figures": sum(len(experiment["figures"]) for experiment in listed),
        "tables": sum(len(experiment["tables"]) for experiment in listed),
        "claims": len(evaluated),
        **{verdict: sum(item.verdict == verdict for item in evaluated) for verdict in VERDICTS},
        **{word: shown.count(word) for word in WORDS},
        "severe": len(severe),
        "headline": sum(words.get(item.id) == ROBUST for item in severe if item.verdict == REPRODUCED),
        "headline after correction": sum(words.get(item.id) == ROBUST for item in severe if item.verdict != REPRODUCED),
    }


COLUMNS = {
    "chapter": "chapter", "figures": "figures", "tables": "tables", "claims": "claims of the book",
    "headline": "reproduced, severely tested and robust", "severe": "hold and are severely tested",
    **{verdict: verdict for verdict in VERDICTS},
    ROBUST: "hold, robust", FRAGILE: "hold, fragile", OPEN: "hold, open or no study",
}  # fmt: skip


def markdown() -> str:
    """The table of the README."""
    counted = rows()
    total = {key: "all" if key == "chapter" else sum(row[key] for row in counted) for key in COLUMNS}
    lines = [" | ".join(COLUMNS.values()), " | ".join("---" for _ in COLUMNS)]
    lines += [" | ".join(str(row[key]) for key in COLUMNS) for row in (*counted, total)]
    return "\n".join(f"| {line} |" for line in lines)
