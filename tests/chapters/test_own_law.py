"""A law of the user's own joins every comparison of its kind, in every chapter and in the scene of the user's own."""

from __future__ import annotations

import re
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import case, rng

from dexrepro import chapters
from dexrepro.case import run, watched
from dexrepro.config import compose_chapter
from dexrepro.control.contract import Command, Measured, check, report
from dexrepro.control.motion import Motion, rest
from dexrepro.errors import InputError
from dexrepro.own_code import check_own
from dexrepro.physics.drive import JointDrive, Limited
from dexrepro.physics.loop import LawFailed
from dexrepro.physics.world import World
from dexrepro.pool import sentence
from dexrepro.robots.planar import planar


class Told:
    """What the law was told last, for the test to look at."""

    measured: Measured[Any]
    desired: Motion[Any]
    calls = resets = 0


class Joint:
    """A weak spring to the desired joint angles, with a little damping applied implicitly."""

    kind = "joint"

    def reset(self, measured: Measured[Any]) -> None:
        Told.resets += 1

    def __call__(self, measured: Measured[Any], desired: Motion[Any]) -> Command:
        Told.measured, Told.desired, Told.calls = measured, desired, Told.calls + 1
        return Command(0.1 * (desired.position - measured.position), 0.01 * np.ones_like(measured.position))


class EndPoint(Joint):
    """A weak spring to the desired end point."""

    kind = "end_point"

    def __call__(self, measured: Measured[Any], desired: Motion[Any]) -> Command:
        Told.measured, Told.desired, Told.calls = measured, desired, Told.calls + 1
        return Command(force=desired.position - measured.position)


class Holding(Joint):
    """Stays where contact began."""

    kind = "holding"

    def __call__(self, measured: Measured[Any]) -> float:  # type: ignore[override]
        Told.measured, Told.calls = measured, Told.calls + 1
        return 0.0


class PlainHolding:
    """The same in the plain shape, which declares no kind."""

    def reset(self, position: float) -> None:
        Told.resets += 1

    def __call__(self, position: float, force: float) -> float:
        Told.measured, Told.calls = Measured(0.0, position, 0.0, force), Told.calls + 1
        return 0.0


class Forgetful:
    """A joint law without its kind, which can be called with two arguments, too."""

    def reset(self, measured: Measured[Any]) -> None: ...

    def __call__(self, measured: Measured[Any], desired: Motion[Any]) -> Command:
        return Command(desired.position - measured.position)


LAWS = {law.kind: law for law in (Joint, EndPoint, Holding)}
KINDS = {"1": "holding", "2": "holding", "3": "joint", "4": "end_point", "5": "joint", "6": "joint", "7": "joint",
         "8": "end_point"}  # fmt: skip
COMPARISONS = [
    (number, name)
    for number in KINDS
    for name, block in compose_chapter(number).items()
    if isinstance(block, dict) and "law" in block and name != "shared"
]


LATCH = "latch: {threshold: -1.0, samples: 1, release: -1.0, release_samples: 1}"
#: What a case says beside its law: one value where a list is studied, and no waiting for contact.
BESIDE = {
    "rigid_boxes": (LATCH,),
    "hand_over": (LATCH,),
    "movement_estimation": ("stiffness: 35, period: 20",),
    "balloon_static": ("contact_force: -1.0",),
    "balloon_movement": ("contact_force: -1.0",),
    "grasp_through_opening": ("choice: random",),
    "bounded_tracking": ("hand.letter: w",),
    "obstacle_tracking": ("goal: 4",),
    "impedance_stability": ("stiffness_gain: 10.0",),
}


def test_every_chapter_has_a_comparison() -> None:
    assert {number for number, _ in COMPARISONS} == set(KINDS)
    assert len(COMPARISONS) == 27


@pytest.fixture
def brief(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every run of a world ends after a few steps."""
    run = World.run

    def few(world: World, duration: float, *arguments: Any, **options: Any) -> Any:
        period = options.get("control_period") or world.step
        return run(world, min(duration, 6 * period), *arguments, **options)

    monkeypatch.setattr(World, "run", few)
    Told.calls = Told.resets = 0


@pytest.mark.parametrize(
    ("number", "name", "law"),
    [
        *((number, name, LAWS[KINDS[number]]) for number, name in COMPARISONS),
        *((number, name, PlainHolding) for number, name in COMPARISONS if KINDS[number] == "holding"),
    ],
)
@pytest.mark.usefixtures("brief")
def test_a_law_of_its_kind_joins_the_comparison(number: str, name: str, law: type) -> None:
    mine = ", ".join((f"law: {{_target_: test_own_law.{law.__name__}}}", *BESIDE.get(name, ())))
    config = case(number, name, "mine", f"+{name}.cases.mine={{{mine}}}", seed=1)
    experiment = chapters.load(number).experiment(name)
    recording = experiment.simulation.simulate(config, rng(name, seed=1))
    assert Told.calls > 0
    assert Told.resets > 0
    assert np.isfinite(np.concatenate([np.ravel(part) for part in Told.measured[:4]])).all()
    measured = [recording[channel] for channel in recording.series if channel.startswith(("arm.", "follower."))]
    assert all(np.isfinite(values).all() for values in measured)


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.usefixtures("brief")
def test_a_law_of_each_kind_drives_the_own_scene(kind: str) -> None:
    arm = "scene.arm={_target_: dexrepro.robots.planar.planar, lengths: [0.4, 0.3], masses: [1.0, 0.8]}"
    leader = "scene.leader={line: {start: [0.5, 0.1, 0], end: [0.55, 0.15, 0], period: 4}}"
    law = f"scene.law={{_target_: test_own_law.{LAWS[kind].__name__}}}"
    given = (arm, leader, law, "scene.start=[-0.5, 1.0]", "scene.offset=[-0.1, 0, 0]")
    config = case("own", "scene", "default", *given)
    recording = chapters.load("own").experiment("scene").simulation.simulate(config, None)
    assert Told.calls == 6
    assert Told.resets > 0
    assert np.ndim(Told.measured.position) == (0 if kind == "holding" else 1)
    assert np.isfinite(recording["arm.torque"]).all()


def test_a_law_of_another_kind_is_refused_with_one_sentence() -> None:
    with pytest.raises(ValueError, match="law Holding is of kind 'holding'; here a law of kind 'joint' is wanted"):
        check(Holding(), "joint")
    with pytest.raises(ValueError, match="object is no law: its class must declare kind = 'holding'"):
        check(object(), "holding")


class Broken(Joint):
    """Divides by zero."""

    def __call__(self, measured: Measured[Any], desired: Motion[Any]) -> Command:
        raise ZeroDivisionError("float division by zero")


OWN = """class Mine:
    kind = "holding"
    def reset(self, measured): ...
    def __call__(self, measured): return 0.0
"""


@pytest.mark.parametrize(
    ("target", "change", "sentence"),
    [
        ("law_a.Mine", ("(self, measured): return", "(self, position, force): return"), "have __call__.self, measured"),
        (
            "law_b.Mine",
            ("def reset(self, measured)", "def reset(self)"),
            "kind 'holding': it must have reset.self, mea",
        ),
        ("law_c.Mine", ("    def reset(self, measured): ...\n", ""), "it must have reset.self, measured."),
        ("law_d.Mine", ("    def __call__(self, measured): return 0.0\n", ""), "it must have __call__.self, measured."),
        ("law_e.Mine", ("holding", "joint"), "it must have __call__.self, measured, desired."),
        ("law_f.Min", ("", ""), "law_f.Min: .*law_f.py has no 'Min'; did you mean 'Mine'"),
        ("signal.Mine", ("", ""), r"'signal' is a module already \(.+\); rename .*signal.py"),
        (
            "law_g.Mine",
            ("class", "from .law_f import Mine as Base\nclass"),
            "name the law with its folder, or import wi",
        ),
        ("law_h.Mine", ("class", "@__import__('dataclasses').dataclass\nclass"), None),
        ("law_i.part.Mine", ("class", "from . import part\nclass"), None),
        ("law_j.Mine", ("(self, measured): return", "(self, measured, gain=1.0): return"), None),
        ("fractions.Fraction", ("", ""), None),
        ("dexrepro.control.joint_pd.JointP", ("", ""), "joint_pd.py has no 'JointP'; did you mean 'JointPD'"),
    ],
)
def test_a_law_that_is_not_there_or_cannot_be_called_gets_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, target: str, change: tuple[str, str], sentence: str | None
) -> None:
    monkeypatch.setattr(sys, "path", [*sys.path, str(tmp_path)])
    place = (tmp_path / Path(*target.split(".")[:-1])).with_suffix(".py")
    place.parent.mkdir(parents=True, exist_ok=True)
    if not target.startswith("dexrepro."):
        place.write_text(OWN.replace(*change, 1))
    with pytest.raises(InputError, match=sentence) if sentence else nullcontext():
        check_own({"law": {"_target_": target}})


@pytest.mark.parametrize(("value", "shown"), [("thirty", "'thirty'"), ([1], "[1]"), (None, "null")])
def test_what_stands_where_a_law_wants_a_number_is_named(value: Any, shown: str) -> None:
    law = {"_target_": "dexrepro.control.computed_torque.ComputedTorque", "frequency": value}
    with pytest.raises(InputError, match=re.escape(f"cases.a.frequency = {shown} is not allowed: it must be a number")):
        check_own({"cases": {"a": law}})


def test_a_law_that_forgot_its_kind_hears_that_it_was_taken_for_a_plain_one() -> None:
    mine = "+holding_comparison.cases.mine={law: {_target_: test_own_law.Forgetful}}"
    config = case("2", "holding_comparison", "mine", mine, seed=1)
    with pytest.raises(
        LawFailed, match=r"the law Forgetful \(of no kind, so told position and force\) of arm 'follower'"
    ):
        chapters.load("2").experiment("holding_comparison").simulation.simulate(config, rng("holding_comparison"))


class Ends(EndPoint):
    """Does what it is told from 5 ms on."""

    does: Any = None

    def __call__(self, measured: Measured[Any], desired: Motion[Any]) -> Command:
        return super().__call__(measured, desired) if measured.time < 0.005 else Ends.does(measured.position)


def unsolved(_: Any) -> None:
    raise RuntimeError("my solver\ndid not converge")


@pytest.mark.parametrize(
    ("does", "told"),
    [
        (unsolved, r"RuntimeError: my solver did not converge \(\S*test_own_law.py, line \d+\)$"),
        (lambda position: None, r"AttributeError: .*; a law of kind 'end_point' must give Command\(force=...\), a f"),
        (lambda position: position, r"AttributeError: .*; a law of kind 'end_point' must give Command\(force="),
        (lambda position: Command(force=np.zeros(7)), r"ValueError: .*; a law of kind 'end_point' must give Command"),
        (lambda position: Command(np.zeros(7)), r"it gave .*; a law of kind 'end_point' must give .*Command\(torque\)"),
    ],
    ids=["raises", "none", "array", "axes", "joints"],
)
def test_whatever_a_law_does_that_ends_its_run_is_told_with_the_time_and_what_to_give(does: Any, told: str) -> None:
    arm = "scene.arm={_target_: dexrepro.robots.planar.planar, lengths: [0.4, 0.3], masses: [1.0, 0.8]}"
    leader = "scene.leader={line: {start: [0.5, 0.1, 0], end: [0.55, 0.15, 0], period: 4}}"
    Ends.does = does
    config = case("own", "scene", "default", arm, leader, "scene.law={_target_: test_own_law.Ends}", seed=1)
    with pytest.raises(LawFailed) as caught:
        run(watched(chapters.load("own").experiment("scene"), []), config, 1)
    assert re.match(rf"LawFailed: the law Ends of arm 'arm' failed at 0.005 s: {told}", sentence(caught.value))


def test_the_own_scene_takes_laws_of_every_kind_so_that_each_must_declare_its_own() -> None:
    arm = "scene.arm={_target_: dexrepro.robots.planar.planar, lengths: [0.4, 0.3], masses: [1.0, 0.8]}"
    leader = "scene.leader={line: {start: [0.5, 0.1, 0], end: [0.55, 0.15, 0], period: 4}}"
    given = (arm, leader, "scene.law={_target_: test_own_law.PlainHolding}", "scene.offset=[-0.1, 0, 0]")
    config = case("own", "scene", "default", *given)
    with pytest.raises(InputError, match="scene law PlainHolding must declare its kind, one of joint, end_point, hold"):
        chapters.load("own").experiment("scene").simulation.simulate(config, None)


class Nameless(Joint):
    """Uses what it has not imported."""

    def __call__(self, measured: Measured[Any], desired: Motion[Any]) -> Command:
        return Command(numpy.zeros(2))  # type: ignore[name-defined]  # noqa: F821


def test_a_name_that_a_law_has_not_imported_is_the_laws_failure() -> None:
    with World() as world:
        world.add_arm("arm", planar([0.4, 0.3], [1.0, 0.8]), [0.1, 0.2])
        with pytest.raises(LawFailed, match=r"the law Nameless of arm 'arm' failed at 0 s: NameError: name 'numpy' is"):
            world.run(0.01, {"arm": JointDrive(Nameless(), rest([0.0, 0.0]))})


def test_what_fails_is_the_law_and_not_its_adapter() -> None:
    with World() as world:
        world.add_arm("arm", planar([0.4, 0.3], [1.0, 0.8]), [0.1, 0.2])
        with pytest.raises(LawFailed, match=r"the law Broken of arm 'arm' failed at 0 s: ZeroDivisionError"):
            world.run(0.01, {"arm": Limited(JointDrive(Broken(), rest([0.0, 0.0])), 1.0)})


def test_a_law_that_reports_nothing_has_no_channels() -> None:
    assert report(Joint()) == {}
