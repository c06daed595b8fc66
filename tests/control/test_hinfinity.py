import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instant import at
from scipy.linalg import eigvals

from dexrepro.control.hinfinity import HInfinityTracking, hinfinity_gain, integrator_chain
from dexrepro.control.motion import Motion


class PointMass:
    """A mass on a plane under gravity and viscous friction: every term is known."""

    def __init__(self, mass=2.0, friction=0.0):
        self.mass, self.friction = mass, friction

    def mass_matrix(self, position):
        return self.mass * np.eye(2)

    def bias(self, position, velocity):
        return self.friction * velocity + np.array([0.0, 9.8 * self.mass])

    def jacobian(self, position):
        return np.eye(2)


def settle(law, plant, duration=2.0, dt=1e-3, push=0.0):
    position, velocity, target = np.array([0.1, 0.0]), np.zeros(2), Motion(np.zeros(2), np.zeros(2), np.zeros(2))
    for _ in range(round(duration / dt)):
        force = law(at(position, np.zeros(2), velocity), target).force
        acceleration = (force + push - plant.bias(position, velocity)) / plant.mass
        velocity = velocity + dt * acceleration
        position = position + dt * velocity
    return position


def achieved_norm(gain, weights, effort):
    """H-infinity norm from the disturbance to [sqrt(Q) e, sqrt(r) u] under u = -K e, by bisection."""
    system, control = integrator_chain(len(weights))
    closed = system - control @ gain[None, :]
    output = np.diag(np.asarray(weights, float)) + effort * np.outer(gain, gain)
    low, high = 0.0, 1.0

    def exceeded(level):
        hamiltonian = np.block([[closed, control @ control.T / level**2], [-output, -closed.T]])
        roots = eigvals(hamiltonian)
        return np.any(np.abs(roots.real) < 1e-8 * np.abs(roots))

    while exceeded(high):
        low, high = high, 2.0 * high
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if exceeded(middle) else (low, middle)
    return high


def test_the_design_of_the_comparison_has_the_known_gain_and_norm():
    gain = hinfinity_gain((1e6, 400.0), effort=1.0, attenuation=1.5)
    assert gain == pytest.approx([1341.6, 74.5], rel=1e-3)
    assert achieved_norm(gain, (1e6, 400.0), 1.0) == pytest.approx(1.292, abs=1e-3)


@given(st.floats(1e2, 1e6), st.floats(1.0, 1e3), st.floats(1.05, 5.0))
@settings(max_examples=20, deadline=None)
def test_the_attenuation_asked_for_is_reached(position_weight, velocity_weight, attenuation):
    weights = (position_weight, velocity_weight)
    assert achieved_norm(hinfinity_gain(weights, 1.0, attenuation), weights, 1.0) <= attenuation * (1 + 1e-6)


def test_an_attenuation_below_the_limit_is_refused():
    with pytest.raises(ValueError, match="cannot be reached"):
        hinfinity_gain((1.0, 1.0), effort=4.0, attenuation=2.0)


def test_an_exact_model_leaves_no_error_and_a_push_leaves_the_static_one():
    law = HInfinityTracking(PointMass(), hinfinity_gain((1e6, 400.0), 1.0, 1.5), dt=1e-3)
    assert settle(law, PointMass()) == pytest.approx([0.0, 0.0], abs=1e-6)
    assert settle(law, PointMass(), push=3.0) == pytest.approx([3.0 / (2.0 * law.gain[0])] * 2, rel=1e-3)


def test_integral_action_removes_the_error_of_a_wrong_model():
    gain = hinfinity_gain((4e7, 6e5, 800.0), 1.0, 1.5)
    wrong = PointMass(mass=1.6)
    static = HInfinityTracking(wrong, hinfinity_gain((1e6, 400.0), 1.0, 1.5), dt=1e-3)
    assert abs(settle(static, PointMass(friction=1.0))[1]) > 1e-3
    law = HInfinityTracking(wrong, gain, dt=1e-3)
    assert settle(law, PointMass(friction=1.0), duration=4.0) == pytest.approx([0.0, 0.0], abs=1e-6)


def test_the_drift_of_the_jacobian_is_part_of_the_acceleration():
    class Crank(PointMass):
        def jacobian(self, position):
            return np.diag(np.cos(position))

    law = HInfinityTracking(Crank(), (0.0, 0.0), dt=1e-3)
    position, velocity = np.array([0.3, -0.4]), np.array([0.7, 0.2])
    _, drift = law._kinematics(position, velocity, axes=2)
    assert drift == pytest.approx(-np.sin(position) * velocity**2, rel=1e-8)


def test_without_a_disturbance_to_fear_the_gain_is_the_linear_quadratic_one():
    """Double integrator, gamma -> infinity: k1 = sqrt(q1 / r), k2 = sqrt(q2 / r + 2 k1)."""
    stiffness = np.sqrt(900.0 / 4.0)
    expected = (stiffness, np.sqrt(50.0 / 4.0 + 2 * stiffness))
    assert hinfinity_gain((900.0, 50.0), effort=4.0, attenuation=1e6) == pytest.approx(expected)


def test_the_force_is_the_inverse_dynamics_of_the_desired_acceleration_and_the_feedback():
    """F = M (x_d'' - K [integral e, e, e']) + n with e = x - x_d: the tip of a crank, J = diag(cos q)."""

    class Crank(PointMass):
        def jacobian(self, position):
            return np.diag(np.cos(position))

    law, dt = HInfinityTracking(Crank(friction=0.5), (5.0, 30.0, 8.0), dt=0.01), 0.01
    q, dq = np.array([0.3, -0.4]), np.array([0.7, 0.2])
    x, v = np.sin(q), np.cos(q) * dq
    goal = Motion(np.array([0.1, 0.2]), np.array([-0.3, 0.4]), np.array([1.0, -2.0]))

    def wanted(integral):
        acceleration = goal.acceleration - 8.0 * (v - goal.velocity) - 30.0 * (x - goal.position) - 5.0 * integral
        joints = (acceleration + np.sin(q) * dq**2) / np.cos(q)
        return (2.0 * joints + 0.5 * dq + [0.0, 19.6]) / np.cos(q)

    told = at(x, np.zeros(2), v, joints=(q, dq))
    for k in (1, 2):
        assert law(told, goal).force == pytest.approx(wanted(k * dt * (x - goal.position)), rel=1e-6)
    law.reset(told)
    assert law(told, goal).force == pytest.approx(wanted(dt * (x - goal.position)), rel=1e-6)
