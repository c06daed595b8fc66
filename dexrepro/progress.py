"""What the user sees while cases run: a bar on a terminal, lines when piped, nothing when quiet."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as RichProgress

from dexrepro.timings import duration, timings

if TYPE_CHECKING:
    from dexrepro.result import CaseEntry


class Silent:
    """Told by the runner what happens, and shows nothing; ``tick`` is called several times a second."""

    def begin(self, cases: Sequence[str], processes: int) -> None: ...
    def tick(self) -> None: ...
    def report(self, process: int, simulated: float, duration: float) -> None: ...
    def note(self, sentence: str) -> None: ...
    def finished(self, name: str, entry: CaseEntry) -> None: ...
    def failed(self, name: str, sentence: str) -> None: ...
    def assembled(self, experiment: str) -> None: ...


SILENCE = 10.0  # s after which a line says how far it is
LONG = 20.0  # s: a run that takes longer says so when it begins


class Lines(Silent):
    """One line a finished case, and one at least every ten seconds; how long it will take, where that was measured."""

    def __init__(self, console: Console) -> None:
        self.console, self.told, self.processes = console, time.monotonic(), 1
        self.expected: dict[str, float] = {}  # s, of the cases that are not finished yet
        self.waiting, self.cases, self.wall, self.foreseen = 0, 0, 0.0, 0.0
        self.latest: dict[int, tuple[float, float, float, float]] = {}

    def begin(self, cases: Sequence[str], processes: int) -> None:
        self.expected, self.processes = expected(cases), max(1, min(processes, len(cases)))
        self.cases = self.waiting = len(cases)
        if self.left() > LONG:
            beside = len(cases) - len(self.expected)
            unknown = f", not counting {beside} that were never timed" if beside else ""
            on = f"{self.processes} processes" if self.processes > 1 else "one process"
            self.note(f"{len(cases)} cases on {on} take about {duration(self.left())}{unknown}")

    def left(self) -> float:
        """Seconds to go [s]: what the cases took when they were measured, at this machine's pace so far."""
        pace = self.wall / self.foreseen if self.foreseen > 1 else 1.0
        return sum(self.expected.values()) * pace / self.processes

    def tick(self) -> None:
        if self.waiting and time.monotonic() - self.told > SILENCE:
            self.note(f"{self.cases - self.waiting} of {self.cases} cases{self.under_way()}{self.to_go()}")

    def under_way(self) -> str:
        now = time.monotonic()
        active = [entry for entry in self.latest.values() if now - entry[1] < 3]
        text = ", ".join(f"{t:.0f}/{total:.0f} s ({speed:.0f}x)" for t, _, total, speed in active)
        return f", simulated {text}" if text else ""

    def to_go(self) -> str:
        return f", about {duration(self.left())} to go" if self.left() > 1 else ""

    def report(self, process: int, simulated: float, duration: float) -> None:
        now = time.monotonic()
        before, then = self.latest.get(process, (0.0, now, 0.0, 0.0))[:2]
        speed = (simulated - before) / (now - then) if simulated > before and now > then else 0.0
        self.latest[process] = (simulated, now, duration, speed)

    def note(self, sentence: str) -> None:
        self.console.print(sentence, highlight=False, markup=False, soft_wrap=True)
        self.told = time.monotonic()

    def finished(self, name: str, entry: CaseEntry) -> None:
        self.waiting -= 1
        if name in self.expected:
            self.wall, self.foreseen = self.wall + entry.wall, self.foreseen + self.expected.pop(name)
        self.note(case_line(name, entry))

    def failed(self, name: str, sentence: str) -> None:
        self.waiting -= 1
        self.expected.pop(name, None)
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

    def begin(self, cases: Sequence[str], processes: int) -> None:
        super().begin(cases, processes)
        self.task = self.bar.add_task("running", total=len(cases))
        self.bar.start()

    def tick(self) -> None:
        said = f"running{self.under_way()}{self.to_go()}"
        self.bar.update(self.task, description=said, completed=self.cases - self.waiting)

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self.bar.stop()


def expected(cases: Sequence[str]) -> dict[str, float]:
    """Seconds [s] that each case ``experiment.case`` took when it was measured; of a new one its experiment's mean."""
    seconds: dict[str, float] = timings().get("cases", {})
    by_experiment: dict[str, list[float]] = {}
    for name, value in seconds.items():
        by_experiment.setdefault(name.partition(".")[0], []).append(value)
    means = {name: sum(values) / len(values) for name, values in by_experiment.items()}
    known = {name: seconds.get(name, means.get(name.partition(".")[0])) for name in cases}
    return {name: value for name, value in known.items() if value is not None}


def case_line(name: str, entry: CaseEntry) -> str:
    """One line about a finished case."""
    parts = [f"{entry.wall:.1f} s"]
    if entry.real_time_factor:
        parts.append(f"{entry.simulated:g} s simulated, {entry.real_time_factor:.0f}x real time")
    if entry.status != "finished":
        parts.append(entry.status)
    return f"{name}: {'; '.join(parts)}"
