"""Tracking inside prescribed bounds, on a two-link arm integrated by Runge-Kutta steps."""

import numpy as np
import pytest
from instant import at
from planar_plant import PlanarPlant

from dexrepro.control.bounded_neural import BoundedNeuralTracking, barrier
from dexrepro.control.gravity_pd import GravityPD
from dexrepro.control.motion import Motion
from dexrepro.control.prescribed_performance import PerformanceBound
from dexrepro.networks import AdaptiveNetwork, Gaussians

STEP = 1e-3
BOUND = PerformanceBound(0.15, 0.02, 2.0)


class Model:
    """The plant's dynamics with all masses multiplied by a factor."""

    def __init__(self, plant, factor=1.0):
        self.plant, self.factor = plant, factor

    def mass_matrix(self, q):
        return self.factor * self.plant.dynamics(q, np.zeros(2))[0]

    def gravity(self, q):
        return self.factor * self.plant.dynamics(q, np.zeros(2))[2]

    def bias(self, q, dq):
        _, coriolis, gravity = self.plant.dynamics(q, dq)
        return self.factor * (coriolis @ dq + gravity)


PLANT = PlanarPlant(mass=0.3, length=0.25, inertia=0.002)


def desired(t):
    phase = np.array([2.0, 3.0]) * t
    rate = np.array([2.0, 3.0])
    size = np.array([0.3, 0.2])
    position = np.array([0.4, 0.8]) + size * np.sin(phase)
    return Motion(position, size * rate * np.cos(phase), -size * rate**2 * np.sin(phase))


def network(gain=3.0):
    samples = np.array([np.concatenate([q / 0.35, dq / 1.2]) for q, dq, _ in map(desired, np.linspace(0, 6, 30))])
    return AdaptiveNetwork(Gaussians(samples, np.sqrt(2)), 2, gain=gain, leakage=0.01, step=STEP)


def law(factor=0.7, learner=None, **options):
    settings = {"convergence": 10.0, "velocity_gain": 0.5, "barrier_gain": 5e-3, "dt": STEP, "torque_limit": 5.0}
    return BoundedNeuralTracking(Model(PLANT, factor), learner, bound=BOUND, **{**settings, **options})


def run(tracking, offset=(0.05, -0.05), duration=3.0):
    q, dq = desired(0.0)[0] - np.array(offset), np.zeros(2)
    errors = []
    for k in range(round(duration / STEP)):
        target = desired(k * STEP)
        errors.append(target[0] - q)
        q, dq = PLANT.step(q, dq, tracking(at(q, 0.0, dq), target).torque, 0.0, STEP)
    return np.array(errors)


def usage(errors):
    return np.abs(BOUND.usage(errors, BOUND.nu(STEP * np.arange(len(errors)))[:, None])).max()


def test_errors_vanish_with_an_exact_model_and_no_network():
    errors = run(law(factor=1.0, barrier_gain=0.0))
    assert np.abs(errors[-1]).max() < 1e-3
    assert usage(errors) < 1


def test_network_makes_up_for_a_wrong_model():
    plain, learned = run(law()), run(law(learner=network()))
    late = slice(2000, None)
    assert usage(learned) < 1
    assert np.abs(learned[late]).max() < 0.3 * np.abs(plain[late]).max()


def test_printed_sign_of_the_network_drives_the_errors_out_of_the_bound():
    assert usage(run(law(learner=network(), printed=["network"]))) > 1


def test_barrier_term_keeps_the_bound_where_it_would_be_left():
    assert usage(run(law(barrier_gain=0.0, velocity_gain=0.15))) > 1
    assert usage(run(law(barrier_gain=2e-2, velocity_gain=0.15))) < 1


def test_printed_gain_vanishes_with_the_bound_s_rate():
    errors = run(law(barrier_gain=0.0, printed=["virtual_gain"]))
    assert np.abs(errors[-1]).max() > np.abs(run(law(barrier_gain=0.0))[-1]).max()


def test_virtual_gain_s_derivative_is_that_of_the_gain():
    for printed in ((), ["virtual_gain"]):
        tracking = law(printed=printed)
        gains = [tracking._virtual_gain() for _ in range(4)]
        assert (gains[2][1] - gains[0][1]) / (2 * STEP) == pytest.approx(gains[1][2], rel=1e-4)


def test_contact_torque_is_taken_off_and_the_torque_limited():
    tracking, target = law(), desired(0.0)
    q, dq, _ = target
    plain = tracking(at(q, 0.0, dq), target).torque
    tracking.reset(at(q))
    touched = tracking(at(q, np.array([0.1, -0.2]), dq), target).torque
    np.testing.assert_allclose(touched, plain - [0.1, -0.2])
    assert np.abs(law(torque_limit=0.05)(at(q - 1.0, 0.0, dq), target).torque).max() == pytest.approx(0.05)


def test_barrier_value_has_the_derivative_of_the_corrected_equation():
    bound = PerformanceBound(0.15, 0.02, 2.0, lower=0.6, upper=0.8)
    error, rate, dt = np.array([0.03, -0.02]), np.array([0.1, 0.05]), 1e-6
    values = [barrier((error + shift * rate)[None], bound, [0.4 + shift])[0] for shift in (-dt, dt)]
    nu, ratio, _ = bound.rate(0.4)
    limit = bound.limit(error, nu)
    expected = np.sum((error * rate - error**2 * ratio) / (limit**2 - error**2))
    assert (values[1] - values[0]) / (2 * dt) == pytest.approx(expected, rel=1e-6)
    assert np.isinf(barrier(np.array([[0.2, 0.0]]), bound, [0.0])[0])


def test_gravity_pd_holds_the_arm_still_with_an_exact_model():
    tracking = GravityPD(Model(PLANT), stiffness=1.0, damping=0.1)
    q = np.array([0.4, 0.8])
    torque = tracking(at(q, 0.0, np.zeros(2)), Motion(q, np.zeros(2), np.zeros(2))).torque
    np.testing.assert_allclose(torque, Model(PLANT).gravity(q))
    stiffer = tracking(at(q - 0.1, 0.0, np.zeros(2)), Motion(q, np.zeros(2), np.zeros(2))).torque
    np.testing.assert_allclose(stiffer - torque, 0.1)


def test_the_printed_robust_term_drives_every_weight_upward_whatever_the_error():
    for side in (1.0, -1.0):
        learner = network(gain=0.0)
        tracking = law(learner=learner, robust_rate=1.0)
        q, dq, ddq = desired(0.0)
        tracking(at(q - side * 0.1, 0.0, dq), Motion(q, dq, ddq))
        delta = tracking.velocity_error
        np.testing.assert_allclose(learner.weights[0], STEP * np.tanh(delta / 0.1) * delta)
        assert (learner.weights > 0).all()


def test_the_printed_gain_has_the_claimed_rate_only_while_the_bound_shrinks_fast_enough():
    def rate(decay):
        tracking = law(printed=["virtual_gain"], convergence=10.0)
        tracking.bound = PerformanceBound(0.15, 1e-9, decay)
        _, gain, _ = tracking._virtual_gain()
        return -(gain + decay)  # -(L - v'/v), which (5.39) wants to be k_c at least

    assert rate(2.0) > 10.0 > rate(1.0)


def test_the_network_adds_its_output_at_the_state_in_units_of_its_scales():
    learner = network(gain=0.0)
    learner.reset(np.random.default_rng(0).normal(size=(30, 2)))
    q, dq, ddq = desired(0.3)
    plain, learned, printed = (
        law(learner=which, printed=forms)(at(q - 0.05, 0.0, dq + 0.3), Motion(q, dq, ddq)).torque
        for which, forms in ((None, ()), (learner, ()), (learner, ("network",)))
    )
    expected = learner.output(np.concatenate([(q - 0.05) / 0.35, (dq + 0.3) / 1.2]))
    assert np.abs(expected).min() > 1e-3
    np.testing.assert_allclose(learned - plain, expected, rtol=1e-4)
    np.testing.assert_allclose(printed - plain, -expected, rtol=1e-4)


def test_a_reset_law_starts_its_bound_anew():
    tracking, target = law(), desired(0.0)
    first, second = (tracking(at(target[0] - 0.05, 0.0, target[1]), target).torque for _ in range(2))
    tracking.reset(at(target[0]))
    assert np.array_equal(tracking(at(target[0] - 0.05, 0.0, target[1]), target).torque, first)
    assert not np.array_equal(second, first)
    nu, gain, _ = law()._virtual_gain()
    assert nu == pytest.approx(BOUND.nu(0.0)), "at t = 0"
    assert gain == pytest.approx(-(10.0 + abs(BOUND.rate(0.0)[1])))


def test_the_printed_gain_is_the_bound_s_rate_times_a_root_of_limits_and_convergence():
    """L = -(1/b_u^2 + 1/b_l^2 + k_c^2)^(1/2) |v'/v|: the printed form of Eq. (5.38)."""
    tracking = law(printed=["virtual_gain"])
    tracking.bound = bound = PerformanceBound(0.15, 0.02, 2.0, lower=0.6, upper=0.8)
    expected = -np.sqrt(1 / 0.8**2 + 1 / 0.6**2 + 10.0**2) * abs(bound.rate(0.0)[1])
    assert tracking._virtual_gain()[1] == pytest.approx(expected)


def test_the_push_of_the_barrier_no_longer_grows_close_to_the_bound():
    """F = e / (b^2 - e^2) up to 0.9998 of the bound, where 1 - e^2/b^2 is 0.02^2; beyond it the push stays."""
    target = Motion(*np.zeros((3, 2)))

    def push(share):
        place = at(-share * 0.15 * np.ones(2), 0.0, np.zeros(2))
        return (
            law(barrier_gain=1.0, torque_limit=np.inf)(place, target).torque
            - law(barrier_gain=0.0)(place, target).torque
        )

    assert push(0.99) == pytest.approx(0.99 / (0.15 * (1 - 0.99**2)), rel=1e-6)
    assert push(1.0) == pytest.approx(1.0 / (0.15 * 0.02**2), rel=2e-3)
    assert push(1.2) == pytest.approx(push(1.0))
