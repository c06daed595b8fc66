import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dexrepro.primitives.transformation import SpringDamper, Step, exact, runge_kutta, semi_implicit

SYSTEM, GOAL, TAU, DURATION = SpringDamper(156.25, 25.0), np.array([2.0]), 1.5, 0.6
DRIFT = np.array([0.4])


def forcing(time):
    return np.array([40.0 * np.sin(5.0 * time)])


def coupling(position, velocity):
    return -3.0 * velocity * position


def stepped(integrator, dt, coupled=coupling):
    x, v = np.array([0.5]), np.array([1.0])
    for k in range(round(DURATION / dt)):
        ends = forcing(k * dt), forcing((k + 1) * dt)
        x, v = integrator(Step(SYSTEM, GOAL, TAU, ends, coupled, DRIFT), x, v, dt)
    return x[0]


def truth(coupled=coupling):
    def rates(t, y):
        x, v = y[:1], y[1:]
        force = forcing(t) + (coupled(x, v) if coupled else 0.0)
        return np.concatenate([v + DRIFT, SYSTEM.acceleration(x, v, GOAL, force)]) / TAU

    return solve_ivp(rates, (0, DURATION), [0.5, 1.0], rtol=1e-11, atol=1e-12).y[0, -1]


@pytest.mark.parametrize(("integrator", "order"), [(exact, 1), (semi_implicit, 1), (runge_kutta, 2)])
def test_integrators_of_a_coupled_primitive_converge_to_the_same_path(integrator, order):
    """Runge-Kutta is of second order here, not of fourth, because the forcing is linear between samples."""
    coarse, fine = (abs(stepped(integrator, dt) - truth()) for dt in (0.02, 0.005))
    assert fine < 5e-3
    assert coarse / fine == pytest.approx(4**order, rel=0.3)


def test_without_coupling_the_closed_form_is_exact_and_the_others_are_not():
    def error(integrator, dt):
        return abs(stepped(integrator, dt, None) - truth(None))

    assert error(exact, 0.02) < 0.02 * error(semi_implicit, 0.02)


def test_printed_kinematics_obey_their_own_equation():
    """tau v' = K (g - x) - D v + F with tau x' = v' means x = x0 + v / tau, Eq. (7.33)."""
    time = np.linspace(0, 1, 2001) * TAU
    path = SYSTEM.solve_printed(np.array([forcing(t) for t in time]), 1 / 2000, [0.5], GOAL, TAU)[:, 0]
    found = solve_ivp(
        lambda t, v: SYSTEM.acceleration(0.5 + v / TAU, v, GOAL, forcing(t)) / TAU,
        (0, TAU), [0.0], t_eval=time, rtol=1e-10, atol=1e-12,
    )  # fmt: skip
    np.testing.assert_allclose(path, 0.5 + found.y[0] / TAU, atol=1e-6)


def test_printed_sign_of_the_damping_changes_the_forcing_by_twice_the_damping():
    position, velocity = np.random.default_rng(0).normal(size=(2, 5, 1))
    correct = SYSTEM.forcing(position, velocity, velocity, GOAL)
    np.testing.assert_allclose(
        SYSTEM.forcing(position, velocity, velocity, GOAL, printed=True), correct - 50.0 * velocity
    )


@pytest.mark.parametrize("stiffness", [1.0, 25.0, 156.25, 1e-3, 3e6, 1234.567])
def test_a_critically_damped_system_is_stepped_in_real_numbers(stiffness):
    """D^2/4 - K is zero up to rounding: a complex pair of roots would be twice the work."""
    step = SpringDamper.critical(stiffness).discretise(0.01)
    assert np.isrealobj(step.first)
    assert step.first == pytest.approx(-(stiffness**0.5))
    slack = SpringDamper(stiffness, 1.999 * stiffness**0.5).discretise(0.01)
    assert np.iscomplexobj(slack.first)


@pytest.mark.parametrize("integrator", [exact, semi_implicit, runge_kutta])
def test_no_drift_is_a_drift_of_zero(integrator):
    x, v, ends = np.array([0.5]), np.array([1.0]), (forcing(0.0), forcing(0.01))
    without, zero = (
        integrator(Step(SYSTEM, GOAL, TAU, ends, None, drift), x, v, 0.01) for drift in (None, np.zeros(1))
    )
    assert np.array_equal(without, zero)
    assert without[0] == pytest.approx(x + 0.01 * v / TAU, abs=0.02), "no faster than its velocity"
