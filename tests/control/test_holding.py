import itertools

import numpy as np
import pytest
from instant import at

from dexrepro.control.force_control import IntegralForceControl
from dexrepro.control.holding import AutoregressiveHolding, Compliant, FixedDistance
from dexrepro.control.passive_impedance import PassiveImpedance

DT, DESIRED = 1e-3, 10.0


def proposed(**changes):
    values = dict(dt=DT, desired_force=DESIRED, gain=0.11, estimator_gain=2.0, adaptation=1e-4, lags=3)
    return AutoregressiveHolding(**(values | changes))


def hold(law, duration, stiffness=50.0, speed=0.0, unilateral=True):
    """Force on a follower with perfect tracking; the partner moves at ``speed`` [m/s] against a spring."""
    law.reset(at(0.0))
    z, forces = 0.0, []
    for k in range(round(duration / DT)):
        force = stiffness * (speed * k * DT - z)
        force = max(0.0, force) if unilateral else force
        forces.append(force)
        z = law(at(z, force))
    return np.array(forces)


def test_constant_contact_reaches_the_desired_force():
    assert hold(proposed(), 15.0)[-1] == pytest.approx(DESIRED, abs=1e-3)


def test_ramp_error_decays_with_the_weights_time_constant():
    error = hold(proposed(gain=0.5), 12.0, speed=0.015) - DESIRED
    # Z is near (1, 0, 0, 0) plus small displacements, so the weights integrate with rate Z.Z / L = 0.5 / s or more.
    assert abs(error[8000]) < 0.5 * abs(error[5000])
    assert abs(error[-1]) < 0.1 * 0.015 / 0.5


def test_a_swinging_partner_leaves_the_force_error_of_the_linear_closed_loop():
    """Adapting weights act as an integral: e = k s^2 (s + L) x / ((s + L) (s^2 + k a s + k N b) + k N a), N = Z.Z."""
    law, stiffness, swing, rate, errors, z = proposed(), 50.0, 0.01, 0.5, [], 0.0
    law.reset(at(0.0))
    for k in range(round(60.0 / DT)):
        errors.append(stiffness * (swing * np.sin(rate * k * DT) - z) - DESIRED)
        z = law(at(z, errors[-1] + DESIRED))
    n, s = 1.0 + 3 * (DESIRED / stiffness) ** 2, 1j * rate
    loop = (s + 2.0) * (s**2 + stiffness * 0.11 * s + stiffness * n * 1e-4) + stiffness * n * 0.11
    assert max(errors[-15000:]) == pytest.approx(abs(stiffness * swing * s**2 * (s + 2.0) / loop), rel=0.03)


def test_without_weights_a_ramp_leaves_speed_over_gain():
    error = hold(proposed(adapt=False), 10.0, speed=0.015)[-1] - DESIRED
    assert error == pytest.approx(0.015 / 0.11, rel=0.01)
    force_law = IntegralForceControl(rate=5e-5 / DT, desired_force=DESIRED, dt=DT)
    assert hold(force_law, 15.0, speed=0.015)[-1] - DESIRED == pytest.approx(0.30, rel=0.01)


def test_estimator_gain_cancels_in_the_reference():
    law = proposed(estimator_gain=7.0)
    law.reset(at(0.0))
    rng = np.random.default_rng(0)
    for force, z in rng.normal(size=(50, 2)):
        weights, before = law.weights.copy(), law.reference
        law(at(z, force))
        rate = (law.reference - before) / DT
        assert rate == pytest.approx(weights @ law.regressor + 0.11 * (force - DESIRED), abs=1e-9)


def test_the_printed_definition_of_the_error_loses_contact_at_once():
    forces = hold(proposed(printed=True), 1.5)
    np.testing.assert_array_equal(forces, 0.0)


@pytest.mark.parametrize(("estimator_gain", "stable"), [(0.12, False), (0.4, True)])
def test_stability_needs_a_large_estimator_gain(estimator_gain, stable):
    # N (1 - k beta) < L (L + k alpha) with N = Z.Z = 1 near the start: L > 0.175.
    law = proposed(estimator_gain=estimator_gain, adaptation=1e-4)
    error = hold(law, 90.0, speed=1e-4, unilateral=False) - DESIRED
    early, late = np.abs(error[10_000:30_000]).max(), np.abs(error[-20_000:]).max()
    assert (late < early) == stable


def test_passive_impedance_rings_at_its_natural_frequency():
    error = (
        hold(PassiveImpedance(dt=DT, desired_force=DESIRED, mass=6.0, damping=2.0), 12.0, unilateral=False) - DESIRED
    )
    down = np.flatnonzero((error[:-1] > 0) & (error[1:] <= 0))
    frequency = 2 * np.pi / (np.diff(down).mean() * DT)
    assert frequency == pytest.approx(np.sqrt(50.0 / 6.0 - 1 / 36.0), rel=0.01)
    peaks = [np.abs(error[a:b]).max() for a, b in itertools.pairwise(down)]
    decay = -np.polyfit(down[:-1] * DT, np.log(peaks), 1)[0]
    assert decay == pytest.approx(1.0 / 6.0, rel=0.05)


def test_compliant_tracking_still_reaches_the_desired_force():
    law = Compliant(law=proposed(), impedance=PassiveImpedance(dt=DT, desired_force=DESIRED, mass=6.0, damping=2.0))
    assert hold(law, 15.0)[-1] == pytest.approx(DESIRED, abs=0.05)


def test_a_batch_equals_its_members():
    gains = np.array([0.05, 0.11])
    law = proposed(gain=gains)
    law.reset(at(np.zeros(2)))
    z = np.zeros(2)
    for _ in range(500):
        z = law(at(z, np.maximum(0.0, -50.0 * z)))
    for gain, end in zip(gains, z):
        assert -50.0 * end == pytest.approx(hold(proposed(gain=gain), 0.501)[-1], rel=1e-12)


def test_fixed_distance_is_reached_at_the_set_speed_and_kept():
    law = FixedDistance(dt=0.01, displacement=-0.15, speed=0.3)
    law.reset(at(0.0))
    path = [float(law(at(0.0))) for _ in range(60)]
    assert path[9] == pytest.approx(-0.03)
    assert path[-1] == -0.15


def test_the_regressor_holds_the_present_displacement_and_the_ones_before():
    """Z = [1, z_A(t), z_A(t - dt), ...], Eq. (1.27); the weights learn from it in the same call, Eq. (1.30)."""
    law = proposed(lags=3)
    law.reset(at(0.0))
    weights, estimate = np.zeros(4), 0.0
    for z, force, regressor in (
        (0.1, 4.0, [1, 0.1, 0, 0]),
        (0.3, 7.0, [1, 0.3, 0.1, 0]),
        (0.2, 9.0, [1, 0.2, 0.3, 0.1]),
    ):
        law(at(z, force))
        error = estimate - z
        rate = weights @ regressor - 2.0 * error
        weights = weights - DT * (error + 1e-4 * (DESIRED - force)) * np.array(regressor)
        estimate += DT * rate
        assert law.regressor == pytest.approx(np.array(regressor))
        assert law.weights == pytest.approx(weights)
        assert law.estimate == pytest.approx(estimate)


def test_the_reference_goes_no_faster_than_its_limit_either_way():
    for force, rate in ((0.0, -0.2), (100.0, 0.2), (10.5, 0.11 * 0.5)):
        law = proposed(speed_limit=0.2, adapt=False)
        law.reset(at(0.0))
        assert law(at(0.0, force)) == pytest.approx(rate * DT)


def test_a_contact_position_that_is_told_takes_the_place_of_the_arm_s():
    """Eq. (1.31): then the estimate errs against z_d, while the regressor still holds z_A."""
    law = proposed()
    law.reset(at(0.0))
    law(at(0.3, DESIRED), 0.1)
    assert law.weights == pytest.approx(DT * 0.1 * np.array([1.0, 0.3, 0.0, 0.0]))
    assert law.estimate == pytest.approx(DT * 2.0 * 0.1)


def test_a_compliant_reference_is_the_law_s_and_the_lead_of_the_impedance():
    law, alone = proposed(), proposed()
    impedance, lead = (PassiveImpedance(dt=DT, desired_force=DESIRED, mass=6.0, damping=2.0) for _ in range(2))
    both = Compliant(law=law, impedance=impedance)
    both.reset(at(0.5))
    alone.reset(at(0.5))
    lead.reset(at(0.0))
    for force in (3.0, 12.0, 8.0):
        assert both(at(0.5, force)) == pytest.approx(alone(at(0.5, force)) + lead(at(0.5, force)), rel=1e-12)
    assert both.diagnostics().keys() == {"weights", "estimate"}
