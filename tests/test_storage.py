"""Several processes, on several machines, share a results folder."""

from __future__ import annotations

import multiprocessing
import signal
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from dexrepro.experiment import Recording
from dexrepro.recordings import load_recording, save_recording
from dexrepro.storage import claimed, locked, remove_leftovers, whole_folder


def claim_and_wait(folder: Path, ready) -> None:
    with claimed(folder, "case"):
        ready.set()
        signal.pause()


def test_a_claim_excludes_others_until_its_process_dies(tmp_path: Path) -> None:
    ready = multiprocessing.Event()
    other = multiprocessing.Process(target=claim_and_wait, args=(tmp_path, ready))
    other.start()
    assert ready.wait(20)
    with claimed(tmp_path, "case", wait=False) as mine:
        assert not mine
    with claimed(tmp_path, "another case", wait=False) as mine:
        assert mine
    other.kill()
    with claimed(tmp_path, "case") as mine:
        assert mine
    other.join()


def replace_and_wait(target: Path, ready, step: str) -> None:
    if step == "between the renames":
        rename = Path.rename

        def first_only(path: Path, other: Path) -> Path:
            renamed = rename(path, other)
            ready.set()
            signal.pause()
            return renamed

        Path.rename = first_only  # type: ignore[method-assign]
    with whole_folder(target) as folder:
        (folder / "new").touch()
        if step == "while it is filled":
            ready.set()
            signal.pause()


@pytest.mark.parametrize("step", ["while it is filled", "between the renames"])
def test_a_process_killed_while_it_replaces_a_folder_loses_nothing(tmp_path: Path, step: str) -> None:
    with whole_folder(tmp_path / "case") as folder:
        (folder / "old").touch()
    ready = multiprocessing.Event()
    other = multiprocessing.Process(target=replace_and_wait, args=(tmp_path / "case", ready, step))
    other.start()
    assert ready.wait(20)
    remove_leftovers(tmp_path)
    assert list(tmp_path.glob(".*.part")), "it is alive"
    other.kill()
    other.join()
    remove_leftovers(tmp_path)
    assert [path.name for path in (tmp_path / "case").iterdir()] == ["old"]
    assert {path.name for path in tmp_path.iterdir()} <= {"case", ".lock"}


def test_an_interrupt_between_the_renames_puts_the_old_folder_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with whole_folder(tmp_path / "case") as folder:
        (folder / "old").touch()
    rename = Path.rename

    def interrupted(path: Path, other: Path) -> Path:
        if path.suffix == ".part":
            raise KeyboardInterrupt
        return rename(path, other)

    monkeypatch.setattr(Path, "rename", interrupted)
    with pytest.raises(KeyboardInterrupt), whole_folder(tmp_path / "case"):
        pass
    assert [path.name for path in (tmp_path / "case").iterdir()] == ["old"]
    with locked(tmp_path):
        assert {path.name for path in tmp_path.iterdir()} == {"case", ".lock"}


@pytest.mark.parametrize("columns", [["a", "b"], [1, 2], ["with, comma", "plain"]])
@pytest.mark.parametrize("missing", [False, True])
def test_a_frame_comes_back_whatever_its_columns(tmp_path: Path, columns: list[object], missing: bool) -> None:
    frame = pd.DataFrame([[0.1, 1e-12], [np.nan if missing else 2.0, -3.0]], columns=columns)
    save_recording(Recording(frames={"table": frame}), tmp_path, "case", 100.0)
    back = load_recording(tmp_path, "case").frames["table"]
    assert list(back.columns) == [str(column) for column in columns]
    np.testing.assert_array_equal(back.to_numpy(), frame.to_numpy())
