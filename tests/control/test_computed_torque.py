import numpy as np
import pytest
from instant import at

from dexrepro.control.computed_torque import ComputedTorque
from dexrepro.control.motion import Motion


class Pendulum:
    """2 kg m^2 against a gravity torque of 3 cos(q)."""

    def inverse_dynamics(self, q, dq, ddq):
        return 2.0 * ddq + 3.0 * np.cos(q)


def test_the_error_decays_as_the_chosen_critically_damped_system():
    law = ComputedTorque(model=Pendulum(), frequency=5.0)
    q, dq, dt = np.array([0.4]), np.zeros(1), 1e-4
    for _ in range(5000):
        torque = law(at(q, 0.0, dq), Motion(*np.zeros((3, 1)))).torque
        dq = dq + dt * (torque - 3.0 * np.cos(q)) / 2.0
        q = q + dt * dq
    assert q[0] == pytest.approx(0.4 * (1 + 5 * 0.5) * np.exp(-5 * 0.5), rel=2e-3)
