import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from instant import at

from dexrepro.control.motion import Motion
from dexrepro.control.time_delay_impedance import (
    ConstantImpedance,
    GravityImpedance,
    MuscleImpedance,
    RobustImpedance,
    TimeDelayImpedance,
    sampled_spectral_radius,
)

DT = 1e-3


class Axis:
    """One link that swings in the vertical plane: M, G = w cos q, no Coriolis torque."""

    def __init__(self, mass=2e-3, weight=0.0):
        self.mass, self.weight = mass, weight

    def mass_matrix(self, q):
        return np.array([[self.mass]])

    def gravity(self, q):
        return self.weight * np.cos(q)

    def bias(self, q, dq):
        return self.gravity(q)


class TwoLinks:
    """Planar arm with two links in the horizontal plane: has Coriolis torques."""

    a, b, c = 3.0, 0.8, 1.1

    def mass_matrix(self, q):
        coupling = self.c + self.b * np.cos(q[1])
        return np.array([[self.a + 2 * self.b * np.cos(q[1]), coupling], [coupling, self.c]])

    def gravity(self, q):
        return np.zeros(2)

    def bias(self, q, dq):
        h = self.b * np.sin(q[1])
        return np.array([-h * dq[1] * (2 * dq[0] + dq[1]), h * dq[0] ** 2])


def run(plant, law, error=0.0, disturbance=lambda t: 0.0, duration=0.5):
    """Follow a slow sine with the exact axis; returns the errors and the values of r."""
    q, dq = np.array([-error]), np.zeros(1)
    errors, filtered = [], []
    for t in np.arange(0, duration, DT):
        desired = Motion(np.array([1 - np.cos(t)]), np.array([np.sin(t)]), np.array([np.cos(t)]))
        torque = law(at(q, 0.0, dq), desired).torque
        errors.append(float(desired[0][0] - q[0]))
        filtered.append(float(law.error[0]))
        dq = dq + DT * (torque + disturbance(t) - plant.bias(q, dq)) / plant.mass
        q = q + DT * dq
        if abs(dq[0]) > 200:
            return np.array([*errors, np.inf]), np.array(filtered)
    return np.array(errors), np.array(filtered)


def test_error_shrinks_by_the_predicted_factor_each_period():
    """Without disturbance and with the exact model r(k+1) = (1 - L K / M) r(k)."""
    plant = Axis()
    law = TimeDelayImpedance(plant, DT, 20.0, ConstantImpedance(0.4), estimation=True)
    _, r = run(plant, law, error=0.1, duration=0.01)
    assert r[2:] / r[1:-1] == pytest.approx(1 - DT * 0.4 / plant.mass, abs=2e-2)


def test_constant_force_is_cancelled_with_estimation_and_yields_without():
    plant = Axis(weight=0.05)
    push = 0.1
    errors = {
        on: run(
            plant,
            TimeDelayImpedance(plant, DT, 20.0, ConstantImpedance(0.5), estimation=on),
            disturbance=lambda t: push,
            duration=2.0,
        )[0][-1]
        for on in (True, False)
    }
    assert abs(errors[True]) < 1e-5
    assert errors[False] == pytest.approx(-push / (0.5 * 20.0), rel=0.01)


def test_estimation_absorbs_a_wrong_model():
    plant = Axis(mass=2e-3, weight=0.1)
    model = Axis(mass=1.2e-3, weight=0.02)
    with_estimate, without = (
        abs(run(plant, TimeDelayImpedance(model, DT, 20.0, ConstantImpedance(0.5), estimation=on))[0][100:]).max()
        for on in (True, False)
    )
    assert with_estimate < 0.01 * without


@pytest.mark.parametrize("line", ["first_line", "second_line"])
def test_printed_signs_diverge(line):
    plant = Axis()
    errors, _ = run(plant, TimeDelayImpedance(plant, DT, 20.0, ConstantImpedance(0.5), printed=[line]), error=1e-3)
    assert abs(errors).max() > 1.0


@pytest.mark.parametrize(("share", "stable"), [(0.95, True), (1.05, False)])
@pytest.mark.parametrize("ratio", [0.3, 1.0, 1.6])
def test_stability_ends_at_the_sampled_bound(ratio, share, stable):
    """0 < K < (4 M - 2 Mb) / L for one axis."""
    plant, model = Axis(mass=2e-3), Axis(mass=2e-3 * ratio)
    gain = share * (4 * plant.mass - 2 * model.mass) / DT
    errors, _ = run(plant, TimeDelayImpedance(model, DT, 5.0, ConstantImpedance(gain)), error=1e-3, duration=1.5)
    assert (abs(errors).max() < 0.1) == stable
    assert (sampled_spectral_radius(plant.mass, model.mass, gain, DT) < 1) == stable


def test_a_model_more_than_twice_too_heavy_is_unstable_for_every_gain():
    assert min(sampled_spectral_radius(1e-3, 2.1e-3, gain, DT) for gain in np.geomspace(1e-4, 10, 50)) > 1


@given(st.floats(0.01, 0.95), st.floats(0.05, 1.95), st.floats(0.05, 1.2))
@settings(deadline=None, max_examples=40)
def test_spectral_radius_agrees_with_the_jury_criterion(mass, ratio, share):
    bound = (4 - 2 * ratio) * mass / DT
    radius = sampled_spectral_radius(mass, ratio * mass, share * bound, DT)
    assert (radius < 1) == (share < 1) or abs(share - 1) < 1e-6


def test_coriolis_part_is_the_christoffel_matrix_times_the_reference_velocity():
    model = TwoLinks()
    law = TimeDelayImpedance(model, DT, 10.0, ConstantImpedance(0.0), estimation=False)
    q, dq, dq_d = np.array([0.3, 0.9]), np.array([0.7, -0.4]), np.array([-0.2, 0.5])
    h = model.b * np.sin(q[1])
    coriolis = np.array([[-h * dq[1], -h * (dq[0] + dq[1])], [h * dq[0], 0.0]])
    e = np.array([0.02, -0.01])
    de = dq_d - dq
    torque = law(at(q, 0.0, dq), Motion(q + e, dq_d, np.zeros(2))).torque
    assert torque == pytest.approx(model.mass_matrix(q) @ (10 * de) + coriolis @ (dq_d + 10 * e))


def test_impedances_follow_their_equations():
    r = np.array([0.5, -2.0, 0.01])
    assert MuscleImpedance(10.0)(0.06, r) == pytest.approx([0.6] * 3)
    assert RobustImpedance(10.0, 0.3, 1.0, 0.2)(0.06, r) == pytest.approx([0.6, 0.6, 1.5])
    assert (RobustImpedance(0.0, 0.3, 1.0, 1e-9)(0.0, r) * r) == pytest.approx(0.3 * np.sign(r))


def test_matched_torque_filter_keeps_a_filtered_velocity_stable():
    """Velocity from a first-order low pass of differences of a quantised angle: only the matched filter is stable."""
    plant, step, a = Axis(), 2.7e-4, 0.1
    worst = {}
    for matched in (True, False):
        law = TimeDelayImpedance(
            plant, DT, 20.0, ConstantImpedance(0.3), velocity_filter=a if matched else 1.0, torque_limit=5.0
        )
        q = dq = filtered = previous = 0.0
        errors = []
        for t in np.arange(0, 2.0, DT):
            measured = step * round(q / step)
            filtered += a * ((measured - previous) / DT - filtered)
            previous = measured
            desired = Motion(np.array([1 - np.cos(t)]), np.array([np.sin(t)]), np.array([np.cos(t)]))
            torque = float(law(at(np.array([measured]), 0.0, np.array([filtered])), desired).torque[0])
            errors.append(1 - np.cos(t) - q)
            dq += DT * (torque + 0.01) / plant.mass
            q += DT * dq
        worst[matched] = np.sqrt(np.mean(np.square(errors)))
    assert worst[True] < 1e-3
    assert worst[False] > 10 * worst[True]


def test_plain_impedance_holds_gravity_and_yields_to_a_push_by_its_gain():
    plant = Axis(weight=0.05)
    law = GravityImpedance(plant, 20.0, ConstantImpedance(0.5))
    q, still = np.array([0.3]), np.zeros(1)
    assert law(at(q, 0.0, still), Motion(q, still, still)).torque == pytest.approx(plant.gravity(q))
    torque = law(at(still, 0.0, still), Motion(np.array([0.01]), still, still)).torque
    assert torque - plant.gravity(np.zeros(1)) == pytest.approx(0.5 * 20.0 * 0.01)


@pytest.mark.parametrize(
    ("printed", "estimate", "impedance"), [((), 1, 1), (("second_line",), 1, -1), (("first_line",), -1, -1)]
)
def test_every_form_has_its_signs_of_the_estimate_and_of_the_impedance(printed, estimate, impedance):
    """Eqs. (7.38), (7.39): base + sign K_imp r + sign (tau - M q'' - G)(t - L)."""
    model = Axis(weight=0.3)
    law = TimeDelayImpedance(model, DT, 5.0, ConstantImpedance(0.4), printed=printed)
    desired = Motion(np.array([0.2]), np.array([0.1]), np.array([0.7]))
    torques = []
    for q, dq in ((0.1, 0.3), (0.15, 0.4)):
        e, de = 0.2 - q, 0.1 - dq
        expected = model.mass * (0.7 + 5.0 * de) + 0.3 * np.cos(q) + impedance * 0.4 * (de + 5.0 * e)
        if torques:
            expected += estimate * (torques[0] - model.mass * (0.4 - 0.3) / DT - 0.3 * np.cos(0.1))
        torques.append(law(at(np.array([q]), 0.0, np.array([dq])), desired).torque.item())
        assert torques[-1] == pytest.approx(expected)


def test_a_relaxed_muscle_adds_nothing_to_gravity():
    law = GravityImpedance(Axis(weight=0.3), 5.0, MuscleImpedance(2.0))
    torque = law(at(np.array([0.1]), 0.0, np.array([0.3])), Motion(np.array([0.2]), np.zeros(1), np.zeros(1))).torque
    assert torque == pytest.approx([0.3 * np.cos(0.1)])


def test_the_plain_rival_has_the_same_error():
    law = GravityImpedance(Axis(weight=0.3), 5.0, ConstantImpedance(0.4))
    torque = law(
        at(np.array([0.1]), 0.0, np.array([0.3])), Motion(np.array([0.2]), np.array([0.7]), np.zeros(1))
    ).torque
    assert torque == pytest.approx([0.3 * np.cos(0.1) + 0.4 * (0.7 - 0.3 + 5.0 * (0.2 - 0.1))])


def test_the_rival_s_integral_adds_up_and_is_held_where_the_torque_is_at_its_limit():
    """tau = M (q_d'' + k e') + G + K r + integral of rate K r: each period adds rate dt K r, none at the limit."""
    plant, r = Axis(weight=0.05), 0.2 + 20.0 * 0.01
    told, goal = at(np.array([0.3]), 0.0, np.array([0.1])), Motion(np.array([0.31]), np.array([0.3]), np.array([2.0]))
    for limit, grows in ((np.inf, True), (0.01, False)):
        law = TimeDelayImpedance(
            plant, DT, 20.0, ConstantImpedance(0.4), estimation=False, integral_rate=3.0, torque_limit=limit
        )
        torques = [law(told, goal).torque[0] for _ in range(3)]
        expected = plant.mass * (2.0 + 20.0 * 0.2) + 0.05 * np.cos(0.3) + 0.4 * r
        added = 3.0 * DT * 0.4 * r
        assert torques == pytest.approx([min(expected + k * added * grows, limit) for k in range(3)])
        assert law.diagnostics()["filtered_error"] == pytest.approx([r])
        law.reset(told)
        assert law(told, goal).torque[0] == torques[0]


def test_the_delayed_torque_goes_through_the_filter_of_the_velocity():
    """tau_hat = tau~ - M q'' - n, where tau~ follows the torque as the measured velocity follows the true one."""
    plant = Axis(weight=0.05)
    law = TimeDelayImpedance(plant, DT, 20.0, ConstantImpedance(0.4), velocity_filter=0.25)
    bare = TimeDelayImpedance(plant, DT, 20.0, ConstantImpedance(0.4), estimation=False)
    goal, velocities, filtered = Motion(np.array([0.31]), np.array([0.3]), np.array([2.0])), [0.1, 0.14, 0.11], None
    for k, velocity in enumerate(velocities):
        told = at(np.array([0.3]), 0.0, np.array([velocity]))
        torque, expected = law(told, goal).torque, bare(told, goal).torque
        if k:
            expected = expected + filtered - plant.mass * (velocity - velocities[k - 1]) / DT - 0.05 * np.cos(0.3)
        assert torque == pytest.approx(expected)
        filtered = torque if filtered is None else filtered + 0.25 * (torque - filtered)
