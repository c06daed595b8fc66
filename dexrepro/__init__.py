"""Reproduce, as simulations, the figures and tables of a robotics book, and check its claims with numbers."""

from __future__ import annotations

import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dexrepro.result import Result

try:
    __version__ = version("dexrepro")
except PackageNotFoundError:  # running from a source tree that was never installed
    __version__ = "0+unknown"

IMPORTED = time.time()
"""When this process read the code; what has been edited since is imported anew in the processes that simulate."""

__all__ = ["__version__", "load", "run"]


def run(chapter: int | str, overrides: list[str] | None = None, **settings: Any) -> dict[str, Result]:
    """Run experiments as ``dexrepro run`` does; returns ``{experiment: Result}``, which a notebook shows.

    settings: ``only``, ``figure``, ``seed``, ``results``, ``workers``, ``force``; overrides: Hydra's grammar, for
    example ``["movement_estimation.stiffness=[25,60]"]``. In a notebook it says what is finished. Raises RuntimeError
    with one sentence a failed case, and dexrepro.errors.InputError for input that cannot be used.
    """
    from dexrepro.plan import plan_chapter
    from dexrepro.progress import of_session
    from dexrepro.result import Result, Results
    from dexrepro.runner import run_plans
    from dexrepro.selection import quoted

    workers, force = settings.pop("workers", None), settings.pop("force", False)
    given = [f"{key}={_text(value)}" for key, value in settings.items()]
    plans, _ = plan_chapter(str(chapter), [*given, *map(quoted, overrides or [])])
    outcome = run_plans(plans, workers=workers, force=force, progress=of_session())
    if outcome.failures:
        raise RuntimeError(outcome.failed)
    return Results((name, Result(folder)) for name, folder in outcome.folders.items())


def load(folder: str | Path) -> Result:
    """A result from its folder, for example ``results/chapter2/movement_estimation``."""
    from dexrepro.result import Result

    return Result(Path(folder))


def _text(value: Any) -> str:
    if isinstance(value, list | tuple):
        return "[" + ",".join(map(_text, value)) + "]"
    from dexrepro.overrides import in_quotes

    return in_quotes(str(value)) if isinstance(value, str | Path) else str(value)
