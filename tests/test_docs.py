"""The manual builds without a warning, its tutorials run, and its reference has every command, parameter and module."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

from dexrepro import chapters, cli
from dexrepro.provenance import commented_leaves

pytest.importorskip("sphinx", reason="pip install dexrepro[docs]")
pytest.importorskip("myst_nb", reason="pip install dexrepro[docs]")
TUTORIALS = sorted((ROOT / "docs/tutorials").glob("*.ipynb"))


@pytest.fixture(scope="module")
def manual(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The manual as ``make docs`` builds it: its tutorials run."""
    folder = tmp_path_factory.mktemp("manual")
    command = [sys.executable, "-m", "sphinx", "--fail-on-warning", "--keep-going", "--quiet"]
    command += [str(ROOT / "docs"), str(folder)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=900)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.stem)
def test_a_tutorial_is_stored_without_outputs(path: Path) -> None:
    cells = [cell for cell in json.loads(path.read_text("utf-8"))["cells"] if cell["cell_type"] == "code"]
    assert cells
    assert not [cell for cell in cells if cell["outputs"] or cell["execution_count"]]


@pytest.mark.slow
def test_the_manual_shows_what_the_tutorials_give_and_they_write_nothing_beside_themselves(manual: Path) -> None:
    assert all("cell_output" in (manual / f"tutorials/{path.stem}.html").read_text("utf-8") for path in TUTORIALS)
    assert not list(ROOT.glob("docs/tutorials/results"))


def text_of(manual: Path, page: str) -> str:
    text = (manual / f"{page}.html").read_text("utf-8")
    return re.sub(r"<[^>]*>", "", text.replace("&gt;", ">").replace("&lt;", "<").replace("&#39;", "'"))


@pytest.mark.slow
def test_the_reference_has_every_command_parameter_file_and_module(manual: Path) -> None:
    (commands,) = (action for action in cli._parser()._actions if action.dest == "command")
    told = text_of(manual, "reference/commands")
    assert not [name for name in commands.choices or () if f"dexrepro {name}" not in told]
    for number in (*chapters.numbers(), "own"):
        page = text_of(manual, f"reference/configuration/{number}")
        assert not [key for key, _, _ in commented_leaves(number) if key.partition(".")[2] not in page]
    formats = text_of(manual, "reference/formats")
    for schema in (ROOT / "docs/schemas").glob("*.json"):
        assert json.loads(schema.read_text("utf-8"))["title"] in formats
    api = "".join(text_of(manual, f"reference/api/{page.stem}") for page in manual.glob("reference/api/*.html"))
    folders = ("control", "humans", "networks", "physics", "primitives", "robots", "vision")
    modules = [path for folder in folders for path in (ROOT / "dexrepro" / folder).glob("*.py")]
    assert not [p for p in modules if p.stem != "__init__" and f"dexrepro.{p.parent.name}.{p.stem}" not in api]


@pytest.mark.slow
def test_the_manual_opens_from_disk_and_loads_nothing_from_elsewhere(manual: Path) -> None:
    for page in manual.rglob("*.html"):
        loaded = re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=\"(https?:[^\"]+)", page.read_text("utf-8"))
        assert not loaded, page
