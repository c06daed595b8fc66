"""A process that dies, crashes, hangs or multiplies concerns its own case alone."""

from __future__ import annotations

import errno
import fcntl
import os
import random
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from conftest import ROOT, Command, whole

from dexrepro import chapters
from dexrepro.plan import plan_chapter
from dexrepro.pool import Failure, Pool
from dexrepro.progress import Silent
from dexrepro.runner import run_plans
from dexrepro.storage import claimed, read_json, remove_leftovers

pytestmark = pytest.mark.usefixtures("bounded")
HALVED = "+decay.cases.halved.fail="


def in_cache(toy: Path) -> set[str]:
    return {path.parent.name.rpartition("-")[0] for path in toy.glob("results/.cache/decay/[!.]*/case.json")}


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        ("kill", "its process was killed (SIGKILL); the same command completes what is missing"),
        ("term", "its process was killed (SIGTERM)"),
        ("abort", "its process crashed (SIGABRT)"),
        ("segv", "its process crashed (SIGSEGV)"),
        ("exit", "its process crashed (exit status 3)"),
        ("leave", "SystemExit: 4"),
        ("interrupt", "KeyboardInterrupt"),
        ("unpicklable", "Unpicklable: cannot travel"),
        ("surrogate", "ValueError: a letter"),
        ("recursion", "RecursionError"),
        ("close", "its process"),
        ("other", "ValueError: told to fail"),
    ],
)
def test_a_case_that_brings_its_process_down_is_named_and_the_others_go_on(
    toy: Path, command: Command, fault: str, sentence: str
) -> None:
    status, said = command(f"run only=decay workers=1 {HALVED}{fault}")
    assert status == 1
    assert "decay.halved failed: " + sentence in " ".join(said.split())
    assert in_cache(toy) == {"plain", "fast", "gain1", "gain2"}
    assert not list(toy.glob("results/runs/*")), "no half result"


def test_a_law_that_crashes_again_is_not_said_to_be_completed(toy: Path, command: Command) -> None:
    said = [command(f"run only=decay workers=1 {HALVED}kill")[1] for _ in range(2)]
    assert "the same command completes" in said[0]
    assert "the same command completes" not in said[1]
    assert "as it did before" in said[1]


def test_a_law_that_crashed_once_is_completed_by_the_same_command(toy: Path, command: Command) -> None:
    assert command(f"run only=decay workers=1 {HALVED}crash_once")[0] == 1
    status, said = command(f"run only=decay workers=1 {HALVED}crash_once")
    assert status == 0
    assert "decay.plain:" not in said, "run again"


@pytest.mark.parametrize("fault", ["thread", "fork", "fork_on"])
def test_a_law_that_starts_a_thread_or_a_process_does_not_keep_the_command(toy: Path, fault: str) -> None:
    start = time.monotonic()
    line = [sys.executable, "-m", "dexrepro", "run", "only=decay", "workers=2", f"{HALVED}{fault}"]
    done = subprocess.run(
        line, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=50, check=False
    )
    assert done.returncode == 0, done.stderr
    assert time.monotonic() - start < 45
    assert len(list(toy.glob("results/runs/*/metrics.json"))) == 1


@pytest.mark.parametrize("fault", ["forever", "deaf"])
def test_a_law_that_never_returns_is_ended_where_that_is_asked_for(toy: Path, command: Command, fault: str) -> None:
    status, said = command(f"run only=decay workers=1 case_timeout=4 {HALVED}{fault}")
    assert status == 1
    assert "decay.halved failed: it took longer than case_timeout = 4 s" in said
    assert in_cache(toy) == {"plain", "fast", "gain1", "gain2"}


@pytest.mark.parametrize("fault", ["elsewhere", "delete", "say", "mute", "mask"])
def test_what_a_law_does_to_its_process_or_to_the_results_spoils_none(toy: Path, command: Command, fault: str) -> None:
    """It changes the folder, deletes the results, prints what is no letter, closes what is said, withdraws rights."""
    status, said = command(f"run only=decay workers=1 {HALVED}{fault}")
    assert status == 0, said
    (result,) = toy.glob("results/runs/[!.]*")
    assert len(read_json(result / "metrics.json")) > 20
    assert in_cache(toy) == {"plain", "fast", "halved", "gain1", "gain2"}
    assert not Path("/results/.cache/decay").exists()


def square(number: int) -> int:
    return number * number


def pause(seconds: float) -> int:
    time.sleep(seconds)
    return os.getpid()


@pytest.mark.parametrize("number", range(3))
def test_a_worker_that_dies_while_it_waits_is_replaced(number: int) -> None:
    with Pool(2) as pool:
        for key in range(2):
            pool.add(key, pause, 0.3)
        idle = [process for _, process in pool.results()]
        for process in random.Random(number).sample(idle, k=1 + number % 2):
            os.kill(process, signal.SIGKILL)
        for key in range(4):
            pool.add(key, square, key)
        assert dict(pool.results()) == {key: key * key for key in range(4)}


def test_a_worker_that_is_killed_at_work_fails_one_task() -> None:
    with Pool(2) as pool:
        for key in range(2):
            pool.add(key, pause, 0.3)
        victim = dict(pool.results())[0]
        for key in "abc":
            pool.add(key, pause, 1.0)
        threading.Timer(0.4, os.kill, (victim, signal.SIGKILL)).start()
        found = dict(pool.results())
    failed = [value for value in found.values() if isinstance(value, Failure)]
    assert [failure.exit for failure in failed] == [-signal.SIGKILL]
    assert set(found) == set("abc")


def test_no_more_processes_than_cases() -> None:
    with Pool(60) as pool:
        for key in range(3):
            pool.add(key, square, key)
        assert dict(pool.results()) == {0: 0, 1: 1, 2: 4}
        assert len(pool._workers) <= 3


def test_results_and_functions_that_cannot_travel_fail_alone() -> None:
    with Pool(1) as pool:
        pool.add("generator", eval, "(x for x in 'abc')")
        pool.add("absent", eval, "no_such_thing")
        pool.add("fine", square, 3)
        found = dict(pool.results())
    assert "cannot pickle" in found["generator"].sentence
    assert "NameError" in found["absent"].sentence
    assert found["fine"] == 9


# ------------------------------------------------------------------------------------------------ kills and interrupts


def start(toy: Path, *words: str) -> subprocess.Popen[str]:
    line = [sys.executable, "-m", "dexrepro", "run", "only=decay", "workers=2", "decay.pause=0.15", *words]
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.Popen(
        line, cwd=toy, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )


def processes_of(group: int) -> int:
    """How many processes are left that a command started (a zombie is none)."""
    left = subprocess.run(["ps", "-eo", "sid=,stat="], capture_output=True, text=True, check=True).stdout
    return sum(line.split()[0] == str(group) and "Z" not in line.split()[1] for line in left.splitlines())


@pytest.mark.parametrize("number", range(6))
def test_whatever_ends_it_at_a_random_moment_nothing_is_lost(toy: Path, toy_result: Path, number: int) -> None:
    kept, rng = whole(toy_result), random.Random(number)
    how = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)[number % 3]
    command = start(toy, f"seed={number + 1}")
    deadline = time.monotonic() + 40
    while not list(toy.glob("results/.cache/decay/*/case.json"))[5:] and time.monotonic() < deadline:
        time.sleep(0.01)
    time.sleep(1.2 * rng.random())
    command.send_signal(how)
    _, said = command.communicate(timeout=20)
    assert "Traceback" not in said
    until = time.monotonic() + 5
    while processes_of(command.pid) and time.monotonic() < until:
        time.sleep(0.05)
    assert not processes_of(command.pid), "a worker outlived its command"
    again = start(toy, f"seed={number + 1}")
    again.communicate(timeout=50)
    assert again.returncode == 0
    assert whole(toy_result) == kept
    assert len(list(toy.glob("results/runs/*/metrics.json"))) == 1
    assert not [path for path in toy.rglob("*") if path.suffix in (".part", ".old")], "half a folder is left"


def test_results_stand_as_soon_as_their_last_case_ends(
    toy: Path, toy_book: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first experiment is on disk before half of the book is simulated; Ctrl-C then keeps it."""
    for name in ("fading", "waning"):
        shutil.copytree(toy_book / "chapter90/decay", toy_book / f"chapter90/{name}")
        for path in (toy_book / f"chapter90/{name}").glob("*.*"):
            path.write_text(path.read_text().replace("decay.", f"{name}.").replace("90.", f"90.{name[0]}"))
    chapters.forget()

    class Watch(Silent):
        finished_cases, stood = 0, 0

        def finished(self, name: str, entry: object) -> None:
            self.finished_cases += 1

        def assembled(self, experiment: str) -> None:
            self.stood = self.stood or self.finished_cases
            if self.finished_cases > 7:
                raise KeyboardInterrupt

    plans, _ = plan_chapter("90")
    watch = Watch()
    with pytest.raises(KeyboardInterrupt):
        run_plans(plans, workers=1, force=False, progress=watch)
    assert watch.stood <= 7, "of 15 cases"
    assert len(list(toy.glob("results/chapter90/*/metrics.json"))) == 2


def test_a_result_that_was_set_aside_comes_back(toy: Path, toy_result: Path, command: Command) -> None:
    kept = whole(toy_result)
    toy_result.rename(toy_result.parent / ".decay-0123456789ab.old")
    (toy_result.parent / ".decay-0123456789ab.part").mkdir()
    remove_leftovers(toy_result.parent)
    assert whole(toy_result) == kept
    assert command("check")[0] in (0, 1)


APART = ["unshare", "--map-root-user", "--pid", "--fork", "--kill-child"]
CONTAINER = """
import errno, fcntl, time
from pathlib import Path
from dexrepro.storage import claimed, whole_folder

def none(*_):
    raise OSError(errno.ENOSYS, "no locks")

if not {flock}:
    fcntl.flock = none
with claimed(Path("results"), "case"), whole_folder(Path("results/mine")) as folder:
    (folder / "half").touch()
    print(folder, flush=True)
    time.sleep(60)
"""


def no_locks(*_: object) -> None:
    raise OSError(errno.ENOSYS, "no locks")


@pytest.mark.parametrize("flock", [True, False])
def test_the_work_of_another_container_of_the_same_host_name_is_no_leftover(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, flock: bool
) -> None:
    """Its processes are numbered anew; also where the file system has no locks, and files say who holds them."""
    if shutil.which("unshare") is None or subprocess.run([*APART, "true"], stderr=subprocess.DEVNULL).returncode:
        pytest.skip("no processes numbered apart can be started here")
    monkeypatch.chdir(tmp_path)
    Path("results").mkdir()
    if not flock:
        monkeypatch.setattr(fcntl, "flock", no_locks)
    line = [*APART, sys.executable, "-W", "ignore", "-c", CONTAINER.format(flock=flock)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(line, env=environment, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout
        folder = Path(other.stdout.readline().strip())
        remove_leftovers(Path("results"))
        assert (folder / "half").exists()
        with claimed(Path("results"), "case", wait=False) as mine:
            assert not mine
        other.kill()
        other.stdout.read()  # until all of its processes are gone
    if flock:
        remove_leftovers(Path("results"))
        assert not list(Path("results").glob(".*-*"))


def test_two_commands_at_once_write_one_whole_result(toy: Path) -> None:
    both = [start(toy, "decay.noise=0.1") for _ in range(2)]
    assert [process.communicate(timeout=50) and process.returncode for process in both] == [0, 0]
    assert len(list(toy.glob("results/runs/*/metrics.json"))) == 1
    assert len(list(toy.glob("results/.cache/decay/*/case.json"))) == 5
    assert read_json(next(toy.glob("results/runs/*/run.json")))["seed"] == 0
    assert not (toy / "results/chapter90").exists()
