"""External joint torque from the generalised momentum, without measured accelerations (Sect. 3.2.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array


class MomentumObserver:
    """Observed external torque sigma = K (p - p(0) - integral), Eqs. (3.17), (3.18).

    With an exact model d sigma/dt = K (tau_ext - sigma), Eq. (3.19): a lag of 1 / K. The momentum p = M dq, Eq. (3.13),
    changes by (tau + tau_ext - C dq - G) dt and by dM dq, Eq. (3.14); both are summed as the steps of the plant make
    them, so that without an external torque sigma stays zero for any motion.

    gain: K [1/s], a number or one a joint, below 2 / dt for stability; dt: period [s].
    """

    def __init__(self, *, gain: ArrayLike, dt: float) -> None:
        self.gain, self.dt = np.asarray(gain, dtype=float), dt
        self.reset()

    def reset(self) -> None:
        """Start at the next call."""
        self._integral: Array | None = None
        self._mass = self._bias = np.zeros(0)
        self.torque = np.zeros(0)

    def __call__(self, mass: Array, velocity: Array, bias: Array, torque: Array) -> Array:
        """Observed external torque sigma (n,) [N m], also kept as ``torque``.

        mass: M(q), (n, n) [kg m^2]; velocity: dq [rad/s]; bias: C dq + G [N m], all of this instant; torque: what the
        motors applied [N m] since the last call.
        """
        if self._integral is None:
            self._integral = mass @ velocity
            self.torque = np.zeros(len(velocity))
        else:
            known = (torque - self._bias + self.torque) * self.dt
            self._integral = self._integral + known + (mass - self._mass) @ velocity
            self.torque = self.gain * (mass @ velocity - self._integral)
        self._mass, self._bias = mass, bias
        return self.torque
