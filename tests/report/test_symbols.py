"""The book's symbols: how they are written, where they are set, and what follows them."""

from __future__ import annotations

from pathlib import Path

import pytest

from dexrepro import chapters
from dexrepro.config import compose_chapter
from dexrepro.provenance import provenance
from dexrepro.report import parameters, symbols, words


@pytest.mark.parametrize(
    ("plain", "html"),
    [
        ("K_d", "<i>K</i><sub><i>d</i></sub>"),
        ("1/gamma_1", "1/<i>γ</i><sub>1</sub>"),
        ("khat_o(0)", "<i>k\u0302</i><sub><i>o</i></sub>(0)"),
        ("rhobar_{D,o}", "<i>ρ\u0304</i><sub><i>D</i>,<i>o</i></sub>"),
        ("h^w", "<i>h</i><sup><i>w</i></sup>"),
        ("Gamma_s", "<i>Γ</i><sub><i>s</i></sub>"),
        ("<b>", "&lt;<i>b</i>&gt;"),
    ],
)
def test_a_symbol_is_written_as_in_the_book(plain: str, html: str) -> None:
    assert symbols.html(plain) == html


def test_a_parameter_has_the_symbol_of_the_shared_one_it_refers_to(toy: Path) -> None:
    composed, origins = compose_chapter("90"), provenance("90")
    rows = parameters.table("decay", composed, origins, {})
    rate = next(row for row in rows if row["key"] == "decay.rate")
    assert (rate["plain"], rate["home"], rate["kind"]) == ("lambda_1", "shared.rate", "printed")
    (entry,) = parameters.index(composed, origins, rows)
    assert (entry["key"], entry["value"], entry["used"]) == ("shared.rate", 2.0, {"decay": "decay.rate"})


def test_parameters_of_a_block_that_is_shared_whole_keep_their_origin() -> None:
    composed, origins = compose_chapter("7"), provenance("7")
    rows = parameters.table("reaching_demonstrations", composed, origins, {})
    start = next(row for row in rows if row["key"] == "reaching_demonstrations.scene.start")
    assert (start["home"], start["unit"], start["kind"]) == ("shared.scene.start", "cm", "printed")


@pytest.mark.parametrize("chapter", chapters.numbers())
def test_every_chapter_names_its_symbols(chapter: str) -> None:
    named = [origin.symbol for origin in provenance(chapter).values() if origin.symbol]
    assert len(named) >= 20


def test_a_symbol_is_found_by_its_letter_and_by_the_word_for_it() -> None:
    assert symbols.text("1/gamma_1") == "1/γ_1 (1/gamma_1)"
    assert symbols.text("k_o") == "k_o"


@pytest.mark.parametrize(("written", "shown"), [
    ("K_R < 300 N/m", "<i>K</i><sub><i>R</i></sub> &lt; 300 N/m"),
    ("so X_2,d = s R X_l.", "so <i>X</i><sub>2,<i>d</i></sub> = s R <i>X</i><sub><i>l</i></sub>."),
    ("|G|^2 and lambda_1", "|G|<sup>2</sup> and <i>λ</i><sub>1</sub>"),
    ("run only=skill_reuse a_b=3 shared.k_o.x", "run only=skill_reuse a_b=3 shared.k_o.x"),
])  # fmt: skip
def test_symbols_in_a_sentence_are_typeset_and_names_are_left_alone(written: str, shown: str) -> None:
    assert str(words.prose(written)) == shown
