"""What the user sees while cases run: a bar on a terminal, one line a case when piped, nothing when quiet."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Protocol

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as RichProgress

if TYPE_CHECKING:
    from dexrepro.runner import CaseEntry


class Progress(Protocol):
    """Told by the runner what happens."""

    def begin(self, cases: int) -> None: ...
    def report(self, process: int, simulated: float, duration: float) -> None: ...
    def note(self, sentence: str) -> None: ...
    def finished(self, name: str, entry: CaseEntry) -> None: ...
    def failed(self, name: str, sentence: str) -> None: ...
    def assembled(self, experiment: str) -> None: ...


class Silent:
    """Shows nothing."""

    def begin(self, cases: int) -> None:
        pass

    def report(self, process: int, simulated: float, duration: float) -> None:
        pass

    def note(self, sentence: str) -> None:
        pass

    def finished(self, name: str, entry: CaseEntry) -> None:
        pass

    def failed(self, name: str, sentence: str) -> None:
        pass

    def assembled(self, experiment: str) -> None:
        pass


class Lines(Silent):
    """One line a finished case."""

    def __init__(self, console: Console) -> None:
        self.console = console

    def note(self, sentence: str) -> None:
        self.console.print(sentence, highlight=False, markup=False, soft_wrap=True)

    def finished(self, name: str, entry: CaseEntry) -> None:
        self.note(case_line(name, entry))

    def failed(self, name: str, sentence: str) -> None:
        self.note(f"{name}: failed: {sentence}")


def of_session() -> Silent:
    """What a Python session sees: a line a finished case in a notebook, nothing elsewhere."""
    return Lines(Console(force_jupyter=False)) if Console().is_jupyter else Silent()


class Bar(Lines):
    """A bar over all cases, with simulated seconds and speed of those under way."""

    def __init__(self, console: Console) -> None:
        super().__init__(console)
        self.bar = RichProgress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            console=console,
            transient=True,
        )
        self.latest: dict[int, tuple[float, float, float, float]] = {}

    def begin(self, cases: int) -> None:
        self.task = self.bar.add_task("running", total=cases)
        self.bar.start()

    def report(self, process: int, simulated: float, duration: float) -> None:
        now = time.monotonic()
        before, then = self.latest.get(process, (0.0, now, 0.0, 0.0))[:2]
        speed = (simulated - before) / (now - then) if simulated > before and now > then else 0.0
        self.latest[process] = (simulated, now, duration, speed)
        active = [entry for entry in self.latest.values() if now - entry[1] < 3]
        text = ", ".join(f"{t:.0f}/{total:.0f} s ({speed:.0f}x)" for t, _, total, speed in active)
        self.bar.update(self.task, description=f"simulated {text}" if text else "running")

    def finished(self, name: str, entry: CaseEntry) -> None:
        super().finished(name, entry)
        self.bar.advance(self.task)

    def failed(self, name: str, sentence: str) -> None:
        super().failed(name, sentence)
        self.bar.advance(self.task)

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self.bar.stop()


def case_line(name: str, entry: CaseEntry) -> str:
    """One line about a finished case."""
    parts = [f"{entry.wall:.1f} s"]
    if entry.real_time_factor:
        parts.append(f"{entry.simulated:g} s simulated, {entry.real_time_factor:.0f}x real time")
    if entry.status != "finished":
        parts.append(entry.status)
    return f"{name}: {'; '.join(parts)}"
