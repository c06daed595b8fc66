"""Compare laws: those of a folder take the place of the laws of the book's cases, and all are tuned alike."""

from __future__ import annotations

import importlib
import inspect
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from dexrepro.case import targets
from dexrepro.checks import leaves
from dexrepro.control.contract import KINDS, is_plain
from dexrepro.errors import InputError, importable
from dexrepro.study.draws import within
from dexrepro.tune import PERIODS, Found, Range, Search, kind_of, search_of


def laws_in(place: str | Path, tell: Callable[[str], None] = lambda text: None) -> dict[str, type]:
    """The laws that a module or those of a folder define, by what ``_target_`` calls them.

    They are the classes that declare a kind, and a plain holding law that is its module's only class: of several, any
    may be a helper, and ``tell`` is told. Raises InputError where there is none, or a module cannot be imported.
    """
    path = Path(os.path.expanduser(place))  # as it is where nobody has that name, which ``importable`` says
    alone = path.suffix == ".py" and path.is_file()
    folder = importable(path.parent if alone else place, "laws")
    found: dict[str, type] = {}
    for file in [path] if alone else sorted(folder.glob("*.py")):
        if file.stem.startswith(("test_", "_", "conftest")):
            continue
        try:
            module = importlib.import_module(file.stem)
        except Exception as error:
            raise InputError(f"{file} cannot be imported: {type(error).__name__}: {error}") from error
        known = getattr(module, "__file__", None)
        if not os.path.samefile(known or os.devnull, file):
            raise InputError(f"'{file.stem}' is a module already ({known or 'built in'}); rename {file}")
        defined = {name: law for name, law in inspect.getmembers(module, inspect.isclass)
                   if law.__module__ == file.stem}  # fmt: skip
        laws = {name: law for name, law in defined.items() if getattr(law, "kind", None) in KINDS}
        plain = {name: law for name, law in defined.items() if is_plain(law)}
        if len(defined) == 1 or not plain:
            laws |= plain
        else:
            tell(
                f"{file}: {', '.join(plain)} could be plain holding laws or helpers; declare kind = 'holding' in a law"
            )
        found |= {f"{file.stem}.{name}": law for name, law in laws.items()}
    if not found:
        raise InputError(
            f"laws = {place} is not allowed: no class in it declares kind = 'joint', 'end_point' or 'holding', and "
            "none that is alone in its file is a plain holding law"
        )
    return found


def joined(search: Search, target: str, law: type) -> Search | None:
    """The same case with the law in place of its own; None where the comparison is of another kind.

    A constructor's argument takes, in this order: the middle of its range in the class attribute ``ranges``, its
    default, the value of that name in the case (``dt``, ``desired_force``). Those with a range are tuned.
    """
    kinds = {kind_of(text) for text in targets(search.values)}
    if "law" not in search.values:
        raise InputError(f"{search.experiment} compares no laws: its cases have no 'law'")
    if getattr(law, "kind", "holding") not in kinds:
        return None
    spans: dict[str, Range] = dict(getattr(law, "ranges", {}))
    needs = set(getattr(law, "needs", ()))
    known = {key.rpartition(".")[2]: value for key, value in leaves(search.values)}
    if periods := [known[key] for key in PERIODS if key in known]:
        known["dt"] = periods[0]
    arguments: dict[str, Any] = {"_target_": target, **({"_partial_": True} if needs else {})}
    for name, parameter in inspect.signature(law).parameters.items():
        if name in spans:
            arguments[name] = within(0.5, *spans[name])
        elif name in needs or parameter.default is not parameter.empty:
            continue
        elif name in known:
            arguments[name] = known[name]
        else:
            raise InputError(
                f"{target}: nothing says what '{name}' is; give it a default, or ranges = {{'{name}': (low, high)}}"
            )
    ranges = {f"law.{name}": (float(low), float(high)) for name, (low, high) in spans.items()}
    case = target.rpartition(".")[2]
    return replace(search, case=case, values={**search.values, "law": arguments}, ranges=ranges, guessed=False)


def leaderboard(
    cases: Sequence[str], laws: Mapping[str, type], metrics: Sequence[str], sign: int, tuned: Callable[[Search], Found],
    overrides: Sequence[str] = (),
) -> list[dict[str, Any]]:  # fmt: skip
    """The laws beside those of the cases named, each ``tuned`` alike; rows by comparison, the best first.

    metrics: one for all experiments, or one each. In each experiment the laws take the place of the law of the first
    case named. overrides: other values throughout; each experiment has its own and those of no experiment named.
    """
    names = list(dict.fromkeys(case.partition(".")[0] for case in cases))
    if len(metrics) not in (1, len(names)):
        raise InputError(f"{','.join(metrics)} is not allowed: give one metric, or one each for {', '.join(names)}")
    metric = dict(zip(names, [*metrics] * (len(names) if len(metrics) == 1 else 1)))
    searches = []
    for case in cases:
        others = {f"{name}." for name in names if not case.startswith(f"{name}.")}
        own = [word for word in overrides if not word.lstrip("+~").startswith((*others,))]
        searches.append(search_of(case, metric[case.partition(".")[0]], sign, (), own))
    contexts = {search.experiment: search for search in reversed(searches)}
    yours = [search for context in contexts.values() for law in laws.items() if (search := joined(context, *law))]
    if laws and not yours:
        kinds = ", ".join(f"{name} is of kind '{getattr(law, 'kind', 'holding')}'" for name, law in laws.items())
        takes = {kind for search in searches for text in targets(search.values) if (kind := kind_of(text))}
        raise InputError(f"no law fits: {kinds}; {', '.join(cases)} take '{', '.join(sorted(takes))}'")
    rows, refused = [], list[InputError]()
    for search in [*searches, *yours]:
        try:
            found = tuned(search)
        except InputError as error:
            refused.append(error)
            found = Found(None, None, {}, 0, 0, [str(error)])  # a metric that this comparison does not have
        rows.append(
            {
                "comparison": search.experiment, "law": search.case,
                "whose": "the book's" if search in searches else "yours", "metric": search.metric,
                "as given": found.start, "tuned": found.best, "runs": found.runs, "failed": found.failed,
                "parameters": ", ".join(f"{key}={value:g}" for key, value in found.chosen.items()),
                "to know": "; ".join(found.edges) or ("" if search.ranges else "nothing to tune"),
            }
        )  # fmt: skip
    if len(refused) == len(rows):
        raise refused[0]
    last = float("inf")
    return sorted(rows, key=lambda row: (row["comparison"], last if row["tuned"] is None else sign * row["tuned"]))
