"""Figures for slides, print and a dark ground, beside a result that stays as it is."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import Command, whole
from matplotlib.colors import to_rgba

from dexrepro.report import export, style


@pytest.fixture
def figure() -> plt.Figure:
    with style.style():
        figure, axes = style.subplots(width=style.ONE_COLUMN)
        axes.plot([0, 1], [0, 1], color="black", label="reference")
        axes.plot([0, 1], [1, 0], color=style.BOOK, marker="o")
        axes.scatter([0.5], [0.5], s=20.0, color="black")
        axes.annotate("here", (0, 0), xytext=(3, 3), textcoords="offset points")
        axes.set_xlabel("Time [s]")
    return figure


def test_all_of_a_figure_grows_alike(figure: plt.Figure) -> None:
    figure.draw_without_rendering()
    axes = figure.axes[0]
    width, line, text = figure.get_figwidth(), axes.lines[0].get_linewidth(), axes.xaxis.label.get_fontsize()
    area, shape = axes.collections[0].get_sizes()[0], axes.get_position().bounds
    export.enlarge(figure, 2.0)
    assert figure.get_figwidth() == 2 * width
    assert axes.lines[0].get_linewidth() == 2 * line
    assert axes.xaxis.label.get_fontsize() == 2 * text
    assert axes.collections[0].get_sizes()[0] == 4 * area
    assert axes.texts[0].xyann == (6, 6)
    np.testing.assert_allclose(axes.get_position().bounds, shape)


def test_a_dark_figure_turns_greys_and_keeps_colours(figure: plt.Figure) -> None:
    export.darken(figure)
    axes = figure.axes[0]
    assert to_rgba(axes.lines[0].get_color()) == (1.0, 1.0, 1.0, 1.0)
    assert to_rgba(axes.lines[1].get_color()) == pytest.approx(to_rgba(style.BOOK))
    assert to_rgba(axes.lines[1].get_markerfacecolor()) == pytest.approx(to_rgba(style.BOOK))
    assert axes.get_facecolor() == pytest.approx((export.GROUND,) * 3 + (1.0,))
    assert to_rgba(axes.xaxis.label.get_color())[0] > 0.8


@pytest.mark.parametrize(("words", "name"), [
    ("style=slides", "slides/fig_90_10.pdf"), ("format=svg style=dark", "dark/fig_90_10.svg"),
    ("format=png figure=90.10", "paper/fig_90_10.png"),
])  # fmt: skip
def test_draw_writes_them_beside_the_results(toy_result: Path, command: Command, words: str, name: str) -> None:
    before = whole(toy_result)
    status, said = command(f"draw {words}")
    assert status == 0, said
    assert str(Path("results/figures", name)) in said
    assert Path("results/figures", name).stat().st_size > 1000
    assert whole(toy_result) == before


@pytest.mark.parametrize(("words", "sentence"), [
    ("format=gif", "format = gif is not allowed: it must be one of pdf, png, svg"),
    ("style=bright", "style = bright is not allowed: it must be one of paper, slides, dark"),
])  # fmt: skip
def test_an_unknown_look_is_refused(toy_result: Path, command: Command, words: str, sentence: str) -> None:
    assert command(f"draw {words}") == (2, f"dexrepro: {sentence}\n")


def test_a_run_with_other_parameters_is_drawn_beside_the_books(toy_result: Path, command: Command) -> None:
    """A lecturer's case: the figure of a changed run, for dark slides."""
    assert command("run decay.start=0.5 workers=1")[0] == 0
    (folder,) = Path("results/runs").glob("decay-*")
    before = whole(folder)
    status, said = command(f"draw {folder} style=dark format=pdf")
    assert (status, said) == (0, f"results/figures/dark/{folder.name}/fig_90_10.pdf\n")
    assert Path(said.strip()).read_bytes().startswith(b"%PDF")
    assert not Path("results/figures/dark/fig_90_10.pdf").exists(), "that is the place of the book's own"
    assert whole(folder) == before
    assert command(f"draw {folder}") == (0, f"{folder}\n")


@pytest.mark.parametrize(("words", "sentence"), [
    ("results/runs/none style=dark", "results/runs/none holds no result"),
    ("results/chapter90/decay only=decay", "only: a folder says which result; leave out one of the two"),
])  # fmt: skip
def test_a_folder_without_a_result_is_refused(toy_result: Path, command: Command, words: str, sentence: str) -> None:
    status, said = command(f"draw {words}")
    assert status == 2
    assert said.startswith(f"dexrepro: {sentence}")
