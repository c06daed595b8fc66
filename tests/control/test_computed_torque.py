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


def test_the_torque_is_the_inverse_dynamics_of_the_feedback():
    law = ComputedTorque(model=Pendulum(), frequency=5.0, damping_ratio=0.4)
    told, goal = at(np.array([0.4]), 0.0, np.array([-0.3])), Motion(np.array([0.6]), np.array([0.2]), np.array([9.0]))
    wanted = 25.0 * 0.2 + 2 * 0.4 * 5.0 * 0.5
    assert law(told, goal).torque == pytest.approx(2.0 * wanted + 3.0 * np.cos(0.4))
