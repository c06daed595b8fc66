"""The set-up finds or fetches a Python with wheels, or says what to install; stubs stand for interpreters and tools."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT

pytestmark = pytest.mark.skipif(
    (platform.system(), platform.machine()) != ("Linux", "x86_64"), reason="PyBullet has wheels for Linux on x86_64"
)
TOOLS = ("sh", "env", "dirname", "basename", "uname", "cat", "chmod", "mkdir", "rm", "cp", "sed")
STUB = """#!/bin/sh
case "$1 $2" in
    "-c "*) echo {version} ;;
    "-m venv") for last; do :; done
        mkdir -p $last/bin; cp "$0" $last/bin/python; echo "{version} venv $last" >> {log} ;;
    "-m pip") echo "{version} $*" >> {log}; {pip} ;;
esac
"""
UV = """#!/bin/sh
echo "uv $*" >> {log}
{then}
for last; do :; done
mkdir -p $last/bin; cp {python} $last/bin/python
"""


class Machine:
    """A machine of stubs: what its PATH has, and what was called."""

    def __init__(self, folder: Path) -> None:
        self.path, self.log, self.project = folder / "path", folder / "log", folder / "project"
        for made in (self.path, self.project / ".ci"):
            made.mkdir(parents=True)
        for name in ("environment", "lock.txt"):
            shutil.copy(ROOT / ".ci" / name, self.project / ".ci")
        for tool in TOOLS:
            (self.path / tool).symlink_to(str(shutil.which(tool)))
        self.python("3.11", self.project.parent / "fetched")

    def python(self, version: str, file: Path | None = None, pip: str = "true") -> Path:
        return self.put(file or self.path / f"python{version}", STUB.format(version=version, log=self.log, pip=pip))

    def put(self, file: Path, text: str) -> Path:
        file.write_text(text)
        file.chmod(0o755)
        return file

    def uv(self, then: str = "") -> str:
        return UV.format(log=self.log, then=then, python=self.project.parent / "fetched")

    def set_up(self, *arguments: str) -> tuple[int, str, list[str]]:
        command = [str(self.project / ".ci/environment"), "dev", *arguments]
        env = {"PATH": str(self.path), "HOME": os.environ.get("HOME", "/")}
        done = subprocess.run(command, env=env, capture_output=True, text=True, check=False, timeout=60)
        return done.returncode, done.stderr, self.log.read_text().splitlines() if self.log.exists() else []


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    return Machine(tmp_path)


def installed(calls: list[str]) -> str:
    return next(line for line in calls if "--require-hashes -r .ci/lock.txt" in line)


def test_a_python_with_wheels_is_used_wherever_it_stands_and_nothing_is_compiled(machine: Machine) -> None:
    machine.python("3.13")
    machine.python("3.11", machine.path / "python3")
    status, _, calls = machine.set_up()
    assert status == 0
    assert calls[0] == "3.11 venv .venv"
    assert "--only-binary :all:" in installed(calls)


def test_the_project_follows_with_the_same_versions(machine: Machine) -> None:
    machine.python("3.11.9", machine.path / "python3")
    machine.set_up()
    assert machine.set_up()[2][-1].endswith("-c .venv/pins.txt -e .[dev]")
    pins = (machine.project / ".venv/pins.txt").read_text().splitlines()
    assert "numpy==" in "".join(pin[:7] for pin in pins)
    assert len(pins) == (ROOT / ".ci/lock.txt").read_text().count("==")


@pytest.mark.parametrize("version", ["3.10", "3.11.2", "3.12", "3.13", "3.14"])
def test_where_there_is_another_python_pip_brings_uv_and_uv_a_python(machine: Machine, version: str) -> None:
    pip = f'd=$(dirname "$0"); cp {machine.path / "uv-to-be"} $d/uv'
    machine.put(machine.path / "uv-to-be", machine.uv())
    machine.python(version, pip=pip)
    (machine.path / "python3").symlink_to(machine.path / f"python{version}")
    status, said, calls = machine.set_up()
    assert status == 0, said
    assert "--only-binary :all: uv==" in calls[1]
    assert "venv --quiet --seed --allow-existing --python 3.11" in calls[2]
    assert installed(calls).startswith("3.11 -m pip install")
    assert "uv fetches one" in said


def test_with_no_python_at_all_uv_on_the_path_brings_one(machine: Machine) -> None:
    machine.put(machine.path / "uv", machine.uv())
    status, _, calls = machine.set_up()
    assert status == 0
    assert installed(calls).startswith("3.11 -m pip install")


def test_conda_is_asked_where_uv_cannot_fetch(machine: Machine) -> None:
    machine.put(machine.path / "uv", machine.uv("exit 2"))
    machine.put(machine.path / "micromamba", machine.uv().replace("for last", "set -- $PWD/.venv; for last"))
    status, said, calls = machine.set_up()
    assert status == 0, said
    assert "--file .ci/environment.yml" in calls[1]
    assert calls[2] == "3.11 -m pip install --quiet --disable-pip-version-check --no-deps -e ."


@pytest.mark.parametrize("version", ["3.12.3", "3.13.5", "3.14.0"])
def test_where_nothing_can_be_fetched_a_newer_python_simulates_with_mujoco(machine: Machine, version: str) -> None:
    name = machine.path / f"python{version[:4]}"
    machine.python(version, name, pip='case "$*" in *uv==*) exit 1 ;; esac')
    (machine.path / "python3").symlink_to(name)
    status, said, calls = machine.set_up()
    assert status == 0
    assert said.startswith(f"dexrepro: Python {version} is used, for which PyBullet has no wheel: MuJoCo simulates")
    assert not any("lock.txt" in line for line in calls), "PyBullet is pinned there"
    assert "--only-binary :all:" in calls[-1]
    assert calls[-1].endswith("-c .venv/pins.txt -e .[dev]")


def test_where_nothing_can_be_fetched_two_sentences_say_what_to_install(machine: Machine) -> None:
    machine.python("3.10", pip="exit 1")
    status, said, calls = machine.set_up()
    assert status == 1
    assert said.splitlines()[0] == "dexrepro: no Python 3.11 was found, and neither uv nor conda could fetch one."
    assert said.splitlines()[1].startswith("dexrepro: Install Python 3.11.5 or newer ")
    assert len(said.splitlines()) == 2
    assert not any("lock.txt" in line for line in calls)


def test_a_python_that_is_asked_for_is_taken_or_refused(machine: Machine) -> None:
    machine.python("3.13", pip='echo "ERROR: no wheel"; exit 1')
    status, said, _ = machine.set_up(str(machine.path / "python3.13"))
    assert status == 1
    assert "for Python 3.13" in said
    status, said, _ = machine.set_up("python3.9")
    assert status == 1
    assert said == "dexrepro: PYTHON = python3.9 does not run here.\n"


def test_an_environment_that_suits_is_kept(machine: Machine) -> None:
    machine.python("3.11")
    machine.set_up()
    _, _, calls = machine.set_up()
    assert sum(" venv " in line for line in calls) == 1
