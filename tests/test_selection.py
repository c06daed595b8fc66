"""Words of the command line select chapters and experiments."""

from __future__ import annotations

from dexrepro.selection import chapters_of, of_chapter


def test_experiments_of_several_chapters_go_each_to_its_own() -> None:
    numbers, rest = chapters_of(["only=lyapunov,keep_out,hand_over", "workers=1"])
    assert numbers == ["1", "6"]
    assert of_chapter("1", numbers, rest) == ["only=[lyapunov,hand_over]", "workers=1"]
    assert of_chapter("6", numbers, rest) == ["only=[keep_out]", "workers=1"]


def test_a_name_that_no_chapter_has_is_left_to_be_refused() -> None:
    assert of_chapter("1", ["1", "6"], ["only=[lyapunof,keep_out]"]) == ["only=[lyapunof]"]
