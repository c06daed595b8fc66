"""Holding-line regulation: the lateral contact force, summed up, moves the arm back onto the partner's line."""

from __future__ import annotations

from typing import Any


class HoldingLineRegulation:
    """Lateral displacement of the arm that brings the lateral contact force to zero, Eqs. (2.8), (2.9).

    The displacement is summed once a control period, so ``gain`` k_y is per sample; with a central contact force f over
    the length L it closes a lateral offset with the time constant L dt / (gain f).

    gain: k_y [m/N per sample]; 0 switches the regulation off.
    sign: -1 as printed; +1 is kept to show what the opposite reading does.
    """

    def __init__(self, *, gain: Any, sign: float = -1.0) -> None:
        self.gain, self.sign = gain, sign
        self.reset()

    def reset(self) -> None:
        self.displacement: Any = 0.0

    def __call__(self, force: Any) -> Any:
        """Lateral displacement [m] after one more sample of the lateral force [N]; floats, or arrays of one shape."""
        self.displacement = self.displacement + self.sign * self.gain * force
        return self.displacement
