"""Laws: one written to begin with, one tuned, those of a folder beside the book's."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.table import Table

from dexrepro.commands import OK, SHOWN, command, option, say, show_table
from dexrepro.errors import InputError, folder_named, whole_number

GIVEN = "\n  EXPERIMENT.key=value    what shall be another value throughout, as for dexrepro run"


@command(
    "search a case's parameters for the best value of a metric",
    ("case", "minimise", "maximise", "limit", "budget", "results", "workers"),
    option("--update", help="renew the search that is shipped, as it was made; without case= all"),
    more="\n  law.KEY=LOW..HIGH       a parameter to search; else those of the law that declare a range" + GIVEN,
)  # fmt: skip
def tune_command(options: argparse.Namespace) -> int:
    """``dexrepro tune case=EXPERIMENT.CASE minimise=METRIC budget=N [law.gain=0.01..0.1 …]``."""
    from dexrepro import chapters, tune
    from dexrepro.selection import quoted

    words = options.selection
    case = next((word[5:] for word in words if word.startswith("case=")), "")
    if options.update and not case:
        for name in tune.searched():
            tune_command(argparse.Namespace(update=True, selection=[f"case={name}", *words]))
        return OK
    made = tune.words_of(case) if options.update else []
    if made and (other := [word for word in words if not word.startswith(("case=", "results=", "workers="))]):
        raise InputError(
            f"{other[0]}: the search for {case} is shipped and is made again as it was, {' '.join(made)}; "
            f"for another, delete {tune.shipped(case)} first"
        )
    known, rest = _search_words([*made, *words], "tune")
    experiment = known["case"].partition(".")[0]
    given, parameters = _given(rest, [experiment])
    if given and options.update:
        raise InputError(f"{given[0]}: a search that is shipped is of the book's own values")
    search = tune.search_of(
        known["case"], known["metric"], known["sign"], parameters, [*map(quoted, given)], known["limit"]
    )
    if not search.ranges:
        some = ", ".join(tune.numbers_of(search)[:SHOWN]) or "none of its parameters is a number"
        raise InputError(
            f"{search.name}: no parameter of its law declares a range; name some, as KEY=LOW..HIGH: {some}"
        )
    found, path = tune.run(search, known["budget"], known["results"], known["workers"], say, options.update)
    if found.best is None:
        raise InputError(f"{search.name}: {found.edges[0]}")
    values = ", ".join(f"{key} = {value:g}" for key, value in found.chosen.items()) or "as it stands"
    was = "undefined" if found.start is None else f"{found.start:.4g}"
    failed = f" ({found.failed} of them without a usable value)" if found.failed else ""
    say(f"{search.name}: {search.metric} {found.best:.4g} instead of {was} after {found.runs} runs{failed}: {values}")
    for edge in found.edges:
        say(edge)
    say(f"stored in {path}")
    if found.chosen:
        run = f"dexrepro run{chapters.option(search.chapter)} only={experiment} case={search.case}"
        say(" ".join([run, *(f"'{word}'" for word in given), search.override(found.chosen)]))
    return OK


@command(
    "the laws of a folder beside the book's, tuned alike",
    ("laws", "case", "minimise", "maximise", "budget", "results", "workers"), more=GIVEN,
)  # fmt: skip
def compare_command(options: argparse.Namespace) -> int:
    """``dexrepro compare laws=FOLDER case=EXPERIMENT.CASE,… minimise=METRIC budget=N [EXPERIMENT.key=value …]``."""
    import pandas as pd

    from dexrepro import comparison, tune
    from dexrepro.selection import quoted
    from dexrepro.storage import digest_of

    known, rest = _search_words(options.selection, "compare", "laws")
    results, names = known["results"], known["case"].split(",")
    experiments = list(dict.fromkeys(name.partition(".")[0] for name in names))
    given, other = _given(rest, experiments)
    if other:
        raise InputError(f"'{other[0]}' has no meaning here; see: dexrepro compare --help")
    laws = comparison.laws_in(known["laws"], say)
    rows = comparison.leaderboard(
        names, laws, known["metric"].split(","), known["sign"],
        lambda search: tune.run(search, known["budget"], results, known["workers"], say)[0],
        [*map(quoted, given)],
    )  # fmt: skip
    shown = Table(*rows[0], title=", ".join([f"{known['budget']} runs each", *given]), box=None, pad_edge=False)
    for row in rows:
        shown.add_row(*(f"{value:.4g}" if isinstance(value, float) else str(value or "") for value in row.values()))
    show_table(shown)
    for name, law in laws.items():
        if name.rpartition(".")[2] not in {row["law"] for row in rows if row["whose"] == "yours"}:
            say(f"{name} is of kind '{getattr(law, 'kind', 'holding')}', which no case here takes: left out")
    changed = [digest_of(given)[:10]] if given else []
    path = results / "tuning" / f"{'-'.join(['leaderboard', *experiments, *changed])}.csv"
    pd.DataFrame(rows).to_csv(path, index=False)
    say(f"stored in {path}")
    return OK


def _given(words: Sequence[str], experiments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Those of the words that override values of the experiments, and the other words."""
    own = re.compile(rf"[+~]|seed=|shared\.|({'|'.join(map(re.escape, experiments))})\.")
    given = [word for word in words if own.match(word)]
    return given, [word for word in words if word not in given]


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
    known |= {
        "limit": dict(map(_limit, filter(None, known.get("limit", "").split(",")))),
        "metric": known[goals[0]], "sign": 1 if goals[0] == "minimise" else -1,
        "budget": whole_number("budget", known.get("budget", "32"), 2, 4096),
        "results": folder_named(known.get("results", "results")),
        "workers": positive_workers(known.get("workers")),
    }  # fmt: skip
    return known, [word for word in words if word.partition("=")[0] not in own]


def _limit(word: str) -> tuple[str, float]:
    name, _, text = word.partition(":")
    try:
        return name, float(text)
    except ValueError:
        raise InputError(f"limit = {word} is not allowed: it must be METRIC:NUMBER") from None


@command(
    "write a working control law of your own, with its test", None,
    option("what", choices=["controller"], help="what to write"),
    option("--kind", choices=["joint", "end_point", "holding"], default="holding", help="where it thinks"),
    option("name", nargs=None, help="class name, for example MyLaw"),
)  # fmt: skip
def new_command(options: argparse.Namespace) -> int:
    """``dexrepro new controller NAME [--kind KIND]``."""
    from dexrepro.scaffold import new_controller

    law, test, words = new_controller(options.name, options.kind, Path())
    say(f"wrote {law} and {test}; try:\n  pytest {test}\n  {words}")
    return OK
