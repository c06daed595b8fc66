"""Several processes, on several machines, share a results folder."""

from __future__ import annotations

import multiprocessing
import os
import signal
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from dexrepro.experiment import Recording
from dexrepro.storage import _owner, claimed, load_recording, remove_leftovers, save_recording, whole_folder


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


def test_leftovers_of_dead_processes_go_and_those_of_other_machines_stay(tmp_path: Path) -> None:
    machine = _owner().partition("@")[2]
    dead, elsewhere = tmp_path / f".case-999999999@{machine}-x1", tmp_path / ".case-999999999@elsewhere-x1"
    dead.mkdir()
    elsewhere.mkdir()
    with whole_folder(tmp_path / "case") as alive:
        remove_leftovers(tmp_path)
        assert alive.exists()
    assert not dead.exists()
    assert elsewhere.exists()
    assert (tmp_path / "case").exists()
    assert os.getpid() == int(_owner().partition("@")[0])


@pytest.mark.parametrize("columns", [["a", "b"], [1, 2], ["with, comma", "plain"]])
@pytest.mark.parametrize("missing", [False, True])
def test_a_frame_comes_back_whatever_its_columns(tmp_path: Path, columns: list[object], missing: bool) -> None:
    frame = pd.DataFrame([[0.1, 1e-12], [np.nan if missing else 2.0, -3.0]], columns=columns)
    save_recording(Recording(frames={"table": frame}), tmp_path, "case", 100.0)
    back = load_recording(tmp_path, "case").frames["table"]
    assert list(back.columns) == [str(column) for column in columns]
    np.testing.assert_array_equal(back.to_numpy(), frame.to_numpy())
