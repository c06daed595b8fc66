"""Samples carried over a change of code that changed no number."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dexrepro.baselines import Baseline, agrees
from dexrepro.physics.engine import REFERENCE
from dexrepro.storage import locked
from dexrepro.study import samples
from dexrepro.study.draws import drawn


def confirm(chapter: str, experiment: str, results: Path, update: bool = False) -> tuple[int, list[str]]:
    """Carry samples over a change of code: returns how many cases of samples were carried, and the cases that differ.

    Of every case the first and the last sample made by other code, of the same draw, run again. One whose metrics are
    in both what they were, within the tolerances of the baseline, is the same simulation: its other samples count as
    such. The samples are those that are shipped where ``update`` renews them, else those among the results.
    """
    path = samples.samples_file(samples.summary_file(experiment, results, update))
    kept = samples.read_samples(path) if update else samples.all_samples(experiment, results)
    entries = {entry["index"]: entry for entry in kept}
    old: dict[str, list[int]] = {}
    for index, entry in entries.items():
        if entry["values"] == drawn(chapter, experiment, index):
            for case, content in samples.contents(chapter, experiment, entry).items():
                if entry["cases"].get(case, {"content": content})["content"] != content:
                    old.setdefault(case, []).append(index)
    runs: dict[int, samples.Cases] = {}
    for case, indices in old.items():
        for index in {indices[0], indices[-1]}:
            runs[index] = (*runs.get(index, ()), case)
    again = {
        index: samples.evaluate(chapter, experiment, index, {}, entries[index].get("engine", REFERENCE), cases)["cases"]
        for index, cases in runs.items()
    }
    known = Baseline.of(chapter, experiment).metrics
    same = {
        case
        for case in old
        if all(
            _is_same(f"{experiment}.{case}", entries[index]["cases"][case], rows[case], known)
            for index, rows in again.items()
            if case in rows
        )
    }
    for case in same:
        for index in old[case]:
            today = samples.contents(chapter, experiment, entries[index], (case,))
            entries[index]["cases"][case]["content"] = today[case]
    if same:
        path.parent.mkdir(parents=True, exist_ok=True)
        with locked(samples.studies_folder(results)):
            samples.write_samples(path, [entries[index] for index in sorted(entries)])
    return sum(len(old[case]) for case in same), sorted(old.keys() - same)


def _is_same(name: str, old: Mapping[str, Any], new: Mapping[str, Any], known: Mapping[str, Mapping[str, Any]]) -> bool:
    """Whether a case of a sample gave the same numbers twice, or failed twice with the same words."""
    was, now = ({f"{name}.{key}": value for key, value in row.get("metrics", {}).items()} for row in (old, new))
    exact = {"rtol": 2e-6, "atol": 0.0}  # samples keep six digits
    entries = {key: {**known.get(key, exact), "value": value} for key, value in was.items()}
    if _words(old) != _words(new):
        return False
    return was.keys() == now.keys() and all(agrees(now[key], entry) for key, entry in entries.items())


def _words(row: Mapping[str, Any]) -> list[str]:
    """Why a case failed, without its numbers, in which rounding may show."""
    return re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", str(row.get("error", ""))).split()
