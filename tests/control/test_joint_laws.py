"""Joint PD laws, term by term."""

import numpy as np
import pytest
from instant import at

from dexrepro.control.gravity_pd import GravityPD
from dexrepro.control.joint_pd import JointPD
from dexrepro.control.motion import Motion

Q, DQ, PUSH = np.array([0.3, -0.2]), np.array([0.1, 0.4]), np.array([0.6, -0.9])
DESIRED = Motion(np.array([0.5, 0.1]), np.array([-0.2, 0.3]), np.zeros(2))


class Model:
    def gravity(self, q):
        return 2.0 * np.cos(q)


def test_gravity_pd_cancels_the_external_torque_and_carries_the_weight_at_the_goal():
    law = GravityPD(Model(), stiffness=[3.0, 4.0], damping=0.5)
    error, rate = DESIRED.position - Q, DESIRED.velocity - DQ
    expected = np.array([3.0, 4.0]) * error + 0.5 * rate + 2.0 * np.cos(DESIRED.position) - PUSH
    assert law(at(Q, PUSH, DQ), DESIRED).torque == pytest.approx(expected)
    limited = GravityPD(Model(), stiffness=[3.0, 4.0], damping=0.5, torque_limit=1.0)
    assert limited(at(Q, PUSH, DQ), DESIRED).torque == pytest.approx(np.clip(expected, -1.0, 1.0))


def test_joint_pd_pulls_to_the_goal_and_knows_nothing_of_the_push():
    law = JointPD(stiffness=np.array([3.0, 4.0]), damping=0.5)
    expected = np.array([3.0, 4.0]) * (DESIRED.position - Q) + 0.5 * (DESIRED.velocity - DQ)
    assert law(at(Q, PUSH, DQ), DESIRED).torque == pytest.approx(expected)
