"""Recorded paths are read, checked and resampled."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.primitives.recorded import demonstrations, read_path, resampled

numbers = st.integers(-100_000, 100_000).map(lambda thousandths: thousandths / 1000)
instants = st.lists(st.floats(1e-3, 10), min_size=2, max_size=30).map(lambda steps: np.cumsum([0.0, *steps]))


@settings(deadline=None, max_examples=50)
@given(st.lists(st.tuples(st.floats(1e-3, 10), numbers, numbers), min_size=2, max_size=20), st.integers(2, 200))
def test_resampling_keeps_the_end_points_and_the_range(rows, samples) -> None:
    steps, *path = np.array(rows).T
    time, path = np.cumsum(steps), np.transpose(path)
    new = resampled(time, path, samples)
    assert new.shape == (samples, 2)
    assert new[[0, -1]] == pytest.approx(path[[0, -1]])
    assert (new >= path.min(axis=0) - 1e-9).all()
    assert (new <= path.max(axis=0) + 1e-9).all()


@settings(deadline=None, max_examples=50)
@given(instants, numbers, numbers)
def test_resampling_reproduces_linear_motion(time, start, speed) -> None:
    new = resampled(time, start + speed * time[:, None], 50)
    wanted = start + speed * np.linspace(0, time[-1], 50)
    assert new[:, 0] == pytest.approx(wanted, abs=1e-9 * (1 + abs(start) + abs(speed) * time[-1]))


ROWS = [f"{2 + 0.1 * k:.1f},{k},{2 * k}" for k in range(10)]


def write(folder: Path, rows: list[str], header: str = "time,x,y\n") -> str:
    (folder / "path.csv").write_text(header + "\n".join(rows) + "\n")
    return str(folder / "path.csv")


@pytest.mark.parametrize("header", ["time,x,y\n", "Time, X, Y\n", ""])
@pytest.mark.parametrize(("unit", "factor"), [("m", 1), ("cm", 0.01), ("mm", 0.001), ("inch", 0.0254)])
def test_lengths_arrive_in_metres_and_time_starts_at_zero(
    tmp_path: Path, header: str, unit: str, factor: float
) -> None:
    time, position = read_path(write(tmp_path, ROWS, header), unit, axes=2)
    assert time == pytest.approx(np.arange(10) * 0.1)
    assert position == pytest.approx(factor * np.column_stack([np.arange(10), 2 * np.arange(10)]))


@pytest.mark.parametrize(
    ("rows", "header", "sentence"),
    [
        (
            [*ROWS[:4], "2.4,nan,1", *ROWS[5:]],
            "time,x,y\n",
            "line 6 of .* holds '2.4,nan,1': every entry must be a fin",
        ),
        ([*ROWS[:4], "2.4,one,1", *ROWS[5:]], "", "line 5 of .* holds '2.4,one,1'"),
        ([*ROWS[:4], ROWS[3], *ROWS[5:]], "time,x,y\n", "does not increase at line 6"),
        (ROWS[:7], "time,x,y\n", "has 7 samples; there must be at least 8"),
        ([], "", "has 0 samples"),
        ([row + ",0" for row in ROWS], "", "line 1 of .* has 4 numbers; it must have time, x, y"),
        (ROWS, "time,y,x\n", "columns of .* are time, y, x; they must be time, x, y"),
    ],
)
def test_a_file_that_cannot_be_used_gets_one_sentence(tmp_path: Path, rows, header: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        read_path(write(tmp_path, rows, header), axes=2)


def test_a_file_or_unit_that_is_not_there_gets_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"cannot read 'no.csv': No such file"):
        read_path("no.csv")
    with pytest.raises(ValueError, match="unit = ft is not allowed: it must be one of m, cm, mm, inch"):
        read_path(write(tmp_path, ROWS), "ft")


def test_several_files_take_turns(tmp_path: Path) -> None:
    for number in (1, 2):
        (tmp_path / f"{number}.csv").write_text("\n".join(f"{k},{number * k},0" for k in range(8)))
    paths = demonstrations(str(tmp_path / "*.csv"), 3, 20, "m", axes=2)
    assert [path[-1, 0] for path in paths] == pytest.approx([7, 14, 7])
    with pytest.raises(ValueError, match="2 files are more than the 1 demonstrations"):
        demonstrations(str(tmp_path / "*.csv"), 1, 20, "m", axes=2)


def test_a_file_saved_by_a_spreadsheet_is_read(tmp_path: Path) -> None:
    rows = "\n".join(f"{k},{k},0" for k in range(8))
    (tmp_path / "saved.csv").write_text(f"time,x,y\n{rows}\n", encoding="utf-8-sig")
    assert read_path(str(tmp_path / "saved.csv"), "m", 2)[1][-1].tolist() == [7, 0]
