"""``dexrepro run``, and jobs by a launcher of Hydra's."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

from rich.table import Table

from dexrepro.commands import FAILED, OK, SHOWN, command, option, out, say, show_table, warn
from dexrepro.errors import InputError, importable, nearest
from dexrepro.keys import SELECTION

if TYPE_CHECKING:
    from dexrepro.plan import Plan
    from dexrepro.result import Result
    from dexrepro.runner import Outcome

HYDRA_FLAGS = ("-m", "--multirun", "--cfg", "-c", "--info", "-i", "--hydra-help", "--resolve")
WITHOUT_PYBULLET = (
    "PyBullet is not installed here (its wheels are for Python 3.11 on Linux): MuJoCo simulates the arms; how its "
    "numbers differ from those stored is in docs/how-to/engines.md"
)
MORE = """
  EXPERIMENT.key=value    any parameter (dexrepro show EXPERIMENT names them); what deviates from the book goes to runs/
  +scene=NAME             a scene, or another file, of the folder that --config-dir names

examples:
  dexrepro run chapter=2                       every experiment of a chapter
  dexrepro run figure=2.7 seed=3               what one figure needs
  dexrepro run -m figure=2.7 'seed=range(10)'  a sweep; hydra/launcher=joblib, ray, submitit_slurm
  dexrepro run --config-dir FOLDER +scene=NAME
  dexrepro run chapter=N --cfg job             every parameter with its value"""


@command(
    "simulate, measure and draw what is not there yet",
    (*SELECTION, "claim", "case", "seed", "engine", "workers", "case_timeout", "force", "quiet", "gui"),
    option("-m", "--multirun", help="a sweep: each combination of values is a job"),
    option("-cd", "--config-dir", metavar="DIR", help="a folder of your own with configurations and laws"),
    option("-c", "--cfg", choices=["job", "hydra", "all"], help="print the configuration, run nothing"),
    option("-i", "--info", nargs=None, help="what Hydra knows: all, defaults, plugins (see also --hydra-help)"),
    option("--resolve", help="with --cfg: references replaced by their values"),
    more=MORE,
)  # fmt: skip
def run_command(arguments: list[str]) -> int:
    """``dexrepro run``: Hydra's own modes go to Hydra, everything else is planned and run here."""
    from dexrepro.selection import for_hydra, needs_of, quoted

    folder = ("--config-dir", "-cd")  # what follows is a name as it is
    arguments = [word if last in folder else quoted(word) for last, word in zip(["", *arguments], needs_of(arguments))]
    extra_dir, overrides = _config_dir_option(arguments)
    if any(argument.split("=")[0] in HYDRA_FLAGS for argument in arguments):
        given = [text for text in overrides if not text.startswith("-") and "=" in text]
        if arguments[-2:] in (["--cfg", "job"], ["-c", "job"]) and not {"-m", "--multirun"} & set(arguments):
            return _print_config(given, extra_dir)
        return launch(for_hydra(arguments, given, extra_dir), _run_job)
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
            extra_dir = arguments[index + 1]
            del rest[index : index + 2]
        elif argument.startswith("--config-dir="):
            extra_dir = argument.partition("=")[2]
            rest.remove(argument)
    # its classes can be named by _target_
    return None if extra_dir is None else str(importable(extra_dir, "--config-dir")), rest


def run_overrides(overrides: Sequence[str], extra_dir: str | None = None) -> int:
    """Plan, run and summarise what a list of overrides selects; say on stderr what failed."""
    failures = _sentences(_run(overrides, extra_dir))
    for sentence in failures:
        warn(sentence)
    return FAILED if failures else OK


def _sentences(outcome: Outcome) -> list[str]:
    """What failed, and under which values that are not the book's, which may be the reason."""
    said = []
    for reason, names in outcome.reasons().items():
        experiment = names[0].partition(".")[0]
        under = _differs(experiment, outcome.differs.get(experiment, []))
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        kept = [f"traceback: {outcome.tracebacks[names[0]]}"] if names[0] in outcome.tracebacks else []
        said.append("; ".join([f"{names[0]}{more} failed: {reason}", *kept, *under]))
    return said


def _differs(name: str, differs: Sequence[str]) -> list[str]:
    named = ", ".join(differs[:SHOWN]) + (f" and {len(differs) - SHOWN} more" if len(differs) > SHOWN else "")
    return [f"{name} differs from the book in: {named}"] if differs else []


def _run(overrides: Sequence[str], extra_dir: str | None) -> Outcome:
    from dexrepro.config import compose_chapter
    from dexrepro.plan import plan_chapter
    from dexrepro.progress import Bar, Lines, Silent
    from dexrepro.result import Result
    from dexrepro.runner import run_plans
    from dexrepro.selection import chapters_of, check_owner, of_chapter, positive_workers
    from dexrepro.unread import without_effect

    numbers, rest = chapters_of(overrides, extra_dir)
    check_owner(rest, numbers)
    plans: list[Plan] = []
    skipped: dict[str, str] = {}
    settings: dict[str, Any] = {}
    workers = None
    for number in numbers:
        own = of_chapter(number, numbers, rest)
        settings = compose_chapter(number, own, extra_dir)
        workers = positive_workers(settings.get("workers"))
        chapter_plans, chapter_skipped = plan_chapter(number, own, composed=settings)
        plans += chapter_plans
        skipped |= chapter_skipped
    if settings.get("engine") is None and any(plan.off_reference for plan in plans):
        warn(WITHOUT_PYBULLET)
    quiet = bool(settings.get("quiet"))
    progress = Silent() if quiet else Bar(out) if out.is_terminal else Lines(out)
    with progress if isinstance(progress, Bar) else nullcontext():
        force = bool(settings.get("force"))
        outcome = run_plans(plans, workers=workers, force=force, progress=progress)
    results = {name: Result(folder) for name, folder in outcome.folders.items()}
    if not quiet:
        _print_summary(results, outcome.differs, skipped)
    for text in dict.fromkeys(text for result in results.values() for text in result.warnings):
        warn(f"warning: {text}")
    for name, result in results.items():
        if keys := without_effect(result.run):
            warn(f"warning: {', '.join(keys[:SHOWN])}: no case that was run reads {'it' if len(keys) == 1 else 'them'}")
        for text in _unmeasured(name, result):
            warn(f"warning: {text}")
    for name in outcome.assembled:
        if left := _undrawn(name, results[name]):
            warn(f"warning: {name}: draw in figures.py made no {', '.join(left)}")
    return outcome


def _unmeasured(name: str, result: Result) -> Iterator[str]:
    """Claims about metrics that an experiment of the user's, run whole, does not have, as sentences."""
    from dexrepro import chapters

    chapter = result.run["chapter"]
    if chapter == chapters.OWN or not chapters.is_added(chapter) or result.run["differs"]:
        return
    for claim in chapters.load(chapter).claims_of(name):
        absent = [key for key in claim.metrics if key.startswith(f"{name}.") and key not in result.metrics]
        for key in absent[:1]:
            yield f"{claim.id} is not evaluated, there is no metric '{key}': {nearest(key, result.metrics)}"


def _undrawn(name: str, result: Result) -> list[str]:
    """Figures that an experiment of the user's names, but does not draw of all its cases."""
    from dexrepro import chapters
    from dexrepro.report.style import file_stem

    chapter = result.run["chapter"]
    if chapter == chapters.OWN or not chapters.is_added(chapter) or result.run["differs"]:
        return []
    declared = chapters.load(chapter).experiment(name).figures
    return [identifier for identifier in declared if file_stem(identifier) not in result.figures]


def launch(arguments: Sequence[str], job: Callable[[Any], None]) -> int:
    """Jobs by Hydra and its launcher; the exit status."""
    from dexrepro.sweep import JobFailed, launch

    try:
        launch(arguments, job)
    except JobFailed as error:
        warn(f"a job of the sweep failed: {error}")
        return FAILED
    return OK


def _run_job(config: Any) -> None:
    """One job of a sweep: the same as a plain run with its overrides."""
    from dexrepro.sweep import JobFailed, enter_launch_folder, job_overrides

    enter_launch_folder()
    overrides, extra_dir = job_overrides()
    if extra_dir is not None:
        importable(extra_dir, "--config-dir")
    if failures := _sentences(_run(overrides, extra_dir)):
        raise JobFailed("; ".join(failures))


def _print_summary(results: Mapping[str, Result], differs: Mapping[str, list[str]], skipped: Mapping[str, str]) -> None:
    from dexrepro.baselines import Baseline
    from dexrepro.claims import NOT_EVALUATED, VERDICTS
    from dexrepro.report.verdicts import to_name

    table = Table(box=None, header_style="bold", pad_edge=False)
    verdicts = {name: Counter(claim["verdict"] for claim in result.claims) for name, result in results.items()}
    shown = [verdict for verdict in VERDICTS if any(counts[verdict] for counts in verdicts.values())]
    for column in ("experiment", "wall [s]", "x real time", *shown, "result"):
        table.add_column(column, justify="left" if column in ("experiment", "result") else "right", no_wrap=True)
    for name, result in results.items():
        factor = f"{result.run['real_time_factor']:.1f}" if result.run["real_time_factor"] else ""
        counts = [str(verdicts[name][key] or "") for key in shown]
        table.add_row(name, f"{result.run['wall']:.1f}", factor, *counts, str(result.folder))
    show_table(table)
    for name, reason in skipped.items():
        say(f"{name} skipped: {reason}")
    for name, keys in differs.items():
        for line in _differs(name, keys) if name in results else ():
            say(line)
    for name, result in results.items():
        for line in to_name(result.claims, Baseline.of(result.run["chapter"], name).claims) if result.claims else ():
            say(line)
    if any(counts[NOT_EVALUATED] for counts in verdicts.values()):
        out.print("claims whose metrics this run does not have are not evaluated")
