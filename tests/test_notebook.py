"""In a notebook a run says what is finished, its results display, and of a class its last cell is what runs."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from conftest import ROOT

import dexrepro
from dexrepro.plan import plan_chapter
from dexrepro.runner import run_plans

CELLS = (
    "import dexrepro",
    "class L(float):\n    def __new__(cls): return float.__new__(cls, 1)",
    "results = dexrepro.run(90, ['+decay.cases.mine.law._target_=__main__.L'], only='decay', workers=1)\nresults",
    "class L(float):\n    def __new__(cls): return float.__new__(cls, 3)",
    "dexrepro.run(90, ['+decay.cases.mine.law._target_=__main__.L'], only='decay', workers=1)['decay']\\\n"
    "    .metrics['decay.mine.largest']",
)


@pytest.mark.slow
def test_a_notebook_shows_progress_and_results_and_runs_the_class_of_its_last_cell(toy: Path) -> None:
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS])
    client = nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(toy)}})
    client.execute(env={**os.environ, "PYTHONPATH": str(ROOT)})
    outputs = [cell.outputs for cell in notebook.cells]
    said = "".join(output.get("text", "") for output in outputs[2])
    assert "decay.plain: " in said
    assert "decay.mine: " in said
    (shown,) = (output.data["text/html"] for output in outputs[2] if "data" in output)
    assert "C90.01" in shown
    assert "differs from the book in" in shown
    assert "data:image/png;base64," in shown
    assert float(outputs[4][-1].data["text/plain"]) == 3.0


def test_a_result_displays_its_claims_and_hides_no_markup(toy: Path) -> None:
    plans, _ = plan_chapter("90", ["only=decay"])
    folder = run_plans(plans, workers=1, force=False).folders["decay"]
    result = dexrepro.load(folder)
    result.claims[0]["note"] = "a < b"
    text = result._repr_html_()
    assert all(claim["verdict"] in text for claim in result.claims)
    assert "a &lt; b" in text
    assert "differs from the book" not in text
