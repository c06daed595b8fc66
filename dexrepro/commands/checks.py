"""Whether it still holds: stored numbers, another engine, other choices of what the book leaves open."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dexrepro.commands import FAILED, OK, SHOWN, WRONG, command, option, out, say, warn
from dexrepro.commands.run import WITHOUT_PYBULLET, launch
from dexrepro.errors import COMPLETES, InputError, nearest, refused, whole_number
from dexrepro.keys import SELECTION

if TYPE_CHECKING:
    from dexrepro.baselines import ChapterReport
    from dexrepro.study.samples import Cases


@command(
    "compare results with the stored baselines, simulate nothing", (*SELECTION, "claim", "case", "workers"),
    option("--json", help="for programs, see docs/schemas"),
    option("--update", help="run, perturb, and store new baselines"),
    option("--accept", nargs="+", default=[], metavar="ID", help="claims whose verdict may change"),
)  # fmt: skip
def check_command(options: argparse.Namespace) -> int:
    """Exit status 0: same; 1: drift; 2: results missing."""
    from dexrepro import baselines
    from dexrepro.physics.engine import REFERENCE, is_installed
    from dexrepro.selection import existing, needs_of, quoted, selected

    accepted = [word for word in options.accept if "=" not in word]  # what selects may stand behind them
    words = [*options.selection, *(word for word in options.accept if "=" in word)]
    numbers, only, results, workers, extra = selected(needs_of(words), "check")
    case = quoted(f"case={extra['case']}") if "case" in extra else None
    _check_accepted(accepted, numbers, options.update)
    if options.update:
        if options.json:
            raise InputError("--json has no meaning with --update")
        if case:
            raise InputError(f"{case} is not allowed with --update: what is stored is of all cases")
        for number in numbers:
            for line in baselines.update_chapter(number, results, only, accept=accepted, workers=workers):
                say(line)
        return OK
    try:
        if case:
            reports = [baselines.check_cases(number, existing(results), only, case) for number in numbers]
        else:
            reports = [baselines.check_chapter(number, existing(results), only) for number in numbers]
    except baselines.ResultsMissing as missing:
        warn(missing)
        return WRONG
    ok = all(report.ok for report in reports)
    if options.json:
        print(json.dumps({"ok": ok, "chapters": list(map(asdict, reports))}, indent=1))
    else:
        for report in reports:
            _print_check(report)
    if not (ok or is_installed(REFERENCE)):
        warn(WITHOUT_PYBULLET)
    return OK if ok else FAILED


def _check_accepted(accepted: Sequence[str], numbers: Sequence[str], update: bool) -> None:
    """Refuse claims that there are not, and any where nothing is stored."""
    from dexrepro import chapters

    if accepted and not update:
        raise InputError(f"--accept {' '.join(accepted)} has no meaning without --update")
    known = [claim.id for number in numbers for claim in chapters.load(number).claims] if accepted else []
    for name in accepted:
        if name not in known:
            raise InputError(
                f"--accept {name} is not allowed: these chapters have no such claim; {nearest(name, known)}"
            )


def _print_check(report: ChapterReport) -> None:
    changed = [claim for claim in report.claims if claim.id in report.verdict_changed]
    out.print(
        f"chapter {report.chapter}: {report.compared} metrics compared, {len(report.drifted)} drifted, "
        f"{len(report.missing)} missing, {len(report.new)} new, {len(report.skipped)} skipped; {len(report.claims)} "
        f"claims, {len(changed)} verdicts changed; {report.tables} tables, {len(report.tables_changed)} differences"
    )
    lines = []
    for entry in report.drifted:
        tolerance = entry.atol + entry.rtol * abs(entry.baseline or 0)
        lines.append(f"{entry.name} = {entry.value}, stored {entry.baseline} +- {tolerance:.3g}")
    for kind, names in {"missing": report.missing, "new": report.new}.items():
        more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
        lines += [f"{kind}: {', '.join(names[:SHOWN])}{more}"] if names else []
    lines += [f"{claim.id}: {claim.verdict or 'missing'}, stored: {claim.expected or 'none'}" for claim in changed]
    lines += report.tables_changed[:SHOWN]
    lines += [f"{name} has a baseline, and no such experiment exists" for name in report.unknown]
    lines += [f"out of date: {text}" for text in report.outdated]
    for line in lines:
        say(f"  {line}")


@command(
    "run the book under MuJoCo, too, and compare", (*SELECTION, "workers"),
    option("--update", help="renew the table that is shipped"),
)  # fmt: skip
def crosscheck_command(options: argparse.Namespace) -> int:
    """Run what simulates arms under the other engine; say which numbers and verdicts differ."""
    from dexrepro import crosscheck
    from dexrepro.selection import selected

    numbers, only, results, workers, _ = selected(options.selection, "crosscheck")
    _refuse_own(numbers, options.update)
    target, compared = crosscheck.table(results, options.update), 0
    for number in numbers:
        for item in crosscheck.run(number, only, results, workers):
            crosscheck.keep([item], target)
            compared += 1
            known = [entry for entry in item.metrics if entry.spread]
            turned = [f"{key} {' under PyBullet, '.join(item.claims[key])} under MuJoCo" for key in item.turned]
            say(
                f"{item.experiment}: {item.compared} numbers, {len(item.metrics)} outside their tolerance, "
                f"{sum(entry.matters for entry in known)} of the {len(known)} that a study has outside its range, too; "
                f"{len(item.claims)} claims, {len(turned)} turn" + "".join(f"\n  {text}" for text in turned)
            )
    if not compared:
        raise InputError("none of these experiments simulates arms, so that no engine makes a difference")
    say(target)
    return OK


@command(
    "how often claims hold when the unprinted varies",
    (*SELECTION, "case", "claim", "samples", "hours", "engine", "jobs", "workers"),
    option("--update", help="renew the study that is shipped"),
    option("--confirm", help="carry samples over a change of code: two run again"),
)  # fmt: skip
def study_command(options: argparse.Namespace) -> int:
    """``dexrepro study chapter=N [claim=ID] [only=EXPERIMENT] [samples=N] [hours=H] [jobs=N hydra/launcher=...]``."""
    if any(text.startswith(("jobs=", "hydra")) for text in options.selection):
        return _study_jobs(options)
    return _study(options.selection, options.update, options.confirm)


def _study(words: Sequence[str], update: bool = False, confirm: bool = False, shown: bool = True) -> int:
    from dexrepro.config import check_engine
    from dexrepro.physics.engine import default
    from dexrepro.selection import selected
    from dexrepro.study import sampling
    from dexrepro.study.confirm import confirm as carry

    numbers, only, results, workers, values = selected(words, "study")
    _refuse_own(numbers, update)
    samples, hours = _samples(values.get("samples")), _hours(values.get("hours"))
    check_engine(engine := values.get("engine", default()))
    for number in numbers:
        for name in sampling.experiments_of(number, only, values.get("claim")):
            if confirm:
                carried, other = carry(number, name, results, update)
                differ = f"; other numbers than before: {', '.join(other)}" if other else ""
                say(f"{name}: {carried} cases of samples carried over{differ}")
                continue
            try:
                cases = _cases(number, name, values)
                if cases and update:
                    raise InputError(f"case = {values['case']} is not allowed with --update: what is shipped is whole")
                path = sampling.run(number, name, samples, results, workers=workers, hours=hours, update=update,
                                    engine=engine, only=cases)  # fmt: skip
            except sampling.SamplesFailed as error:
                warn(error)
                return FAILED
            if shown:
                _print_study(name, path, results)
            there = len(sampling.kept_samples(number, name, results, only=cases))
            if there < (held := sampling.held(path)):
                warn(f"{path} holds {held} samples, {there} of them of today's values and code: it stays as it was; to "
                     "renew it with fewer, remove it first")  # fmt: skip
    return OK


def _cases(number: str, name: str, values: Mapping[str, str]) -> Cases:
    from dexrepro.study.sampling import cases_of

    return cases_of(number, name, values["case"].strip("[]")) if "case" in values else ()


def _refuse_own(numbers: Sequence[str], update: bool) -> None:
    """Refuse to put among what is shipped what is about chapters of the user's."""
    from dexrepro import chapters

    if update and (own := [number for number in numbers if number != chapters.OWN and chapters.is_added(number)]):
        raise InputError(f"--update renews what is shipped, and chapter {own[0]} is yours: leave --update out")


def _samples(text: str | None) -> int | None:
    return None if text is None else whole_number("samples", text, 1, 1024)


def _hours(text: str | None) -> float | None:
    with suppress(ValueError):
        if text is None or (math.isfinite(float(text)) and float(text) > 0):
            return float(text) if text else None
    raise refused("hours", text, "be a number greater than 0")


def _study_jobs(options: argparse.Namespace) -> int:
    """A study by jobs of a Hydra launcher, which share its samples."""
    from dexrepro.selection import selected
    from dexrepro.study.samples import summary_file
    from dexrepro.study.sampling import experiments_of

    values = dict(text.partition("=")[::2] for text in options.selection)
    jobs = whole_number("jobs", values.pop("jobs", ""), 1, 1024)
    launcher = [f"{key}={value}" for key, value in values.items() if key.startswith("hydra")]
    words = [f"{key}={value}" for key, value in values.items() if not key.startswith("hydra")]
    numbers, only, folder, _, _ = selected(words, "study")
    _refuse_own(numbers, options.update)
    _samples(values.get("samples")), _hours(values.get("hours"))
    made = [
        (name, summary_file(name, folder, only=_cases(number, name, values)))
        for number in numbers
        for name in experiments_of(number, only, values.get("claim"))
    ]
    selection = ",".join(json.dumps(text) for text in words)
    results = [text for text in words if text.startswith("results=")]
    status = launch(["-m", f"+job=range({jobs})", f"+selection=[{selection}]", *results, *launcher], _study_job)
    if options.update and status == OK:
        return _study(words, update=True)
    for name, path in made:
        if path.exists():
            _print_study(name, path, folder)
    return status


def _study_job(config: Any) -> None:
    from dexrepro.sweep import JobFailed, enter_launch_folder

    enter_launch_folder()
    if _study(["workers=1", *config.selection], shown=False) != OK:
        raise JobFailed(f"a process was killed; {COMPLETES}")


def _print_study(name: str, path: Path, results: Path) -> None:
    from dexrepro.report import studies
    from dexrepro.storage import read_json

    summary = read_json(path)
    drawing = studies.save(summary, results / "studies" / f"{path.stem}.svg")
    say(f"{name}: {path}, drawn in {drawing}")
    for claim, row in summary["claims"].items():
        interval = f"{100 * row['low']:.0f} to {100 * row['high']:.0f} %"
        most = f", follows {row['parameter']} most" if row["parameter"] else ""
        say(f"  {claim}: holds in {row['holds']} of {row['samples']} ({interval}), {row['word']}{most}")
