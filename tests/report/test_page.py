"""The report opens from disk in a real browser: nothing missing, nothing fetched from elsewhere, search works."""

from __future__ import annotations

import html.parser
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pandas as pd
import pytest
from PIL import Image

from dexrepro.plan import plan_chapter
from dexrepro.report import page
from dexrepro.runner import run_plans

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


@pytest.fixture
def report(toy: Path) -> Path:
    plans, _ = plan_chapter("90")
    run_plans(plans, workers=1, force=False)
    films = Path("results/chapter90/decay/animation")
    films.mkdir()
    for name in ("plain.gif", "plain.png"):
        Image.new("RGB", (80, 33), "white").save(films / name)
    return page.build(Path("results")).parent.resolve()


class Links(html.parser.HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.ids: set[str] = set()

    def handle_starttag(self, tag: str, attributes) -> None:
        for key, value in attributes:
            if key in ("href", "src") and value:
                self.targets.append(value)
            if key == "id":
                self.ids.add(value)


def test_every_link_leads_to_something_inside_the_folder(report: Path) -> None:
    pages = {file: Links() for file in report.rglob("*.html")}
    for file, links in pages.items():
        links.feed(file.read_text())
    for file, links in pages.items():
        for target in links.targets:
            if target.startswith("data:"):
                continue
            name, _, anchor = target.partition("#")
            there = (file.parent / name).resolve() if name else file
            assert not re.match(r"\w+:|/", name), f"{file.name} leaves the folder: {target}"
            assert there.is_relative_to(report), f"{file.name} leaves the folder: {target}"
            assert there.exists(), f"{file.name}: {target}"
            if anchor:
                assert anchor in pages[there].ids, f"{file.name}: {target}"


def test_the_scoreboard_counts_the_verdicts(report: Path) -> None:
    text = (report / "index.html").read_text()
    row = re.search(r'<th scope="row"><a href="chapter90.html">.*?</tr>', text, re.DOTALL)[0]
    assert re.findall(r"<td>(.*?)</td>", row) == ["2", "", "", "", "", "1", "", "", "0 of 0"]


@pytest.mark.parametrize(
    ("claimed", "figure", "expected"),
    [
        ("2.8a", "2.8", True),
        ("2.8", "2.8a", True),
        ("2.5, 2.8", "2.8", True),
        ("2.8a", "2.8b", False),
        ("2.8", "2.81", False),
    ],
)
def test_a_claim_stands_beside_the_figures_it_is_about(claimed: str, figure: str, expected: bool) -> None:
    assert page._concerns(claimed, figure) is expected


def test_a_symbol_leads_to_its_parameter_and_back(report: Path) -> None:
    chapter, index = ((report / name).read_text() for name in ("chapter90.html", "symbols.html"))
    assert '<a href="symbols.html#symbol-90-shared.rate"><i>λ</i><sub>1</sub></a>' in chapter
    assert '<a href="chapter90.html#key-decay.rate">decay</a>' in index
    assert "lambda_1" in (report / "search-index.js").read_text()


def test_a_film_is_a_still_that_leads_to_the_moving_picture(report: Path) -> None:
    text = (report / "chapter90.html").read_text()
    assert '<a href="files/decay/film_plain.gif"><img src="files/decay/film_plain.png"' in text
    assert (report / "files/decay/film_plain.gif").exists()


def test_text_from_configurations_is_escaped(toy: Path) -> None:
    plans, _ = plan_chapter("90")
    plans[0].block["note"] = "<script>alert(1)</script>"
    run_plans(plans, workers=1, force=False)
    path = toy / "results/chapter90/decay/claims.json"
    claims = json.loads(path.read_text())
    claims[0]["statement"] = "<img src=x onerror=alert(1)>"
    path.write_text(json.dumps(claims))
    folder = page.build(Path("results")).parent
    for file in folder.glob("*.html"):
        assert "<img src=x" not in file.read_text()
    assert "<img" not in (folder / "search-index.js").read_text()


@pytest.mark.skipif(BROWSER is None and not os.environ.get("CI"), reason="no Chromium is installed")
def test_in_a_real_browser(report: Path, tmp_path: Path) -> None:
    assert BROWSER, "continuous integration installs Chromium"
    probe = """<script>
    window.addEventListener('error', (e) => document.title = 'ERROR ' + (e.message || e.target.src), true);
    window.addEventListener('load', () => setTimeout(() => {
      const shown = [...document.images].filter((i) => i.getAttribute('src'));
      const broken = shown.filter((i) => !(i.complete && i.naturalWidth)).length;
      const box = document.getElementById('search');
      box.value = 'nothing grows';
      box.dispatchEvent(new Event('input'));
      const hit = document.querySelector('#found a');
      const film = document.querySelector('figure.film');
      const sources = film && [film.querySelector('img').getAttribute('src')];
      if (film) { film.querySelector('button').click(); sources.push(film.querySelector('img').getAttribute('src')); }
      const away = performance.getEntriesByType('resource').filter((r) => !r.name.startsWith('file:')).length;
      const state = {broken, away, hit: hit && hit.getAttribute('href'), sources, title: document.title};
      const pre = document.createElement('pre'); pre.id = 'probe'; pre.textContent = JSON.stringify(state);
      document.body.append(pre);
    }, 300));
    </script>"""
    for name in ("index.html", "chapter90.html", "symbols.html", "equations.html"):
        text = (report / name).read_text().replace('loading="lazy"', "").replace("<head>", f"<head>{probe}")
        (report / f"probe-{name}").write_text(text)
        flags = "--headless --no-sandbox --force-prefers-reduced-motion --disable-gpu --no-first-run"
        command = [BROWSER, *flags.split(), "--disable-component-update", "--disable-sync", "--dump-dom",
                   "--disable-background-networking", "--enable-logging=stderr", "--virtual-time-budget=4000",
                   f"--user-data-dir={tmp_path / 'profile'}",
                   (report / f"probe-{name}").resolve().as_uri()]  # fmt: skip
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
        found = re.search(r'<pre id="probe">(.*?)</pre>', done.stdout)
        assert found, done.stderr[-2000:]
        state = json.loads(found[1].replace("&amp;", "&"))
        assert not state["title"].startswith("ERROR"), state
        assert (state["broken"], state["away"]) == (0, 0), state
        assert state["hit"] == "chapter90.html#C90.02", state
        still, moving = (f"files/decay/film_plain.{kind}" for kind in ("png", "gif"))
        assert state["sources"] == ([still, moving] if name == "chapter90.html" else None), "plays when asked to"
        assert "CONSOLE" not in done.stderr, done.stderr[-2000:]


def test_cells_are_words_and_numbers_that_read_well() -> None:
    shown = [page._cell(value) for value in (True, "no_network", "K_1 + K_2", "k_s", 15385.3, -0.0123456, float("nan"))]
    assert shown == ["yes", "no network", "K_1 + K_2", "k_s", "15385", "\u22120.01235", "–"]


def test_a_column_of_phrases_is_given_width() -> None:
    columns = [pd.Series([1.0, 2.0]), pd.Series(["a", "b"]), pd.Series(["a", "a phrase that would be broken up"])]
    assert [page._column_kind(column) for column in columns] == ["number", "", "words"]
