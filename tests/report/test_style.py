"""What the figures share is drawn once, for the cases that were run."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from dexrepro.report import style


class Run(dict[str, np.ndarray]):
    time = np.array([0.0, 1.0])


def test_curves_are_drawn_of_the_cases_that_were_run_and_scaled() -> None:
    _, axes = style.subplots()
    cases = {"law": ("the law", "book"), "rival": ("its rival", "rival")}
    style.curves(axes, {"law": Run(error=np.array([1.0, 2.0]))}, cases, "error", 1e3)
    (line,) = axes.get_lines()
    assert (line.get_label(), line.get_color(), *line.get_ydata()) == ("the law", style.BOOK, 1e3, 2e3)


def test_only_figures_whose_cases_were_run_are_drawn() -> None:
    shown = {"9.1": (lambda *given: given, ("law",)), "9.2": (lambda *given: given, ("law", "rival"))}
    assert style.drawn(shown, {"law": SimpleNamespace()}, 7) == {"9.1": ({"law": SimpleNamespace()}, 7)}  # type: ignore[arg-type]


def test_small_multiples_are_labelled_at_their_edges_alone() -> None:
    _, grid = style.subplots(2, 2)
    style.edges(grid, "Time [s]", ("upper", "lower"))
    style.panels(grid.flat, "one", "two", "three", "four")
    assert [axes.get_xlabel() for axes in grid.flat] == ["", "", "Time [s]", "Time [s]"]
    assert [axes.get_ylabel() for axes in grid.flat] == ["upper", "", "lower", ""]
    assert [axes.get_title(loc="left") or axes.get_title() for axes in grid.flat][3] == "(d) four"
