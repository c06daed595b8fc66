import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instant import at

from dexrepro.control.barrier_tracking import BarrierTracking, barrier_energy, barrier_terms
from dexrepro.control.motion import Motion
from dexrepro.networks import AdaptiveNetwork, GrowingGaussians

BOUND = 0.05
inside = st.floats(-0.999, 0.999).map(lambda share: share * BOUND)


@given(inside)
def test_the_barrier_decays_with_exactly_the_position_gain(error):
    phi, _, force = barrier_terms(error, BOUND)
    assert force * phi == pytest.approx(barrier_energy(error, BOUND), rel=1e-9, abs=1e-20)


@given(inside.filter(lambda z: abs(z) > 1e-4))
def test_the_slope_is_the_derivative(error):
    step = 1e-8
    numeric = (barrier_terms(error + step, BOUND)[0] - barrier_terms(error - step, BOUND)[0]) / (2 * step)
    assert barrier_terms(error, BOUND)[1] == pytest.approx(numeric, abs=1e-6)


def test_the_limits_of_the_barrier():
    assert barrier_terms(0.0, BOUND) == (0.0, 0.5, 0.0)
    assert barrier_terms(1e-4, BOUND)[0] == pytest.approx(0.5e-4, rel=1e-6)
    assert barrier_terms(BOUND, BOUND)[0] == pytest.approx(0.0, abs=1e-15)
    assert barrier_terms(0.01, 1e3)[2] == pytest.approx(0.01, rel=1e-6)
    assert barrier_energy(0.01, 1e3) == pytest.approx(0.5e-4, rel=1e-6)
    shares = np.linspace(0.01, 0.99, 981)
    assert shares[np.argmax([barrier_terms(s * BOUND, BOUND)[0] for s in shares])] == pytest.approx(0.609, abs=2e-3)


@given(inside, st.sampled_from([1e-3, 1.0, 20.0]))
def test_the_barrier_has_no_length_of_its_own(error, scale):
    phi, slope, force = barrier_terms(error, BOUND)
    assert barrier_terms(scale * error, scale * BOUND) == pytest.approx((scale * phi, slope, scale * force), rel=1e-6)


def test_the_terms_are_continuous_at_the_target():
    """phi -> z/2, where 0/0 is not computed: the error there is of the fourth order in z."""
    assert barrier_terms(1e-9, BOUND) == pytest.approx((0.5e-9, 0.5, 1e-9), rel=1e-9)


def test_beyond_the_barrier_the_virtual_control_points_the_wrong_way():
    assert barrier_terms(1.2 * BOUND, BOUND)[0] < 0
    assert barrier_terms(math.sqrt(2) * BOUND, BOUND)[0] == pytest.approx(0.0, abs=1e-12)


def network(outputs, dimension, gain, enhanced=True):
    basis = GrowingGaussians(dimension, width=0.1, threshold=0.1, enhanced=enhanced)
    return AdaptiveNetwork(basis, outputs, gain=gain, leakage=5.0, step=1e-3)


def controller(gain=1000.0, **options):
    return BarrierTracking(
        (network(4, 2, 100.0), network(4, 4, 100.0), network(2, 2, gain)),
        bound=(BOUND, BOUND), position_gain=(80, 80), velocity_gain=(60, 60), robust_gain=(5, 5), **options,
    )  # fmt: skip


def drive(law, mass=2.0, load=(0.0, -20.0), start=(0.03, 0.0), duration=3.0, dt=1e-3, push=(0.0, 0.0)):
    """A point mass with an unknown constant load tracks a circle; errors (n, 2)."""
    position, velocity, errors = np.array([0.2 + start[0], 0.2 + start[1]]), np.zeros(2), []
    for step in range(round(duration / dt)):
        angle = 0.5 * step * dt
        circle, turn = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        target = Motion(np.array([0.1, 0.2]) + 0.1 * circle, 0.05 * turn, -0.025 * circle)
        force = law(at(position, np.array(push), velocity), target).force
        errors.append(position - target.position)
        velocity = velocity + dt * (force + np.array(load) + np.array(push)) / mass
        position = position + dt * velocity
    return np.array(errors)


def test_an_unknown_load_is_carried_inside_the_bound():
    errors = drive(controller(boundary_layer=0.01))
    assert np.abs(errors).max() < BOUND
    assert np.abs(errors[-500:]).max() < 1e-3


def test_the_networks_carry_the_load_and_not_the_feedback():
    learning, idle = controller(boundary_layer=0.01), controller(gain=0.0, boundary_layer=0.01)
    error = np.abs(drive(learning)[-500:, 1]).max()
    assert error < 0.3 * np.abs(drive(idle)[-500:, 1]).max()
    assert learning.network_force[1] > 10.0


def test_a_basis_shared_by_mass_and_gravity_changes_no_number():
    law, apart = controller(), controller()
    inertia, coriolis, _ = law.networks
    law.networks = inertia, coriolis, AdaptiveNetwork(inertia.basis, 2, gain=1000.0, leakage=5.0, step=1e-3)
    assert np.array_equal(drive(law, duration=0.5), drive(apart, duration=0.5))
    assert [network.nodes for network in law.networks] == [network.nodes for network in apart.networks]
    assert apart.networks[2].nodes > 0


def test_the_measured_force_is_cancelled_with_the_minus_sign():
    quiet = drive(controller(boundary_layer=0.01), duration=0.5)
    pushed = drive(controller(boundary_layer=0.01), duration=0.5, push=(10.0, 0.0))
    doubled = drive(controller(boundary_layer=0.01, printed=True), duration=0.5, push=(10.0, 0.0))
    assert pushed == pytest.approx(quiet, abs=1e-9)
    assert np.abs(doubled - quiet).max() > 1e-4


@given(st.floats(0.0, 0.4), st.floats(0.0, 0.4))
@settings(max_examples=20, deadline=None)
def test_enhanced_features_have_one_unit_of_length_more_a_node(x, y):
    broad = GrowingGaussians(2, width=0.1, threshold=0.1)
    plain = GrowingGaussians(2, width=0.1, threshold=0.1, enhanced=False)
    for point in ([0.1, 0.1], [0.3, 0.1], [0.2, 0.3], [x, y]):
        features, gaussians = broad(point, grow=True).copy(), plain(point, grow=True)
    assert features @ features == pytest.approx(broad.nodes + gaussians @ gaussians)


def test_a_reset_law_repeats_itself():
    law = controller()
    first = drive(law, duration=0.2)
    law.reset(at(np.zeros(2)))
    assert np.array_equal(drive(law, duration=0.2), first)


def test_before_anything_is_learned_the_force_is_barrier_velocity_and_robust_term():
    """F = -z1 / cos^2(pi z1^2 / (2 iota^2)) - K_p z2 - K_r sgn(z2), Eq. (8.31), with z2 = x' - x_0' + K_1 phi."""
    law, x, v = controller(), np.array([0.23, 0.18]), np.array([0.05, -0.02])
    target = Motion(np.array([0.21, 0.2]), np.array([0.01, 0.03]), np.array([0.2, -0.1]))
    z1 = x - target.position
    phi = BOUND**2 / (2 * np.pi * z1) * np.sin(np.pi * z1**2 / BOUND**2)
    z2 = v - target.velocity + 80 * phi
    force = law(at(x, np.zeros(2), v), target).force
    assert force == pytest.approx(-z1 / np.cos(np.pi * z1**2 / (2 * BOUND**2)) ** 2 - 60 * z2 - 5 * np.sign(z2))


def test_the_inertia_learns_from_the_rate_of_the_virtual_velocity():
    """dW_D/dt = -Gamma S (z2 alpha'^T), Eq. (8.38), with alpha' by a difference along the motion."""
    law, x, v = controller(), np.array([0.23, 0.18]), np.array([0.05, -0.02])
    target = Motion(np.array([0.21, 0.2]), np.array([0.01, 0.03]), np.array([0.2, -0.1]))

    def alpha(dt):
        z1 = x + dt * v - target.position - dt * target.velocity
        return target.velocity + dt * target.acceleration - 80 * np.array([barrier_terms(z, BOUND)[0] for z in z1])

    law(at(x, np.zeros(2), v), target)
    rate = (alpha(1e-6) - alpha(-1e-6)) / 2e-6
    inertia = law.networks[0]
    expected = -1e-3 * 100.0 * np.outer(inertia.features, np.outer(v - alpha(0.0), rate))
    assert inertia.weights == pytest.approx(expected, rel=1e-6)
