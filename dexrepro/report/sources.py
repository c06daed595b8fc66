"""The code behind the results as pages of the report: each line has an anchor, so that a claim can point at it."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

from dexrepro.config import config_dir

TOP = Path(__file__).parents[2]


def label(path: Path) -> str:
    """A file's name as a reader knows it: from the top of the checkout, or from the folder that holds the user's."""
    for top in (TOP, config_dir().parent, Path.cwd()):
        if path.is_relative_to(top):
            return str(path.relative_to(top))
    return str(Path(path.parent.name) / path.name)


def place(thing: Any) -> tuple[Path, int]:
    """File and line where a function, class or module is defined."""
    file = Path(inspect.getsourcefile(thing) or "")
    return file, 1 if inspect.ismodule(thing) else inspect.getsourcelines(thing)[1]


class Sources:
    """Remembers the files that pages of a report point at, and writes a page for each."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.wanted = folder, dict[Path, str]()

    def link(self, path: Path, line: int) -> dict[str, Any]:
        """``to`` for an ``href``, and ``label`` ("dexrepro/control/barrier.py:27") for its text."""
        name = self.wanted.setdefault(path, label(path).replace("/", "-"))
        return {"to": f"source/{name}.html#L{line}", "label": f"{label(path)}:{line}"}

    def pages(self) -> list[dict[str, Any]]:
        """What the template needs for each file: target, label and lines."""
        return [
            {"target": f"source/{name}.html", "label": label(path), "lines": path.read_text("utf-8").splitlines()}
            for path, name in sorted(self.wanted.items())
        ]
