"""The process pool: one process a core, one BLAS thread a process, and no process that outlives the command."""

from __future__ import annotations

import contextlib
import ctypes
import gc
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from typing import Any

Submit = Callable[..., Future[Any]]


@contextlib.contextmanager
def pool(
    workers: int | None, listen: Callable[[Any], None] | None = None, in_process: bool = False
) -> Iterator[Submit]:
    """``submit(function, *arguments)`` to ``workers`` processes (None: one a core), or to this process.

    ``listen`` is handed the queue on which the workers say (process, simulated time [s], duration [s]) and must keep it
    empty. An exception inside the block, Ctrl-C among them, ends the workers at once.
    """
    if in_process:
        yield _submit_here
        return
    import dexrepro.physics.loop  # noqa: F401  imported once, before the processes fork

    context = multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")
    queue = context.SimpleQueue() if listen else None
    if listen:
        listen(queue)
    executor = ProcessPoolExecutor(
        workers or available_cores(), mp_context=context, initializer=begin_worker, initargs=(queue,)
    )
    try:
        yield executor.submit
    except BaseException:
        for process in list(executor._processes.values()):
            process.kill()
        executor.shutdown(wait=False, cancel_futures=True)
        raise
    executor.shutdown()


def _submit_here(function: Callable[..., Any], *arguments: Any) -> Future[Any]:
    future: Future[Any] = Future()
    try:
        future.set_result(function(*arguments))
    except Exception as error:
        future.set_exception(error)
    return future


def begin_worker(queue: Any) -> None:
    """Leave Ctrl-C to the parent, die with it, use one BLAS thread, and report simulated time."""
    from threadpoolctl import threadpool_limits

    from dexrepro.physics.loop import Progress as Simulation

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)
    threadpool_limits(1)
    gc.freeze()  # what is imported stays; without this the collector walks all of it again and again
    gc.set_threshold(20_000)
    if queue is not None:
        Simulation.report = staticmethod(lambda simulated, duration: queue.put((os.getpid(), simulated, duration)))


def available_cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
