import numpy as np
import pytest
from instant import at

from dexrepro.control.motion import Motion
from dexrepro.control.target_impedance import TargetImpedance
from dexrepro.robots.planar import PlanarChain

ARM = PlanarChain((0.5, 0.3, 0.1), (1.5, 0.9, 0.2))


def test_the_tip_obeys_the_target_impedance_under_the_measured_force():
    law = TargetImpedance(model=ARM, mass=0.5, damping=2.0, stiffness=10.0, desired_force=1.0)
    q, dq, force, target = [1.0, 0.8, 0.6], [0.2, -0.4, 0.3], (1.7, 0.4), (0.1, 0.7)
    torque = law(at(None, force, joints=(q, dq)), Motion(target, 0.0, 0.0)).torque
    joints = np.array(ARM.acceleration(q, dq, np.add(torque, ARM.tip_torque(q, force))))
    jacobian = np.array(ARM.jacobian(q))
    ax, ay = jacobian @ joints + ARM.centripetal(q, dq)
    (x, y), (vx, vy) = ARM.forward(q), jacobian @ dq
    assert 0.5 * ax + 2.0 * vx + 10.0 * (x - 0.1) == pytest.approx(0.7, abs=1e-9)
    assert ay == pytest.approx(100.0**2 * (0.7 - y) - 200.0 * vy, abs=1e-8)


def test_motion_that_leaves_the_tip_where_it_is_decays_at_its_own_rate():
    """Along n with J n = 0 the law asks for n . q'' = -decay n . q', whatever the tip does."""
    law = TargetImpedance(model=ARM, mass=0.5, damping=2.0, stiffness=10.0, desired_force=1.0, null_damping=7.0)
    q, dq, force = [1.0, 0.8, 0.6], [0.2, -0.4, 0.3], (1.7, 0.4)
    torque = law(at(None, force, joints=(q, dq)), Motion((0.1, 0.7), 0.0, 0.0)).torque
    joints = ARM.acceleration(q, dq, np.add(torque, ARM.tip_torque(q, force)))
    idle = np.cross(*np.array(ARM.jacobian(q)))
    assert abs(idle @ dq) > 1e-3
    assert idle @ joints == pytest.approx(-7.0 * (idle @ dq))


def test_against_a_spring_the_force_settles_where_the_stiffnesses_balance():
    """e (k + k_o) = k k_o (x_c - f_d / k_o - x_r): Eq. (2.30)."""
    law = TargetImpedance(model=ARM, mass=0.5, damping=10.0, stiffness=10.0, desired_force=1.0)
    q, dq, rest = [1.0, 0.8, 0.6], [0.0] * 3, ARM.forward([1.0, 0.8, 0.6])[0] + 0.05
    target = (rest - 0.05, ARM.forward(q)[1])
    for _ in range(5000):
        force = (35.0 * (rest - ARM.forward(q)[0]), 0.0)
        torque = np.add(law(at(None, force, joints=(q, dq)), Motion(target, 0.0, 0.0)).torque, ARM.tip_torque(q, force))
        dq = [v + 1e-3 * a for v, a in zip(dq, ARM.acceleration(q, dq, torque))]
        q = [a + 1e-3 * v for a, v in zip(q, dq)]
    error = force[0] - 1.0
    assert error == pytest.approx(35.0 / 45.0 * (10.0 * 0.05 - 10.0 / 35.0), rel=1e-3)
