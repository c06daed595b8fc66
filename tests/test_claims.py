"""Claims: margins have the sign of the statement, and verdicts follow from margins."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dexrepro.claims import (
    BY_CONSTRUCTION,
    NOT_EVALUATED,
    TIE,
    Claim,
    Erratum,
    Reference,
    about,
    every,
    greater,
    less,
    ordered,
    robustness,
    slip,
    within,
)

numbers = st.floats(-1e6, 1e6).filter(lambda x: abs(x) > 1e-6)


@given(numbers, numbers)
def test_margin_is_positive_exactly_when_the_statement_holds(a: float, b: float) -> None:
    values = {"a": a, "b": b}
    tied = abs(a - b) <= TIE * max(abs(a), abs(b))
    assert (less("a", "b").margin(values) > 0) == (a < b and not tied)
    assert (greater("a", "b").margin(values) > 0) == (a > b and not tied)
    assert (less("a", "b", factor=3).margin(values) > 0) == (a < 3 * b)
    assert (less("a", 2.0, factor=3).margin(values) > 0) == (a < 6)
    assert (within("a", -10, 10).margin(values) >= 0) == (-10 <= a <= 10)


@given(numbers, numbers, numbers)
def test_a_conjunction_has_its_weakest_margin(a: float, b: float, c: float) -> None:
    values = {"a": a, "b": b, "c": c}
    parts = less("a", "b"), less("b", "c")
    assert every(*parts).margin(values) == min(part.margin(values) for part in parts)
    assert ordered("a", "b", "c").margin(values) == every(*parts).margin(values)


def test_margins_are_relative_gaps() -> None:
    assert less("a", "b", factor=2).margin({"a": 1.0, "b": 2.0}) == pytest.approx(0.75)
    assert less("a", "b").margin({"a": 1.0, "b": 4.0}) == pytest.approx(0.75 - TIE)
    assert less("a", "b").margin({"a": 0.0, "b": 0.0}) == -TIE
    assert less("a", 4.0).margin({"a": 1.0}) == pytest.approx(0.75)
    assert within("a", 0, 10).margin({"a": 2.0}) == pytest.approx(0.2)
    with pytest.raises(ValueError, match="not below"):
        within("a", 1, 1)


def test_names_from_the_dot_on_are_of_the_experiment_whose_folder_holds_the_claim() -> None:
    parts = every(less(".fast.error", ".slow.error", 0.5), greater("other.case.value", 0.25), within(".gain", 0.5, 1))
    claim = Claim(
        "C1.01", "1.1", "", parts, control=less(".2b.x", 1), readings={"r": less(".r.x", 1)}, note="{.fast.error}"
    )
    found = claim.of("sponge")
    assert found.metrics == ("sponge.fast.error", "sponge.slow.error", "other.case.value", "sponge.gain",
                             "sponge.2b.x", "sponge.r.x")  # fmt: skip
    assert (
        str(found.predicate)
        == "sponge.fast.error < 0.5 sponge.slow.error; other.case.value > 0.25; 0.5 <= sponge.gain <= 1"
    )
    assert found.note == "{sponge.fast.error}"
    assert Reference(".fast.error", 1.0, "1.1").of("sponge").metric == "sponge.fast.error"


def test_verdicts_of_every_kind() -> None:
    def verdict(**values: object) -> str:
        claim = Claim("C", "1", "a falls", less("e.a.x", 1.0), **values)
        return claim.evaluate({"e.a.x": 0.5, "e.b.x": 2.0, "e.c.x": 0.7, "e.d.x": None}).verdict

    holds, fails, undefined = less("e.c.x", 1.0), less("e.b.x", 1.0), less("e.d.x", 1.0)
    assert verdict() == verdict(control=fails) == verdict(control=holds) == verdict(printed=holds) == "reproduced"
    assert verdict(printed=fails) == verdict(printed=undefined) == "after correction"
    assert verdict(control=holds, credits="the term") == "not attributed"
    assert verdict(control=fails, credits="the term") == "reproduced"
    assert verdict(readings={"another window": fails}) == "reading-dependent"
    assert verdict(readings={"a case that was not run": less("e.absent.x", 1.0)}) == NOT_EVALUATED
    assert verdict(by_construction="the generator does it") == BY_CONSTRUCTION
    assert Claim("C", "1", "a falls", fails).evaluate({"e.b.x": 2.0}).verdict == "not reproduced"
    assert Claim("C", "1", "a falls", fails).evaluate({"e.b.x": None}).verdict == "not reproduced"
    assert Claim("C", "1", "a falls", fails).evaluate({}).verdict == NOT_EVALUATED
    assert (
        Claim("C", "1", "a falls", fails, printed=holds).evaluate({"e.b.x": 2.0, "e.c.x": 0.7}).verdict
        == "not reproduced"
    )
    assert verdict(printed=less("e.gone.x", 1.0)) == NOT_EVALUATED
    assert Claim("C", "1", "people like it", None, not_testable="no people").evaluate({}).verdict == "not testable"


def test_a_claim_needs_a_predicate_or_a_reason() -> None:
    with pytest.raises(ValueError, match=r"C1\.04"):
        Claim("C1.04", "1.1", "nothing", None)


def test_claims_about_one_figure_share_it_and_its_place_unless_they_say_another() -> None:
    fig_2_5 = about("2.5", "2.4.1.1")
    holds = less("e.a.x", 1.0)
    assert fig_2_5("C2.90", "it holds", holds) == Claim("C2.90", "2.5", "it holds", holds, where="2.4.1.1")
    assert fig_2_5("C2.91", "it holds", holds, where="2.6").where == "2.6"


def test_a_note_names_the_metrics_of_its_own_experiment_by_what_follows_the_dot() -> None:
    claim = Claim("C2.90", "2.5", "it holds", less("e.a.x", 1.0), note="{.a.x:.1f}, elsewhere {other.a.x:.1f}")
    assert claim.note == "{e.a.x:.1f}, elsewhere {other.a.x:.1f}"


def test_the_numbers_of_a_note_come_from_the_run() -> None:
    claim = Claim("C", "1", "a falls", less("e.a.x", 1.0), note="It is {e.a.x:.1f} mm, not {e.a.gone}.")
    assert claim.evaluate({"e.a.x": 0.52}).note == "It is 0.5 mm, not ?."


def test_an_erratum_of_a_kind_is_that_erratum() -> None:
    assert slip("E9.01", "(9.1)", "a sign", "+") == Erratum("E9.01", "(9.1)", "slip", "a sign", "+")


def test_an_erratum_needs_one_of_the_four_kinds() -> None:
    with pytest.raises(ValueError, match="mistake"):
        Erratum("E1.01", "(1.1)", "mistake", "text")


def test_what_a_study_shows() -> None:
    assert robustness(26, 26) == "robust"
    assert robustness(25, 25) == "open"
    assert robustness(9, 16) == "fragile"
    assert robustness(10, 16) == "open"
    assert robustness(0, 8) == "fragile"
    assert robustness(90, 100) == "open"
    assert robustness(0, 0) == ""
