"""What is there, and what is made of it: lists, pages, pictures, films, comparisons."""

from __future__ import annotations

import argparse
import errno
import json
from collections.abc import Sequence
from pathlib import Path

from dexrepro.commands import FAILED, OK, command, option, out, say, warn
from dexrepro.errors import InputError, refused
from dexrepro.keys import SELECTION

UNWRITABLE = (errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOSPC)


@command(
    "chapters, experiments, cases, figures, claims, errata", ("chapter",),
    option("--json", help="for programs, see docs/schemas"),
    option("--markdown", help="the claims of the book counted by verdict"),
    option("--schema", help="a JSON schema of all parameters, for an editor"),
)  # fmt: skip
def list_command(options: argparse.Namespace) -> int:
    """Everything there is, as text or JSON; or the claims of the book counted, as the README's table."""
    from dexrepro.report.listing import listing

    if len(forms := [form for form in ("json", "markdown", "schema") if getattr(options, form)]) > 1:
        raise InputError(f"--{forms[0]} and --{forms[1]} exclude each other: give one of them")
    if options.selection and (options.markdown or options.schema):
        raise InputError("chapter= is for the list, not for --markdown or --schema")
    if options.markdown:
        from dexrepro import scoreboard

        print(scoreboard.markdown())
        return OK
    if options.schema:
        from dexrepro.report.schema import schema

        print(json.dumps(schema(), indent=1))
        return OK

    data = listing()
    if options.selection:
        from dexrepro.selection import selected

        numbers = selected(options.selection, "list").chapters
        data = {"chapters": [chapter for chapter in data["chapters"] if chapter["chapter"] in numbers]}
    if options.json:
        print(json.dumps(data, indent=1))
        return OK
    for chapter in data["chapters"]:
        out.print(f"[bold]Chapter {chapter['chapter']}: {chapter['title']}[/bold]")
        for experiment in chapter["experiments"]:
            made = ", ".join([*experiment["figures"], *experiment["tables"]])
            say(f"  {experiment['name']}: {made}")
            say(f"    cases: {', '.join(experiment['cases'])}")
        if options.selection:
            verdicts = _stored_verdicts(chapter["chapter"])
            for item in chapter["claims"]:
                known = ", ".join(filter(None, [verdicts[item["id"]], item["robustness"]]))
                say(f"  {item['id']}{f' ({known})' if known else ''}: {item['statement']}")
            for item in chapter["errata"]:
                say(f"  {item['id']}: {item['kind']} in {item['equation']}: {item['summary']}")
        out.print(f"  {len(chapter['claims'])} claims, {len(chapter['errata'])} errata")
    return OK


def _stored_verdicts(number: str) -> dict[str, str]:
    """Verdict of each claim of a chapter on the metrics that are stored, "" where there are none."""
    from dexrepro import baselines, chapters
    from dexrepro.claims import NOT_EVALUATED

    metrics = baselines.stored_values(number)
    found = {claim.id: claim.evaluate(metrics).verdict for claim in chapters.load(number).claims}
    return {key: "" if verdict == NOT_EVALUATED else verdict for key, verdict in found.items()}


@command(
    "all there is about a claim, figure, equation, symbol, law, parameter or experiment", ("results",),
    metavar="NAME",
    more="\n\nexamples: dexrepro show C4.01 (or 2.7, 2.32, k_o, ImpedanceReference, movement_estimation.stiffness)",
)  # fmt: skip
def show_command(options: argparse.Namespace) -> int:
    """``dexrepro show NAME ...``: all there is about a claim, figure, equation, symbol, law, parameter, experiment."""
    from dexrepro.report.show import show
    from dexrepro.selection import existing, selected

    keyed = [word for word in options.selection if word.startswith("results=")]
    results = existing(selected(keyed, "show").results)
    if not (names := [word for word in options.selection if word not in keyed]):
        raise InputError("show needs a name, such as C4.01, 2.7, 2.32, k_o or movement_estimation")
    for name in names:
        for line in show(name, results):
            say(line)
    return OK


@command(
    "draw again from files, nothing simulated: of a FOLDER such as one in results/runs, or as selected",
    (*SELECTION, "case", "format", "style"), metavar="FOLDER|key=value",
)  # fmt: skip
def draw_command(options: argparse.Namespace) -> int:
    """``dexrepro draw [FOLDER ...] [key=value ...]``: figures and tables again from what is on disk."""
    from dexrepro import chapters
    from dexrepro.damage import check_result
    from dexrepro.pool import sentence
    from dexrepro.result import redraw
    from dexrepro.selection import selected
    from dexrepro.storage import read_json

    folders, words = ([text for text in options.selection if ("=" in text) == keyed] for keyed in (False, True))
    numbers, only, results, _, extra = selected(words, "draw")
    given, look, kind = dict(word.partition("=")[::2] for word in words), extra.pop("style", None), None
    if look or "format" in extra:
        from dexrepro.report import export

        kind, look = export.checked(extra.pop("format", "pdf"), look or "paper")
    if folders and (other := {"chapter", "only", *extra} & set(given)):
        raise InputError(f"{', '.join(sorted(other))}: a folder says which result; leave out one of the two")
    found = [Path(folder) for folder in folders] or _folders(numbers, only, results, extra.get("case"))
    if not found:
        run = "dexrepro run" + "".join(dict.fromkeys(map(chapters.option, numbers)))
        run = " ".join([run, *(word for word in options.selection if not word.startswith(("style=", "format=")))])
        raise InputError(f"there is no such result in {results}; run first: {run}")
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
            if isinstance(error, OSError) and error.errno in UNWRITABLE:
                raise InputError(f"{results if kind else folder} cannot be written ({error.strerror})") from error
            warn(f"{folder} cannot be drawn, run it again: {sentence(error)}")
            status = FAILED
        else:
            for path in made:
                say(path)
            if not made:
                say(f"{folder}: none of its figures shows the cases that were run")
    return status


def _folders(numbers: Sequence[str], only: Sequence[str], results: Path, case: str | None) -> list[Path]:
    """The results that are selected, as far as they are there."""
    from dexrepro.overrides import selecting
    from dexrepro.plan import plan_chapter
    from dexrepro.selection import existing, quoted, select

    existing(results)
    if case is None:
        found = [results / f"chapter{n}" / e.name for n in numbers for e in select(n, list(only) or None, None)]
    else:
        words = [*selecting(results, only), quoted(f"case={case}")]
        found = [plan.folder for n in numbers for plan in plan_chapter(n, words, write=False)[0]]
    return [folder for folder in found if (folder / "run.json").exists()]


@command("build the HTML page from files", ("results",))
def report_command(options: argparse.Namespace) -> int:
    """Build results/report/index.html."""
    from dexrepro.report import page
    from dexrepro.selection import existing, selected

    say(page.build(existing(selected(options.selection, "report").results)))
    return OK


@command(
    "animate recorded runs: of a FOLDER, or films that are missing or outdated",
    (*SELECTION, "case", "format", "allow"), metavar="FOLDER|key=value",
)  # fmt: skip
def render_command(options: argparse.Namespace) -> int:
    """``dexrepro render [FOLDER | chapter=N] [only=EXPERIMENT] [case=NAME] [format=gif|mp4] [allow=MODULE,...]``.

    Without a folder or an experiment: the film of every experiment that declares one and has a result, where it is
    missing or older than its recording.
    """
    from dexrepro import chapters
    from dexrepro.report import animation
    from dexrepro.selection import listed, selected

    folders = [Path(text) for text in options.selection if "=" not in text]
    words = [text for text in options.selection if "=" in text]
    numbers, only, results, _, values = selected(words, "render")
    allow = [*filter(None, listed(values.get("allow", "")))]
    kind = values.get("format", "gif")
    if kind not in ("gif", "mp4"):
        raise refused("format", kind, "be gif or mp4")
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
        raise InputError(
            f"no result in {results} is of an experiment that declares a film: run one, or name what to animate, "
            "a FOLDER or only=EXPERIMENT"
        )
    for folder in folders:
        say(animation.render(folder, values.get("case"), kind, allow))
    if not folders:
        out.print(f"nothing to render: {len(films)} films are up to date")
    return OK


@command(
    "compare two results: configuration, metrics, verdicts, series", None,
    option("a", type=Path, help="folder of a result"),
    option("b", type=Path, help="folder of another"),
    option("--html", type=Path, metavar="FILE", help="write a page instead, with both recordings to explore"),
)  # fmt: skip
def diff_command(options: argparse.Namespace) -> int:
    """Compare two result folders."""
    from dexrepro.report.compare import compare, write_page

    if options.html:
        if options.html.suffix.lower() not in (".html", ".htm"):  # perhaps a file that is to be kept
            raise refused("--html", options.html, "be the name of a page, such as two.html")
        write_page(options.a, options.b, options.html)
        say(options.html)
        return OK
    for line in compare(options.a, options.b):
        say(line)
    return OK
