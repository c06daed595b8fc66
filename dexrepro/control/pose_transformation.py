"""From the leader's pose to the follower's: re-"fixing" (clutching) and scaling, Sections 1.3.1 and 1.3.2."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from dexrepro.arrays import Array, Number


class SpeedScaling:
    """Scaling factor s(v) that grows with the speed of the hand, Eq. (1.45).

    base: s_b [-]; gain: s_p [-]; slow, fast: v_min and v_max [m/s].
    """

    def __init__(self, *, base: float = 1.0, gain: float = 7.0, slow: float = 0.05, fast: float = 0.3) -> None:
        self.base, self.gain, self.slow, self.fast = base, gain, slow, fast

    def __call__(self, speed: Number) -> Number:
        """Scaling of the follower's displacement at hand speed ``speed`` [m/s], of the same shape."""
        share = (np.minimum(speed, self.fast) - self.slow) / (self.fast - self.slow)
        return self.base + self.gain * np.maximum(share, 0.0)


class ConstantScaling:
    """The same factor at every speed: the whole-workspace mapping of Eq. (1.7)."""

    def __init__(self, *, factor: float) -> None:
        self.factor = factor

    def __call__(self, speed: Number) -> Number:
        return self.factor * np.ones_like(speed)  # type: ignore[return-value]


class RelativePose:
    """Pose of the follower from the leader's pose relative to the instant at which both were fixed together.

    It is f and g of Eqs. (1.1), (1.2).

    leader_to_follower: rotation from the leader's to the follower's base frame, shape (3, 3).
    scaling: s as a function of hand speed [m/s]; dt: sampling time [s].
    incremental: apply s to each sample's displacement; otherwise to the total displacement since the fixing, which is
        Eq. (1.11) to the letter. Both agree while s is constant, but with s(v) the total form pulls the follower back
        whenever the hand slows down.
    """

    def __init__(
        self,
        *,
        scaling: Callable[[float], float],
        dt: float,
        leader_to_follower: Array | None = None,
        incremental: bool = True,
    ) -> None:
        self.scaling, self.dt, self.incremental = scaling, dt, incremental
        self.leader_to_follower = np.eye(3) if leader_to_follower is None else np.asarray(leader_to_follower, float)

    def reset(
        self, leader_position: Array, leader_rotation: Array, follower_position: Array, follower_rotation: Array
    ) -> None:
        """Fix follower and leader together in the poses they have now, Eq. (1.4), (1.5)."""
        self.fixed_rotation = (self.leader_to_follower @ leader_rotation).T @ follower_rotation
        self.leader_start = self.leader_last = np.array(leader_position, float)
        self.follower_start = np.array(follower_position, float)
        self.position = self.follower_start.copy()

    def __call__(self, leader_position: Array, leader_rotation: Array) -> tuple[Array, Array]:
        """Position [m] and rotation matrix of the follower in its base frame, Eq. (1.6), (1.8), (1.9), (1.11)."""
        step = leader_position - self.leader_last
        scale = self.scaling(float(np.sqrt(step @ step)) / self.dt)
        if self.incremental:
            self.position = self.position + scale * (self.leader_to_follower @ step)
        else:
            total = leader_position - self.leader_start
            self.position = self.follower_start + scale * (self.leader_to_follower @ total)
        self.leader_last = np.array(leader_position, float)
        return self.position, self.leader_to_follower @ leader_rotation @ self.fixed_rotation


def scaled_path(hand: Array, scaling: Callable[[Array], Array], dt: float) -> tuple[Array, Array]:
    """Displacement of the follower [m] and the scale along a whole path of the hand [m], shape (n, k) -> (n, k), (n,).

    The scale of a sample is that of the step which leads to it; what :class:`RelativePose` does sample by sample.
    """
    steps = np.diff(hand, axis=0, prepend=hand[:1])
    scale = scaling(np.linalg.norm(steps, axis=1) / dt)
    return np.cumsum(scale[:, None] * steps, axis=0), scale
