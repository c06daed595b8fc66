"""The report of the book itself, where its results are at hand (`make figures`): units and weights."""

from __future__ import annotations

from pathlib import Path

import pytest
from browser import PROGRAM, Browser

from dexrepro import chapters
from dexrepro.report import explorer
from dexrepro.storage import read_json

RESULTS = Path(__file__).parents[2] / "results"
RUN = sorted(path.parent for path in RESULTS.glob("chapter*/*/run.json"))
PAGES = sorted((RESULTS / "report").glob("*.html"))
pytestmark = pytest.mark.skipif(not RUN, reason="the book has not been run")


@pytest.mark.parametrize("place", RUN, ids=lambda place: place.name)
def test_every_recorded_channel_has_a_unit(place: Path, tmp_path: Path) -> None:
    experiment = chapters.load(place.parent.name.removeprefix("chapter")).experiment(place.name)
    cases = read_json(place / "run.json")["cases"]
    series = explorer.write(place, tmp_path, cases, None, experiment.units) or {"channels": [], "cases": {}}
    assert not [channel["name"] for channel in series["channels"] if not channel["unit"]]
    columns = {column for case in series["cases"].values() for column in case["channels"]}
    for channel in series["channels"]:
        parts, units = [c for c in columns if c.startswith(f"{channel['name']}[")], channel["unit"].split(", ")
        assert len(units) in (1, len(parts)), f"{channel['name']}: {len(parts)} components, units {units}"


@pytest.mark.skipif(PROGRAM is None or not PAGES, reason="there is no Chromium, or no report")
def test_the_first_load_of_each_page_is_light(tmp_path: Path) -> None:
    browser = Browser(tmp_path)
    browser.screen(1440, 900)
    weights = {}
    for page in PAGES:
        browser.open(page)
        weights[page.stem] = browser.weight()
        print(f"{page.stem}: {weights[page.stem]:.0f} kB")
    browser.close()
    assert not {page: weight for page, weight in weights.items() if weight >= 500}
