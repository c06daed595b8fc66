"""The one simulation loop and the one recorder."""

from __future__ import annotations

import time as wall
import traceback
from array import array
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol, cast

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array
from dexrepro.control.contract import Plain, Undefined, Unusable
from dexrepro.experiment import Recording
from dexrepro.physics.elements import Element, Ends
from dexrepro.physics.engine import Scene
from dexrepro.physics.plant import Controller, Reply, RigidBody, SimulatedArm

Probe = Callable[[], ArrayLike]
GUARD = 1e3  # sum of an arm's joint angles and rates [rad, rad/s] beyond which a run has diverged


class Stage(Ends, Protocol):
    """What stands in a world, and its clock: ``step`` and ``time`` [s], ``gui`` whether a window is open."""

    step: float
    time: float
    gui: bool
    scene: Scene
    arms: dict[str, SimulatedArm]
    elements: list[Element]

    @property
    def moving(self) -> dict[str, RigidBody]:
        """Rigid bodies that are not static."""


class Progress:
    """``report``(simulated, duration) [s], if set, is called about twice a second of wall time by every run."""

    report: Callable[[float, float], None] | None = None


class Diverged(RuntimeError):
    """A joint left every physical range; the sentence says when, which and by how much."""


class LawFailed(RuntimeError):
    """A law raised an error or gave something that is no torque; the sentence names it, the time and the value."""


MUST_GIVE = {
    "joint": "Command(torque), a torque [N m] of each joint",
    "end_point": "Command(force=...), a force [N] along each axis of measured.position, or Command(torque)",
}


class Recorder:
    """Rows of numbers, one after another, turned into named channels at the end."""

    def __init__(self) -> None:
        self._numbers, self._rows = array("d"), 0

    def write(self, row: list[float]) -> None:
        """Append one row; all rows of a recorder are of one length."""
        self._numbers.fromlist(row)
        self._rows += 1

    def series(self, channels: Sequence[tuple[str, int]]) -> dict[str, Array]:
        """Channels in the order of the rows; a width of 0 stands for a single number: (samples,), else (samples, k)."""
        rows = np.array(self._numbers).reshape(self._rows, sum(max(width, 1) for _, width in channels))
        result, start = {}, 0
        for name, width in channels:
            result[name] = rows[:, start : start + width].copy() if width else rows[:, start].copy()
            start += max(width, 1)
        return result


@dataclass
class Probes:
    """Functions without arguments whose values, numbers, tuples of them or arrays of one shape, become channels."""

    functions: Mapping[str, Probe]
    channels: list[tuple[str, int]] = field(default_factory=list)

    def values(self) -> list[float]:
        """What all functions return now, one after another; the first call settles the channels' widths."""
        row: list[float] = []
        results = [function() for function in self.functions.values()]
        if not self.channels:
            sizes = [0 if np.ndim(value) == 0 else np.size(value) for value in results]
            self.channels = list(zip(self.functions, sizes, strict=True))
        for value in results:
            if isinstance(value, (float, int)):
                row.append(value)
            elif isinstance(value, tuple):
                row += value
            else:
                row += np.asarray(value).ravel().tolist()
        return row


def run(
    world: Stage,
    duration: float,
    controllers: Mapping[str, Controller],
    control_period: float | None,
    probes: Mapping[str, Probe],
    stop: Callable[[float], str | None] | None,
    events: Sequence[tuple[float, Callable[[], object]]],
    record_every: int,
    on_divergence: str,
) -> Recording:
    """See :meth:`World.run`."""
    step, start = world.step, world.time
    steps = round(duration / step)
    every = 1 if control_period is None else round(control_period / step)
    if every < 1 or abs(every * step - (control_period or step)) > 1e-9:
        raise ValueError(f"the control period {control_period} s is no multiple of the physics step {step} s")
    scene = _Scene(world, controllers, probes, every * step)
    pending = sorted(((round((at - start) / step), action) for at, action in events), key=lambda item: item[0])
    status, done, clock = "finished", 0, _Clock(duration, world.gui)
    for k in range(steps):
        now = world.time = start + k * step
        while pending and pending[0][0] <= k:
            pending.pop(0)[1]()
        trouble = scene.read(now)
        if trouble:
            if on_divergence == "raise":
                raise Diverged(trouble)
            status = trouble
            break
        sample = k % every == 0
        try:
            scene.act(now, sample)
        except LawFailed as failure:
            if on_divergence == "raise" or not isinstance(failure.__cause__, Undefined):
                raise
            scene.record(now)
            status, done = str(failure), k + 1
            break
        if k % record_every == 0:
            scene.record(now)
        reason = stop(now) if stop is not None and sample else None
        if reason:
            status = reason
            break
        scene.step()
        done = k + 1
        if k & 255 == 0 or world.gui:
            clock.tick(now - start)
    world.time = start + done * step
    return Recording(series=scene.series(), steps=done, simulated=done * step, status=status)


class _Clock:
    """Wall time: tells the progress and, with a window open, keeps the simulation from running ahead."""

    def __init__(self, duration: float, gui: bool) -> None:
        self._duration, self._gui = duration, gui
        self._start = self._told = wall.perf_counter()

    def tick(self, simulated: float) -> None:
        now = wall.perf_counter()
        if Progress.report is not None and now - self._told > 0.5:
            self._told = now
            Progress.report(simulated, self._duration)
        if self._gui:
            wall.sleep(max(0.0, self._start + simulated - now))


class _Scene:
    """The parts of a world during one run, in lists that are quick to walk."""

    def __init__(
        self,
        world: Stage,
        controllers: Mapping[str, Controller],
        probes: Mapping[str, Probe],
        period: float,
    ) -> None:
        unknown = set(controllers) - set(world.arms)
        if unknown:
            raise ValueError(f"controllers for arms that are not in the world: {', '.join(sorted(unknown))}")
        self._world, self._step = world, world.step
        self._advance = world.scene.advance
        self._arms = list(world.arms.values())
        for arm in self._arms:
            arm.prepare(period)
        self._driven = [(world.arms[name], controller) for name, controller in controllers.items()]
        self._commands: dict[str, Reply] = {}
        self._bodies = list(world.moving.values())
        self._elements = list(world.elements)
        self._forces = [element.bind(world) for element in self._elements]
        self._seen = [] if all(getattr(element, "blind", False) for element in self._elements) else self._arms
        self._probes, self._recorder = Probes(probes), Recorder()

    def read(self, now: float) -> str:
        """Take the state from the engine; the text says which arm diverged, if one did."""
        for arm in self._arms:
            arm.read()
            # A sum is cheap and is not a number if any of its terms is not.
            if not sum(map(abs, arm.q + arm.dq)) < GUARD:
                return _diverged(arm, now)
        for body in self._bodies:
            body.read()
        return ""

    def act(self, now: float, sample: bool) -> None:
        """Evaluate force elements, then controllers; between control instants only their inner loops and damping."""
        for arm in self._seen:
            arm.locate()
        for apply in self._forces:
            apply(now)
        for arm, controller in self._driven:
            try:
                if sample:
                    answer = self._commands[arm.name] = controller(arm.observe(now, True))
                    if callable(answer):
                        answer = answer(arm.sense)
                else:
                    answer = self._commands[arm.name]
                    if callable(answer):
                        answer = answer(arm.observe(now, False))
                    elif not isinstance(answer, tuple) or answer[1] is None:
                        continue  # the torque of the control instant still holds
                if isinstance(answer, tuple):
                    arm.command(answer[0], answer[1], self._step)
                else:
                    arm.command(answer, None, self._step)
            except (TypeError, ValueError, LookupError, AttributeError, ArithmeticError, NameError) as error:
                what = " ".join(str(error).split())
                kind = "" if isinstance(error, Unusable) else f"{type(error).__name__}: "
                name = _name_of(controller)
                raise LawFailed(f"the law {name} of arm '{arm.name}' failed at {now:.4g} s: {kind}{what}") from error

    def step(self) -> None:
        for arm in self._arms:
            arm.apply()
        self._advance()

    def record(self, now: float) -> None:
        row = [now]
        for arm in self._arms:
            arm.locate()
            row += arm.q
            row += arm.dq
            row += arm.torque
            row += (arm.x, arm.y, arm.z, arm.fx, arm.fy, arm.fz)
            if arm.force_channel is not None:
                row += arm.sense.felt
        for body in self._bodies:
            row += (body.x, body.y, body.z, *body.orientation)
        for element in self._elements:
            row += element.channels().values()
        if self._probes.functions:
            row += self._probes.values()
        self._recorder.write(row)

    def series(self) -> dict[str, Array]:
        channels: list[tuple[str, int]] = [("time", 0)]
        for arm in self._arms:
            names = [("position", arm.dof), ("velocity", arm.dof), ("torque", arm.dof), ("tip", 3), ("force", 3)]
            if arm.force_channel is not None:
                names.append(("sensed_force", 3))
            channels += [(f"{arm.name}.{name}", width) for name, width in names]
        channels += [(f"{name}.pose", 7) for name in self._world.moving]
        channels += [(f"{element.name}.{name}", 0) for element in self._elements for name in element.channels()]
        return self._recorder.series(channels + self._probes.channels)


def _name_of(controller: Controller) -> str:
    """The class of the law that a controller carries out, and what it is told where it does not say so."""
    law, told = cast(object, controller), ""
    while not hasattr(law, "kind") and hasattr(law, "law"):
        told = " (of no kind, so told position and force)" if isinstance(law, Plain) else ""
        law = law.law
    return f"{getattr(law, '__qualname__', type(law).__name__)}{told}"


def law_failure(error: Exception) -> LawFailed | None:
    """How a law has ended a :func:`run`, whatever it raised, with arm and time; where what it gave was of no use, with
    what it must give. None where no law was at work, or gave numbers that are not finite."""
    cause = error.__cause__ if isinstance(error, LawFailed) else error
    frames = [frame for frame, _ in traceback.walk_tb(cause.__traceback__ if cause else None)]
    acting = next((frame.f_locals for frame in frames if frame.f_code is _Scene.act.__code__), None)
    if acting is None or isinstance(cause, Undefined):
        return None
    text, law = str(error), acting["controller"]
    if error is cause:
        what = f"{type(error).__name__}: {' '.join(text.split())}"
        text = f"the law {_name_of(law)} of arm '{acting['arm'].name}' failed at {acting['now']:.4g} s: {what}"
    while not hasattr(law, "kind") and hasattr(law, "law"):
        law = law.law
    modules = [frame.f_globals.get("__name__", "") for frame in frames]
    answered = [name for name in modules if name.startswith(("dexrepro.", law.__module__))][-1]
    if answered.startswith("dexrepro.physics.") and getattr(law, "kind", "") in MUST_GIVE:
        text += f"; a law of kind '{law.kind}' must give {MUST_GIVE[law.kind]}"
    return LawFailed(text)


def _diverged(arm: SimulatedArm, now: float) -> str:
    """Names the quantity that makes up most of the sum, and its joint; what is not a number exceeds everything."""
    sizes = [[abs(value) if abs(value) < np.inf else np.inf for value in values] for values in (arm.q, arm.dq)]
    angles, rates = sizes
    if sum(angles) > sum(rates):
        values, size, what, unit = arm.q, angles, "angle", "rad"
    else:
        values, size, what, unit = arm.dq, rates, "velocity", "rad/s"
    worst = size.index(max(size))
    joint = arm.arm.joints[worst].name
    return f"diverged at {now:.4g} s: {what} of joint '{joint}' of arm '{arm.name}' is {values[worst]:.4g} {unit}"
