"""One command prints all there is about one thing."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from dexrepro.errors import InputError
from dexrepro.report.show import show


def said(word: str, results: Path = Path("nowhere")) -> str:
    return "\n".join(show(word, results))


def test_a_claim_is_shown_with_verdict_control_study_parameters_lines_and_commands() -> None:
    text = said("c2.08")
    for part in (
        "C2.08  reproduced, margin +", "Fig. 2.7", "holds if", "movement_estimation.light10.estimation_error = 0.0",
        "control ", "tested ",
        "study ", "varies ", "chapters/chapter2/movement_estimation/claims.py:",
        "conf/chapter/2/movement_estimation.yaml", "control/movement_estimation.py:",
        "$ dexrepro run chapter=2 only=movement_estimation",
        "$ dexrepro study chapter=2 claim=C2.08",
    ):  # fmt: skip
        assert part in text


@pytest.mark.parametrize(
    ("word", "parts"),
    [
        ("2.7", ["2.7  of chapter 2", "C2.08", "$ dexrepro run figure=2.7", "Equation (2.7)"]),
        ("1.16", ["C1.18", "C1.20"]),  # one of the figure, one of a panel
        ("T2.1", ["T2.1  of chapter 2", "no claim names T2.1; ", "C2.14  ", "$ dexrepro run figure=T2.1"]),
        ("T6.1", ["C6.46", "C6.47"]),
        ("Eq. (2.32)", ["Equation (2.32), Sect. 2.3.3", r"\frac{1}{k}", "holding_reference.py:", "ImpedanceReference"]),
        ("k_o", ["movement_estimation.stiffness = k_o = [25, 35, 45] N/m  [printed 2.4.1.2]"]),
        ("movement_estimation.stiffness", ["k_o = [25, 35, 45] N/m"]),
        ("letter_accuracy.unit", ["letter_accuracy.unit = None -  [chosen of lengths in your files"]),  # inherited
        ("letter_accuracy.dmp", ["letter_accuracy.dmp.stiffness = K = 400", "letter_accuracy.dmp.samples = 1001"]),
        ("ImpedanceReference", ["Eq. (2.32)", "used by ", "holding_comparison"]),
        ("movement_estimation", ["cases ", "parameter ", "C2.11", "2.7  "]),
        ("E2.01", ["E2.01", "written in"]),
        ("2.10", ["balloon as a spring of 150 N/m"]),  # texts are filled with numbers
        ("E8.03", ["E8.03  reading", "supply 0.", "chapter=8 'circle_tracking.networks.rates=[1,1,1]'"]),
    ],
)
def test_a_word_is_found_whatever_kind_of_thing_it_names(word: str, parts: list[str]) -> None:
    text = said(word)
    assert all(part in text for part in parts), text
    assert not re.search(r"\{\w+(\.\w+)+(:[^{}]*)?\}", text.replace("${", "")), text


def test_an_equation_alone_is_no_figure() -> None:
    assert "of chapter 2" not in said("(2.7)")


def test_an_unknown_word_gets_the_nearest() -> None:
    with pytest.raises(
        InputError, match=r"nothing is called 'movement_estimaton': did you mean 'movement_estimation'\?"
    ):
        said("movement_estimaton")
    with pytest.raises(InputError, match=r"'zzzz': name a claim, figure, table, .* or erratum: dexrepro list"):
        said("zzzz")
    with pytest.raises(InputError, match=r"'chapter=4': see: dexrepro list chapter=4"):
        said("chapter=4")


def test_a_claim_is_found_as_other_commands_name_it_and_a_parameter_is_said_once() -> None:
    assert said("claim=C4.01") == said("C4.01")
    assert said("gamma").count("settling_time.gamma") == 1


def test_a_result_here_goes_before_what_is_stored(toy_result: Path) -> None:
    text = said("C90.01", Path("results"))
    assert "as run here, results/chapter90/decay" in text
    assert "values" in text
