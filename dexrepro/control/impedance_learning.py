"""Optimal interaction along one axis: a gain learned during contact, and the virtual reference that realises it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np

from dexrepro.arrays import Array
from dexrepro.control.contract import Measured
from dexrepro.control.interaction_optimum import InteractionCost
from dexrepro.control.motion import Motion
from dexrepro.control.policy_iteration import Learned, Windows, policy_iteration

WAITING, EXPLORING, SOLVING, TRANSFERRING, DONE = range(5)


class Gain(Protocol):
    """A gain K(t) of tau_e = -K [x, s] and a force added to it, updated once a control period during contact.

    learned: what it found out, None where it has learned nothing (yet).
    """

    gain: Sequence[float]
    exploration: float
    phase: int
    learned: Learned | None

    def reset(self) -> None:
        """Back to the gain before contact."""

    def update(self, indentation: float, reference: float, force: float) -> None:
        """Advance one control period: indentation x [m], reference s, force tau_e of the object on the robot [N]."""


def soft_transfer(initial: Array, optimal: Array, progress: Array | float) -> Array:
    """Gain between two gains along half a sine, Eq. (8.11); progress t/T_s in [0, 1], shape (...); returns (..., p)."""
    weight = np.sin(-0.5 * np.pi + np.pi * np.clip(progress, 0.0, 1.0))[..., None]
    return 0.5 * (optimal + initial) + 0.5 * (optimal - initial) * weight


class ConstantGain:
    """A gain given in advance: the initial one, or one computed from a model of the object.

    With ``initial`` that gain holds for ``wait`` [s] of contact first, in steps of ``dt`` [s].
    """

    def __init__(
        self, gain: Sequence[float], initial: Sequence[float] | None = None, wait: float = 0.0, dt: float = 0.001
    ) -> None:
        self._final = [float(entry) for entry in gain]
        self._initial = self._final if initial is None else [float(entry) for entry in initial]
        self._wait = round(wait / dt)
        self.reset()

    def reset(self) -> None:
        """Back to the gain at first contact."""
        self.gain: Sequence[float] = self._initial
        self._steps = 0
        self.exploration, self.phase, self.learned = 0.0, WAITING, None

    def update(self, indentation: float, reference: float, force: float) -> None:
        """One control period of contact."""
        self._steps += 1
        if self._steps > self._wait:
            self.gain = self._final


def exploration_windows(samples: Array, dt: float, length: int, exosystem: float | None, start: float = 1.0) -> Windows:
    """Data of Eq. (8.10) from samples of x [m], s and tau_e [N], shape (n, 3), in windows of ``length`` steps.

    Where an exosystem M [1/s] is given, s is the auxiliary signal start exp(M t): the data identity holds for any s
    that obeys Eq. (8.8), while the desired path does not.
    """
    states = samples[:, :2]
    if exosystem is not None:
        auxiliary = start * np.exp(exosystem * dt * np.arange(len(samples)))
        states = np.column_stack([samples[:, 0], auxiliary])
    return Windows.of(states, samples[:, 2:], dt, length)


class LearnedGain:
    """Algorithm 8.1: hold K_0, explore until the data have full rank, iterate, then move to the learned gain.

    initial: K_0 [N/m, N]; cost: Eq. (8.9); tolerance: on |P_m - P_{m-1}|; exosystem: M [1/s] of the regressor
    s(t) = start exp(M t), an auxiliary signal since the desired path does not obey Eq. (8.8), or None to regress on
    the desired path itself; start: its value at the start of the exploration; amplitude [N] of the exploration
    sum_k amplitude/k sin(k t), k = 1 ... 8; wait, explore, solve, transfer: durations [s] of the phases, transfer 0
    being the abrupt change; window: of the data [s]; dt: control period [s].
    """

    def __init__(
        self,
        initial: Sequence[float],
        cost: InteractionCost,
        tolerance: float,
        exosystem: float | None,
        start: float,
        amplitude: float,
        wait: float,
        explore: float,
        solve: float,
        transfer: float,
        window: float,
        dt: float,
    ) -> None:
        self.initial, self.cost, self.tolerance = np.array(initial, float), cost, tolerance
        self.exosystem, self.start, self.amplitude = exosystem, start, amplitude
        self.wait, self.explore, self.solve, self.transfer = wait, explore, solve, transfer
        self.window, self.dt = round(window / dt), dt
        self.reset()

    def reset(self) -> None:
        """Back to K_0, with no data."""
        self.gain: Sequence[float] = self.initial.tolist()
        self.exploration, self.phase = 0.0, WAITING
        self.learned: Learned | None = None
        self._steps = 0
        self._samples: list[tuple[float, float, float]] = []

    @property
    def windows(self) -> Windows:
        """The data gathered so far, Eq. (8.10)."""
        return exploration_windows(self.samples, self.dt, self.window, self.exosystem, self.start)

    @property
    def samples(self) -> Array:
        """Indentation x [m], desired s and force tau_e [N] at the control instants of the exploration, shape (n, 3)."""
        return np.array(self._samples).reshape(-1, 3)

    def update(self, indentation: float, reference: float, force: float) -> None:
        """One control period of the algorithm."""
        elapsed = self._steps * self.dt
        self._steps += 1
        if self.phase == WAITING and elapsed >= self.wait:
            self._enter(EXPLORING)
        elif self.phase == EXPLORING and elapsed >= self.explore and self._at_window_end() and self.windows.excited:
            self._enter(SOLVING)
            self.learned = policy_iteration(
                self.windows, self.cost.state_weight, self.cost.effort_weight, self.initial, self.tolerance
            )
        elif self.phase == SOLVING and elapsed >= self.solve:
            self._enter(TRANSFERRING)
        elif self.phase == TRANSFERRING and elapsed >= self.transfer:
            self._enter(DONE)
        elapsed = self._steps * self.dt - self.dt
        if self.phase == EXPLORING:
            self._samples.append((indentation, reference, force))
        self.exploration = self._noise(elapsed) if self.phase == EXPLORING else 0.0
        if self.phase >= TRANSFERRING and self.learned is not None:
            progress = elapsed / self.transfer if self.phase == TRANSFERRING and self.transfer > 0 else 1.0
            self.gain = soft_transfer(self.initial, self.learned.gain[0], progress).tolist()

    def _enter(self, phase: int) -> None:
        self.phase, self._steps = phase, 1

    def _at_window_end(self) -> bool:
        return (len(self._samples) - 1) % self.window == 0

    def _noise(self, elapsed: float) -> float:
        return sum(self.amplitude / k * math.sin(k * elapsed) for k in range(1, 9))


class IntegratingReference:
    """Virtual reference that integrates the force error: v_c = kappa (tau_e - f_d), followed within 1/bandwidth.

    mobility: kappa [m/(N s)]; bandwidth [1/s]; dt: control period [s].
    """

    def __init__(self, mobility: float, bandwidth: float, dt: float) -> None:
        self.mobility, self.bandwidth, self.dt = mobility, bandwidth, dt

    def acceleration(self, state: Motion[float], force: float, desired: float, target: float) -> float:
        """Acceleration [m/s^2] of x_0 for tau_e = ``force`` and f_d = ``desired`` [N]; ``target`` is not used."""
        return self.bandwidth * (self.mobility * (force - desired) - state.velocity)


class StaticReference:
    """Virtual reference where tau_e = -K [x, s] would hold for the measured force, behind two lags of a rate [1/s]."""

    def __init__(self, rate: float, dt: float) -> None:
        self.rate, self.dt = rate, dt

    def acceleration(self, state: Motion[float], force: float, desired: float, target: float) -> float:
        """Acceleration [m/s^2] of x_0 towards ``target`` [m], where the measured force would balance."""
        return self.rate**2 * (target - state.position) - 2.0 * self.rate * state.velocity


class InteractionLaw:
    """Moves the virtual reference x_0 so that the contact force follows tau_e = -K [x - x_ob, (x_d - x_ob)/N].

    The surface x_ob is where the force first exceeds ``contact_force`` [N]. Before contact x_0 = x_d; once x_d has left
    the object, x_0 returns to it at the rate ``recovery`` [1/s]. side: +1 for an object at positions above its
    surface, -1 for one below; output: N of the cost; origin: position [m] from which x and x_d count, None for the
    surface itself; surface_error: error [m] of the surface found; printed: tau_e = +K [x, s].
    """

    def __init__(
        self,
        gain: Gain,
        reference: IntegratingReference | StaticReference,
        output: float,
        side: int,
        contact_force: float,
        recovery: float,
        origin: float | None = None,
        surface_error: float = 0.0,
        printed: bool = False,
    ) -> None:
        self.gain, self.reference, self.output, self.side = gain, reference, output, side
        self.contact_force, self.recovery = contact_force, recovery
        self.origin, self.surface_error, self._sign = origin, surface_error, -1.0 if printed else 1.0
        self.reset()

    def reset(self) -> None:
        """Forget the surface and what the gain has learned."""
        self.gain.reset()
        self.surface: float | None = None
        self.desired_force = 0.0
        self.state = Motion(0.0, 0.0, 0.0)

    def __call__(self, measured: Measured[float], desired: Motion[float]) -> Motion[float]:
        """Virtual reference for the desired motion and what is measured along the axis; the force is on the robot."""
        _, position, _, force, *_ = measured
        dt = self.reference.dt
        if self.surface is None and abs(force) > self.contact_force:
            self.surface, self.state = position + self.surface_error, desired
        if self.surface is None:
            self.desired_force = 0.0
            return desired
        if self.side * (desired.position - self.surface) > 0:
            acceleration = self._interact(desired, position, force)
        else:
            command = desired.velocity + self.recovery * (desired.position - self.state.position)
            acceleration = 10.0 * self.recovery * (command - self.state.velocity)
        velocity = self.state.velocity + dt * acceleration
        self.state = Motion(self.state.position + dt * velocity, velocity, acceleration)
        return self.state

    def _interact(self, desired: Motion[float], position: float, force: float) -> float:
        origin = self.surface if self.origin is None else self.origin
        assert origin is not None
        indentation, target = position - origin, (desired.position - origin) / self.output
        self.gain.update(indentation, target, force)
        gain_x, gain_s = self.gain.gain[0] * self._sign, self.gain.gain[1] * self._sign
        noise = self.gain.exploration
        self.desired_force = -gain_x * indentation - gain_s * target + noise
        balance = origin - (force + gain_s * target - noise) / gain_x
        return self.reference.acceleration(self.state, force, self.desired_force, balance)
