"""Recordings, metrics and results as files: written to a temporary sibling and renamed, so whole or absent."""

from __future__ import annotations

import contextlib
import fcntl
import gzip
import hashlib
import json
import math
import os
import platform
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from dexrepro.experiment import Recording


@contextlib.contextmanager
def whole_folder(target: Path) -> Iterator[Path]:
    """A new folder that replaces ``target`` when the block ends well and leaves no trace when it does not."""
    target.parent.mkdir(parents=True, exist_ok=True)
    folder = Path(tempfile.mkdtemp(prefix=f".{target.name}-{_owner()}-", dir=target.parent))
    folder.chmod(0o755)
    try:
        yield folder
        with locked(target.parent):
            old = folder.with_name(folder.name + "-old")
            if target.exists():
                target.rename(old)
            folder.rename(target)
        shutil.rmtree(old, ignore_errors=True)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _owner() -> str:
    """Process and machine: several machines may share a folder."""
    return f"{os.getpid()}@{platform.node().replace('-', '_')}"


def remove_leftovers(folder: Path) -> None:
    """Delete the temporary folders of processes of this machine that no longer exist."""
    machine = _owner().partition("@")[2]
    for path in folder.glob(f".*-*@{machine}-*"):
        pid = path.name.removesuffix("-old").rsplit("-", 2)[-2].partition("@")[0]
        if path.is_dir() and pid.isdigit() and not Path(f"/proc/{pid}").exists() and Path("/proc/self").exists():
            shutil.rmtree(path, ignore_errors=True)


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Exclude other processes that use the same lock; the kernel frees it when a process dies."""
    with open(folder / ".lock", "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextlib.contextmanager
def claimed(folder: Path, name: str, wait: bool = True) -> Iterator[bool]:
    """Whether this process alone works on the thing of that name, among all that share the folder, on any machine.

    The kernel frees a claim when its process dies. A process holds one at a time: closing the file ends them all.
    """
    position = int(hashlib.sha1(name.encode()).hexdigest()[:15], 16)
    with open(folder / ".claims", "a") as file:
        try:
            fcntl.lockf(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB), 1, position)
        except (BlockingIOError, PermissionError):
            yield False
        else:
            yield True


def read_yaml(path: Path) -> Any:
    """The content of a YAML file, parsed in C where the library has it."""
    return yaml.load(path.read_text(), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def write_yaml(path: Path, data: Any) -> None:
    """Write YAML, keys in the order given."""
    dumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    path.write_text(yaml.dump(finite(data), Dumper=dumper, sort_keys=False, allow_unicode=True))


def write_json(path: Path, data: Any) -> None:
    """Write JSON in one move; numbers that are not finite become null."""
    write_text(path, json.dumps(finite(data), indent=1) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write a file in one move: the old text or the new, never a part."""
    temporary = path.with_name(f".{path.name}-{_owner()}")
    temporary.write_text(text)
    temporary.replace(path)


def read_json(path: Path) -> Any:
    return json.loads(path.read_text())


def finite(data: Any) -> Any:
    """Plain Python numbers, with null for what is not finite."""
    if isinstance(data, Mapping):
        return {str(key): finite(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [finite(value) for value in data]
    if isinstance(data, np.generic):
        data = data.item()
    if isinstance(data, float) and not math.isfinite(data):
        return None
    return data


def digest_of(data: Any) -> str:
    """A hash that changes with any value in the data."""
    return hashlib.sha1(json.dumps(finite(data), sort_keys=True, default=str).encode()).hexdigest()


# ------------------------------------------------------------------------------------------------------ recordings


def save_recording(recording: Recording, folder: Path, case: str, rate: float) -> None:
    """Write a recording's series at ``rate`` [Hz], its frames and its images below ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    if recording.series:
        kept = _thinned(recording, rate)
        columns: dict[str, Any] = {}
        for name, values in kept.items():
            if values.ndim == 1:
                columns[name] = values
            else:
                flat = values.reshape(len(values), -1)
                columns.update({f"{name}[{index}]": flat[:, index] for index in range(flat.shape[1])})
        _write_frame(pd.DataFrame(columns), folder / f"{case}.csv.gz")
    for name, frame in recording.frames.items():
        _write_frame(frame, folder / f"{case}.{name}.csv.gz")
    if recording.images:
        import matplotlib.image

        for name, image in recording.images.items():
            matplotlib.image.imsave(folder / f"{case}.{name}.png", image)


def load_recording(folder: Path, case: str, status: str = "finished") -> Recording:
    """Read back what save_recording wrote (series at the kept rate)."""
    recording = Recording(status=status)
    path = folder / f"{case}.csv.gz"
    if path.exists():
        recording.series = _unflattened(_read_frame(path))
    for path in sorted(folder.glob(f"{case}.*.csv.gz")):
        recording.frames[path.name[len(case) + 1 : -len(".csv.gz")]] = _read_frame(path)
    for path in sorted(folder.glob(f"{case}.*.png")):
        import matplotlib.image

        image = matplotlib.image.imread(path)
        recording.images[path.name[len(case) + 1 : -len(".png")]] = (image[..., :3] * 255).round().astype(np.uint8)
    return recording


def _thinned(recording: Recording, rate: float) -> dict[str, np.ndarray]:
    """Every k-th sample, the first and the last among them."""
    time = recording.time
    if len(time) < 3 or not rate:
        return recording.series
    stride = max(1, round(1 / (rate * (time[-1] - time[0]) / (len(time) - 1))))
    index = np.arange(0, len(time), stride)
    if index[-1] != len(time) - 1:
        index = np.append(index, len(time) - 1)
    return {name: np.asarray(values)[index] for name, values in recording.series.items()}


def _unflattened(frame: pd.DataFrame) -> dict[str, np.ndarray]:
    groups: dict[str, list[str]] = {}
    for column in frame.columns:
        groups.setdefault(column.partition("[")[0], []).append(column)
    return {
        name: frame[columns[0]].to_numpy() if columns == [name] else frame[columns].to_numpy()
        for name, columns in groups.items()
    }


def _write_frame(frame: pd.DataFrame, path: Path) -> None:
    values = frame.to_numpy() if (frame.dtypes == np.float64).all() else None
    if values is not None and np.isfinite(values).all():  # several times as fast as to_csv, to the same text
        line = ",".join(["%.9g"] * values.shape[1]) + "\n"
        text = frame[:0].to_csv(index=False) + "".join([line % tuple(row) for row in values.tolist()])
    else:
        text = frame.to_csv(index=False, float_format="%.9g")
    with open(path, "wb") as raw, gzip.GzipFile(fileobj=raw, mode="wb", compresslevel=4, mtime=0) as file:
        file.write(text.encode())


def _read_frame(path: Path) -> pd.DataFrame:
    return pd.read_csv(path, keep_default_na=True)


# --------------------------------------------------------------------------------------------------------- results


class Result:
    """One result folder, read when asked: metrics, claims, run (provenance), recordings, tables, figures.

    Raises FileNotFoundError where the folder holds no result.
    """

    def __init__(self, folder: Path) -> None:
        if not (folder / "run.json").exists():
            raise FileNotFoundError(f"{folder} holds no result (no run.json)")
        self.folder = folder
        self.run: dict[str, Any] = read_json(folder / "run.json")
        self.metrics: dict[str, float | None] = read_json(folder / "metrics.json")
        self.claims: list[dict[str, Any]] = read_json(folder / "claims.json")

    def recording(self, case: str) -> Recording:
        """Series, frames and images of one case, at the rate kept on disk."""
        return load_recording(self.folder / "series", case, self.run["cases"][case]["status"])

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        return {path.stem: _read_frame(path) for path in sorted((self.folder / "tables").glob("*.csv"))}

    @property
    def figures(self) -> dict[str, Path]:
        return {path.stem: path for path in sorted((self.folder / "figures").glob("*.png"))}

    def __repr__(self) -> str:
        return f"Result({str(self.folder)!r}, {len(self.metrics)} metrics, {len(self.claims)} claims)"
