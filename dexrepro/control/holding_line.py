"""Holding-line regulation: the lateral contact force, summed up, moves the arm back onto the partner's line."""

from __future__ import annotations

from dexrepro.arrays import Real


class HoldingLineRegulation:
    """Lateral displacement of the arm that brings the lateral contact force to zero, Eqs. (2.8), (2.9).

    The displacement is summed once a control period, so ``gain`` k_y is per sample; with a central contact force f over
    the length L it closes a lateral offset with the time constant L dt / (gain f).

    gain: k_y [m/N per sample]; 0 switches the regulation off.
    printed: False takes the opposite sign, to show what that reading does.
    """

    def __init__(self, *, gain: Real, printed: bool = True) -> None:
        self.gain, self._sign = gain, (-1.0 if printed else 1.0)
        self.reset()

    def reset(self) -> None:
        """Back to no displacement."""
        self.displacement: Real = 0.0

    def __call__(self, force: Real) -> Real:
        """Lateral displacement [m] after one more sample of the lateral force [N]; floats, or arrays of one shape."""
        self.displacement = self.displacement + self._sign * self.gain * force
        return self.displacement
