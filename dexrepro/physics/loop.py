"""The one simulation loop and the one recorder."""

from __future__ import annotations

import time as wall
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pybullet as bullet
from numpy.typing import NDArray

from dexrepro.experiment import Recording
from dexrepro.physics.plant import Controller, SimulatedArm

if TYPE_CHECKING:
    from dexrepro.physics.world import World

VELOCITY_GUARD = 1e3
POSITION_GUARD = 1e3


class Progress:
    """``report``(simulated, duration) [s], if set, is called about twice a second of wall time by every run."""

    report: Callable[[float, float], None] | None = None


class Diverged(RuntimeError):
    """A joint left every physical range; the sentence says when, which and by how much."""


class Recorder:
    """Rows of numbers written into one array that is made beforehand, turned into named channels at the end."""

    def __init__(self, rows: int) -> None:
        self._rows, self._count = rows, 0
        self._buffer: NDArray[np.float64] | None = None
        self.channels: list[tuple[str, int, bool]] = []

    def write(self, row: list[float]) -> None:
        if self._buffer is None:
            self._buffer = np.empty((self._rows, len(row)))
        self._buffer[self._count] = row
        self._count += 1

    def series(self) -> dict[str, NDArray[Any]]:
        """Channels of shape (samples,) or (samples, width)."""
        width = sum(size for _, size, _ in self.channels)
        buffer = np.empty((0, width)) if self._buffer is None else self._buffer[: self._count]
        result, start = {}, 0
        for name, size, scalar in self.channels:
            result[name] = buffer[:, start].copy() if scalar else buffer[:, start : start + size].copy()
            start += size
        return result


class Probes:
    """Functions without arguments whose values, numbers or arrays of one shape, become channels."""

    def __init__(self, probes: Mapping[str, Callable[[], Any]]) -> None:
        self._functions = list(probes.values())
        self._names = list(probes)

    def values(self) -> list[float]:
        row: list[float] = []
        for function in self._functions:
            value = function()
            if isinstance(value, (float, int)):
                row.append(value)
            else:
                row.extend(np.ravel(value).tolist())
        return row

    def channels(self) -> list[tuple[str, int, bool]]:
        sizes = [np.asarray(function()) for function in self._functions]
        return [(name, value.size, value.ndim == 0) for name, value in zip(self._names, sizes, strict=True)]


def run(
    world: World,
    duration: float,
    controllers: Mapping[str, Controller],
    control_period: float | None,
    probes: Mapping[str, Callable[[], Any]],
    stop: Callable[[float], str | None] | None,
    events: Sequence[tuple[float, Callable[[], Any]]],
    record_every: int,
    on_divergence: str,
) -> Recording:
    """See :meth:`World.run`."""
    step, start = world.step, world.time
    steps = round(duration / step)
    every = 1 if control_period is None else round(control_period / step)
    if every < 1 or abs(every * step - (control_period or step)) > 1e-9:
        raise ValueError(f"the control period {control_period} s is no multiple of the physics step {step} s")
    arms = list(world.arms.values())
    unknown = set(controllers) - set(world.arms)
    if unknown:
        raise ValueError(f"controllers for arms that are not in the world: {', '.join(sorted(unknown))}")
    for arm in arms:
        arm.prepare(every * step)
    driven = [(arm, controllers.get(arm.name)) for arm in arms]
    bodies = list(world.moving.values())
    elements = list(world.elements)
    forces = [element.bind(world) for element in elements]
    commands: dict[str, Any] = {}
    pending = sorted(((round((at - start) / step), action) for at, action in events), key=lambda item: item[0])
    recorder, probing = Recorder(-(-steps // record_every)), Probes(probes)
    status, done = "finished", 0
    clock = wall.perf_counter()
    for k in range(steps):
        now = world.time = start + k * step
        while pending and pending[0][0] <= k:
            pending.pop(0)[1]()
        for arm in arms:
            arm.read()
            # A sum is cheap and is not a number if any of its terms is not.
            if not (sum(map(abs, arm.dq)) < VELOCITY_GUARD and sum(map(abs, arm.q)) < POSITION_GUARD):
                status = _diverged(arm, now)
        if status != "finished":
            if on_divergence == "raise":
                raise Diverged(status)
            break
        if forces:
            for arm in arms:
                arm.locate()
        for body in bodies:
            body.read()
        for apply in forces:
            apply(now)
        _control(driven, commands, now, k % every == 0, step)
        if k % record_every == 0:
            if not recorder.channels:
                recorder.channels = _channels(arms, world, elements, probing)
            row = [now]
            for arm in arms:
                arm.locate()
                row += arm.q
                row += arm.dq
                row += arm.torque
                row += (arm.x, arm.y, arm.z, arm.fx, arm.fy, arm.fz)
                if arm.force_channel is not None:
                    row += arm.sense.force.tolist()
            for body in bodies:
                row += (body.x, body.y, body.z, *body.orientation)
            for element in elements:
                row += element.channels().values()
            recorder.write(row + probing.values() if probes else row)
        if stop is not None and k % every == 0:
            reason = stop(now)
            if reason:
                status = reason
                break
        for arm in arms:
            arm.apply()
        bullet.stepSimulation(physicsClientId=world.client)
        done = k + 1
        if k & 255 == 0 and Progress.report is not None and wall.perf_counter() - clock > 0.5:
            clock = wall.perf_counter()
            Progress.report(now - start, duration)
        if world.gui:
            wall.sleep(step)
    world.time = start + done * step
    if not recorder.channels:
        recorder.channels = _channels(arms, world, elements, probing)
    return Recording(series=recorder.series(), steps=done, simulated=done * step, status=status)


def _control(
    driven: list[tuple[SimulatedArm, Controller | None]],
    commands: dict[str, Any],
    now: float,
    sample: bool,
    step: float,
) -> None:
    """Ask the controllers at control instants; between them hold torques and damping, and evaluate inner loops."""
    for arm, controller in driven:
        if controller is None:
            continue
        if sample:
            answer = commands[arm.name] = controller(arm.observe(now, True))
            if callable(answer):
                answer = answer(arm.sense)
        else:
            answer = commands[arm.name]
            if callable(answer):
                answer = answer(arm.observe(now, False))
        if type(answer) is tuple:
            arm.command(answer[0], answer[1], step)
        elif sample or answer is not arm.torque:
            arm.command(answer, None, step)


def _channels(
    arms: list[SimulatedArm], world: World, elements: list[Any], probing: Probes
) -> list[tuple[str, int, bool]]:
    result: list[tuple[str, int, bool]] = [("time", 1, True)]
    for arm in arms:
        names = [("position", arm.dof), ("velocity", arm.dof), ("torque", arm.dof), ("tip", 3), ("force", 3)]
        if arm.force_channel is not None:
            names.append(("sensed_force", 3))
        result += [(f"{arm.name}.{name}", size, False) for name, size in names]
    result += [(f"{name}.pose", 7, False) for name in world.moving]
    result += [(f"{element.name}.{name}", 1, True) for element in elements for name in element.channels()]
    return result + probing.channels()


def _diverged(arm: SimulatedArm, now: float) -> str:
    if all(abs(rate) < VELOCITY_GUARD for rate in arm.dq):
        values, what, unit = arm.q, "angle", "rad"
    else:
        values, what, unit = arm.dq, "velocity", "rad/s"
    worst = max(range(arm.dof), key=lambda i: abs(values[i]) if abs(values[i]) < np.inf else np.inf)
    joint = arm.arm.joints[worst].name
    return f"diverged at {now:.4g} s: {what} of joint '{joint}' of arm '{arm.name}' is {values[worst]:.4g} {unit}"
