"""What samples show of each claim: how often it holds, by what margin, and what its margin follows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dexrepro import chapters
from dexrepro.arrays import Array
from dexrepro.claims import LOOKS, robustness
from dexrepro.errors import InputError
from dexrepro.physics.engine import REFERENCE
from dexrepro.provenance import Provenance
from dexrepro.storage import read_json, require
from dexrepro.study import draws
from dexrepro.study.samples import metrics_of, samples_file, studies_folder

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of the margin, in a summary
PERMUTATIONS = 999
NUMBER = (int, float)
ROW = {"predicate": str, "samples": int, "holds": int, "share": NUMBER, "low": NUMBER, "high": NUMBER,
       "median_margin": NUMBER, "quantiles": list, "parameter": (str, type(None)),
       "correlation": (int, float, type(None))}  # fmt: skip


def summary(chapter: str, experiment: str, entries: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """How often each claim holds and its control fails, what that shows, and the parameter its margin follows.

    Only samples count whose cases all ran; "undefined" says in how many a metric was undefined, where the claim fails.
    """
    from dexrepro.measures import binomial_interval

    claims: dict[str, Any] = {}
    origins = draws.parameters(chapter, experiment)
    sampled = [(metrics_of(chapter, experiment, entry), _numeric(entry["values"], origins)) for entry in entries]
    for claim in chapters.load(chapter).claims_of(experiment):
        pairs = [
            (evaluation, values)
            for metrics, values in sampled
            if (evaluation := claim.evaluate(metrics)).margin is not None
        ]
        if not pairs:
            continue
        margins = np.array([found.margin for found, _ in pairs], dtype=float)
        controls = [found.control_margin for found, _ in pairs if found.control_margin is not None]
        holds = int(np.sum(margins > 0))
        low, high = binomial_interval(holds, len(pairs))
        parameter, correlation = _most_influential(margins, [values for _, values in pairs])
        names = claim.predicate.metrics if claim.predicate else ()
        claims[claim.id] = {
            "predicate": str(claim.predicate), "samples": len(pairs), "holds": holds, "share": holds / len(pairs),
            "low": low, "high": high, "word": robustness(holds, len(pairs)),
            "undefined": sum(any(found.values[name] is None for name in names) for found, _ in pairs),
            "control_fails": sum(margin <= 0 for margin in controls) if controls else None,
            "control_samples": len(controls),
            "parameter": parameter, "correlation": correlation, "median_margin": float(np.median(margins)),
            "quantiles": np.quantile(margins, QUANTILES).tolist(), "least": float(margins.min()),
            "boundary": _boundary(parameter, pairs),
        }  # fmt: skip
    engines = dict(sorted(Counter(entry.get("engine", REFERENCE) for entry in entries).items()))
    failed = sum(any("error" in row for row in entry["cases"].values()) for entry in entries)
    seconds = sum(row.get("seconds", 0.0) for entry in entries for row in entry["cases"].values())
    return {"chapter": chapter, "experiment": experiment, "samples": len(entries), "failed": failed,
            "seconds": round(seconds, 1), "varied": draws.varied(chapter, experiment), "claims": claims,
            **({"engines": engines} if set(engines) - {REFERENCE} else {})}  # fmt: skip


def _numeric(values: Mapping[str, float | str], origins: Mapping[str, Provenance]) -> dict[str, float]:
    """The values drawn, with the place of a word among its words."""
    return {k: origins[k].words.index(v) if isinstance(v, str) else v for k, v in values.items()}


def _boundary(parameter: str | None, pairs: Sequence[tuple[Any, Mapping[str, float]]]) -> list[list[float]] | None:
    """Value of the deciding parameter and margin of every sample: where the claim turns."""
    if parameter is None:
        return None
    return sorted([float(values[parameter]), float(f"{found.margin:.4g}")] for found, values in pairs)


def _most_influential(margins: Array, values: Sequence[Mapping[str, float]]) -> tuple[str | None, float | None]:
    """The parameter whose ranks follow the margins' most, if that is more than chance among all parameters.

    The largest |Spearman correlation| is compared with the largest under permuted margins (5 % of 999), so that trying
    many parameters finds none by luck.
    """
    names = [key for key in values[0] if key != "seed" and len({row[key] for row in values}) > 1]
    if len(margins) < LOOKS[0] or np.ptp(margins) == 0 or not names:
        return None, None
    columns = np.array([[row[key] for row in values] for key in names])
    ranks, order = _standard_ranks(columns), _standard_ranks(margins[None, :])[0]
    correlations = ranks @ order / len(order)
    best = int(np.argmax(np.abs(correlations)))
    rng = np.random.default_rng(0)
    permuted = np.array([rng.permutation(order) for _ in range(PERMUTATIONS)])
    chance = np.max(np.abs(permuted @ ranks.T), axis=1) / len(order)
    if np.sum(chance >= abs(correlations[best])) + 1 > 0.05 * (PERMUTATIONS + 1):
        return None, None
    return names[best], float(correlations[best])


def _standard_ranks(rows: Array) -> Array:
    from scipy.stats import rankdata

    ranks = rankdata(rows, axis=1)
    return (ranks - ranks.mean(axis=1, keepdims=True)) / ranks.std(axis=1, keepdims=True)


def stored(results: Path) -> list[dict[str, Any]]:
    """Every study there is: of those shipped and those made here, the one of more samples; ours where equal.

    One that varied something else than would be drawn today is left out, and of the others the row of a claim that
    says something else today or is gone.
    """
    largest: dict[str, dict[str, Any]] = {}
    for path in (path for shipped in (True, False) for path in studies_folder(results, shipped).glob("*.json")):
        item = _summary(path)
        known = chapters.load(item["chapter"]).claims if item["chapter"] in chapters.numbers() else ()
        today = {claim.id: str(claim.predicate) for claim in known if claim.experiment == item["experiment"]}
        kept = {key: row for key, row in item["claims"].items() if row["predicate"] == today.get(key)}
        other = bool(today) and item["varied"] != draws.varied(item["chapter"], item["experiment"])
        if other or (item["claims"] and not kept):
            continue
        if item["samples"] >= largest.get(path.name, item)["samples"]:
            largest[path.name] = item | {"claims": kept}
    return [largest[name] for name in sorted(largest)]


def _summary(path: Path) -> dict[str, Any]:
    """A stored summary. Raises InputError where the file is none."""
    try:
        found: dict[str, Any] = read_json(path)
        require(found, {"chapter": str, "experiment": str, "samples": int, "varied": dict, "claims": dict})
        for key, row in found["claims"].items():
            require(row, ROW, f"{key}.")
            sizes = row["quantiles"]
            if len(sizes) != len(QUANTILES) or not all(isinstance(size, int | float) for size in sizes):
                raise ValueError(f"{key}.quantiles = {sizes} is of another kind")
    except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        reason = f"{type(error).__name__}: {' '.join(str(error).split())}"
        raise InputError(f"{path} is no study ({reason}); remove it and repeat: dexrepro study") from error
    return found


def held(summary: Path) -> int:
    """Samples that a summary must not lose: those beside it. One without its samples cannot go on and is replaced."""
    return int(_summary(summary)["samples"]) if summary.exists() and samples_file(summary).exists() else 0


def robustness_of(chapter: str, results: Path = Path("results")) -> dict[str, str]:
    """What the studies show each claim of a chapter to be: "robust", "fragile" or "open"."""
    rows = [row for item in stored(results) if item["chapter"] == chapter for row in item["claims"].items()]
    return {key: robustness(row["holds"], row["samples"]) for key, row in rows}
