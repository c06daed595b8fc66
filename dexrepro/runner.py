"""From plans to files: run the cases that the cache lacks in one pool, assemble whole results."""

from __future__ import annotations

import contextlib
import json
import os
import platform
import re
import shutil
import subprocess
import time
import traceback
import warnings
import zlib
from collections.abc import Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from dexrepro import __version__, chapters
from dexrepro.config import InputError
from dexrepro.experiment import Config, Experiment, Metrics, Recording
from dexrepro.plan import Job, Plan
from dexrepro.pool import pool
from dexrepro.progress import Progress, Silent
from dexrepro.storage import (
    claimed,
    finite,
    load_recording,
    locked,
    read_json,
    read_yaml,
    remove_leftovers,
    save_recording,
    whole_folder,
    write_json,
    write_yaml,
)

PACKAGES = ("numpy", "scipy", "pybullet", "pandas", "matplotlib", "hydra-core")
SUMMARY = "summary"  # stands for the numbers over several cases in nested metrics
KEPT, RECENT = 6, 7 * 24 * 3600  # cached results a case: so many, and all of the last seconds (a sweep may need them)


@dataclass
class Outcome:
    """What a run did: result folders, failures as sentences, experiments skipped with the reason."""

    folders: dict[str, Path] = field(default_factory=dict)
    failures: dict[str, str] = field(default_factory=dict)
    skipped: dict[str, str] = field(default_factory=dict)
    differs: dict[str, list[str]] = field(default_factory=dict)

    def reasons(self) -> dict[str, list[str]]:
        """What failed, by the sentence that says why."""
        found: dict[str, list[str]] = {}
        for name, sentence in self.failures.items():
            found.setdefault(sentence, []).append(name)
        return found


# --------------------------------------------------------------------------------------------------------- running


def generator(seed: int, experiment: str, purpose: str) -> np.random.Generator:
    """The random numbers of one purpose: the same in all cases of an experiment."""
    entropy = [seed, zlib.crc32(experiment.encode()), zlib.crc32(purpose.encode())]
    return np.random.default_rng(np.random.SeedSequence(entropy))


def live(config: Mapping[str, Any]) -> Config:
    """A configuration whose ``_target_`` nodes are objects; InputError says why one cannot be made."""
    from hydra.utils import instantiate

    if "_target_" in json.dumps(finite(config), default=str):
        try:
            config = instantiate(dict(config), _convert_="all")
        except Exception as error:
            cause: BaseException = error
            while cause.__cause__ is not None:
                cause = cause.__cause__
            text = " ".join(str(cause).split())
            if isinstance(cause, LookupError | AttributeError | TypeError):  # these say little by themselves
                text = f"{type(cause).__name__}: {text}"
            where = re.search(r"full_key: (\S+)", str(error))
            key = f" ({where[1]})" if where else ""
            raise InputError(f"cannot build the objects of the configuration{key}: {text}") from error
    return Config.of(config)


def execute(job: Job) -> dict[str, Any]:
    """Simulate, measure and store one case; returns its entry for run.json."""
    from dexrepro.physics.world import World

    World.live = job.gui
    experiment = chapters.load(job.chapter).experiment(job.experiment)
    start = time.perf_counter()
    with warnings.catch_warnings(record=True) as caught:
        config = live(job.config)
        recording: Recording = experiment.simulation.simulate(
            config, lambda purpose: generator(job.seed, job.experiment, purpose)
        )
        wall = time.perf_counter() - start
        measured: Metrics = experiment.simulation.measure(recording, config)
    entry = {
        "status": recording.status,
        "steps": recording.steps,
        "simulated": recording.simulated,
        "wall": wall,
        "real_time_factor": recording.simulated / wall if recording.simulated else None,
    }
    if caught:  # what the user's files made doubtful, above all
        entry["warnings"] = sorted({" ".join(str(warning.message).split()) for warning in caught})
    with whole_folder(Path(job.folder)) as folder:
        save_recording(recording, folder / "series", job.case, experiment.rate)
        write_json(folder / "case.json", {"entry": entry, "metrics": measured, "config": job.config})
    return entry


def complete(job: Job) -> dict[str, Any]:
    """Execute a case unless another process has finished it meanwhile."""
    folder = Path(job.folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    with claimed(folder.parent, folder.name):
        if (folder / "case.json").exists():
            return dict(read_json(folder / "case.json")["entry"])
        return execute(job)


def assemble(plan: Plan) -> None:
    """Turn the cached cases of a plan into a result folder with metrics, claims, tables, figures and provenance."""
    experiment = chapters.load(plan.chapter).experiment(plan.experiment)
    cases = {job.case: read_json(Path(job.folder) / "case.json") for job in plan.jobs}
    nested: dict[str, Metrics] = {case: data["metrics"] for case, data in cases.items()}
    configs = {case: data["config"] for case, data in cases.items()}
    config = Config.of({**plan.block, "cases": configs})
    summarise(experiment, nested, config)
    with whole_folder(plan.folder) as folder:
        (folder / "series").mkdir()
        for job in plan.jobs:
            for path in sorted((Path(job.folder) / "series").glob("*")):
                _link(path, folder / "series" / path.name)
        write_yaml(folder / "config.yaml", config)
        write_json(folder / "metrics.json", flat(experiment.name, nested))
        write_json(folder / "run.json", _run_entry(plan, {case: data["entry"] for case, data in cases.items()}))
        present(plan.chapter, experiment, folder)
        _keep_animations(plan.folder, folder)
    _prune(plan)


def _keep_animations(old: Path, new: Path) -> None:
    """Take over what was rendered from recordings that are still the same (cached files keep their time)."""
    for path in sorted(old.glob("animation/*")):
        recording = new / "series" / f"{path.stem}.csv.gz"
        if recording.exists() and recording.stat().st_mtime <= path.stat().st_mtime:
            (new / "animation").mkdir(exist_ok=True)
            _link(path, new / "animation" / path.name)


def summarise(experiment: Experiment, nested: dict[str, Metrics], config: Config) -> None:
    """Add the numbers over several cases to nested metrics."""
    if function := experiment.function("summarise"):
        nested[SUMMARY] = function(nested, config)


def present(chapter: str, experiment: Experiment, folder: Path) -> None:
    """Evaluate claims, draw figures and write tables in a result folder, from its files alone."""
    from dexrepro.report import style

    run = read_json(folder / "run.json")
    flat_metrics = read_json(folder / "metrics.json")
    config = Config.of(read_yaml(folder / "config.yaml"))
    nested: dict[str, Metrics] = {case: {} for case in run["cases"]}
    for name, value in flat_metrics.items():
        _, first, *rest = name.split(".", 2)
        nested.setdefault(first if rest else SUMMARY, {})[rest[0] if rest else first] = value
    recordings = {
        case: load_recording(folder / "series", case, entry["status"]) for case, entry in run["cases"].items()
    }
    claims = [claim.evaluate(flat_metrics).as_dict() for claim in chapters.load(chapter).claims_of(experiment.name)]
    write_json(folder / "claims.json", claims)
    for name in ("tables", "figures"):
        shutil.rmtree(folder / name, ignore_errors=True)
        (folder / name).mkdir()
    if tabulate := experiment.function("tabulate"):
        for identifier, table in tabulate(recordings, nested, config).items():
            table.to_csv(folder / "tables" / f"{identifier}.csv", index=False, float_format="%.6g")
    if draw := experiment.function("draw"):
        with style.style():
            for identifier, figure in draw(recordings, nested, config).items():
                style.save(figure, folder / "figures", identifier)


def redraw(chapter: str, experiment: Experiment, target: Path) -> None:
    """Present again a result from its files alone; where that fails, it stays as it was."""
    with whole_folder(target) as folder:
        shutil.copytree(target, folder, dirs_exist_ok=True, copy_function=_link)
        present(chapter, experiment, folder)


def flat(experiment: str, nested: Mapping[str, Metrics]) -> Metrics:
    """``experiment.case.metric`` and, for numbers over several cases, ``experiment.metric``."""
    return {
        f"{experiment}.{name}" if case == SUMMARY else f"{experiment}.{case}.{name}": value
        for case, metrics in nested.items()
        for name, value in metrics.items()
    }


def _run_entry(plan: Plan, entries: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    simulated = sum(entry["simulated"] for entry in entries.values())
    wall = sum(entry["wall"] for entry in entries.values())
    return {
        "chapter": plan.chapter,
        "experiment": plan.experiment,
        "version": __version__,
        "revision": revision(),
        "seed": plan.seed,
        "fingerprint": plan.fingerprint,
        "differs": plan.differs,
        "packages": {name: version(name) for name in PACKAGES},
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "python": platform.python_version(),
        "wall": wall,
        "steps": sum(entry["steps"] for entry in entries.values()),
        "simulated": simulated,
        "real_time_factor": simulated / wall if simulated and wall else None,
        "cases": entries,
    }


@cache
def revision() -> str | None:
    """Git revision of the checkout this code runs from, with "+" where files have been changed."""
    git = ["git", "-C", str(Path(__file__).parent)]
    with contextlib.suppress(OSError, subprocess.CalledProcessError):
        head = subprocess.run([*git, "rev-parse", "--short=12", "HEAD"], capture_output=True, text=True, check=True)
        dirty = subprocess.run([*git, "status", "--porcelain", "--untracked-files=no"], capture_output=True, text=True)
        return head.stdout.strip() + ("+" if dirty.stdout.strip() else "")
    return None


def _link(source: str | Path, target: str | Path) -> None:
    try:
        os.link(source, target)
    except OSError:  # other file system
        shutil.copy2(source, target)


def _prune(plan: Plan) -> None:
    for job in plan.jobs:
        parent = Path(job.folder).parent
        with locked(parent):
            entries = sorted(parent.glob(f"{job.case}-" + "?" * 16), key=lambda p: p.stat().st_mtime, reverse=True)
            for old in entries[KEPT:]:
                if str(old) != job.folder and old.stat().st_mtime < time.time() - RECENT:
                    shutil.rmtree(old, ignore_errors=True)


# ------------------------------------------------------------------------------------------------------- scheduling


def run_plans(plans: Sequence[Plan], *, workers: int | None, force: bool, progress: Progress | None = None) -> Outcome:
    """Run what is missing, assemble what is complete; a failing case does not stop the others."""
    progress = progress or Silent()
    outcome = Outcome(differs={plan.experiment: plan.differs for plan in plans if plan.chapter != chapters.OWN})
    waiting: dict[str, set[str]] = {}
    todo: list[Job] = []
    for plan in plans:
        for parent in (Path(plan.jobs[0].folder).parent, plan.folder.parent):
            remove_leftovers(parent)
        if not force and _up_to_date(plan):
            outcome.folders[plan.experiment] = plan.folder
            continue
        missing = [job for job in plan.jobs if force or not (Path(job.folder) / "case.json").exists()]
        waiting[plan.experiment] = {job.case for job in missing}
        todo += missing
    if not waiting:
        return outcome
    by_name = {plan.experiment: plan for plan in plans}
    # An experiment of few cases has long ones: they begin, and the short ones of the others fill the gaps at the end.
    todo.sort(key=lambda job: len(by_name[job.experiment].jobs))
    import dexrepro.report.style  # noqa: F401  imported once, before the processes fork

    with pool(workers, progress.listen, in_process=any(job.gui for job in todo)) as submit:
        pending: dict[Future[Any], Job | Plan] = {submit(execute if force else complete, job): job for job in todo}
        pending |= {submit(assemble, by_name[name]): by_name[name] for name, cases in waiting.items() if not cases}
        progress.begin(len(todo))
        while pending:
            done, _ = wait(pending, timeout=0.2, return_when=FIRST_COMPLETED)
            progress.refresh()
            for future in done:
                task = pending.pop(future)
                name = task.name if isinstance(task, Job) else task.experiment
                try:
                    value = future.result()
                except BrokenProcessPool:
                    outcome.failures[name] = "its process was killed; the same command completes what is missing"
                except BaseException as error:
                    outcome.failures[name] = sentence(error)
                    _keep_traceback(task, error)
                else:
                    if isinstance(task, Plan):
                        outcome.folders[task.experiment] = task.folder
                        progress.assembled(task.experiment)
                        continue
                    progress.finished(task.name, value)
                    waiting[task.experiment].discard(task.case)
                    if not waiting[task.experiment]:
                        plan = by_name[task.experiment]
                        with contextlib.suppress(BrokenProcessPool):
                            pending[submit(assemble, plan)] = plan
                    continue
                if isinstance(task, Job):
                    progress.failed(task.name, outcome.failures[name])
    return outcome


def _up_to_date(plan: Plan) -> bool:
    try:
        return bool(read_json(plan.folder / "run.json")["fingerprint"] == plan.fingerprint)
    except (OSError, ValueError, KeyError):
        return False


def sentence(error: BaseException) -> str:
    """What went wrong, in one line."""
    text = " ".join(str(error).split())
    return text if isinstance(error, InputError) else f"{type(error).__name__}: {text}"


def _keep_traceback(task: Job | Plan, error: BaseException) -> None:
    folder = Path(task.folder if isinstance(task, Job) else task.jobs[0].folder).parent
    name = task.case if isinstance(task, Job) else "assemble"
    with contextlib.suppress(OSError):
        (folder / f"{name}.error.txt").write_text("".join(traceback.format_exception(error)))


def summary_rows(outcome: Outcome) -> list[dict[str, Any]]:
    """One row an experiment for the table at the end: wall time, real-time factor, claims by verdict."""
    rows = []
    for name, folder in outcome.folders.items():
        run, claims = read_json(folder / "run.json"), read_json(folder / "claims.json")
        verdicts: dict[str, int] = {}
        for claim in claims:
            verdicts[claim["verdict"]] = verdicts.get(claim["verdict"], 0) + 1
        timing = {key: run[key] for key in ("wall", "simulated", "real_time_factor")}
        doubts = sorted({text for entry in run["cases"].values() for text in entry.get("warnings", ())})
        rows.append({"experiment": name, "folder": str(folder), "claims": verdicts, "warnings": doubts, **timing})
    return rows
