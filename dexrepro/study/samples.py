"""A sample: the cases of one draw, run; and the files that keep samples, one a line."""

from __future__ import annotations

import gzip
import json
import time
import zlib
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from dexrepro import chapters
from dexrepro.cache_key import content_of
from dexrepro.case import measured
from dexrepro.claims import Claim, cases_in
from dexrepro.config import baseline_dir
from dexrepro.errors import InputError
from dexrepro.experiment import Config, Metrics
from dexrepro.physics.engine import REFERENCE
from dexrepro.plan import case_values
from dexrepro.result import SUMMARY, flat, over_cases
from dexrepro.storage import digest_of, finite, opened, write_text
from dexrepro.study.draws import draw

Cases = tuple[str, ...]


def evaluate(
    chapter: str, experiment: str, index: int, known: Mapping[str, Any], engine: str = REFERENCE, only: Cases = ()
) -> dict[str, Any]:
    """One sample: what was drawn and, of every case that a claim is about, the key of its simulation and its metrics.

    known: cases that were run before, by the key of their simulation; they are taken over. engine: of the simulations;
    a sample says which it was, where it is not that of the baselines. only: some of the cases.
    """
    definition, cases = chapters.load(chapter).experiment(experiment), {}
    values, configs = _configurations(chapter, experiment, index, engine, only)
    for case, config in configs.items():
        content = content_of(definition, config)
        if content in known:
            cases[case] = known[content]
            continue
        start = time.process_time()
        try:
            found: dict[str, Any] = {"metrics": _rounded(measured(definition, config))}
        except Exception as problem:
            found = {"error": f"{type(problem).__name__}: {' '.join(str(problem).split())}"}
        cases[case] = {"content": content, **found, "seconds": round(time.process_time() - start, 3)}
    return {"index": index, "values": values, "cases": cases} | ({} if engine == REFERENCE else {"engine": engine})


def _configurations(
    chapter: str, experiment: str, index: int, engine: str, only: Cases
) -> tuple[dict[str, float | str], dict[str, dict[str, Any]]]:
    """The values drawn for a sample, and under them every case that a claim is about."""
    values, block = draw(chapter, experiment, index)
    names = needed_cases(chapters.load(chapter).claims_of(experiment), block["cases"], only)
    return values, {case: case_values(block["cases"][case], case, int(values["seed"]), engine) for case in names}


def contents(chapter: str, experiment: str, entry: Mapping[str, Any], only: Cases = ()) -> dict[str, str]:
    """The key of the present simulation of every case that a claim is about, in one sample."""
    definition = chapters.load(chapter).experiment(experiment)
    configs = _configurations(chapter, experiment, entry["index"], entry.get("engine", REFERENCE), only)[1]
    return {case: content_of(definition, config) for case, config in configs.items()}


class _Asked(Mapping[str, Metrics]):
    """Metrics by case, of which ``cases`` are those that were asked for; all, where they were gone through."""

    def __init__(self, metrics: Mapping[str, Metrics], names: Iterable[str]) -> None:
        self.metrics, self.names, self.cases = metrics, {*names}, set[str]()

    def __getitem__(self, case: str) -> Metrics:
        self.cases.add(case)
        return self.metrics[case]

    def __iter__(self) -> Iterator[str]:
        self.cases |= self.names
        return iter(self.metrics)

    def __len__(self) -> int:
        self.cases |= self.names
        return len(self.metrics)


def metrics_of(chapter: str, experiment: str, entry: Mapping[str, Any]) -> Metrics:
    """All metrics of a sample by their full names, with those over several cases if it has the cases they are made of;
    a case that failed has none."""
    nested = _by_case(entry)
    found, cases = _over_several(chapter, experiment, entry, nested)
    return finite(flat(experiment, nested | ({SUMMARY: found} if cases <= nested.keys() else {})))


def cases_over(chapter: str, experiment: str, entries: Iterable[Mapping[str, Any]]) -> set[str] | None:
    """The cases that numbers over several are made of, as a sample of all cases tells; None without one."""
    names = draw(chapter, experiment, 0)[1]["cases"].keys()
    whole = next((entry for entry in entries if _by_case(entry).keys() >= names), None)
    return _over_several(chapter, experiment, whole, _by_case(whole))[1] if whole else None


def _by_case(entry: Mapping[str, Any]) -> dict[str, Metrics]:
    return {case: dict(row["metrics"]) for case, row in entry["cases"].items() if "metrics" in row}


def _over_several(
    chapter: str, experiment: str, entry: Mapping[str, Any], nested: Mapping[str, Metrics]
) -> tuple[Metrics, set[str]]:
    """A sample's numbers over several cases, and the cases that they are made of: they count where these are there."""
    block = draw(chapter, experiment, entry["index"])[1]
    asked, found = _Asked(nested, block["cases"]), Metrics()
    try:
        found = over_cases(chapters.load(chapter).experiment(experiment), asked, Config.of(block))
    except Exception:
        if asked.cases <= nested.keys():
            raise
    return found, asked.cases


def _rounded(numbers: Mapping[str, float | None]) -> dict[str, float | None]:
    return {key: value if value is None else float(f"{value:.6g}") for key, value in numbers.items()}


def needed_cases(
    claims: Iterable[Claim],
    cases: Iterable[str],
    only: Cases = (),
    deciding: bool = False,
    over: Container[str] | None = None,
) -> list[str]:
    """The cases that the claims are about, and ``over`` (None: all) if one needs a number over several; of them only
    some.

    deciding: those of the predicates alone, on which a claim's word rests, without controls and other readings.
    """
    if only:
        return [case for case in cases if case in only]
    tests = (test for claim in claims for test in ((claim.predicate,) if deciding else claim.predicates) if test)
    about, over_several = cases_in(name for test in tests for name in test.metrics)
    return [case for case in cases if case in about or (over_several and (over is None or case in over))]


def studies_folder(results: Path, shipped: bool = False) -> Path:
    """Where studies are kept: among the user's results, or beside the baselines that are shipped."""
    return baseline_dir() / "study" if shipped else results / "studies"


def summary_file(experiment: str, results: Path, shipped: bool = False, only: Cases = ()) -> Path:
    """Where the summary of a study is kept, or of one of some cases ``only``."""
    if only:
        return studies_folder(results) / "cases" / f"{experiment}-{digest_of([*only])[:10]}.json"
    return studies_folder(results, shipped) / f"{experiment}.json"


def samples_file(summary: Path) -> Path:
    """Samples beside a summary: plain where they grow, compressed where they are shipped."""
    return summary.with_suffix(".jsonl.gz" if summary.parent == studies_folder(Path(), shipped=True) else ".jsonl")


def add_sample(path: Path, entry: Mapping[str, Any]) -> None:
    """Add a sample to a file, whose last line may have been cut short."""
    with open(path, "a+b") as file:
        file.seek(max(file.tell() - 1, 0))
        cut_short = file.read(1) not in (b"", b"\n")
        file.write(b"\n" * cut_short + _line(entry).encode())


def write_samples(path: Path, entries: Sequence[Mapping[str, Any]]) -> None:
    """Keep samples in a file in place of those that it holds."""
    text = "".join(map(_line, entries))
    if path.suffix == ".gz":
        path.write_bytes(gzip.compress(text.encode(), mtime=0))
    else:
        write_text(path, text)


def _line(entry: Mapping[str, Any]) -> str:
    return json.dumps(entry) + "\n"


def read_samples(path: Path) -> Iterator[dict[str, Any]]:
    """The samples of a file; what is none (a line may have been cut short) is left out."""
    try:
        data = b""
        if path.exists():
            with opened(path) as file:
                data = file.read()
        lines = (gzip.decompress(data) if path.suffix == ".gz" and data else data).splitlines()
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(f"{path} holds no samples of a study ({error}); remove it") from error
    for line in lines:
        with suppress(ValueError, RecursionError, TypeError, LookupError, AttributeError):
            entry = json.loads(line)
            sound = isinstance(entry["index"], int) and entry["index"] >= 0 and isinstance(entry["values"], dict)
            if sound and all(isinstance(row["content"], str) for row in entry["cases"].values()):
                yield entry


def all_samples(experiment: str, results: Path) -> Iterator[dict[str, Any]]:
    """Samples that are shipped, then those made here, whatever simulation made them."""
    for shipped in (True, False):
        yield from read_samples(samples_file(summary_file(experiment, results, shipped)))


def shipped_samples(experiment: str) -> list[dict[str, Any]]:
    """The samples that are shipped, whatever simulation made them."""
    return list(read_samples(samples_file(summary_file(experiment, Path(), shipped=True))))
