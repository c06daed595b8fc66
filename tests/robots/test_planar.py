import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.robots.planar import PlanarChain

ARM = PlanarChain((0.5, 0.3, 0.1), (1.5, 0.9, 0.2), base=(0.5, 0.0))
angles = st.tuples(*[st.floats(-3, 3)] * 3)


@pytest.mark.parametrize(
    ("q", "base", "tip"),
    [
        ((math.pi / 3,) * 3, 0.5, (0.5, 0.6928)),
        ((0.9112, 1.4184, 0.8120), 0.5, (0.5, 0.6128)),
        ((2 * math.pi / 3, -math.pi / 3, -math.pi / 3), 0.0, (0.0, 0.6928)),
    ],
)
def test_printed_poses_of_the_two_arms(q, base, tip):
    arm = PlanarChain((0.5, 0.3, 0.1), (1.5, 0.9, 0.2), base=(base, 0.0))
    assert arm.forward(q) == pytest.approx(tip, abs=1e-4)


@settings(deadline=None, max_examples=20)
@given(angles)
def test_jacobian_is_the_derivative_of_the_tip(q):
    h = 1e-6
    for j in range(3):
        ahead, behind = list(q), list(q)
        ahead[j] += h
        behind[j] -= h
        slope = [(a - b) / (2 * h) for a, b in zip(ARM.forward(ahead), ARM.forward(behind))]
        assert [row[j] for row in ARM.jacobian(q)] == pytest.approx(slope, abs=1e-8)


@settings(deadline=None, max_examples=20)
@given(angles, angles, angles)
def test_dynamics_agree_with_a_rigid_body_library(q, dq, torque):
    pin = pytest.importorskip("pinocchio")
    model = pin.Model()
    joint, offset = 0, 0.0
    for length, mass in zip((0.5, 0.3, 0.1), (1.5, 0.9, 0.2)):
        placement = pin.SE3(np.eye(3), np.array([offset, 0, 0]))
        joint = model.addJoint(joint, pin.JointModelRZ(), placement, f"j{offset}")
        inertia = pin.Inertia(mass, np.array([length / 2, 0, 0]), np.diag([0, 1, 1]) * mass * length**2 / 12)
        model.appendBodyToJoint(joint, inertia, pin.SE3.Identity())
        offset = length
    model.gravity.linear[:] = 0
    expected = pin.aba(model, model.createData(), *(np.array(v, float) for v in (q, dq, torque)))
    assert ARM.acceleration(q, dq, torque) == pytest.approx(expected, rel=1e-8, abs=1e-8)


@settings(deadline=None, max_examples=20)
@given(angles, angles, angles)
def test_inverse_dynamics_undoes_the_dynamics(q, dq, torque):
    assert ARM.torque(q, dq, ARM.acceleration(q, dq, torque)) == pytest.approx(torque, abs=1e-9)


@settings(deadline=None, max_examples=20)
@given(angles, angles)
def test_centripetal_acceleration_is_the_second_derivative_at_constant_rates(q, dq):
    h = 1e-4
    places = [np.array(ARM.forward([a + s * h * b for a, b in zip(q, dq)])) for s in (-1, 0, 1)]
    assert ARM.centripetal(q, dq) == pytest.approx((places[0] - 2 * places[1] + places[2]) / h**2, abs=1e-4)


def test_closed_loop_inverse_kinematics_reaches_its_target():
    q = (math.pi / 3,) * 3
    for _ in range(30):
        q = ARM.approach(q, (0.6, 0.6))
    assert ARM.forward(q) == pytest.approx((0.6, 0.6), abs=1e-9)


@settings(deadline=None, max_examples=10)
@given(angles, st.tuples(st.floats(-5, 5), st.floats(-5, 5)))
def test_tip_force_does_the_work_of_its_joint_torques(q, force):
    (jx, jy), torque = ARM.jacobian(q), ARM.tip_torque(q, force)
    assert torque == pytest.approx([x * force[0] + y * force[1] for x, y in zip(jx, jy)])


def test_a_batch_equals_single_arms():
    batch = PlanarChain((0.5, 0.3, 0.1), (1.5, 0.9, 0.2), functions=np)
    single = PlanarChain((0.5, 0.3, 0.1), (1.5, 0.9, 0.2))
    q, dq, torque = np.random.default_rng(0).normal(size=(3, 3, 4))
    together = np.array(batch.acceleration(q, dq, torque))
    for i in range(4):
        assert single.acceleration(q[:, i], dq[:, i], torque[:, i]) == pytest.approx(together[:, i])


@settings(deadline=None, max_examples=10)
@given(angles)
def test_gravity_torque_is_the_slope_of_the_potential_energy(q):
    def potential(q):
        heights, total = np.array([0.25, 0.15, 0.05]), 0.0
        for i, mass in enumerate((1.5, 0.9, 0.2)):
            t = np.cumsum(q)
            total += mass * 9.81 * (np.sum((0.5, 0.3, 0.1)[:i] * np.sin(t[:i])) + heights[i] * np.sin(t[i]))
        return total

    slope = [(potential(q + 1e-6 * e) - potential(q - 1e-6 * e)) / 2e-6 for e in np.eye(3)]
    assert ARM.gravity(q) == pytest.approx(slope, abs=1e-6)


@pytest.mark.parametrize("damping", [0.0, 0.3])
def test_rates_are_those_of_the_damped_pseudo_inverse_and_an_approach_is_one_step_of_them(damping):
    q, velocity = (0.4, 0.9, -0.6), np.array([0.7, -0.2])
    jacobian = np.array(ARM.jacobian(q))
    expected = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping**2 * np.eye(2), velocity)
    assert ARM.rates(q, velocity, damping) == pytest.approx(expected)
    target = np.array(ARM.forward(q)) + velocity
    assert ARM.approach(q, target, damping) == pytest.approx(np.array(q) + expected)
