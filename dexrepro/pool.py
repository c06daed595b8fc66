"""The process pool: one process a core, one BLAS thread a process, and no process that outlives the command.

Each worker has a pipe of its own, shares no lock with the others and holds one task at a time: whenever and however it
dies, only its own task fails, and another worker takes its place. Tasks wait here until a worker is free.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import importlib
import multiprocessing
import os
import signal
import sys
import threading
import time
import traceback
import warnings
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any

from dexrepro.closure import is_users
from dexrepro.errors import COMPLETES, InputError, one_line, whole_number

TICK = 0.2  # s between looks at workers whose end nobody announces
BLAS_THREADS = "DEXREPRO_BLAS_THREADS"  # variable of the environment: another count than one, to see what rounding does


WARNED = "it was warned that "
"""Begins a note that an error carries of a warning before it."""


def sentence(error: BaseException) -> str:
    """What went wrong, in one line, and the line of the user's file that did it."""
    told, text, place = isinstance(error, InputError), one_line(error), ""
    if frame := _own_line(error.__cause__ if told else error):
        file = Path(frame.filename)
        file = file.relative_to(Path.cwd()) if file.is_relative_to(Path.cwd()) else file
        text = one_line(error.msg if isinstance(error, SyntaxError) else text or frame.line)
        place = f" ({file}, line {frame.lineno})" if file.name not in text else ""
    said = "".join(f"; {note}" for note in getattr(error, "__notes__", ()) if note.startswith(WARNED))
    return ("" if told else f"{type(error).__name__}: ") + text + place + said


def _own_line(error: BaseException | None) -> traceback.FrameSummary | None:
    """The innermost line of the user's that led to an error; to one without words, of anybody."""
    found = None
    while error is not None:
        frames = [*traceback.extract_tb(error.__traceback__)]
        if isinstance(error, SyntaxError) and error.filename:
            frames.append(traceback.FrameSummary(error.filename, error.lineno, ""))
        own = [frame for frame in frames if is_users(Path(frame.filename))]
        if own or not (found or str(error)):
            found = (own or frames or [None])[-1]
        error = error.__cause__
    return found


@dataclass(frozen=True)
class Failure:
    """Why a task gave no result, in one sentence; ``exit`` is the status of a process that died of it.

    told: the sentence says all, the traceback need not be looked at.
    """

    sentence: str
    traceback: str = ""
    exit: int | None = None
    told: bool = True

    @classmethod
    def of(cls, error: BaseException) -> Failure:
        told = isinstance(error, InputError)
        return cls(sentence(error), "".join(traceback.format_exception(error)), told=told)


@dataclass
class _Task:
    key: Any
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    timeout: float | None
    tries: int = 2  # a worker may be killed between two tasks: what it had not begun is handed on


class Pool:
    """``add`` tasks, then take their ``results`` as they come; tasks may be added on the way.

    workers: processes at most (None: one a core); as many begin as there are tasks. ``report`` is told
    (process, simulated time [s], duration [s]) by the simulations under way, ``tick`` is called while one waits for
    them. here: use no other process.
    Leaving the block, by Ctrl-C too, ends the workers and what they have started.
    """

    def __init__(
        self,
        workers: int | None = None,
        report: Callable[[int, float, float], None] | None = None,
        here: bool = False,
        tick: Callable[[], None] | None = None,
    ) -> None:
        self.size, self.report, self.here, self.tick = workers or available_cores(), report, here, tick
        method = start_method()
        whole_number(BLAS_THREADS, os.environ.get(BLAS_THREADS, "1"), 1, 1024)
        if multiprocessing.get_start_method(allow_none=True) not in (None, *multiprocessing.get_all_start_methods()):
            multiprocessing.set_start_method(method, force=True)  # joblib's own is unknown to what is spawned
        self._context = multiprocessing.get_context(method)
        self._tasks: deque[_Task] = deque()
        self._workers: list[_Worker] = []

    def __enter__(self) -> Pool:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            worker.end()

    def add(self, key: Any, function: Callable[..., Any], *arguments: Any, timeout: float | None = None,
            first: bool = False) -> None:  # fmt: skip
        """One more task, before all that wait if ``first``; ``timeout`` [s] ends it and its process."""
        task = _Task(key, function, arguments, timeout)
        self._tasks.appendleft(task) if first else self._tasks.append(task)

    def results(self) -> Iterator[tuple[Any, Any]]:
        """(key, what the function returned or a Failure) of every task, in the order in which they end."""
        while self.here and self._tasks:
            task = self._tasks.popleft()
            try:
                yield task.key, task.function(*task.arguments)
            except Exception as error:
                yield task.key, Failure.of(error)
        while self._tasks or any(worker.task for worker in self._workers):
            self._hand_out()
            if self.tick:
                self.tick()
            connections = {worker.connection: worker for worker in self._workers}
            for connection in wait(list(connections), TICK):
                worker = connections[connection]
                try:
                    kind, content = worker.connection.recv()
                except (EOFError, OSError):
                    yield from self._buried(worker)
                    continue
                if kind == "begun":
                    worker.started()
                elif kind == "report":
                    if self.report:
                        self.report(*content)
                elif worker.task:
                    key, worker.task = worker.task.key, None
                    yield key, content
            for worker in list(self._workers):
                if not worker.process.is_alive() and not worker.connection.poll():
                    yield from self._buried(worker)
                elif worker.task and time.monotonic() > worker.deadline:
                    worker.end()
                    reason = f"it took longer than case_timeout = {worker.task.timeout:g} s"
                    yield from self._buried(worker, Failure(reason))

    def _hand_out(self) -> None:
        while self._tasks:
            free = next((worker for worker in self._workers if worker.task is None), None)
            if free is None and len(self._workers) < self.size:
                free = _Worker(self._context, [worker.connection for worker in self._workers])
                self._workers.append(free)
            if free is None:
                return
            free.begin(self._tasks.popleft())

    def _buried(self, worker: _Worker, failure: Failure | None = None) -> Iterator[tuple[Any, Failure]]:
        """Take leave of a worker that is gone; its task fails, or is handed on if it had not been begun."""
        if worker not in self._workers:
            return
        self._workers.remove(worker)
        worker.end()
        task = worker.task
        if task is None:
            return
        task.tries -= 1
        if failure is None and not worker.begun and task.tries:
            self._tasks.appendleft(task)
        else:
            yield task.key, failure or _death(worker.process.exitcode or 0)


def _death(status: int) -> Failure:
    """Why a process is gone: killed from outside (a lack of memory does so too), or crashed by itself."""
    name = signal.Signals(-status).name if status < 0 else f"exit status {status}"
    if status in (-getattr(signal, "SIGKILL", 9), -signal.SIGTERM):
        return Failure(f"its process was killed ({name}); {COMPLETES}", exit=status)
    return Failure(f"its process crashed ({name}) in code that it calls; no other case is concerned", exit=status)


class _Worker:
    """One process of the pool, its pipe and the task it has."""

    def __init__(self, context: Any, others: list[Connection]) -> None:
        self.connection, theirs = context.Pipe()
        forked = context.get_start_method() == "fork"
        inherited = [*others, self.connection] if forked else []
        self.process = context.Process(target=serve, args=(theirs, inherited, sys.path), daemon=False)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*fork.*", category=DeprecationWarning)
            self.process.start()
        theirs.close()
        self.task: _Task | None = None
        self.begun, self.deadline = False, float("inf")

    def begin(self, task: _Task) -> None:
        self.task, self.begun, self.deadline = task, False, float("inf")
        with contextlib.suppress(OSError):  # it has just died: the next look finds it
            self.connection.send((task.function, task.arguments))

    def started(self) -> None:
        """It works on its task: until now it may have imported, which is no case's own time."""
        self.begun = True
        if self.task and self.task.timeout:
            self.deadline = time.monotonic() + self.task.timeout

    def end(self) -> None:
        """Kill the process and all that it has started."""
        with contextlib.suppress(OSError):
            if hasattr(os, "killpg") and os.getpgid(self.process.pid) == self.process.pid:
                os.killpg(self.process.pid, signal.SIGKILL)
        self.process.kill()
        self.process.join()
        self.connection.close()


# ------------------------------------------------------------------------------------------------------ in a worker


def serve(connection: Connection, inherited: list[Connection], path: list[str]) -> None:
    """What a worker does: a task after another, until its pipe is closed; it imports from where the command does."""
    sys.path[:] = path  # a process that is spawned would take "" for the folder in which the command began
    for other in inherited:
        other.close()
    forget_edited()
    importlib.import_module(__name__).serve_tasks(connection)


def serve_tasks(connection: Connection) -> None:
    """Receive tasks, send what they return or why they fail; a fork of this process that a law made is left alone."""
    begin_worker(connection)
    me = os.getpid()
    while True:
        try:
            received = connection.recv_bytes()
        except (EOFError, OSError):
            os._exit(0)
        try:
            function, arguments = ForkingPickler.loads(received)
            connection.send(("begun", None))
            answer = ForkingPickler.dumps(("done", function(*arguments)))
        except BaseException as error:
            answer = ForkingPickler.dumps(("done", Failure.of(error)))
        if os.getpid() != me:
            os._exit(0)
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError, AttributeError):
                stream.flush()
        try:
            connection.send_bytes(answer)
        except OSError:  # the command has ended meanwhile
            os._exit(0)


def begin_worker(connection: Connection) -> None:
    """Leave Ctrl-C to the parent, die with it, use one BLAS thread (or so many), report simulated time."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    with contextlib.suppress(OSError, AttributeError):
        os.setpgid(0, 0)  # so that what a law starts can be ended with it
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()
    with contextlib.suppress(OSError, AttributeError):  # where Linux offers it: also in the midst of a long call
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)
    from threadpoolctl import threadpool_limits

    from dexrepro.physics.loop import Progress as Simulation

    threadpool_limits(int(os.environ.get(BLAS_THREADS, 1)))
    gc.freeze()  # what is imported stays; without this the collector walks all of it again and again
    gc.set_threshold(20_000)
    Simulation.report = staticmethod(
        lambda simulated, duration: connection.send(("report", (os.getpid(), simulated, duration)))
    )


def _end_with(parent: Any) -> None:
    parent.join()
    os._exit(1)


def forget_edited() -> None:
    """Let this package be imported anew where one of its files has been edited since it was imported."""
    package = sys.modules["dexrepro"]
    loaded = [(name, getattr(m, "__file__", None)) for name, m in sys.modules.items() if name.startswith("dexrepro")]
    for _, place in loaded:
        with contextlib.suppress(OSError):
            if place and os.stat(place).st_mtime > package.IMPORTED:
                for name, _ in loaded:
                    del sys.modules[name]
                importlib.invalidate_caches()
                return


def start_method() -> str:
    """How processes begin: as DEXREPRO_START or the program says; else by a fork on Linux, which is quick and safe."""
    known, told = multiprocessing.get_all_start_methods(), os.environ.get("DEXREPRO_START")
    if told and told not in known:
        raise InputError(f"DEXREPRO_START = {told} is not allowed: it must be one of {', '.join(known)}")
    chosen = told or multiprocessing.get_start_method(allow_none=True)
    if chosen in known:  # joblib's workers have one of their own
        return chosen
    return "fork" if sys.platform == "linux" else "spawn"


def available_cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
