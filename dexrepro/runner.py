"""From plans to results: run the cases that the cache lacks in one pool, assemble whole result folders."""

from __future__ import annotations

import contextlib
import logging
import os
import platform
import shutil
import subprocess
import time
import warnings
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from dexrepro import __version__, chapters
from dexrepro.cache_key import own_digest
from dexrepro.case import live, targets, watched
from dexrepro.case import run as run_case
from dexrepro.checks import differences
from dexrepro.errors import COMPLETES, InputError, one_line
from dexrepro.experiment import Config, Experiment, Metrics, Recording
from dexrepro.own_code import check_own, import_anew
from dexrepro.plan import Job, Plan, outdated
from dexrepro.pool import WARNED, Failure, Pool, start_method
from dexrepro.progress import Silent
from dexrepro.result import CaseEntry, RunEntry, flat, present, redraw
from dexrepro.storage import (
    claimed,
    copy,
    locked,
    read_json,
    remove_leftovers,
    sync,
    whole_folder,
    write_json,
    write_text,
    write_yaml,
)
from dexrepro.unread import Watched, unread

PACKAGES = ("pandas", "matplotlib", "hydra-core")  # beside those that can change a number
log = logging.getLogger(__name__)
NO_NUMBER = "the law "  # how a status begins that says which law gave no number, when, and what instead
SHOWN = 6  # differences that are named
KEPT, RECENT = 6, 7 * 24 * 3600  # cached results a case: so many, and all of the last seconds (a sweep may need them)


@dataclass
class Outcome:
    """What a run did: result folders and failures as sentences, by name; in what experiments differ from the book.

    unusable: cases that a law of the user's ended by giving no number, as sentences; there is a result up to then.
    tracebacks: files that say more of a failure, by name. assembled: experiments whose result is new.
    """

    folders: dict[str, Path] = field(default_factory=dict)
    failures: dict[str, str] = field(default_factory=dict)
    unusable: dict[str, str] = field(default_factory=dict)
    tracebacks: dict[str, Path] = field(default_factory=dict)
    assembled: list[str] = field(default_factory=list)
    differs: dict[str, list[str]] = field(default_factory=dict)

    @property
    def failed(self) -> str:
        """What failed, and why, in one line ("" where nothing did)."""
        return "; ".join(f"{name} failed: {text}" for name, text in self.failures.items())

    def reasons(self) -> dict[str, list[str]]:
        """What failed, by the sentence that says why."""
        found: dict[str, list[str]] = {}
        for name, sentence in {**self.failures, **self.unusable}.items():
            found.setdefault(sentence, []).append(name)
        return found


# --------------------------------------------------------------------------------------------------------- running


def execute(job: Job) -> CaseEntry:
    """Simulate, measure and store one case."""
    from dexrepro.physics import engine
    from dexrepro.physics.world import World
    from dexrepro.recordings import save_recording

    World.live = job.gui
    engine.use(job.config.get("engine", engine.REFERENCE))
    experiment = chapters.load(job.chapter).experiment(job.experiment)
    import_anew(job.config)
    with warnings.catch_warnings(record=True) as caught, contextlib.chdir("."):  # a law may go elsewhere
        check_own(job.config)
        config = Watched.of(live(job.config)) if job.watched else live(job.config)
        if job.own != own_digest(job.config) and "__main__." not in str(job.config):
            raise InputError("a file that it uses was edited meanwhile; the same command runs it again")
        try:
            recording, metrics, wall = _run(experiment, config, job.seed)
        except Exception as error:
            for text in sorted({one_line(warning.message) for warning in caught}):
                error.add_note(f"{WARNED}{text}")
            raise
    factor = recording.simulated / wall if recording.simulated else None
    doubts = sorted({one_line(warning.message) for warning in caught})
    left = [*unread(config)] if job.watched else None
    entry = CaseEntry(recording.status, recording.steps, recording.simulated, wall, factor, doubts, left)
    with whole_folder(Path(job.folder)) as folder:
        save_recording(recording, folder / "series", job.case, experiment.rate)
        files = {path.name: [path.stat().st_size, _checksum(path)] for path in sorted((folder / "series").iterdir())}
        content = {"entry": asdict(entry), "metrics": metrics, "config": job.config, "files": files}
        write_json(folder / "case.json", content)
        sync(folder)
    return entry


def _run(experiment: Experiment, config: Config, seed: int) -> tuple[Recording, Metrics, float]:
    """As ``case.run``. Raises InputError with the reason why a run ended early where it then cannot be measured."""
    ends: list[str] = []
    try:
        return run_case(watched(experiment, ends), config, seed)
    except Exception as error:
        if ends in ([], [Recording.status]):
            raise
        raise InputError(f"{ends[0]}; what was recorded until then cannot be measured") from error


def complete(job: Job) -> CaseEntry:
    """Execute a case unless another process has finished it meanwhile."""
    folder = Path(job.folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    with claimed(folder.parent, folder.name):
        if (data := stored_case(job)) is not None:
            return CaseEntry(**data["entry"])
        return execute(job)


def stored_case(job: Job, thorough: bool = False) -> dict[str, Any] | None:
    """What the cache holds of a case; None where it lacks the case or a file of it is damaged.

    thorough: look at every byte of the series, not only at their sizes.
    """
    folder = Path(job.folder)
    try:
        data = read_json(folder / "case.json")
        CaseEntry(**data["entry"])
        for name, (size, checksum) in data["files"].items():
            path = folder / "series" / name
            if path.stat().st_size != size or (thorough and _checksum(path) != checksum):
                return None
        return data if isinstance(data["metrics"], dict) and isinstance(data["config"], dict) else None
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return None


def _checksum(path: Path) -> int:
    return zlib.crc32(path.read_bytes())


def assemble(plan: Plan) -> list[Job]:
    """Turn the cached cases of a plan into a result folder with metrics, claims, tables, figures and provenance.

    Returns the cases that the cache no longer has whole; then nothing has been assembled.
    """
    experiment = chapters.load(plan.chapter).experiment(plan.experiment)
    found = {job.case: stored_case(job, thorough=True) for job in plan.jobs}
    if lacking := [job for job in plan.jobs if found[job.case] is None]:
        return lacking
    cases: dict[str, dict[str, Any]] = {name: data for name, data in found.items() if data}
    nested: dict[str, Metrics] = {name: data["metrics"] for name, data in cases.items()}
    configs = {name: data["config"] for name, data in cases.items()}
    config = Config.of({**plan.block, "cases": configs})
    with whole_folder(plan.folder) as folder:
        (folder / "series").mkdir()
        for job in plan.jobs:
            for name in cases[job.case]["files"]:
                copy(Path(job.folder, "series", name), folder / "series" / name)
        write_yaml(folder / "config.yaml", config)
        write_json(folder / "metrics.json", flat(experiment.name, nested))
        entries = {name: CaseEntry(**data["entry"]) for name, data in cases.items()}
        series = sorted(path.name for path in (folder / "series").iterdir())
        write_json(folder / "run.json", asdict(_run_entry(plan, entries, series)))
        present(plan.chapter, experiment, folder)
        _keep_animations(plan.folder, folder)
        _keep_own(plan.folder, folder)
        sync(folder)
    _prune(plan)
    return []


def _keep_animations(old: Path, new: Path) -> None:
    """Take over what was rendered from recordings that are still the same (cached files keep their time)."""
    for path in sorted(old.glob("animation/*")):
        recording = new / "series" / f"{path.stem}.csv.gz"
        if recording.exists() and recording.stat().st_mtime <= path.stat().st_mtime:
            (new / "animation").mkdir(exist_ok=True)
            copy(path, new / "animation" / path.name)


def _keep_own(old: Path, new: Path) -> None:
    """Take over what somebody has put beside the files of a result, such as notes."""
    for path in old.glob("*"):
        if path.is_dir() and path.name not in ("animation", *os.listdir(new)):
            shutil.copytree(path, new / path.name, symlinks=True, copy_function=copy)
        elif path.is_file() and not (new / path.name).exists():
            copy(path, new / path.name)


def _run_entry(plan: Plan, entries: dict[str, CaseEntry], series: list[str]) -> RunEntry:
    simulated = sum(entry.simulated for entry in entries.values())
    wall = sum(entry.wall for entry in entries.values())
    return RunEntry(
        chapter=plan.chapter,
        experiment=plan.experiment,
        version=__version__,
        revision=revision(),
        seed=plan.seed,
        contents=plan.contents,
        presentation=plan.presentation,
        differs=plan.differs,
        series=series,
        packages={**plan.versions, **{name: version(name) for name in PACKAGES}},
        machine=f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        python=platform.python_version(),
        wall=wall,
        steps=sum(entry.steps for entry in entries.values()),
        simulated=simulated,
        real_time_factor=simulated / wall if simulated and wall else None,
        cases=entries,
    )


@cache
def revision() -> str | None:
    """Git revision of the checkout this code runs from, with "+" where files have been changed."""
    git = ["git", "-C", str(Path(__file__).parent)]
    with contextlib.suppress(OSError, subprocess.CalledProcessError):
        head = subprocess.run([*git, "rev-parse", "--short=12", "HEAD"], capture_output=True, text=True, check=True)
        dirty = subprocess.run([*git, "status", "--porcelain", "--untracked-files=no"], capture_output=True, text=True)
        return head.stdout.strip() + ("+" if dirty.stdout.strip() else "")
    return None


def _prune(plan: Plan) -> None:
    for job in plan.jobs:
        parent = Path(job.folder).parent
        with locked(parent):
            entries = sorted(parent.glob(f"{job.case}-" + "?" * 16), key=lambda p: p.stat().st_mtime, reverse=True)
            for old in entries[KEPT:]:
                if str(old) != job.folder and old.stat().st_mtime < time.time() - RECENT:
                    shutil.rmtree(old, ignore_errors=True)


# ------------------------------------------------------------------------------------------------------- scheduling


def run_plans(plans: Sequence[Plan], *, workers: int | None, force: bool, progress: Silent | None = None) -> Outcome:
    """Run what is missing, assemble each experiment as its last case ends; a failing case does not stop the others."""
    parents = {folder.parent for plan in plans for folder in (Path(plan.jobs[0].folder), plan.folder)}
    for parent in parents:
        remove_leftovers(parent)
    run = _Run(plans, force, progress or Silent())
    if run.waiting or run.again:
        try:
            run.work(workers)
        finally:
            for parent in parents:  # of workers that were ended
                remove_leftovers(parent)
    run.outcome.unusable = _unusable(plans, run.outcome.folders)
    return run.outcome


class _Run:
    """Plans on their way to results.

    todo: cases to run; waiting: those of each experiment without which it cannot be assembled; again: plans whose
    result is only to be presented again; repeated: experiments of which the cache had lost a case on the way.
    """

    def __init__(self, plans: Sequence[Plan], force: bool, progress: Silent) -> None:
        self.plans, self.force, self.progress = {plan.experiment: plan for plan in plans}, force, progress
        self.outcome = Outcome(
            differs={plan.experiment: plan.differs for plan in plans if plan.chapter != chapters.OWN}
        )
        self.todo: list[Job] = []
        self.waiting: dict[str, set[str]] = {}
        self.again: list[Plan] = []
        self.repeated: set[str] = set()
        for plan in plans:
            self._sort_in(plan)
        # An experiment of few cases has long ones: they begin, and the short ones of others fill the gaps at the end.
        self.todo.sort(key=lambda job: len(self.plans[job.experiment].jobs))

    def _sort_in(self, plan: Plan) -> None:
        """Take a result as it is, have it presented again, or run what the cache lacks of it."""
        if not self.force and up_to_date(plan):
            log.info("%s: up to date in %s", plan.experiment, plan.folder)
            self.outcome.folders[plan.experiment] = plan.folder
            return
        missing = [job for job in plan.jobs if self.force or stored_case(job) is None]
        if missing and not self.force and up_to_date(plan, presented=False):  # it has what the cache has lost
            self.again.append(plan)
            return
        why = "force=true" if self.force else _why_again(plan)
        cached, all_ = len(plan.jobs) - len(missing), len(plan.jobs)
        log.info("%s: %s; %d of %d cases are cached", plan.experiment, why, cached, all_)
        for job in missing:
            log.info("%s: %s", job.name, _why_run(job))
            if Path(job.folder).exists() and not self.force:
                self._note_damage(job)
        self.waiting[plan.experiment] = {job.case for job in missing}
        self.todo += missing

    def _note_damage(self, job: Job) -> None:
        self.progress.note(f"{job.name} is damaged in {Path(job.folder).parent}: run again")

    def work(self, workers: int | None) -> None:
        """Do all of it in one pool."""
        _load_engines(self.todo)
        here = any(job.gui or (start_method() != "fork" and "__main__." in str(job.config)) for job in self.todo)
        with Pool(workers, self.progress.report, here, self.progress.tick) as pool:
            for job in self.todo:
                pool.add(job, execute if self.force else complete, job, timeout=job.timeout)
            for plan in (self.plans[name] for name, cases in self.waiting.items() if not cases):
                pool.add(plan, assemble, plan)
            for plan in self.again:
                pool.add(plan, redraw, plan.chapter, plan.experiment, plan.folder)
            self.progress.begin([job.name for job in self.todo], pool.size)
            for task, value in pool.results():
                if isinstance(value, Failure):
                    self._failed(task, value)
                elif isinstance(task, Job):
                    self._finished(task, value, pool)
                else:
                    self._assembled(task, value, pool)

    def _failed(self, task: Job | Plan, failure: Failure) -> None:
        name = task.name if isinstance(task, Job) else task.experiment
        self.outcome.failures[name], kept = _kept_failure(task, failure)
        if not failure.told and kept.exists():
            self.outcome.tracebacks[name] = kept
        if isinstance(task, Job):
            self.progress.failed(name, self.outcome.failures[name])

    def _finished(self, job: Job, entry: CaseEntry, pool: Pool) -> None:
        """Assemble the experiment whose last case this was."""
        self.progress.finished(job.name, entry)
        self.waiting[job.experiment].discard(job.case)
        if not self.waiting[job.experiment]:
            plan = self.plans[job.experiment]
            pool.add(plan, assemble, plan, first=True)

    def _assembled(self, plan: Plan, lost: Sequence[Job] | None, pool: Pool) -> None:
        """Done, unless the cache has lost cases meanwhile (of which the sizes were right, the bytes are not)."""
        if not lost:
            self.outcome.folders[plan.experiment] = plan.folder
            self.outcome.assembled.append(plan.experiment)
            self.progress.assembled(plan.experiment)
        elif plan.experiment in self.repeated:
            self.outcome.failures[plan.experiment] = f"{Path(lost[0].folder).parent} does not keep what is written"
        else:
            self.repeated.add(plan.experiment)
            self.waiting[plan.experiment] = {job.case for job in lost}
            for job in lost:
                self._note_damage(job)
                pool.add(job, execute, job, timeout=job.timeout, first=True)


def _load_engines(jobs: Sequence[Job]) -> None:
    """Import what simulates arms once, before the processes fork."""
    import dexrepro.physics.world  # noqa: F401
    from dexrepro.physics import engine

    for word in filter(engine.is_installed, {job.config.get("engine", engine.REFERENCE) for job in jobs}):
        engine.use(word)
        engine.engine()


def _unusable(plans: Sequence[Plan], folders: Mapping[str, Path]) -> dict[str, str]:
    """Cases that a law gave no number to, where the law is the user's: under one of the book's that is a result."""
    found = {}
    for plan in plans:
        own = [job for job in plan.jobs if any(not text.startswith("dexrepro.") for text in targets(job.config))]
        entries = read_json(plan.folder / "run.json")["cases"] if own and plan.experiment in folders else {}
        for job in own:
            if (status := entries.get(job.case, {}).get("status", "")).startswith(NO_NUMBER):
                found[job.name] = status
    return found


def _why_again(plan: Plan) -> str:
    """Why a result is not taken as it is."""
    try:
        return outdated(plan, read_json(plan.folder / "run.json")) or "its result is not whole or of other packages"
    except (OSError, ValueError, AttributeError):
        return f"there is no whole result in {plan.folder}"


def _why_run(job: Job) -> str:
    """Why the cache does not have a case: in what it differs from the one of its name that was run last."""
    earlier = sorted(Path(job.folder).parent.glob(f"{job.case}-*/case.json"), key=lambda path: path.stat().st_mtime)
    if not earlier:
        return f"runs, it is not in {Path(job.folder).parent}"
    try:
        changed = differences(job.config, read_json(earlier[-1])["config"])
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        changed = []
    named = ", ".join(changed[:SHOWN]).replace("(book: ", "(was: ")
    return f"runs again: {named or 'code or a file that it uses, or the version of a package changed'}"


def up_to_date(plan: Plan, presented: bool = True) -> bool:
    """Whether the result of a plan is there, whole, and made of the present values, code and packages.

    presented: ask that its claims, tables and figures are of the present code too.
    """
    try:
        run = read_json(plan.folder / "run.json")
        same = run["contents"] == plan.contents and not (presented and run["presentation"] != plan.presentation)
        same = same and run["version"] == __version__ and run["differs"] == plan.differs
        same = same and all(run["packages"][name] == number for name, number in plan.versions.items())
        kinds = (("metrics.json", dict), ("claims.json", list))
        whole = all(isinstance(read_json(plan.folder / name), kind) for name, kind in kinds)
        whole = whole and (plan.folder / "config.yaml").stat().st_size > 0
        return same and whole and all((plan.folder / "series" / name).exists() for name in run["series"])
    except (OSError, ValueError, KeyError, TypeError):
        return False


def _kept_failure(task: Job | Plan, failure: Failure) -> tuple[str, Path]:
    """Keep why a task failed beside the cached cases; the sentence, with whether it did so before, and the file."""
    job = task if isinstance(task, Job) else task.jobs[0]
    path = Path(job.folder).parent / f"{task.case if isinstance(task, Job) else 'assemble'}.error.txt"
    text, before = failure.sentence, ""
    with contextlib.suppress(OSError, UnicodeError):
        before = path.read_text(encoding="utf-8")
    if failure.exit is not None and before.startswith(job.content):
        text = f"{text.removesuffix(f'; {COMPLETES}')}, as it did before"
    with contextlib.suppress(OSError):
        write_text(path, f"{job.content if failure.exit is not None else ''}\n{text}\n{failure.traceback}")
    return text, path
