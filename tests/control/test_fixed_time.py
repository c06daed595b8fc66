import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instant import at

from dexrepro.control.fixed_time import FixedTimeBackstepping, secant, settling_bound
from dexrepro.control.motion import Motion
from dexrepro.networks import AdaptiveNetwork, GrowingGaussians

FIRST, SECOND, POWERS = (30.0, 2.0, 2.0), (20.0, 1.5, 1.5), (0.5, 2.0)
finite = st.floats(-10, 10)


def signed_power(x, power):
    """SIG^r(x) of Eq. (3.12) without its square root."""
    return np.sign(x) * np.abs(x) ** power


@given(st.lists(st.floats(0.001, 10), min_size=3, max_size=3))
@settings(max_examples=20, deadline=None)
def test_secant_times_error_is_the_sum_of_the_three_terms(values):
    x = np.array(values)
    expected = 30 * x + 2 * signed_power(x, 0.5) + 2 * signed_power(x, 2.0)
    assert secant(x, FIRST, *POWERS) * x == pytest.approx(expected)


def law(**options):
    return FixedTimeBackstepping(first=FIRST, second=SECOND, powers=POWERS, dt=1e-3, **options)


def test_torque_minus_damping_times_velocity_is_the_printed_law():
    e1, dq, desired = np.array([0.1, -0.2]), np.array([0.5, 0.3]), np.array([0.0, 0.1])
    place = np.array([0.7, -0.4])
    torque, damping, _ = law()(at(place + e1, 0.0, dq), Motion(place, desired, np.zeros(2)))
    x2d = -30 * e1 - 2 * signed_power(e1, 0.5) - 2 * signed_power(e1, 2.0) + desired
    e2 = dq - x2d
    expected = -e1 - 20 * e2 - 1.5 * signed_power(e2, 0.5) - 1.5 * signed_power(e2, 2.0)
    assert torque - damping * dq == pytest.approx(expected)


def test_printed_virtual_control_halves_the_second_error():
    e1, dq = np.array([0.1]), np.array([0.5])
    corrected, printed = law(), law(printed=True)
    for controller in (corrected, printed):
        controller(at(e1, 0.0, dq), Motion(*np.zeros((3, 1))))
    # As printed: x_2d = v + e2 and e2 = dq - x_2d, with v the corrected x_2d.
    assert dq - printed.virtual == pytest.approx((dq - corrected.virtual) / 2)
    assert printed.virtual == pytest.approx(corrected.virtual + dq - printed.virtual)


def simulate(error, controller, load=0.0, seconds=1.5, mass=1.0):
    """A mass under the law, damping applied implicitly; returns its errors."""
    h, position, velocity, errors = 1e-3, error, 0.0, []
    for _ in range(round(seconds / h)):
        told = at(np.array([position]), 0.0, np.array([velocity]))
        torque, damping, _ = controller(told, Motion(*np.zeros((3, 1))))
        velocity = (velocity + h / mass * (float(torque[0]) + load)) / (1 + h / mass * float(damping[0]))
        position += h * velocity
        errors.append(abs(position))
    return np.array(errors)


def test_a_mass_settles_before_the_bound_from_any_distance():
    bound = settling_bound(FIRST, SECOND, POWERS, inertia=1.0, joints=1)
    times = [np.flatnonzero(simulate(e, law()) > 1e-3)[-1] * 1e-3 for e in (0.01, 1.0, 100.0)]
    assert max(times) < bound
    assert times[2] < 2.0 * times[1]  # a hundred times the error is no longer a hundred times the wait


def test_network_removes_the_error_that_an_unknown_load_leaves():
    basis = GrowingGaussians(4, width=7.1, threshold=10, neighbours=3, placement=0.9, enhanced=False, max_nodes=50)
    learning = law(network=AdaptiveNetwork(basis, 1, gain=100, leakage=0.1, step=1e-3))
    without, with_network = (simulate(0.1, c, load=5.0, seconds=2.0)[-1] for c in (law(), learning))
    assert without > 3e-3
    assert with_network < 0.05 * without


def test_bound_falls_with_every_gain_and_is_inverse_to_the_share():
    base = settling_bound(FIRST, SECOND, POWERS, inertia=4.0, joints=7)
    more = settling_bound((30, 4, 4), (20, 3, 3), POWERS, inertia=4.0, joints=7)
    assert more == pytest.approx(base / 2)
    assert settling_bound(FIRST, SECOND, POWERS, inertia=4.0, joints=7, share=0.5) == pytest.approx(2 * base)


def test_bound_of_one_scalar_error_holds_for_the_scalar_system():
    # V = e^2 / 2 under de/dt = -k2 |e|^(1/2) - k3 e^2 from a huge error, against the same constants with unit inertia.
    k2, k3, h, e, time = 2.0, 2.0, 1e-4, 1e6, 0.0
    while e > 1e-6:
        e, time = e / (1 + h * (k2 * e**-0.5 + k3 * e)), time + h
    assert time < settling_bound((0, k2, k3), (0, k2, k3), POWERS, inertia=1.0, joints=1)


def test_printed_bound_is_shorter_than_the_corrected_one_on_the_arm():
    options = dict(inertia=4.35, joints=7)
    assert settling_bound(FIRST, SECOND, POWERS, **options) == pytest.approx(20.8, abs=0.1)
    assert settling_bound(FIRST, SECOND, POWERS, printed=True, **options) == pytest.approx(9.0, abs=0.1)


def test_the_rate_of_the_virtual_velocity_is_a_filtered_difference():
    """Backward Euler of T r' = dx_2d/dt - r: after one period the share dt / (T + dt) of the difference."""
    controller, rest = law(smoothing=0.004), np.zeros(2)
    controller(at(np.array([0.1, -0.2]), 0.0, rest), Motion(rest, rest, rest))
    before = controller.virtual
    controller(at(np.array([0.2, -0.1]), 0.0, rest), Motion(rest, rest, rest))
    assert controller.rate == pytest.approx((controller.virtual - before) / 1e-3 * 1e-3 / (0.004 + 1e-3))


class Watching:
    """Stands where the network does and keeps what it is told."""

    nodes = 4

    def __init__(self):
        self.forgotten = 0

    def forget(self):
        self.forgotten += 1

    def output(self, z, grow=False):
        self.z, self.grow = z, grow
        return np.array([0.3, -0.2])

    def adapt(self, error):
        self.error = error


def test_the_network_s_output_is_taken_off_and_it_learns_from_the_second_error():
    """- W^T S(z) with z = [q, dq, x_2d, dx_2d/dt], Eq. (3.27); the weights are driven by e2, Eq. (3.28)."""
    network, place, velocity = Watching(), np.array([0.1, -0.2]), np.array([0.5, 0.3])
    plain, learning = law(), law(network=network)
    for k in range(2):
        told, goal = at(place * (1 + k), 0.0, velocity), Motion(*np.zeros((3, 2)))
        bare, torque = plain(told, goal).torque, learning(told, goal).torque
    assert bare - torque == pytest.approx([0.3, -0.2])
    assert network.z == pytest.approx(np.concatenate([2 * place, velocity, plain.virtual, plain.rate]))
    assert network.grow
    assert network.error == pytest.approx(velocity - plain.virtual)
    learning.part = lambda error: 2 * error
    learning(told, goal)
    assert network.error == pytest.approx(2 * (velocity - plain.virtual))
    assert learning.diagnostics() == {"nodes": 4}
    assert network.forgotten == 1
    learning.reset(told)
    assert network.forgotten == 2
    assert learning.virtual is None
    learning(told, goal)
    assert not np.any(learning.rate), "no difference to a past that is forgotten"


def test_the_bound_is_that_of_the_scalar_comparison_system():
    """V' = -a V^((1 + alpha)/2) - b V^((1 + beta)/2) ends within 2/(a (1 - alpha)) + 2/(b (beta - 1)).

    With equal gains k and unit inertia V = e^2/2 gives a = k 2^((1 + alpha)/2); the squares of n joints' errors add up
    to at least n^(1 - (1 + beta)/2) times their sum's power, and those of the two errors to 2^(1 - (1 + beta)/2).
    """
    a, b = 3.0 * 2**0.75, 3.0 * 2**1.5 * (2 * 5) ** -0.5
    expected = 2.0 / (a * 0.5) + 2.0 / (b * 1.0)
    assert settling_bound((1.0, 3.0, 3.0), (1.0, 3.0, 3.0), POWERS, inertia=1.0, joints=5) == pytest.approx(expected)
    heavy = settling_bound((1.0, 3.0, 3.0), (1.0, 3.0, 3.0), POWERS, inertia=16.0, joints=5)
    assert heavy == pytest.approx(2.0 * 16**0.75 / (a * 0.5) + 2.0 * 16**1.5 / b)
    free = settling_bound((1.0, 3.0, 3.0), (1.0, 1e9, 1e9), POWERS, inertia=16.0, joints=5)
    assert free == pytest.approx(expected), "then the first error is the slower one"
