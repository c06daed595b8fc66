"""What the user sees while cases run: a bar on a terminal, one line a case when piped, nothing when quiet."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any, Protocol

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as RichProgress


class Progress(Protocol):
    """Told by the runner what happens."""

    def listen(self, queue: Any) -> None: ...
    def begin(self, cases: int) -> None: ...
    def refresh(self) -> None: ...
    def finished(self, name: str, entry: Mapping[str, Any]) -> None: ...
    def failed(self, name: str, sentence: str) -> None: ...
    def assembled(self, experiment: str) -> None: ...


class Silent:
    """Shows nothing; keeps the workers' queue empty."""

    queue: Any = None

    def listen(self, queue: Any) -> None:
        self.queue = queue

    def begin(self, cases: int) -> None:
        pass

    def refresh(self) -> None:
        self.reports()

    def reports(self) -> list[tuple[int, float, float]]:
        """What the workers have said since the last call: (process, simulated time [s], duration [s])."""
        found = []
        while self.queue is not None and not self.queue.empty():
            found.append(self.queue.get())
        return found

    def finished(self, name: str, entry: Mapping[str, Any]) -> None:
        pass

    def failed(self, name: str, sentence: str) -> None:
        pass

    def assembled(self, experiment: str) -> None:
        pass


class Lines(Silent):
    """One line a finished case."""

    def __init__(self, console: Console) -> None:
        self.console = console

    def finished(self, name: str, entry: Mapping[str, Any]) -> None:
        self.console.print(case_line(name, entry), highlight=False, soft_wrap=True)

    def failed(self, name: str, sentence: str) -> None:
        self.console.print(f"{name}: failed: {sentence}", highlight=False, soft_wrap=True)


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

    def refresh(self) -> None:
        now = time.monotonic()
        for process, simulated, duration in self.reports():
            before, then = self.latest.get(process, (0.0, now, 0.0, 0.0))[:2]
            speed = (simulated - before) / (now - then) if simulated > before and now > then else 0.0
            self.latest[process] = (simulated, now, duration, speed)
        active = [entry for entry in self.latest.values() if now - entry[1] < 3]
        text = ", ".join(f"{t:.0f}/{total:.0f} s ({speed:.0f}x)" for t, _, total, speed in active)
        self.bar.update(self.task, description=f"simulated {text}" if text else "running")

    def finished(self, name: str, entry: Mapping[str, Any]) -> None:
        super().finished(name, entry)
        self.bar.advance(self.task)

    def failed(self, name: str, sentence: str) -> None:
        super().failed(name, sentence)
        self.bar.advance(self.task)

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self.bar.stop()


def case_line(name: str, entry: Mapping[str, Any]) -> str:
    """One line about a finished case."""
    parts = [f"{entry['wall']:.1f} s"]
    if entry["simulated"]:
        parts.append(f"{entry['simulated']:g} s simulated, {entry['real_time_factor']:.0f}x real time")
    if entry["status"] != "finished":
        parts.append(entry["status"])
    return f"{name}: {'; '.join(parts)}"
