"""Recordings as files: series at a kept rate, frames and images of one case."""

from __future__ import annotations

import gzip
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import Recording


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
        recording.series = _unflattened(read_frame(path))
    for path in sorted(folder.glob(f"{case}.*.csv.gz")):
        recording.frames[path.name[len(case) + 1 : -len(".csv.gz")]] = read_frame(path)
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


def read_frame(path: Path) -> pd.DataFrame:
    return pd.read_csv(path, keep_default_na=True)
