"""The command line; each command is thin (``dexrepro --help`` names them)."""

from __future__ import annotations

import argparse
import json
import logging
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
from dexrepro.errors import InputError, folder_named

if TYPE_CHECKING:
    from dexrepro.baselines import ChapterReport

HYDRA_FLAGS = ("-m", "--multirun", "--cfg", "-c", "--info", "-i", "--hydra-help", "--resolve")
SHOWN = 8  # names in one line
OK, FAILED, WRONG, INTERRUPTED = 0, 1, 2, 130
STATUSES = {
    OK: "done; check: the same as stored",
    FAILED: "a case failed or cannot be drawn; check: something differs; the output is no longer read",
    WRONG: "the input cannot be used, or results are missing; one sentence says what",
    INTERRUPTED: "interrupted; the same command completes what is missing",
}
RUN = """
  EXPERIMENT.key=value    any parameter (dexrepro show EXPERIMENT names them); what deviates from the book goes to runs/
  +scene=NAME             a scene, or another file, of the folder that --config-dir names

examples:
  dexrepro run chapter=2                       every experiment of a chapter
  dexrepro run figure=2.7 seed=3               what one figure needs
  dexrepro run -m figure=2.7 'seed=range(10)'  a sweep; hydra/launcher=joblib, ray, submitit_slurm
  dexrepro run --config-dir FOLDER +scene=NAME
  dexrepro run chapter=N --cfg job             every parameter with its value"""
TUNE = "\n  law.KEY=LOW..HIGH       a parameter to search; else those of the law that declare a range\n"
TUNE += "  EXPERIMENT.key=value    what shall be another value throughout, as for dexrepro run"
SHOW = "\n\nexamples: dexrepro show C4.01 (or 2.7, 2.32, k_o, ImpedanceReference, movement_estimation.stiffness)"

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
        return _dispatch(_global_options(arguments))
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
    if arguments[:1] == ["run"] and not {"-h", "--help"} & {*arguments}:
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


class _ToTerminal(logging.Handler):
    """Says what is logged where errors are said."""

    def emit(self, record: logging.LogRecord) -> None:
        err.print(record.getMessage(), markup=False)


def _global_options(arguments: list[str]) -> list[str]:
    """Heed ``--log`` and ``--experiments DIR``, before or behind any command; the other arguments."""
    from dexrepro import chapters

    parser = argparse.ArgumentParser(prog="dexrepro", add_help=False, allow_abbrev=False)
    parser.add_argument("--experiments", action="append", default=[], type=Path, metavar="DIR")
    parser.add_argument("-v", "--log", action="store_true")
    options, rest = parser.parse_known_args(arguments)
    logging.getLogger("dexrepro").handlers = [_ToTerminal()]
    logging.getLogger("dexrepro").setLevel(logging.INFO if options.log else logging.WARNING)
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
    from dexrepro.keys import described

    told = "exit status:\n" + "\n".join(f"  {status:<5}{meaning}" for status, meaning in STATUSES.items())
    parser = argparse.ArgumentParser(
        prog="dexrepro", description="Reproduce the book's figures and check its claims.", epilog=told,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("--version", action="version", version=f"dexrepro {__version__}")
    parser.add_argument("--experiments", metavar="DIR", help="experiments of your own, beside the book's")
    parser.add_argument("-v", "--log", action="store_true", help="say what is read, and why something runs again")
    commands = parser.add_subparsers(required=True, metavar="command", dest="command")

    def add(name: str, help: str, more: str = "", metavar: str = "key=value") -> argparse.ArgumentParser:
        command: argparse.ArgumentParser = commands.add_parser(
            name, help=help, description=help[0].upper() + help[1:] + ".", epilog=described(name) + more,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )  # fmt: skip
        words = command.add_argument("selection", nargs="*", metavar=metavar, help="as listed below")
        words.completer = _completions  # type: ignore[attr-defined]
        command.set_defaults(function=globals()[f"{name}_command"])
        return command

    run = add("run", "simulate, measure and draw what is not there yet", RUN)
    run.add_argument("-m", "--multirun", action="store_true", help="a sweep: each combination of values is a job")
    run.add_argument("-cd", "--config-dir", metavar="DIR", help="a folder of your own with configurations and laws")
    run.add_argument("-c", "--cfg", choices=["job", "hydra", "all"], help="print the configuration, run nothing")
    run.add_argument("-i", "--info", help="what Hydra knows: all, defaults, plugins (see also --hydra-help)")
    run.add_argument("--resolve", action="store_true", help="with --cfg: references replaced by their values")

    listing = commands.add_parser("list", help="chapters, experiments, cases, figures, claims, errata")
    listing.add_argument("--json", action="store_true", help="for programs, see docs/schemas")
    listing.add_argument("--markdown", action="store_true", help="the claims of the book counted by verdict")
    listing.add_argument("--schema", action="store_true", help="a JSON schema of all parameters, for an editor")
    listing.set_defaults(function=list_command)

    add("show", "all there is about a claim, figure, equation, symbol, law, parameter or experiment", SHOW, "NAME")
    check = add("check", "compare results with the stored baselines, simulate nothing")
    check.add_argument("--json", action="store_true", help="for programs, see docs/schemas")
    check.add_argument("--update", action="store_true", help="run, perturb, and store new baselines")
    check.add_argument("--accept", nargs="+", default=[], metavar="ID", help="claims whose verdict may change")

    add(
        "draw",
        "draw again from files, nothing simulated: of a FOLDER such as one in results/runs, or as selected",
        "",
        "FOLDER|key=value",
    )
    add("report", "build the HTML page from files")
    cross = add("crosscheck", "run the book under MuJoCo, too, and compare")
    cross.add_argument("--update", action="store_true", help="renew the table that is shipped")
    study = add("study", "how often claims hold when the unprinted varies")
    study.add_argument("--update", action="store_true", help="renew the study that is shipped")
    study.add_argument("--confirm", action="store_true", help="carry samples over a change of code: two run again")
    add("tune", "search a case's parameters for the best value of a metric", TUNE)
    add("compare", "the laws of a folder beside the book's, tuned alike")
    add("render", "animate recorded runs: of a FOLDER, or films that are missing or outdated", "", "FOLDER|key=value")

    new = commands.add_parser("new", help="write a working control law of your own, with its test")
    new.add_argument("what", choices=["controller"], help="what to write")
    new.add_argument("--kind", choices=["joint", "end_point", "holding"], default="holding", help="where it thinks")
    new.add_argument("name", help="class name, for example MyLaw")
    new.set_defaults(function=new_command)

    diff = commands.add_parser("diff", help="compare two results: configuration, metrics, verdicts, series")
    diff.add_argument("a", type=Path, help="folder of a result")
    diff.add_argument("b", type=Path, help="folder of another")
    diff.add_argument("--html", type=Path, metavar="FILE", help="write a page instead, with both recordings to explore")
    diff.set_defaults(function=diff_command)

    completion = commands.add_parser("completion", help='for Tab: eval "$(dexrepro completion bash)"')
    completion.add_argument("shell", choices=("bash", "zsh", "fish"), help="whose script to print")
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
            extra_dir = str(folder_named(arguments[index + 1], argument))
            del rest[index : index + 2]
        elif argument.startswith("--config-dir="):
            extra_dir = str(folder_named(argument.partition("=")[2], "--config-dir"))
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
    """What failed, and under which values that are not the book's, which may be the reason."""
    said = []
    for reason, names in outcome.reasons().items():
        experiment = names[0].partition(".")[0]
        under = _differs(experiment, outcome.differs.get(experiment, []))
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        said.append("; ".join([f"{names[0]}{more} failed: {reason}", *under]))
    return said


def _differs(name: str, differs: Sequence[str]) -> list[str]:
    named = ", ".join(differs[:SHOWN]) + (f" and {len(differs) - SHOWN} more" if len(differs) > SHOWN else "")
    return [f"{name} differs from the book in: {named}"] if differs else []


def _run(overrides: Sequence[str], extra_dir: str | None) -> Any:
    from dexrepro.config import compose_chapter
    from dexrepro.physics.engine import REFERENCE
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
    if settings.get("engine") is None and any(REFERENCE != plan.engine in plan.versions for plan in plans):
        err.print(
            "PyBullet is not installed here (its wheels are for Python 3.11 on Linux): MuJoCo simulates the arms; how "
            "its numbers differ from those stored is in docs/how-to/engines.md"
        )
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
        for line in _differs(name, differs) if name in outcome.folders else ():
            out.print(line, markup=False)
    for line in _claims_to_name(outcome):
        out.print(line, markup=False)
    if not evaluated:
        out.print("claims whose metrics this run does not have are not evaluated")


def _claims_to_name(outcome: Any) -> list[str]:
    from dexrepro.baselines import Baseline
    from dexrepro.report import verdicts
    from dexrepro.storage import read_json

    lines = []
    for name, folder in outcome.folders.items():
        run, claims = read_json(folder / "run.json"), read_json(folder / "claims.json")
        lines += verdicts.to_name(claims, Baseline.of(run["chapter"], name).claims) if claims else []
    return lines


# --------------------------------------------------------------------------------------------------- other commands


def list_command(options: argparse.Namespace) -> int:
    """Everything there is, as text or JSON; or the claims of the book counted, as the README's table."""
    from dexrepro import scoreboard
    from dexrepro.report.listing import listing

    if options.markdown:
        print(scoreboard.markdown())
        return OK
    if options.schema:
        from dexrepro.report.schema import schema

        print(json.dumps(schema(), indent=1))
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

    numbers, only, results, workers, extra = selected(options.selection, "check")
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
        out.print(f"  {line}", markup=False)


def crosscheck_command(options: argparse.Namespace) -> int:
    """Run what simulates arms under the other engine; say which numbers and verdicts differ."""
    from dexrepro import crosscheck
    from dexrepro.selection import selected

    numbers, only, results, workers, _ = selected(options.selection, "crosscheck")
    target = crosscheck.table(results, options.update)
    for number in numbers:
        for item in crosscheck.run(number, only, results, workers):
            crosscheck.keep([item], target)
            known = [entry for entry in item.metrics if entry.spread]
            turned = [f"{key} {' under PyBullet, '.join(item.claims[key])} under MuJoCo" for key in item.turned]
            out.print(
                f"{item.experiment}: {item.compared} numbers, {len(item.metrics)} outside their tolerance, "
                f"{sum(entry.matters for entry in known)} of the {len(known)} that a study has outside its range, too; "
                f"{len(item.claims)} claims, {len(turned)} turn" + "".join(f"\n  {text}" for text in turned),
                markup=False,
            )
    out.print(str(target), markup=False)
    return OK


def draw_command(options: argparse.Namespace) -> int:
    """``dexrepro draw [FOLDER ...] [key=value ...]``: figures and tables again from what is on disk."""
    from dexrepro.plan import plan_chapter, select
    from dexrepro.pool import sentence
    from dexrepro.report.damage import check_result
    from dexrepro.runner import redraw
    from dexrepro.selection import existing, quoted, selected
    from dexrepro.storage import read_json

    folders, words = ([text for text in options.selection if ("=" in text) == keyed] for keyed in (False, True))
    numbers, only, results, _, extra = selected(words, "draw")
    given, look, kind = dict(word.partition("=")[::2] for word in words), extra.pop("style", None), None
    if look or "format" in extra:
        from dexrepro.report import export

        kind, look = export.checked(extra.pop("format", "pdf"), look or "paper")
    if folders:
        if other := {"chapter", "only", *extra} & set(given):
            raise InputError(f"{', '.join(sorted(other))}: a folder says which result; leave out one of the two")
        found = [Path(folder) for folder in folders]
    else:
        parts = {n: select(n, only or None, None) for n in numbers}
        found = [existing(results) / f"chapter{n}" / e.name for n, experiments in parts.items() for e in experiments]
        if extra:
            words = [quoted(f"results={results}"), *(quoted(f"case={value}") for value in extra.values())]
            words += [f"only=[{','.join(only)}]"] if only else []
            plans = [plan for number in numbers for plan in plan_chapter(number, words, write=False)[0]]
            found = [plan.folder for plan in plans]
        found = [folder for folder in found if (folder / "run.json").exists()]
    if not found:
        raise InputError(f"there is no such result in {results}; run first: dexrepro run {' '.join(options.selection)}")
    checked = [check_result(folder, "metrics.json", "config.yaml", series=True) for folder in found]
    status = OK
    for folder, experiment in zip(found, checked):
        try:
            if kind and look:
                target = results / "figures" / look
                if folder.name != experiment.name:  # of other parameters, or of some cases
                    target /= folder.name
                made = export.export(experiment, folder, target, kind, look, given.get("figure"))
            else:
                redraw(read_json(folder / "run.json")["chapter"], experiment.name, folder)
                made = [folder]
        except Exception as error:  # a result of another version, say; the others can still be drawn
            err.print(f"{folder} cannot be drawn, run it again: {sentence(error)}", markup=False)
            status = FAILED
        else:
            for path in made:
                out.print(str(path), markup=False)
    return status


def show_command(options: argparse.Namespace) -> int:
    """``dexrepro show NAME ...``: all there is about a claim, figure, equation, symbol, law, parameter, experiment."""
    from dexrepro.report.show import show
    from dexrepro.selection import selected

    keyed = [word for word in options.selection if word.startswith("results=")]
    results = selected(keyed, "show").results
    if not (names := [word for word in options.selection if word not in keyed]):
        raise InputError("show needs a name, such as C4.01, 2.7, 2.32, k_o or movement_estimation")
    for name in names:
        for line in show(name, results):
            out.print(line, markup=False)
    return OK


def report_command(options: argparse.Namespace) -> int:
    """Build results/report/index.html."""
    from dexrepro.report import page
    from dexrepro.selection import existing, selected

    out.print(str(page.build(existing(selected(options.selection, "report").results))), markup=False)
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
    numbers, only, results, _, values = selected(words, "render")
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
    from dexrepro.config import check_engine
    from dexrepro.physics.engine import default
    from dexrepro.selection import selected

    if any(text.startswith(("jobs=", "hydra")) for text in options.selection):
        return _study_jobs(options)
    numbers, only, results, workers, values = selected(options.selection, "study")
    samples, hours = _samples(values.get("samples")), _hours(values.get("hours"))
    check_engine(engine := values.get("engine", default()))
    for number in numbers:
        for name in study.experiments_of(number, only, values.get("claim")):
            if options.confirm:
                carried, other = study.confirm(number, name, results, options.update)
                differ = f"; other numbers than before: {', '.join(other)}" if other else ""
                out.print(f"{name}: {carried} cases of samples carried over{differ}", markup=False)
                continue
            try:
                cases = study.cases_of(number, name, values["case"].strip("[]")) if "case" in values else ()
                if cases and options.update:
                    raise InputError(f"case = {values['case']} is not allowed with --update: what is shipped is whole")
                path = study.run(number, name, samples, results, workers=workers, hours=hours, update=options.update,
                                 engine=engine, only=cases)  # fmt: skip
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
    numbers, only, folder, _, _ = selected(words, "study")
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


def tune_command(options: argparse.Namespace) -> int:
    """``dexrepro tune case=EXPERIMENT.CASE minimise=METRIC budget=N [law.gain=0.01..0.1 …]``."""
    from dexrepro import tune
    from dexrepro.selection import quoted

    known, rest = _search_words(options.selection, "tune")
    experiment = known["case"].partition(".")[0]
    overrides = [quoted(word) for word in rest if re.match(rf"[+~]|seed=|shared\.|{re.escape(experiment)}\.", word)]
    parameters = [word for word in rest if quoted(word) not in overrides]
    search = tune.search_of(known["case"], known["metric"], known["sign"], parameters, overrides)
    if not search.ranges:
        raise InputError(f"{search.name}: no parameter of its law declares a range; name some: law.gain=0.01..0.1")
    found, path = tune.run(search, known["budget"], known["results"], known["workers"], _say)
    if found.best is None:
        raise InputError(f"{search.name}: {found.edges[0]}")
    values = ", ".join(f"{key} = {value:g}" for key, value in found.chosen.items()) or "as it stands"
    was = "undefined" if found.start is None else f"{found.start:.4g}"
    failed = f" ({found.failed} of them without a usable value)" if found.failed else ""
    _say(f"{search.name}: {search.metric} {found.best:.4g} instead of {was} after {found.runs} runs{failed}: {values}")
    for edge in found.edges:
        _say(edge)
    _say(f"stored in {path}")
    if found.chosen:
        given = [f"'{word}'" for word in rest if word not in parameters]
        _say(" ".join(["dexrepro run", f"only={experiment} case={search.case}", *given, search.override(found.chosen)]))
    return OK


def compare_command(options: argparse.Namespace) -> int:
    """``dexrepro compare laws=FOLDER case=EXPERIMENT.CASE,… minimise=METRIC budget=N``."""
    import pandas as pd

    from dexrepro import tune

    known, rest = _search_words(options.selection, "compare", "laws")
    if rest:
        raise InputError(f"'{rest[0]}' has no meaning here; see: dexrepro compare --help")
    laws = tune.laws_in(folder_named(known["laws"], "laws"))
    results, names = known["results"], known["case"].split(",")
    rows = tune.leaderboard(
        names, laws, known["metric"].split(","), known["sign"],
        lambda search: tune.run(search, known["budget"], results, known["workers"], _say)[0],
    )  # fmt: skip
    shown = Table(*rows[0], title=f"{known['budget']} runs each", box=None, pad_edge=False)
    for row in rows:
        shown.add_row(*(f"{value:.4g}" if isinstance(value, float) else str(value or "") for value in row.values()))
    out.print(shown)
    path = results / "tuning" / f"leaderboard-{'-'.join(dict.fromkeys(name.partition('.')[0] for name in names))}.csv"
    pd.DataFrame(rows).to_csv(path, index=False)
    _say(f"stored in {path}")
    return OK


def _say(text: str) -> None:
    out.print(text, markup=False)


def _search_words(words: Sequence[str], command: str, *needed: str) -> tuple[dict[str, Any], list[str]]:
    """What the words of ``tune`` and ``compare`` ask for, and the other words."""
    from dexrepro.keys import TAKEN
    from dexrepro.selection import positive_workers

    own = TAKEN[command]
    known: dict[str, Any] = dict(text.partition("=")[::2] for text in words if text.partition("=")[0] in own)
    for key in ("case", *needed):
        if not known.get(key):
            raise InputError(f"{key}= is missing; there are: {', '.join(f'{name}=' for name in own)}")
    goals = [key for key in ("minimise", "maximise") if known.get(key)]
    if len(goals) != 1:
        raise InputError("give minimise=METRIC or maximise=METRIC: the metric of the case that is to be best")
    budget = str(known.get("budget", "32"))
    if not (budget.isdecimal() and 2 <= int(budget) <= 4096):
        raise InputError(f"budget = {budget} is not allowed: it must be a whole number of 2 or greater, 4096 at most")
    workers = known.get("workers")
    known |= {
        "metric": known[goals[0]], "sign": 1 if goals[0] == "minimise" else -1, "budget": int(budget),
        "results": folder_named(known.get("results", "results")),
        "workers": positive_workers(int(workers) if workers and workers.isdigit() else workers),
    }  # fmt: skip
    return known, [word for word in words if word.partition("=")[0] not in own]


def completion_command(options: argparse.Namespace) -> int:
    """``dexrepro completion bash|zsh|fish``."""
    from dexrepro.completion import script

    print(script(options.shell))
    return OK


def diff_command(options: argparse.Namespace) -> int:
    """Compare two result folders."""
    from dexrepro.report.compare import compare, write_page

    if options.html:
        write_page(options.a, options.b, options.html)
        out.print(str(options.html), markup=False)
        return OK
    for line in compare(options.a, options.b):
        out.print(line, markup=False)
    return OK
