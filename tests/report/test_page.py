"""What the pages of the report say, and that every link leads somewhere inside its folder."""

from __future__ import annotations

import base64
import html.parser
import io
import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from dexrepro.plan import plan_chapter
from dexrepro.report import contents, page, relations, words
from dexrepro.runner import run_plans


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
                assert value not in self.ids, f"two things are named {value}"
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
    assert re.findall(r"<td>(.*?)</td>", row) == ["3", "2", "1", "", "", "", "0 of 0"]


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
    assert relations.concerns(claimed, figure) is expected


def test_what_another_experiment_shows_stands_beside_a_claim_where_it_was_run(report: Path) -> None:
    text = (report / "chapter90.html").read_text()
    assert "Elsewhere it begins at 0.50 m." in text
    assert "Elsewhere it ends at" not in text, "that experiment needs a package that is not here"


def test_a_symbol_leads_to_its_parameter_and_back(report: Path) -> None:
    chapter, index = ((report / name).read_text() for name in ("parameters90.html", "symbols.html"))
    assert '<a href="symbols.html#symbol-90-shared.rate"><i>λ</i><sub>1</sub></a>' in chapter
    assert '<a href="parameters90.html#key-decay.rate">decay</a>' in index
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


def test_cells_are_words_and_numbers_that_read_well() -> None:
    shown = [words.cell(value) for value in (True, "no_network", "K_1 + K_2", "k_s", 15385.3, -0.0123456, float("nan"))]
    assert shown == ["yes", "no network", "K_1 + K_2", "k_s", "15385", "\u22120.01235", "–"]


def test_a_column_of_phrases_is_given_width() -> None:
    columns = [pd.Series([1.0, 2.0]), pd.Series(["a", "b"]), pd.Series(["a", "a phrase that would be broken up"])]
    assert [words.column_kind(column) for column in columns] == ["number", "", "words"]


def test_what_was_not_run_is_named_with_what_it_needs(report: Path) -> None:
    for name in ("index.html", "chapter90.html"):
        text = " ".join((report / name).read_text("utf-8").split())
        assert "<code>dexrepro run chapter=90 only=needs_more</code> (needs no_such_package: pip install" in text
        assert "only=decay</code>" not in text.partition('class="note absent">')[2].partition("</p>")[0]


def test_a_drawing_is_shown_lighter_than_it_is_stored_and_looks_the_same() -> None:
    pixels = np.zeros((60, 80, 4), np.uint8)
    pixels[..., 0], pixels[..., 3] = np.arange(80) * 3, 255
    Image.fromarray(pixels).save(stored := io.BytesIO(), "PNG", compress_level=0)
    picture = base64.b64encode(stored.getvalue()).decode()
    light = contents._light(f'<path d="M 1.23456 2\nL 30.00001 4 "/><image href="data:image/png;base64,{picture}"/>')
    assert 'd="M 1.23 2 L 30.00 4"' in light
    shown = re.search('base64,([^"]*)', light)[1]
    assert len(shown) < len(picture) / 5
    difference = np.asarray(Image.open(io.BytesIO(base64.b64decode(shown))).convert("RGBA")).astype(int) - pixels
    assert np.abs(difference).max() <= 4
