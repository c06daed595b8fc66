import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instant import at
from planar_plant import PlanarPlant

from dexrepro.control.global_adaptive import GlobalAdaptiveControl, RobustTerm, Switch
from dexrepro.control.motion import Motion
from dexrepro.control.prescribed_performance import PerformanceBound
from dexrepro.networks import AdaptiveNetwork, GrowingGaussians

BOUND = PerformanceBound(initial=1.25, final=0.1, decay=1.0, lower=0.2, upper=0.2)


def ellipse(t):
    a, rate = 2 * np.pi * t / 5 + np.pi / 2, 2 * np.pi / 5
    c, s = np.cos(a), np.sin(a)
    return Motion(
        np.array([1 + 0.3 * c, 0.2 * s]),
        rate * np.array([-0.3 * s, 0.2 * c]),
        rate**2 * np.array([-0.3 * c, -0.2 * s]),
    )


class ExactDynamics:
    """Stands where the network does and knows F = -(M alpha' + C alpha + G)."""

    def __init__(self, plant):
        self.plant = plant

    def output(self, z, grow=False):
        mass, coriolis, gravity = self.plant.dynamics(z[:2], z[2:4])
        return -(mass @ z[6:8] + coriolis @ z[4:6] + gravity)

    def adapt(self, error):
        pass


def control(plant, network, **options):
    return GlobalAdaptiveControl(
        plant, network, bound=BOUND, position_gain=30.0, velocity_gain=np.full(2, 30.0), step=1e-3, **options
    )


def tip(plant, q, dq):
    return at(plant.position(q), 0.0, plant.jacobian(q) @ dq, joints=(q, dq))


def follow(law, plant, duration, force=(0.0, 0.0)):
    q, dq = plant.inverse(np.array([1.0, 0.0])), np.zeros(2)
    errors, energies = [], []
    for k in range(round(duration / 1e-3)):
        torque, damping, _ = law(tip(plant, q, dq), ellipse(k * 1e-3))
        mass = plant.dynamics(q, dq)[0]
        z2 = law.velocity_error
        energies.append(0.5 * np.sum(np.log(1 / (1 - law.usage**2))) + 0.5 * z2 @ mass @ z2)
        errors.append(law.error)
        q, dq = plant.step(q, dq, torque, damping, 1e-3, force)
    return np.array(errors), np.array(energies)


def test_gravity_torque_of_the_plant_at_the_start_is_the_known_one():
    plant = PlanarPlant()
    assert plant.dynamics(plant.inverse(np.array([1.0, 0.0])), np.zeros(2))[2] == pytest.approx([98.0, 24.5])


def test_with_the_exact_dynamics_the_lyapunov_function_never_increases():
    plant = PlanarPlant()
    _, energy = follow(control(plant, ExactDynamics(plant)), plant, 3.0)
    assert energy[0] == pytest.approx(215.93, rel=2e-3)
    assert np.all(np.diff(energy) <= 1e-9 * energy[0])
    assert energy[-1] < 1e-5


class ThreeLinks:
    """Kinematics of three unit links in a plane: one joint more than the task has axes."""

    def position(self, q):
        angles = np.cumsum(q)
        return np.array([np.cos(angles).sum(), np.sin(angles).sum()])

    def jacobian(self, q):
        angles = np.cumsum(q)
        return np.array([[-np.sin(angles)[j:].sum() for j in range(3)], [np.cos(angles)[j:].sum() for j in range(3)]])


@pytest.mark.parametrize(
    ("arm", "q", "dq"),
    [(PlanarPlant(), [-0.95, 2.1], [0.4, -0.7]), (ThreeLinks(), [-1.2, 1.4, 0.9], [0.4, -0.7, 0.5])],
)
def test_virtual_acceleration_is_the_derivative_of_the_virtual_velocity(arm, q, dq):
    n, h, q, dq, alphas = len(q), 1e-5, np.array(q), np.array(dq), []
    law = GlobalAdaptiveControl(arm, None, bound=BOUND, position_gain=30.0, velocity_gain=np.full(n, 30.0), step=h)
    for k in range(3):
        law(tip(arm, q + k * h * dq, dq), ellipse(k * h))
        alphas.append(law.input.copy())
    assert alphas[1][3 * n :] == pytest.approx((alphas[2] - alphas[0])[2 * n : 3 * n] / (2 * h), rel=1e-5, abs=1e-4)


def test_an_adaptive_network_keeps_the_bound_and_removes_the_gravity_error():
    plant = PlanarPlant()
    basis = GrowingGaussians(8, width=20.0, threshold=20.0, neighbours=3, placement=0.5, interval=10)
    network = AdaptiveNetwork(basis, 2, gain=60.0, leakage=0.01, step=1e-3)
    law = control(plant, network, switch=Switch(5.0, 20.0), robust=RobustTerm([200.0, 80.0], [0.1, 0.12]))
    errors, _ = follow(law, plant, 6.0, force=(0.0, 2.0))
    bare, _ = follow(control(plant, None), plant, 6.0, force=(0.0, 2.0))
    bound = 0.2 * BOUND.nu(np.arange(len(errors)) * 1e-3)[:, None]
    assert np.all(np.abs(errors) < bound)
    assert np.sqrt(np.mean(errors[-2000:] ** 2)) < 0.5 * np.sqrt(np.mean(bare[-2000:] ** 2))


def test_learning_can_be_frozen():
    plant = PlanarPlant()
    network = AdaptiveNetwork(GrowingGaussians(8, width=20, threshold=5), 2, gain=60.0, leakage=0.01, step=1e-3)
    law = control(plant, network)
    law.learning = False
    follow(law, plant, 0.2)
    assert network.basis.nodes == 1
    assert not network.weights.any()


@settings(deadline=None, max_examples=50)
@given(st.lists(st.floats(-30, 30), min_size=3, max_size=3), st.sampled_from([(0.6382, False), (1, False), (2, True)]))
def test_switch_lies_between_zero_and_one(z, reading):
    shape, outside = reading
    assert 0.0 <= Switch(5.0, 20.0, shape, outside)(z) <= 1.0 + 1e-6


def test_switch_is_one_inside_zero_outside_and_continuous():
    switch = Switch(5.0, 20.0)
    assert switch([4.9, -4.9]) == 1.0
    assert switch([0.0, 20.1]) == 0.0
    assert switch([5.0 + 1e-9, 0.0]) == pytest.approx(1.0)
    assert switch([20.0 - 1e-9, 0.0]) == pytest.approx(0.0, abs=1e-8)


def test_switch_exceeds_one_below_the_smallest_admissible_shape():
    sizes = np.linspace(5, 20, 400)
    assert Switch(5.0, 20.0, 0.638).component(sizes, 5.0, 20.0).max() > 1.0
    assert Switch(5.0, 20.0, 0.6382).component(sizes, 5.0, 20.0).max() == pytest.approx(1.0)
    assert Switch(5.0, 20.0, 1.0, True).component(sizes, 5.0, 20.0).max() > 1.0


def test_the_square_is_of_the_argument_or_of_the_exponential():
    """Both readings of Eq. (4.26): (1 - s) times exp((s / w)^2) or exp(s / w)^2, s = (Xi^2 - a^2) / (b^2 - a^2)."""
    sizes = np.linspace(5.0, 20.0, 7)
    share = (sizes**2 - 25.0) / 375.0
    for shape in (0.8, 2.0):
        inside, outside = (Switch(5.0, 20.0, shape, way).component(sizes, 5.0, 20.0) for way in (False, True))
        assert inside == pytest.approx((1 - share) * np.exp(share**2 / shape**2))
        assert outside == pytest.approx((1 - share) * np.exp(share / shape) ** 2)
    mixed = [7.0, -3.0, 12.0]
    assert Switch(5.0, 20.0)(mixed) == pytest.approx(np.prod(Switch(5.0, 20.0).component([7.0, 12.0], 5.0, 20.0)))


def test_a_reset_law_starts_its_bound_anew():
    plant = PlanarPlant()
    law, told = control(plant, None), tip(plant, plant.inverse(np.array([1.0, 0.05])), np.array([0.4, -0.7]))
    first, second = law(told, ellipse(0.0)).torque, law(told, ellipse(0.0)).torque
    law.reset(told)
    assert np.array_equal(law(told, ellipse(0.0)).torque, first)
    assert np.array_equal(law.usage, BOUND.usage(law.error, BOUND.nu(0.0))), "at t = 0"
    assert not np.array_equal(second, first)


def test_switch_scales_with_the_farthest_node():
    switch = Switch(0.2, 0.6, node_scaled=True)
    assert switch([1.0], radius=10.0) == 1.0
    assert switch([1.0], radius=1.0) == 0.0


def test_robust_term_is_bounded_and_odd():
    term = RobustTerm([200.0, 80.0], [0.1, 0.12])
    assert term(np.array([10.0, -10.0])) == pytest.approx([200.0, -80.0])
    assert term(np.zeros(2)) == pytest.approx([0.0, 0.0])
