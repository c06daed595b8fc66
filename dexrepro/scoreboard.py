"""The claims of the book counted: by verdict, and how many of them are reproduced, severely tested and robust.

Counted from the stored baselines and studies alone, so that the README has the same numbers everywhere.
"""

from __future__ import annotations

from typing import Any

from dexrepro import baselines, chapters
from dexrepro.claims import FRAGILE, OPEN, ROBUST, VERDICTS
from dexrepro.report import verdicts
from dexrepro.report.listing import chapter_listing
from dexrepro.study.summaries import robustness_of

WORDS = (ROBUST, FRAGILE, OPEN)  # what studies show of the claims that hold


def _row(number: str) -> dict[str, Any]:
    """What a chapter has, its claims of the book by verdict, those severely tested, and the headline."""
    chapter, listed = chapters.load(number), chapter_listing(number)["experiments"]
    metrics, words = baselines.stored_values(number), robustness_of(number)
    claims = [
        {**claim.evaluate(metrics).as_dict(), "robustness": words.get(claim.id, OPEN)}
        for claim in chapter.claims
        if claim.source == "book"
    ]
    score = verdicts.score(claims)
    shown = [claim["robustness"] for claim in claims if claim["verdict"] in verdicts.HOLDS]
    return {
        "chapter": number,
        "figures": sum(len(experiment["figures"]) for experiment in listed),
        "tables": sum(len(experiment["tables"]) for experiment in listed),
        "claims": score["total"],
        **{verdict: score["counts"][verdict] for verdict in VERDICTS},
        **{word: shown.count(word) for word in WORDS},
        "severe": score["severe"],
        "headline": score["headline"],
    }


COLUMNS = {
    "chapter": "chapter", "figures": "figures", "tables": "tables", "claims": "claims of the book",
    "headline": "reproduced, severely tested and robust", "severe": "hold and are severely tested",
    **{verdict: verdict for verdict in VERDICTS},
    ROBUST: "hold, robust", FRAGILE: "hold, fragile", OPEN: "hold, open or no study",
}  # fmt: skip


def markdown() -> str:
    """The table of the README."""
    counted = [_row(number) for number in chapters.numbers()]
    total = {key: "all" if key == "chapter" else sum(row[key] for row in counted) for key in COLUMNS}
    lines = [" | ".join(COLUMNS.values()), " | ".join("---" for _ in COLUMNS)]
    lines += [" | ".join(str(row[key]) for key in COLUMNS) for row in (*counted, total)]
    return "\n".join(f"| {line} |" for line in lines)
