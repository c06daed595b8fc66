"""Two results side by side: configuration, metrics, verdicts, and their series in one picture."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from dexrepro.checks import differences
from dexrepro.errors import InputError
from dexrepro.recordings import load_recording
from dexrepro.report import style
from dexrepro.report.damage import check_result
from dexrepro.storage import read_json, read_yaml

PANELS = 6


def compare(a: Path, b: Path) -> Iterator[str]:
    """Yield what differs, a line each, and write ``diff-<b>.png`` into the folder ``a``'s parent.

    Raises InputError where a folder holds no result, or a damaged one.
    """
    for folder in (a, b):
        if not (folder / "metrics.json").exists():
            raise InputError(f"{folder} holds no result (no metrics.json)")
        check_result(folder, "config.yaml", "metrics.json", "claims.json", series=True)
    yield from (
        f"config   {line.replace('book', str(b))}"
        for line in differences(*(read_yaml(folder / "config.yaml") for folder in (a, b)))
    )
    mine, theirs = (read_json(folder / "metrics.json") for folder in (a, b))
    for name in dict.fromkeys([*mine, *theirs]):
        if mine.get(name) != theirs.get(name):
            yield f"metric   {name}: {mine.get(name)} | {theirs.get(name)}"
    verdicts = [{c["id"]: c["verdict"] for c in read_json(folder / "claims.json")} for folder in (a, b)]
    for key in dict.fromkeys([*verdicts[0], *verdicts[1]]):
        if verdicts[0].get(key) != verdicts[1].get(key):
            yield f"verdict  {key}: {verdicts[0].get(key)} | {verdicts[1].get(key)}"
    picture = _overlay(a, b)
    yield f"series   {picture}" if picture else "series   no common channel differs"


def _overlay(a: Path, b: Path) -> Path | None:
    pairs = []
    cases = [case for case in read_json(a / "run.json")["cases"] if case in read_json(b / "run.json")["cases"]]
    for case in cases:
        first, second = (load_recording(folder / "series", case) for folder in (a, b))
        for channel in first.series:
            if channel == "time" or channel not in second or first[channel].dtype.kind not in "fi":
                continue
            one, two = (r[channel].reshape(len(r.time), -1) for r in (first, second))
            resampled = np.column_stack([np.interp(first.time, second.time, column) for column in two.T])
            if one.shape == resampled.shape:
                spread = np.ptp(one) or 1.0
                pairs.append((float(np.max(np.abs(one - resampled)) / spread), case, channel, first, second))
    pairs = sorted((pair for pair in pairs if pair[0] > 0), key=lambda pair: -pair[0])[:PANELS]
    if not pairs:
        return None
    with style.style():
        figure, axes = style.subplots(len(pairs), height=1.3 * len(pairs) + 0.4, squeeze=False)
        for ax, (_, case, channel, first, second) in zip(axes[:, 0], pairs, strict=True):
            lines = ax.plot(first.time, first[channel], color=style.BOOK)
            others = ax.plot(second.time, second[channel], color=style.RIVAL, linestyle="-.")
            ax.set_title(f"{case}: {channel}")
        axes[0, 0].legend([lines[0], others[0]], [str(a), str(b)])
        axes[-1, 0].set_xlabel("Time [s]")
        target = a.parent / f"diff-{a.name}-{b.name}.png"
        figure.savefig(target)
    return target
