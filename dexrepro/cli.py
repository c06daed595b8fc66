"""The command line: dexrepro run, list, check, draw, report, render, study, new, diff, completion; each is thin."""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import nullcontext, suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table

from dexrepro import __version__
from dexrepro.errors import InputError

if TYPE_CHECKING:
    from dexrepro.baselines import ChapterReport

HYDRA_FLAGS = ("-m", "--multirun", "--cfg", "-c", "--help", "-h", "--info", "-i", "--hydra-help", "--resolve")
SHOWN = 6  # names in one line of the check
CASES = ("case", "cases")
STUDY = ("claim", "samples", "hours")  # what only a study knows
OK, FAILED, WRONG, INTERRUPTED = 0, 1, 2, 130

for name in ("stdout", "stderr"):  # closed, or of an alphabet that lacks a sign: no reason to fail
    stream: Any = getattr(sys, name) or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  as long as we run
    setattr(sys, name, stream)
    if hasattr(stream, "reconfigure"):
        stream.reconfigure(errors="backslashreplace")
out = Console(highlight=False, soft_wrap=True, width=None if sys.stdout.isatty() else 160)
err = Console(stderr=True, highlight=False, soft_wrap=True)


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; returns the exit status."""
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    sys.path.append("")  # a user's own classes, named by _target_: behind all that is installed
    try:
        return _dispatch(_experiments_option(arguments))
    except KeyboardInterrupt:
        err.print("interrupted; the same command completes what is missing", markup=False)
        return INTERRUPTED
    except Exception as error:
        if isinstance(error, BrokenPipeError):  # who reads the output has seen enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return FAILED
        if isinstance(error, OSError):  # a full or write-protected disk, an unreadable file
            error = InputError(f"{error.filename or 'cannot read or write a file'}: {error.strerror or error}")
        if not isinstance(error, InputError):
            raise
        err.print(f"dexrepro: {error}", markup=False)
        return WRONG


def _dispatch(arguments: list[str]) -> int:
    if arguments[:1] == ["run"]:
        return run_command(arguments[1:])
    parser = _parser()
    if "_ARGCOMPLETE" in os.environ:
        from dexrepro.completion import complete

        complete(parser)
    options, words = parser.parse_known_args(arguments)
    if words and not (hasattr(options, "selection") and all(re.match(r"[\w.]+=", word) for word in words)):
        parser.error(f"unrecognized arguments: {' '.join(words)}")
    if words:  # key=value behind an option
        options.selection += words
    return int(options.function(options))


def _experiments_option(arguments: list[str]) -> list[str]:
    """Add the folders that ``--experiments DIR`` names, before or behind any command; the other arguments."""
    from dexrepro import chapters

    parser = argparse.ArgumentParser(prog="dexrepro", add_help=False, allow_abbrev=False)
    parser.add_argument("--experiments", action="append", default=[], type=Path, metavar="DIR")
    options, rest = parser.parse_known_args(arguments)
    for folder in options.experiments:
        if not folder.is_dir():
            raise InputError(f"--experiments = {folder} is not allowed: there is no such folder")
        known = chapters.numbers()
        chapters.add(folder)
        if chapters.numbers() == known and not chapters.is_added(known[0]):
            raise InputError(
                f"--experiments = {folder} adds nothing: an experiment is a folder in it with experiment.py"
            )
    return rest


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="dexrepro", description="Reproduce the book's figures and check its claims.")
    parser.add_argument("--version", action="version", version=f"dexrepro {__version__}")
    parser.add_argument("--experiments", metavar="DIR", help="experiments of your own, beside the book's")
    commands = parser.add_subparsers(required=True, metavar="command", dest="command")
    selection = argparse.ArgumentParser(add_help=False)
    words = selection.add_argument(
        "selection", nargs="*", metavar="key=value", help="chapter=N, only=EXPERIMENT, results=DIR"
    )
    words.completer = _completions  # type: ignore[attr-defined]
    commands.add_parser("run", parents=[selection], help="simulate, measure and draw (see: dexrepro run --help)")

    listing = commands.add_parser("list", help="chapters, experiments, cases, figures, claims, errata")
    listing.add_argument("--json", action="store_true")
    listing.add_argument("--markdown", action="store_true", help="the claims of the book counted by verdict")
    listing.set_defaults(function=list_command)

    check = commands.add_parser("check", parents=[selection], help="compare results with the stored baselines")
    check.add_argument("--json", action="store_true")
    check.add_argument("--update", action="store_true", help="run, perturb, and store new baselines")
    check.add_argument("--accept", nargs="+", default=[], metavar="ID", help="claims whose verdict may change")
    check.set_defaults(function=check_command)

    draw = commands.add_parser("draw", parents=[selection], help="draw again from files, nothing simulated")
    draw.set_defaults(function=draw_command)

    report = commands.add_parser("report", parents=[selection], help="build the HTML page from files")
    report.set_defaults(function=report_command)

    study = commands.add_parser("study", parents=[selection], help="how often claims hold when the unprinted varies")
    study.add_argument("--update", action="store_true", help="renew the study that is shipped")
    study.add_argument("--confirm", action="store_true", help="carry samples over a change of code: two run again")
    study.set_defaults(function=study_command)

    render = commands.add_parser("render", parents=[selection], help="animate recorded runs (case=NAME format=gif|mp4)")
    render.set_defaults(function=render_command)

    new = commands.add_parser("new", help="write a working control law of your own, with its test")
    new.add_argument("what", choices=["controller"])
    new.add_argument("--kind", choices=["joint", "end_point", "holding"], default="holding")
    new.add_argument("name", help="class name, for example MyLaw")
    new.set_defaults(function=new_command)

    diff = commands.add_parser("diff", help="compare two results: configuration, metrics, verdicts, series")
    diff.add_argument("a", type=Path)
    diff.add_argument("b", type=Path)
    diff.set_defaults(function=diff_command)

    completion = commands.add_parser("completion", help='for Tab: eval "$(dexrepro completion bash)"')
    completion.add_argument("shell", choices=("bash", "zsh", "fish"))
    completion.set_defaults(function=completion_command)
    return parser


def _completions(**context: Any) -> list[str]:
    from dexrepro.completion import words

    return list(words(**context))


# -------------------------------------------------------------------------------------------------------------- run


def run_command(arguments: list[str]) -> int:
    """``dexrepro run``: Hydra's own modes go to Hydra, everything else is planned and run here."""
    from dexrepro.selection import for_hydra, quoted

    arguments = [quoted(argument) for argument in arguments]
    extra_dir, overrides = _config_dir_option(arguments)
    if any(argument.split("=")[0] in HYDRA_FLAGS for argument in arguments):
        given = [text for text in overrides if not text.startswith("-") and "=" in text]
        if arguments[-2:] in (["--cfg", "job"], ["-c", "job"]) and not {"-m", "--multirun"} & set(arguments):
            return _print_config(given, extra_dir)
        return _launch(for_hydra(arguments, given, extra_dir), _run_job)
    return run_overrides(overrides, extra_dir)


def _print_config(overrides: Sequence[str], extra_dir: str | None) -> int:
    """Every parameter of the chapters selected, as the experiments see them."""
    import yaml

    from dexrepro.config import compose_chapter
    from dexrepro.selection import chapters_of, of_chapter

    numbers, rest = chapters_of(overrides, extra_dir)
    for number in numbers:
        composed = compose_chapter(number, of_chapter(number, numbers, rest), extra_dir)
        print(yaml.safe_dump({key: value for key, value in composed.items() if key != "hydra"}, sort_keys=False))
    return OK


def _config_dir_option(arguments: list[str]) -> tuple[str | None, list[str]]:
    rest, extra_dir = list(arguments), None
    for index, argument in enumerate(arguments):
        if argument in ("--config-dir", "-cd"):
            if index + 1 == len(arguments):
                raise InputError("--config-dir needs a folder")
            extra_dir = os.path.expanduser(arguments[index + 1])
            del rest[index : index + 2]
        elif argument.startswith("--config-dir="):
            extra_dir = os.path.expanduser(argument.partition("=")[2])
            rest.remove(argument)
    if extra_dir is not None:
        _make_importable(extra_dir)
    return extra_dir, rest


def _make_importable(folder: str) -> None:
    """Let ``_target_`` name classes of files in the user's folder, here and in the processes started from here."""
    if not Path(folder).is_dir():
        raise InputError(f"--config-dir = {folder} is not allowed: there is no such folder")
    if (path := str(Path(folder).resolve())) not in sys.path:
        sys.path.append(path)


def run_overrides(overrides: Sequence[str], extra_dir: str | None = None) -> int:
    """Plan, run and summarise what a list of overrides selects; say on stderr what failed."""
    failures = _sentences(_run(overrides, extra_dir))
    for sentence in failures:
        err.print(sentence, markup=False)
    return FAILED if failures else OK


def _sentences(outcome: Any) -> list[str]:
    return [
        f"{names[0]}{f' and {len(names) - 1} more' if len(names) > 1 else ''} failed: {reason}"
        for reason, names in outcome.reasons().items()
    ]


def _run(overrides: Sequence[str], extra_dir: str | None) -> Any:
    from dexrepro.config import compose_chapter
    from dexrepro.plan import plan_chapter
    from dexrepro.progress import Bar, Lines, Silent
    from dexrepro.runner import Outcome, run_plans, summary_rows
    from dexrepro.selection import chapters_of, of_chapter, positive_workers

    numbers, rest = chapters_of(overrides, extra_dir)
    plans: list[Any] = []
    skipped: dict[str, str] = {}
    settings: dict[str, Any] = {}
    for number in numbers:
        own = of_chapter(number, numbers, rest)
        settings = compose_chapter(number, own, extra_dir)
        chapter_plans, chapter_skipped = plan_chapter(number, own, composed=settings)
        plans += chapter_plans
        skipped |= chapter_skipped
    quiet = bool(settings.get("quiet"))
    progress = Silent() if quiet else Bar(out) if out.is_terminal else Lines(out)
    with progress if isinstance(progress, Bar) else nullcontext():
        outcome: Outcome = run_plans(
            plans,
            workers=positive_workers(settings.get("workers")),
            force=bool(settings.get("force")),
            progress=progress,
        )
    outcome.skipped = skipped
    if not quiet:
        _print_summary(outcome)
    for text in dict.fromkeys(text for row in summary_rows(outcome) for text in row["warnings"]):
        err.print(f"warning: {text}", markup=False)
    return outcome


def _launch(arguments: Sequence[str], job: Callable[[Any], None]) -> int:
    from dexrepro.sweep import JobFailed, launch

    try:
        launch(arguments, job)
    except JobFailed as error:
        err.print(f"a job of the sweep failed: {error}", markup=False)
        return FAILED
    return OK


def _run_job(config: Any) -> None:
    """One job of a sweep: the same as a plain run with its overrides."""
    from dexrepro.sweep import JobFailed, enter_launch_folder, job_overrides

    enter_launch_folder()
    overrides, extra_dir = job_overrides()
    if extra_dir is not None:
        _make_importable(extra_dir)
    if failures := _sentences(_run(overrides, extra_dir)):
        raise JobFailed("; ".join(failures))


def _print_summary(outcome: Any) -> None:
    from dexrepro.claims import NOT_EVALUATED, VERDICTS
    from dexrepro.runner import summary_rows

    table = Table(box=None, header_style="bold", pad_edge=False)
    rows = summary_rows(outcome)
    shown = [verdict for verdict in VERDICTS if any(row["claims"].get(verdict) for row in rows)]
    for column in ("experiment", "wall [s]", "x real time", *shown, "result"):
        table.add_column(column, justify="left" if column in ("experiment", "result") else "right", no_wrap=True)
    evaluated = True
    for row in rows:
        factor = f"{row['real_time_factor']:.1f}" if row["real_time_factor"] else ""
        verdicts = row["claims"]
        evaluated = evaluated and not verdicts.get(NOT_EVALUATED)
        counts = [str(verdicts.get(key, 0) or "") for key in shown]
        table.add_row(row["experiment"], f"{row['wall']:.1f}", factor, *counts, row["folder"])
    out.print(table)
    for name, reason in outcome.skipped.items():
        out.print(f"{name} skipped: {reason}", markup=False)
    for name, differs in outcome.differs.items():
        if differs and name in outcome.folders:
            named = ", ".join(differs[:8]) + (f" and {len(differs) - 8} more" if len(differs) > 8 else "")
            out.print(f"{name} differs from the book in: {named}", markup=False)
    if not evaluated:
        out.print("claims whose metrics this run does not have are not evaluated")


# --------------------------------------------------------------------------------------------------- other commands


def list_command(options: argparse.Namespace) -> int:
    """Everything there is, as text or JSON; or the claims of the book counted, as the README's table."""
    from dexrepro import scoreboard
    from dexrepro.report.listing import listing

    if options.markdown:
        print(scoreboard.markdown())
        return OK

    data = listing()
    if options.json:
        print(json.dumps(data, indent=1))
        return OK
    for chapter in data["chapters"]:
        out.print(f"[bold]Chapter {chapter['chapter']}: {chapter['title']}[/bold]")
        for experiment in chapter["experiments"]:
            made = ", ".join([*experiment["figures"], *experiment["tables"]])
            out.print(f"  {experiment['name']}: {made}", markup=False)
            out.print(f"    cases: {', '.join(experiment['cases'])}", markup=False)
        out.print(f"  {len(chapter['claims'])} claims, {len(chapter['errata'])} errata")
    return OK


def check_command(options: argparse.Namespace) -> int:
    """Exit status 0: same; 1: drift; 2: results missing."""
    from dexrepro import baselines
    from dexrepro.selection import existing, quoted, selected

    numbers, only, results, workers, extra = selected(options.selection, CASES)
    case = next((quoted(f"case={value}") for value in extra.values()), None)
    if options.update:
        for number in numbers:
            for line in baselines.update_chapter(number, results, only, accept=options.accept, workers=workers):
                out.print(line, markup=False)
        return OK
    try:
        if case:
            reports = [baselines.check_cases(number, existing(results), only, case) for number in numbers]
        else:
            reports = [baselines.check_chapter(number, existing(results), only) for number in numbers]
    except baselines.ResultsMissing as missing:
        err.print(str(missing), markup=False)
        return WRONG
    ok = all(report.ok for report in reports)
    if options.json:
        print(json.dumps({"ok": ok, "chapters": list(map(asdict, reports))}, indent=1))
    else:
        for report in reports:
            _print_check(report)
    return OK if ok else FAILED


def _print_check(report: ChapterReport) -> None:
    changed = [claim for claim in report.claims if claim.id in report.verdict_changed]
    out.print(
        f"chapter {report.chapter}: {report.compared} metrics compared, {len(report.drifted)} drifted, "
        f"{len(report.missing)} missing, {len(report.new)} new, {len(report.skipped)} skipped; "
        f"{len(report.claims)} claims, {len(changed)} verdicts changed; "
        f"{report.tables} tables, {len(report.tables_changed)} differences"
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
        out.print(f"  {line}", markup=False)


def draw_command(options: argparse.Namespace) -> int:
    """Draw figures and tables again from what is on disk."""
    from dexrepro.plan import plan_chapter, select
    from dexrepro.pool import sentence
    from dexrepro.report.damage import check_result
    from dexrepro.runner import redraw
    from dexrepro.selection import existing, quoted, selected

    numbers, only, results, _, extra = selected(options.selection, CASES)
    found = [(n, e, existing(results) / f"chapter{n}" / e.name) for n in numbers for e in select(n, only or None, None)]
    if extra:
        words = [quoted(f"results={results}"), *(quoted(f"case={value}") for value in extra.values())]
        words += [f"only=[{','.join(only)}]"] if only else []
        plans = [plan for number in numbers for plan in plan_chapter(number, words, write=False)[0]]
        folders = {plan.experiment: plan.folder for plan in plans}
        found = [(n, e, folders[e.name]) for n, e, _ in found if e.name in folders]
    found = [item for item in found if (item[2] / "run.json").exists()]
    if not found:
        raise InputError(f"there is no such result in {results}; run first: dexrepro run {' '.join(options.selection)}")
    for _, _, folder in found:
        check_result(folder, "metrics.json", "config.yaml", series=True)
    status = OK
    for number, experiment, folder in found:
        try:
            redraw(number, experiment.name, folder)
        except Exception as error:  # a result of another version, say; the others can still be drawn
            err.print(f"{folder} cannot be drawn, run it again: {sentence(error)}", markup=False)
            status = FAILED
        else:
            out.print(str(folder), markup=False)
    return status


def report_command(options: argparse.Namespace) -> int:
    """Build results/report/index.html."""
    from dexrepro.report import page
    from dexrepro.selection import existing, selected

    out.print(str(page.build(existing(selected(options.selection).results))), markup=False)
    return OK


def new_command(options: argparse.Namespace) -> int:
    """``dexrepro new controller NAME [--kind KIND]``."""
    from dexrepro.scaffold import new_controller

    law, test, command = new_controller(options.name, options.kind, Path())
    out.print(f"wrote {law} and {test}; try:\n  pytest {test}\n  {command}", markup=False)
    return OK


def render_command(options: argparse.Namespace) -> int:
    """``dexrepro render [FOLDER | chapter=N] [only=EXPERIMENT] [case=NAME] [format=gif|mp4] [allow=MODULE,...]``.

    Without a folder or an experiment: the film of every experiment that declares one and has a result, where it is
    missing or older than its recording.
    """
    from dexrepro import chapters
    from dexrepro.report import animation
    from dexrepro.selection import selected

    folders = [Path(text) for text in options.selection if "=" not in text]
    words = [text for text in options.selection if "=" in text]
    numbers, only, results, _, values = selected(words, ("case", "format", "allow"))
    allow = [name for name in values.get("allow", "").strip("[]").split(",") if name]
    kind = values.get("format", "gif")
    if kind not in ("gif", "mp4"):
        raise InputError(f"format = {kind} is not allowed: it must be gif or mp4")
    if "case" in values and not folders and not only:
        raise InputError(f"case = {values['case']}: of which experiment? add only=EXPERIMENT or a result folder")
    films = []
    for number in () if folders else numbers:
        for experiment in chapters.load(number).experiments:
            folder = results / f"chapter{number}" / experiment.name
            if film := animation.film_of(folder, experiment):
                films.append(film)
            outdated = film is not None and not animation.up_to_date(film.with_suffix(f".{kind}"), experiment)
            if experiment.name in only or (not only and outdated):
                folders.append(folder)
    if not folders and not films:
        raise InputError(f"no result in {results} has a film; run first: dexrepro run")
    for folder in folders:
        out.print(str(animation.render(folder, values.get("case"), kind, allow)), markup=False)
    if not folders:
        out.print(f"nothing to render: {len(films)} films are up to date")
    return OK


def study_command(options: argparse.Namespace) -> int:
    """``dexrepro study chapter=N [claim=ID] [only=EXPERIMENT] [samples=N] [hours=H] [jobs=N hydra/launcher=...]``."""
    from dexrepro import study
    from dexrepro.selection import selected

    if any(text.startswith(("jobs=", "hydra")) for text in options.selection):
        return _study_jobs(options)
    numbers, only, results, workers, values = selected(options.selection, STUDY)
    samples, hours = _samples(values.get("samples")), _hours(values.get("hours"))
    for number in numbers:
        for name in study.experiments_of(number, only, values.get("claim")):
            if options.confirm:
                carried, other = study.confirm(number, name, results, options.update)
                differ = f"; other numbers than before: {', '.join(other)}" if other else ""
                out.print(f"{name}: {carried} cases of samples carried over{differ}", markup=False)
                continue
            try:
                path = study.run(number, name, samples, results, workers=workers, hours=hours, update=options.update)
            except study.SamplesFailed as error:
                err.print(str(error), markup=False)
                return FAILED
            _print_study(name, path, results)
    return OK


def _samples(text: str | None) -> int | None:
    if text is not None and not (text.isdecimal() and 1 <= int(text) <= 1024):
        raise InputError(f"samples = {text} is not allowed: it must be a whole number of 1 or greater, 1024 at most")
    return int(text) if text else None


def _hours(text: str | None) -> float | None:

    with suppress(ValueError):
        if text is None or (math.isfinite(float(text)) and float(text) > 0):
            return float(text) if text else None
    raise InputError(f"hours = {text} is not allowed: it must be a number greater than 0")


def _study_jobs(options: argparse.Namespace) -> int:
    """A study by jobs of a Hydra launcher, which share its samples."""
    from dexrepro import study
    from dexrepro.selection import selected

    values = dict(text.partition("=")[::2] for text in options.selection)
    jobs = values.pop("jobs", "")
    if not jobs.isdigit() or int(jobs) < 1:
        raise InputError(f"jobs = {jobs or 'null'} is not allowed: it must be a whole number of 1 or greater")
    launcher = [f"{key}={value}" for key, value in values.items() if key.startswith("hydra")]
    words = [f"{key}={value}" for key, value in values.items() if not key.startswith("hydra")]
    numbers, only, folder, _, _ = selected(words, STUDY)
    _samples(values.get("samples")), _hours(values.get("hours"))
    names = [name for number in numbers for name in study.experiments_of(number, only, values.get("claim"))]
    selection = ",".join(json.dumps(text) for text in words)
    results = [text for text in words if text.startswith("results=")]
    status = _launch(["-m", f"+job=range({jobs})", f"+selection=[{selection}]", *results, *launcher], _study_job)
    if options.update and status == OK:
        return study_command(argparse.Namespace(selection=words, update=True, confirm=False))
    for name in names:
        if (path := study.summary_file(name, folder)).exists():
            _print_study(name, path, folder)
    return status


def _study_job(config: Any) -> None:
    from dexrepro.sweep import JobFailed, enter_launch_folder

    enter_launch_folder()
    if study_command(argparse.Namespace(selection=["workers=1", *config.selection], update=False, confirm=False)) != OK:
        raise JobFailed("a process was killed; the same command completes what is missing")


def _print_study(name: str, path: Path, results: Path) -> None:
    from dexrepro.report import studies
    from dexrepro.storage import read_json

    summary = read_json(path)
    drawing = studies.save(summary, results / "studies" / f"{name}.svg")
    out.print(f"{name}: {path}, drawn in {drawing}", markup=False)
    for claim, row in summary["claims"].items():
        interval = f"{100 * row['low']:.0f} to {100 * row['high']:.0f} %"
        most = f", follows {row['parameter']} most" if row["parameter"] else ""
        out.print(
            f"  {claim}: holds in {row['holds']} of {row['samples']} ({interval}), {row['word']}{most}", markup=False
        )


def completion_command(options: argparse.Namespace) -> int:
    """``dexrepro completion bash|zsh|fish``."""
    from dexrepro.completion import script

    print(script(options.shell))
    return OK


def diff_command(options: argparse.Namespace) -> int:
    """Compare two result folders."""
    from dexrepro.report.compare import compare

    for line in compare(options.a, options.b):
        out.print(line, markup=False)
    return OK
