"""Closed-loop inverse kinematics with a damped pseudo-inverse and joint limits, Eq. (1.3)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg.lapack import dposv

from dexrepro.arrays import Array
from dexrepro.robots.arm import Arm
from dexrepro.robots.kinematics import forward, jacobian
from dexrepro.robots.planar import PlanarTip
from dexrepro.robots.rotations import rotation_error, tilt

Place = Sequence[float] | Array
TASKS = ("position", "pose", "axis")


class Kinematics(Protocol):
    """Pose and Jacobian of one joint state, such as physics.model.RigidBodyModel offers."""

    def forward(self, q: Array) -> tuple[Array, Array]:
        """Position (3,) [m] and rotation (3, 3) of the end point, world frame, at joint angles (n,) [rad]."""

    def jacobian(self, q: Array) -> Array:
        """Geometric Jacobian (6, n): linear [m/rad] over angular rows, world frame."""


class Unreachable(RuntimeError):
    """No joint angles within the limits bring the end point to where it was asked to be."""


class InverseKinematics:
    """Joint references that follow an end-point reference, one step a call.

    dq = J^+ (V_d + k_E (X_d - X)) + (I - J^+ J) k_n (q_rest - q), Eq. (1.3) with the sign that makes the error decay,
    J^+ = J^T (J J^T + lambda^2 I)^-1, integrated over the period. The error is that of the reference itself, not of
    the measured arm. Rates stay within the arm's speed limits; a joint that would leave its range is held at its
    limit and the others take over its share, or do not where ``redistribute`` is False (and the task waits).

    task: "position" (planar arms: x, y), "pose" (planar arms: x, y, heading) or "axis" (position and the direction
    of the end point's z axis). gain: k_E [1/s], where 1 / period makes every call one Newton step; period [s];
    damping: lambda; rest: q_rest (n,) [rad] pulled at with rest_gain k_n [1/s]; kinematics: a faster source of pose
    and Jacobian than the arm's description.
    """

    def __init__(
        self,
        arm: Arm,
        task: str = "position",
        gain: float = 100.0,
        period: float = 1e-3,
        damping: float = 1e-3,
        rest: ArrayLike | None = None,
        rest_gain: float = 0.0,
        kinematics: Kinematics | None = None,
        redistribute: bool = True,
    ) -> None:
        if task not in TASKS:
            raise ValueError(f"task '{task}' is none of {', '.join(TASKS)}")
        self.arm, self.task = arm, task
        self.gain, self.period, self.damping, self.rest_gain = gain, period, damping, rest_gain
        self.redistribute = redistribute
        self.rest = None if rest is None else np.asarray(rest, dtype=float)
        self._kinematics = kinematics or _Description(arm)
        self._planar = PlanarTip(arm) if arm.is_planar and task == "position" else None
        self._limited = bool(np.isfinite([arm.lower, arm.upper, arm.speed]).any())
        self._limits = list(zip(arm.lower.tolist(), arm.upper.tolist(), arm.speed.tolist(), strict=True))
        self.position = np.zeros(arm.dof)
        self.velocity = np.zeros(arm.dof)
        self.error = np.zeros(0)

    def reset(self, position: ArrayLike) -> None:
        """Start from joint angles (n,) [rad]."""
        self.position = np.array(position, dtype=float)
        self.velocity = np.zeros(self.arm.dof)

    def __call__(self, position: Place, rotation: ArrayLike | None = None, velocity: ArrayLike | None = None) -> Array:
        """Next joint reference (n,) [rad] towards an end point (3,) [m] and rotation (3, 3), world frame.

        velocity: V_d of the end point, (3,) linear [m/s] or (6,) with angular [rad/s] behind it. The reference's
        rate is ``velocity``, and the task error before the step is ``error``.
        """
        jacobian, error, rows = self._task(self.position, position, rotation)
        rate = self.gain * error
        if velocity is not None:
            twist = np.zeros(6)
            twist[: np.size(velocity)] = velocity
            rate = rate + rows @ twist if rows is not None else rate + twist[: len(rate)]
        pull = None
        if self.rest is not None and self.rest_gain:
            pull = self.rest_gain * (self.rest - self.position)
        self.error = error
        self.velocity = (
            self._within_limits(jacobian, rate, pull) if self._limited else self._rates(jacobian, rate, pull)
        )
        self.position = self.position + self.period * self.velocity
        return self.position

    def _task(self, q: Array, position: Place, rotation: ArrayLike | None) -> tuple[Array, Array, Array | None]:
        """Task Jacobian (m, n), error (m,) and the matrix (m, 6) from twist to task (None: its first m rows)."""
        if self._planar is not None:
            angles = q.tolist()
            x, y = self._planar.tip(angles)
            goal = position.tolist() if isinstance(position, np.ndarray) else position
            return self._planar.jacobian(angles), np.array((goal[0] - x, goal[1] - y)), None
        place, turn = self._kinematics.forward(q)
        full = self._kinematics.jacobian(q)
        offset = np.asarray(position, dtype=float) - place
        if self.task == "position":
            return full[:3], offset, None
        if rotation is None:
            raise ValueError(f"the task '{self.task}' needs a rotation")
        if self.arm.is_planar:
            rows = np.eye(6)[[0, 1, 5]]
            error = np.append(offset[:2], rotation_error(rotation, turn)[2])
        elif self.task == "pose":
            return full, np.concatenate((offset, rotation_error(rotation, turn))), None
        else:
            rows = np.zeros((5, 6))
            rows[:3, :3] = np.eye(3)
            rows[3:, 3:] = turn.T[:2]
            lean = turn.T[:2] @ tilt(turn[:, 2], np.asarray(rotation, dtype=float)[:, 2])
            error = np.concatenate((offset, lean))
        return rows @ full, error, rows

    def _rates(self, jacobian: Array, rate: Array, pull: Array | None) -> Array:
        """J^+ rate + (I - J^+ J) pull, written as pull + J^+ (rate - J pull)."""
        if pull is not None:
            rate = rate - jacobian @ pull
        square = jacobian @ jacobian.T
        if len(rate) == 2:
            (a, b), (_, c) = square.tolist()
            u, v = rate.tolist()
            a, c = a + self.damping**2, c + self.damping**2
            scale = 1.0 / (a * c - b * b)
            result: Array = jacobian.T @ np.array((scale * (c * u - b * v), scale * (a * v - b * u)))
        else:
            square.reshape(-1)[:: len(rate) + 1] += self.damping**2
            _, solution, singular = dposv(square, rate)  # np.linalg.solve takes four times as long for six rows
            if singular:
                raise np.linalg.LinAlgError("the Jacobian is singular and the damping 0")
            result = jacobian.T @ solution
        return result if pull is None else result + pull

    def _within_limits(self, jacobian: Array, rate: Array, pull: Array | None) -> Array:
        """Rates whose step stays within position and speed limits; blocked joints are taken out one after another."""
        arm, result = self.arm, self._rates(jacobian, rate, pull)
        if self._allowed(result):
            return result
        low = np.maximum((arm.lower - self.position) / self.period, -arm.speed)
        high = np.minimum((arm.upper - self.position) / self.period, arm.speed)
        if not self.redistribute:
            return np.minimum(np.maximum(result, low), high)
        free = np.ones(arm.dof, dtype=bool)
        fixed = np.zeros(arm.dof)
        while True:
            excess = np.maximum(result - high, low - result)
            excess[~free] = 0.0
            worst = int(excess.argmax())
            if excess[worst] <= 1e-12:
                return np.minimum(np.maximum(result, low), high)
            free[worst] = False
            fixed[worst] = high[worst] if result[worst] > high[worst] else low[worst]
            result = fixed.copy()
            if free.any():
                part = None if pull is None else pull[free]
                result[free] = self._rates(jacobian[:, free], rate - jacobian[:, ~free] @ fixed[~free], part)

    def _allowed(self, rates: Array) -> bool:
        """Whether the step with these rates breaks no limit at all."""
        period = self.period
        for (low, high, speed), angle, rate in zip(self._limits, self.position.tolist(), rates.tolist()):
            if not (-speed <= rate <= speed and low <= angle + period * rate <= high):
                return False
        return True


def solve(
    arm: Arm,
    position: Place,
    rotation: ArrayLike | None = None,
    start: ArrayLike | None = None,
    task: str = "position",
    rest: ArrayLike | None = None,
    rest_gain: float = 0.0,
    damping: float = 1e-2,
    tolerance: float = 1e-6,
    restarts: int = 20,
    seed: int = 0,
) -> Array:
    """Joint angles (n,) [rad] that put the end point (3,) [m], rotation (3, 3) where asked, within the joint limits.

    Starts from ``start`` (by default mid-range) and, where that fails, from random angles; the damping, at most
    ``damping``, shrinks with the error. tolerance: of the norm of the task error [m, rad]. Raises Unreachable with
    the best error found.
    """
    lower, upper = np.maximum(arm.lower, -np.pi), np.minimum(arm.upper, np.pi)
    rng = np.random.default_rng(seed)
    follower = InverseKinematics(arm, task, 1.0, 1.0, damping, rest, rest_gain)
    best = np.inf
    first = (lower + upper) / 2 if start is None else np.asarray(start, dtype=float)
    for attempt in range(restarts + 1):
        follower.damping = damping
        follower.reset(first if attempt == 0 else rng.uniform(lower, upper))
        for iteration in range(200):
            before = follower.position
            follower(position, rotation)
            size = float(np.linalg.norm(follower.error))
            best = min(best, size)
            follower.damping = min(damping, size)
            if size < tolerance:
                turns = 2 * np.pi * np.round(before / (2 * np.pi))
                return before - np.where(np.isinf(arm.upper), turns, 0.0)
            if iteration == 150:
                follower.rest_gain = 0.0
        follower.rest_gain = rest_gain
    raise Unreachable(_missed(arm, task, best))


def nearest(
    arm: Arm, posture: ArrayLike, position: Place, rotation: ArrayLike | None = None, task: str = "pose",
    settle: int = 150,
) -> Array:  # fmt: skip
    """Of all joint angles (n,) [rad] that put the end point where asked, those nearest to a posture (n,) [rad].

    Steps are small: whole Newton steps can end in another branch, with wrist or elbow turned over. The distance from
    the nearest shrinks by the factor 0.95 in each of ``settle`` steps. Raises Unreachable with the error left.
    """
    follower = InverseKinematics(arm, task, 0.3, 1.0, 1e-2, posture, 0.05, redistribute=False)
    follower.reset(posture)
    for step in range(settle + 250):
        follower.rest_gain = 0.05 if step < settle else 0.0
        follower(position, rotation)
        if step >= settle and np.abs(follower.velocity).max() < 1e-12:
            break
    left = float(np.linalg.norm(follower.error))
    if left > 1e-6:
        raise Unreachable(_missed(arm, task, left))
    return follower.position


def _missed(arm: Arm, task: str, error: float) -> str:
    return f"arm '{arm.name}' comes no closer than {error:.2g} to the {task} asked of it"


class _Description:
    """Pose and Jacobian from the arm's description alone."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm

    def forward(self, q: Array) -> tuple[Array, Array]:
        return forward(self._arm, q)

    def jacobian(self, q: Array) -> Array:
        return jacobian(self._arm, q)
