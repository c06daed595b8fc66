"""The drawing of a study shows each claim with its interval, its margin and what it follows."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from dexrepro import cli
from dexrepro.plan import plan_chapter
from dexrepro.report import page, studies
from dexrepro.runner import run_plans
from dexrepro.storage import write_json
from dexrepro.study import samples, summaries


def entry(index: int, largest: float) -> dict:
    cases = {"plain": {"final": 1.0, "largest": largest}, "fast": {"final": 0.5}}
    rows = {case: {"content": "", "metrics": metrics, "seconds": 0.0} for case, metrics in cases.items()}
    return {"index": index, "values": {"decay.start": float(index)}, "cases": rows}


@pytest.fixture
def entries() -> list[dict]:
    """Twenty samples: C90.01 always holds, C90.02 in the first half, by a margin that falls with the start."""
    return [entry(k, 0.2625 + 0.025 * k) for k in range(20)]


@pytest.fixture
def summary(toy: Path, entries: list[dict]) -> dict:
    return summaries.summary("90", "decay", entries)


def test_the_margin_is_summarised_by_quantiles(summary: dict) -> None:
    expected = [-0.4275, -0.2375, 0.0, 0.2375, 0.4275]
    assert summary["claims"]["C90.02"]["quantiles"] == pytest.approx(expected)


def test_the_samples_of_a_study_are_those_of_its_summary(summary: dict, entries: list[dict]) -> None:
    lines = Path("results/studies/decay.jsonl")
    lines.parent.mkdir(parents=True)
    lines.write_text("".join(json.dumps(item) + "\n" for item in entries))
    draws = studies.samples(summary, Path("results"))
    assert [draw["margins"]["C90.02"] > 0 for draw in draws] == [True] * 10 + [False] * 10
    assert draws[3]["values"] == {"decay.start": 3.0}
    assert draws[3]["margins"]["C90.03"] is None
    lines.write_text("".join(json.dumps(item) + "\n" for item in entries[:5]))
    assert studies.samples(summary, Path("results")) == [], "of another number of samples than the summary"


def test_the_figure_shows_shares_intervals_and_what_a_claim_follows(summary: dict) -> None:
    figure = studies.draw(summary)
    shares, margins = figure.axes
    assert [label.get_text() for label in shares.get_yticklabels()] == ["C90.02", "C90.01"]
    whiskers = [line.get_xdata() for line in shares.lines if len(line.get_xdata()) == 2]
    row = summary["claims"]["C90.02"]
    assert list(whiskers[0]) == pytest.approx([100 * row["low"], 100 * row["high"]])
    words = {text.get_text() for text in margins.texts}
    assert {"start (\u22121.0)", "\u2013", "follows most"} <= words
    assert studies.finding(summary) == "Of 2 claims over 20 samples: 1 fragile, 1 open"


def test_the_report_shows_stored_studies(summary: dict, toy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(samples, "baseline_dir", lambda: toy / "baselines")
    (toy / "baselines/study").mkdir(parents=True)
    write_json(toy / "baselines/study/decay.json", summary)
    plans, _ = plan_chapter("90")
    run_plans(plans, workers=1, force=False)
    folder = page.build(Path("results")).parent
    assert "follows most" in (folder / "files/decay/study.svg").read_text()
    assert 'src="files/decay/study.svg"' in (folder / "chapter90.html").read_text()
    assert "fragile: 10 of 20 draws, 30 % to 70 %" in (folder / "claims.html").read_text()


def test_the_command_says_where_the_drawing_is(toy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["study", "chapter=90", "samples=2", "workers=1"]) == 0
    assert "drawn in results/studies/decay.svg" in capsys.readouterr().out
    assert (toy / "results/studies/decay.svg").exists()
