"""The report in a real browser, opened from disk: what a reader does with mouse and keyboard works."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import PROGRAM, Browser, axe

from dexrepro import cli
from dexrepro.recordings import load_recording
from dexrepro.report.explorer import _packed

pytestmark = pytest.mark.skipif(PROGRAM is None, reason="no Chromium is installed")
PAGES = ("index", "chapter90", "parameters90", "claims", "errata", "equations", "equations90", "symbols", "verdicts")

ALL = (*PAGES, "run", "diff")


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    browser = Browser(tmp_path_factory.mktemp("profile"))
    yield browser
    browser.close()


@pytest.fixture
def browser(program: Browser, report: Path) -> Iterator[Browser]:
    program.problems.clear()
    program.screen(1440, 900)
    yield program
    assert not program.problems
    assert all(url.startswith(("file:", "data:", "about:", "blob:")) for url in program.loaded.values())


@pytest.fixture
def explorer(browser: Browser, report: Path) -> Browser:
    browser.open(report / "chapter90.html", "#explore-decay")
    browser.wait("document.querySelectorAll('.panel .u-over').length == 2")
    browser.js("document.querySelector('.panel').scrollIntoView({block: 'center'})")
    return browser


def file(report: Path, page: str) -> Path:
    """A page of the report; "run" is that of the run with other parameters, "diff" compares it with the book's."""
    if page == "run":
        return next(report.glob("run-decay-*.html"))
    if page == "diff" and not (report.parent / "diff.html").exists():
        run = next(Path("results/runs").glob("decay-*"))
        assert cli.main(["diff", "results/chapter90/decay", str(run), "--html", str(report.parent / "diff.html")]) == 0
    return report.parent / "diff.html" if page == "diff" else report / f"{page}.html"


def area(browser: Browser) -> list[float]:
    return browser.js(
        "(() => { const r = document.querySelector('.panel .u-over').getBoundingClientRect();"
        " return [r.x, r.y, r.width, r.height] })()"
    )


def shown(browser: Browser, label: str) -> float:
    """A value as the legend of the first panel shows it."""
    text = browser.js(
        "[...document.querySelectorAll('.panel .u-legend tr')].filter("
        f"(row) => row.querySelector('.u-label').textContent == {label!r})[0].querySelector('.u-value').textContent"
    )
    return float(text.split()[0].replace("\u2212", "-"))


def ends(browser: Browser) -> list[float]:
    """Where each panel's time axis ends [s]."""
    return browser.js("[...document.querySelectorAll('.panel')].map((node) => node.plot.scales.x.max)")


def test_a_claim_is_one_click_from_the_front_page(browser: Browser, report: Path) -> None:
    browser.open(report / "index.html")
    browser.js("document.querySelector('.map a[href=\"chapter90.html#C90.02\"]').click()")
    browser.wait("location.pathname.endsWith('chapter90.html') && document.readyState == 'complete'")
    browser.wait("document.getElementById('C90.02').querySelector('details').open")
    assert browser.js("document.getElementById('C90.02').getBoundingClientRect().top < innerHeight")


def test_from_a_claim_to_its_line_and_back_to_the_command(browser: Browser, report: Path) -> None:
    browser.open(report / "chapter90.html", "#C90.02")
    assert "dexrepro run chapter=90 only=decay cases=plain seed=0" in browser.js(
        "document.getElementById('C90.02').textContent"
    )
    browser.js("[...document.querySelectorAll('#C90\\\\.02 a')].filter((a) => a.textContent == 'the claim')[0].click()")
    browser.wait("location.pathname.includes('/source/') && document.readyState == 'complete'")
    line = "document.querySelector('code:target')"  # of a claim on several lines its first
    assert "C90.02" in browser.js(f"{line}.textContent + {line}.nextElementSibling.textContent")


def test_hovering_shows_the_stored_value(explorer: Browser) -> None:
    x, y, width, height = area(explorer)
    explorer.mouse("mouseMoved", x + 0.4 * width, y + height / 2)
    stored = load_recording(Path("results/chapter90/decay/series"), "plain")
    instant = shown(explorer, "t")
    index = abs(stored.time - instant).argmin()
    assert stored.time[index] == pytest.approx(instant, rel=1e-4)
    assert shown(explorer, "plain") == pytest.approx(stored["x"][index], rel=1e-4)
    values = "[...document.querySelectorAll('.panel:first-child .u-legend .u-value')].map((node) => node.textContent)"
    assert all(value.endswith((" m", " s")) for value in explorer.js(values)), "each value with its unit"


def test_zooming_one_panel_zooms_all(explorer: Browser) -> None:
    before = ends(explorer)
    x, y, width, height = area(explorer)
    explorer.mouse("mouseMoved", x + 0.2 * width, y + height / 2)
    explorer.mouse("mousePressed", x + 0.2 * width, y + height / 2, pressed=True)
    explorer.mouse("mouseMoved", x + 0.5 * width, y + height / 2, pressed=True)
    explorer.mouse("mouseReleased", x + 0.5 * width, y + height / 2)
    explorer.wait(f"document.querySelector('.panel').plot.scales.x.max < {0.6 * before[0]}")
    first, second = ends(explorer)
    assert first == pytest.approx(second)
    explorer.js("[...document.querySelectorAll('button')].filter((b) => b.textContent == 'Whole time')[0].click()")
    explorer.wait(f"document.querySelector('.panel').plot.scales.x.max >= {0.999 * before[0]}")


def test_the_keyboard_moves_the_cursor_and_zooms(explorer: Browser) -> None:
    explorer.js("document.querySelector('.panel .uplot').focus()")
    explorer.key("ArrowRight")
    first = shown(explorer, "t")
    explorer.key("ArrowRight")
    assert shown(explorer, "t") > first
    before = ends(explorer)[0]
    explorer.key("+")
    explorer.wait(f"document.querySelector('.panel').plot.scales.x.max < {before}")


def test_cases_and_channels_are_switched(explorer: Browser) -> None:
    lines = "document.querySelectorAll('.panel:first-child .u-series').length"
    before = explorer.js(lines)
    explorer.js("document.querySelector('.choices input[value=plain]').click()")
    explorer.wait(f"{lines} == {before - 1}")
    explorer.js("document.querySelector('.choices input[value=pair]').click()")
    explorer.wait("document.querySelectorAll('.panel').length == 1")


def test_a_run_with_other_parameters_is_shown_beside_the_books(browser: Browser, report: Path) -> None:
    (page,) = report.glob("run-decay-*.html")
    browser.open(page, "#explore-decay")
    browser.wait("document.querySelectorAll('.panel .u-over').length == 2")
    assert "start=0.5 (book: 1.0)" in browser.js("document.querySelector('.lead').textContent")
    rows = browser.js("[...document.querySelectorAll('.changes tbody tr')].map((row) => row.innerText)")
    assert len(rows) == 1
    assert "not reproduced" in rows[0], "what grew in the book's run does not in this one"
    browser.js("document.querySelector('.panel .uplot').focus()")
    browser.key("ArrowRight")
    assert shown(browser, "plain") == pytest.approx(shown(browser, "book: plain") / 2, rel=1e-3)


def test_every_draw_of_a_study_can_be_pointed_at_and_run_again(browser: Browser, report: Path) -> None:
    browser.open(report / "chapter90.html", "#study-decay")
    browser.wait("document.querySelectorAll('.whatif circle, .whatif .fails').length == 8")
    browser.js("document.querySelector('.whatif svg').focus()")
    browser.key("ArrowRight")
    told = "document.querySelector('.whatif [aria-live]').innerText"
    first = browser.js(told)
    lines = Path("results/studies/decay.jsonl").read_text().splitlines()
    draws = sorted((json.loads(line) for line in lines), key=lambda draw: draw["values"]["decay.start"])
    assert f"Draw {draws[0]['index']}:" in first
    assert f"dexrepro run chapter=90 only=decay decay.start={draws[0]['values']['decay.start']}" in first
    browser.key("ArrowRight")
    assert f"Draw {draws[1]['index']}:" in browser.js(told)


def test_a_scene_moves_stops_and_shares_its_time_with_the_series(explorer: Browser) -> None:
    columns = {
        name: np.linspace(0, 2, 21, dtype=np.float32) * (name in ("time", "x"))
        for name in ["time", "x", "y", "z", "a", "b", "c", "w"]
    }
    columns["w"] += 1
    poses, samples, _ = _packed(columns)
    camera = {"target": [0, 0, 0], "distance": 3, "yaw": 0, "pitch": -30, "field_of_view": 50}
    solid = {"kind": "capsule", "size": [0.1, 0.5], "colour": [1, 0, 0, 1]}
    scene = {"case": "plain", "samples": samples, "poses": poses, "camera": camera, "solids": [solid]}
    explorer.js(
        "(async () => { await load('vendor/three/three.iife.min.js'); await load('scene.js'); window.told = [];"
        " window.host = { place: document.querySelector('.panels > .scene'), onTime: (f) => { window.hover = f },"
        f" setTime: (t) => told.push(t) }}; await showScene(host, {json.dumps(scene)}); }})()"
    )
    instant = "Number(document.querySelector('canvas:focus-within, .scene canvas').dataset.time)"
    assert explorer.js(instant) == 0
    explorer.js("[...document.querySelectorAll('.scene button')].at(-1).click()")
    explorer.wait(f"{instant} > 0.1")
    explorer.js("[...document.querySelectorAll('.scene button')].at(-1).click()")
    stopped = explorer.js(instant)
    assert explorer.js("told.at(-1)") == pytest.approx(stopped)
    explorer.js("new Promise((done) => setTimeout(done, 200))")
    assert explorer.js(instant) == stopped
    explorer.js("hover(1.25)")
    assert explorer.js(instant) == pytest.approx(1.25)
    before = explorer.js("document.querySelector('.scene canvas').toDataURL()")
    explorer.js("document.querySelector('.scene canvas').focus()")
    explorer.key("ArrowLeft")
    assert explorer.js(instant) == pytest.approx(1.25), "the arrow keys turn the scene, they do not move the time"
    assert before.startswith("data:image/png")


def test_the_search_knows_verdicts_equations_and_says_when_it_cut(browser: Browser, report: Path) -> None:
    browser.open(report / "chapter90.html")
    assert "search-index.js" not in str(list(browser.loaded.values())), "loaded when first needed"
    browser.key("/")
    assert browser.js("document.activeElement.id") == "search"

    def find(words: str) -> list[str]:
        browser.js(f"box.value = {json.dumps(words)}; search()")
        return browser.js("[...document.querySelectorAll('#found a')].map((a) => a.getAttribute('href'))")

    assert find("not reproduced") == ["chapter90.html#C90.02"]
    assert find("nothing grows") == ["chapter90.html#C90.02"]
    assert find("eq (90.1)")[0] == "equations90.html#eq-90.1"
    assert find("lambda_1")[0].startswith("symbols.html#")
    browser.js("for (const entry of [...SEARCH_INDEX]) SEARCH_INDEX.push(entry, entry); 0")
    assert len(find("e")) == 40
    assert "the first 40 of" in browser.js("found.textContent")


def test_the_list_of_all_claims_is_filtered(browser: Browser, report: Path) -> None:
    browser.open(report / "claims.html")
    browser.js("filter.elements.verdict.value = 'not reproduced'; filter.dispatchEvent(new Event('input'))")
    rows = browser.js("[...document.querySelectorAll('.answers tbody tr:not([hidden])')].map((r) => r.textContent)")
    assert len(rows) == 1
    assert "C90.02" in rows[0]


def test_a_film_plays_when_asked_to(browser: Browser, report: Path) -> None:
    browser.open(report / "chapter90.html")
    source = "document.querySelector('.film img').getAttribute('src')"
    assert browser.js(source) == "files/decay/film_plain.png"
    browser.js("document.querySelector('.film button').click()")
    assert browser.js(source) == "files/decay/film_plain.gif"


@pytest.mark.parametrize("page", ALL)
def test_pictures_load_and_a_phone_needs_no_sideways_scrolling(browser: Browser, report: Path, page: str) -> None:
    browser.screen(390, 844)
    browser.open(file(report, page))
    assert browser.js("document.documentElement.scrollWidth") <= 390
    browser.js("document.querySelectorAll('img').forEach((image) => image.loading = 'eager')")
    browser.wait("[...document.images].filter((i) => i.getAttribute('src')).every((i) => i.complete && i.naturalWidth)")


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("page", ALL)
def test_no_barrier_for_assistive_technology(
    browser: Browser, report: Path, request: pytest.FixtureRequest, page: str, dark: bool
) -> None:
    source = axe(request.config.cache.mkdir("axe"))
    if source is None:
        pytest.skip("axe-core cannot be fetched")
    browser.screen(1440, 900, dark)
    browser.open(file(report, page))
    browser.js("document.querySelectorAll('details').forEach((node) => node.open = true)")
    browser.wait("[...document.querySelectorAll('.explorer')].every((node) => node.querySelector('.u-over'))")
    browser.js(source + "; 0")
    found = browser.js(
        "axe.run({preload: false}).then((r) => r.violations.map((v) => [v.id, v.nodes[0].html.slice(0, 200)]))"
    )
    assert not found


def test_the_front_page_is_light(browser: Browser, report: Path) -> None:
    browser.open(report / "index.html")
    assert browser.weight() < 500
    assert all(path.stat().st_size <= 15_000 for path in report.rglob("*.webp"))


def test_two_results_are_compared_on_one_page_without_further_files(browser: Browser, report: Path) -> None:
    page = file(report, "diff")
    browser.open(page)
    browser.wait("document.querySelectorAll('.panel .u-over').length == 2")
    assert [url for url in browser.loaded.values() if not url.startswith("data:")] == [page.resolve().as_uri()]
    headings = browser.js("[...document.querySelectorAll('h2')].map((node) => node.textContent)")
    assert headings == ["Changed parameters", "Changed verdicts and margins", "Series", "Changed metrics"]
    assert "start1.00.5" in browser.js("document.querySelector('table').innerText.replace(/\\s/g, '')")
    assert "not reproduced" in browser.js("document.querySelector('.changes tbody').innerText")
    browser.js("document.querySelector('.panel .uplot').focus()")
    browser.key("ArrowRight")
    assert shown(browser, "B: plain") == pytest.approx(shown(browser, "A: plain") / 2, rel=1e-3)
    linked = browser.js("[...document.querySelectorAll('.panels a')].map((node) => node.getAttribute('href'))")
    assert linked
    assert all((page.parent / path).exists() for path in linked)


def test_the_index_shows_the_equation_itself_with_its_lines_and_says_what_is_not_used(
    browser: Browser, report: Path
) -> None:
    browser.open(report / "equations90.html", "#eq-90.1")
    fraction = "document.querySelector('#eq-90\\\\.1 math mfrac').getBoundingClientRect()"
    assert browser.js(f"{fraction}.height > 1.5 * parseFloat(getComputedStyle(document.body).fontSize)"), (
        "it is typeset"
    )
    browser.wait("document.getElementById('eq-90.1').innerText.includes('E90.01')")  # rendered once it is in view
    unused = "document.getElementById('eq-90.2')"  # below the fold: not rendered, so no innerText
    assert "Not used." in browser.js(f"{unused}.textContent")
    browser.js("document.querySelector('#eq-90\\\\.1 a').click()")
    browser.wait("!location.pathname.endsWith('equations90.html') && document.readyState == 'complete'")
    browser.wait("document.querySelector(':target') != null")


@pytest.mark.parametrize("page", [*PAGES, "run"])
def test_the_first_load_of_each_page_is_light(browser: Browser, report: Path, page: str) -> None:
    browser.open(file(report, page))
    assert browser.weight() < 500
